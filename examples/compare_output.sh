#!/usr/bin/env bash
# compare_output.sh SOURCE PROGRAM   runs the command in the source's "// $ ..." line with PROGRAM
# and compares what it prints with the comment lines below.
set -euo pipefail
arguments=$(sed -n 's/^\/\/ \$ [^ ]* *//p' "$1")
expected=$(sed -n '/^\/\/ \$ /,/^$/p' "$1" | sed -n 's/^\/\/ > //p')
cd ..
# shellcheck disable=SC2086  # arguments are words
diff <(printf '%s\n' "$expected") <("$2" $arguments)
