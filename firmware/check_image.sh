#!/usr/bin/env bash
# check_image.sh IMAGE [RAM [FLASH]]   sizes and contents of the firmware of an STM32F091: fails if
# it is larger than so many bytes, or if anything is linked that is not holdfast's or on the list.
set -euo pipefail
image=$1
flash_max=${3:-61440}  # 60 KB of the 62 that Blinky Blocks 2 leave for programs
ram_max=${2:-20992}  # 8 KB, and 12.5 KB in which Blinky Blocks' own library keeps its buffers

# Names of ours, the compiler's calls that firmware/src defines, and what is left of libgcc: shifts,
# products of 64 bits, jump tables, leading and trailing zeros, float to integer for the lamp.
allowed='^(_Z.*8holdfast.*|holdfast_.*|CSWTCH\.[0-9]+|memcpy|memmove|memset|memcmp'
allowed+='|__aeabi_(d|f)(add|sub|mul|div|cmp(eq|lt|gt|le|ge))'
allowed+='|__aeabi_(d2f|f2d|i2d|ui2d|d2iz|i2f|ui2f)|__aeabi_u?idiv(mod)?'
allowed+='|__aeabi_(llsl|llsr|lmul|idiv0|ldiv0|f2iz|f2uiz)|__(ashl|lshr|mul)di3'
allowed+='|__c[lt]zsi2|__fixunssfsi|__fixsfsi|__gnu_thumb1_case_(u|s)(q|h)i)$'

bad=$(arm-none-eabi-nm --defined-only --format=just-symbols "$image" |
      grep -Ev -e '^\$[atd]' -e '^\.' | grep -Ev "$allowed" | sort -u || true)
heap=$(arm-none-eabi-nm --format=just-symbols "$image" |
       grep -E '^(malloc|free|_Znw|_Zna|_Zdl|_Zda|_sbrk|__cxa_)' || true)
size=$(arm-none-eabi-size "$image" | tail -1)
read -r text data bss _ <<<"$size"
fault=0
if [ -n "$bad$heap" ]; then
  printf 'firmware: linked, but not allowed:\n%s\n%s\n' "$bad" "$heap"
  fault=1
fi
if [ $((text + data)) -gt "$flash_max" ]; then
  echo "firmware: $((text + data)) bytes of flash, expected at most $flash_max"
  fault=1
fi
if [ $((data + bss)) -gt "$ram_max" ]; then
  echo "firmware: $((data + bss)) bytes of RAM, expected at most $ram_max"
  fault=1
fi
[ $fault -eq 0 ] || exit 1
echo "firmware: $((text + data)) bytes of flash, $((data + bss)) of RAM, all symbols allowed"
