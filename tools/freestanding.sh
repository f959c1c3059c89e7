#!/usr/bin/env bash
# freestanding.sh ARCHIVE...   fails if an archive calls anything but holdfast's own functions, the
# four memory functions that every compiler may call, and what stands for a port's empty functions.
set -euo pipefail
allowed='^(memcpy|memmove|memset|memcmp|__cxa_pure_virtual|_GLOBAL_OFFSET_TABLE_|_ZNK?8holdfast.*)$'
symbols=$(nm --undefined-only --format=just-symbols "$@" |
          grep -v -e ':$' -e '^$' | sort -u || true)
bad=$(grep -Ev "$allowed" <<<"$symbols" || true)
if [ -n "$bad" ]; then
  printf 'freestanding: calls outside the allow-list:\n%s\n' "$bad"
  exit 1
fi
echo "freestanding: $(wc -w <<<"$symbols") undefined symbols, all allowed"
