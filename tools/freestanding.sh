#!/usr/bin/env bash
# freestanding.sh ARCHIVE...   fails if an archive calls anything but holdfast's own functions and
# the four memory functions that every compiler may call.
set -euo pipefail
allowed='^(memcpy|memmove|memset|memcmp|_GLOBAL_OFFSET_TABLE_|_ZNK?8holdfast.*)$'
symbols=$(nm --undefined-only --format=just-symbols "$@" |
          grep -v -e ':$' -e '^$' | sort -u || true)
bad=$(grep -Ev "$allowed" <<<"$symbols" || true)
if [ -n "$bad" ]; then
  printf 'freestanding: calls outside the allow-list:\n%s\n' "$bad"
  exit 1
fi
echo "freestanding: $(wc -w <<<"$symbols") undefined symbols, all allowed"
