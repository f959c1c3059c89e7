# shellcheck shell=bash
# Sourced, after `program` is set, by tests that run the program as its users do: makes a folder
# of its own, counts faults and checks expectations.
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
faults=0

fault() {
  printf 'FAULT: %s\n' "$*"
  faults=$((faults + 1))
}

# expect_exit CODE ARGUMENTS...   output in out, errors in err
expect_exit() {
  local expected=$1 code=0
  shift
  "${program:?}" "$@" >out 2>err </dev/null || code=$?
  [ "$code" -eq "$expected" ] || fault "exit $code, expected $expected: $*: $(head -c 300 err)"
}

# expect_line FILE PATTERN   one of its lines matches
expect_line() { grep -Eq -- "$2" "$1" || fault "no line '$2' in $1: $(head -c 400 "$1")"; }

# expect_usage TEXT ARGUMENTS...   exit 64 and one or two lines, one of which matches
expect_usage() {
  local text=$1
  shift
  expect_exit 64 "$@"
  [ "$(wc -l <err)" -le 2 ] || fault "$*: more than two lines: $(head -c 400 err)"
  expect_line err "$text"
}
