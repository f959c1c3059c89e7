#!/usr/bin/env bash
# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
# threads.sh FOLDER [TURNS]
# The solver on our own threads (host::Team), on OpenMP and on oneTBB, on every family.
#
# FOLDER holds the programs: solver_bench three times, linked with another Team each. They run in
# turn, TURNS times (9), on two threads, cells in memory to load ratios; each run is a process of
# its own that says its fastest solution. Prints the fastest and the median of the runs, and how
# many times as long as ours the libraries take by the median.
set -euo pipefail
folder=$1
turns=${2:-9}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

column() { # PROGRAM: the fastest and the median of its runs
  sort -g "$work/$1" |
    awk '{ at[NR] = $1 } END { printf "%.3f %.3f", at[1], at[int((NR + 1) / 2)] }'
}

printf '%-14s %9s  %-17s %-25s %s\n' \
  structure modules 'ours ms' 'OpenMP ms, ratio' 'oneTBB ms, ratio'
while read -r family size; do
  rm -f "$work"/*
  for ((turn = 0; turn < turns; ++turn)); do
    for team in own openmp onetbb; do
      line=$("$folder/threads_$team" holdfast "$family" "$size" bonded 2 /dev/null)
      modules=${line%% *}
      awk '{ print 1000 * $2 }' <<<"$line" >>"$work/$team"
    done
  done
  read -r own_best own <<<"$(column own)"
  row=$(printf '%-14s %9s  %7s %7s' "$family $size" "$modules" "$own_best" "$own")
  for team in openmp onetbb; do
    read -r best middle <<<"$(column "$team")"
    row+=$(printf '    %8s %8s %5.2f' "$best" "$middle" \
      "$(awk -v a="$middle" -v b="$own" 'BEGIN { print a / b }')")
  done
  echo "$row"
done <<'STRUCTURES'
cube 10
tower 1000
scaffold 20
portal 320
growth 10000
bridge 400
shell 45
cube 46
scaffold 85
STRUCTURES
