#!/usr/bin/env bash
# completion_test.sh PROGRAM FOLDER   every option that --help lists is completed by bash, zsh and
# fish, for the command that has it; words where the program allows only some.
set -euo pipefail
program=$1
folder=$2
faults=0

fault() {
  printf 'FAULT: %s\n' "$*"
  faults=$((faults + 1))
}

# complete_words WORDS...   what bash offers for the last of them, one a line
complete_words() {
  COMP_WORDS=(holdfast "$@")
  COMP_CWORD=$#
  COMPREPLY=()
  _holdfast
  printf '%s\n' "${COMPREPLY[@]}"
}

# options_of COMMAND   the long options in its --help
options_of() {
  "$program" "$1" --help | sed -n 's/^  \(-[a-zA-Z], \)\{0,1\}\(--[a-z-]*\).*/\2/p'
}

# offers SHELL COMMAND OPTION TEXT PATTERN   the shell's TEXT holds PATTERN
offers() { grep -q -e "$5" <<<"$4" || fault "$1 does not complete $2 $3"; }

# shellcheck source=/dev/null
. "$folder/holdfast.bash"
commands=$("$program" --help | sed -n '/^Commands:/,/^$/s/^  \([a-z]*\)  .*/\1/p')
[ "$(wc -w <<<"$commands")" -ge 6 ] || fault "only these commands are listed: $commands"
count=0
for command in $commands; do
  offers bash "$command" '' "$(complete_words '')" "^$command\$"
  offers zsh "$command" '' "$(<"$folder/_holdfast")" "^        '$command:"
  offers fish "$command" '' "$(<"$folder/holdfast.fish")" "__fish_use_subcommand -a $command "
  in_bash=$(complete_words "$command" --)
  in_zsh=$(sed -n "/^    $command)\$/,/^      ;;\$/p" "$folder/_holdfast")
  in_fish=$(grep "seen_subcommand_from $command'" "$folder/holdfast.fish")
  for option in $(options_of "$command"); do
    count=$((count + 1))
    offers bash "$command" "$option" "$in_bash" "^$option\$"
    offers zsh "$command" "$option" "$in_zsh" "$option\["
    offers fish "$command" "$option" "$in_fish" "-l ${option#--} "
  done
done
[ "$count" -ge 40 ] || fault "only $count options were found in --help"
[ "$(complete_words simulate --link "" | xargs)" = "v1 v2 catoms unit" ] ||
  fault "bash does not complete the words of --link"
[ "$(complete_words simulate --method p)" = polynomial ] ||
  fault "bash does not complete --method polynomial"
[ "$(complete_words generate po)" = portal ] || fault "bash does not complete generate portal"
cd "$(dirname "$0")"
[ "$(complete_words check completion_te)" = completion_test.sh ] ||
  fault "bash does not complete files"
[ "$faults" -eq 0 ] && echo "completions: $count options, in three shells each"
exit "$((faults > 0))"
