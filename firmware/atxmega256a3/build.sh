#!/usr/bin/env bash
# build.sh FOLDER   compiles the module's program for the ATxmega256A3 (Blinky Blocks 1) into FOLDER
# and says how large it is. Debian's avr-g++ 5 knows no C++20, so clang compiles and avr-g++ links;
# the headers of the standard library are those of the Cortex-M0's compiler.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
rooms=$root/libs
out=$1
flash_max=262144
ram_max=16384
headers=$(echo /usr/include/newlib/c++/*/ | tr ' ' '\n' | tail -1)
flags=(--target=avr -mmcu=atxmega256a3 -std=c++20 -Os -DNDEBUG -ffreestanding -fno-exceptions
       -fno-rtti -ffp-contract=off -ffunction-sections -fdata-sections -nostdinc++
       -DHOLDFAST_AGENT_ONE_SWEEP_ONLY -DHOLDFAST_AGENT_STARTS_AFRESH
       -DHOLDFAST_AGENT_SMALL_CHECKSUM -DHOLDFAST_AGENT_FLOOR_ONLY
       -isystem "$headers" -isystem "${headers}arm-none-eabi/thumb/v6-m/nofp"
       -isystem /usr/lib/avr/include
       "-fmacro-prefix-map=$root/=")  # The image must not depend on where it is built.
for room in base mechanics agent module; do
  flags+=("-I$rooms/$room/include" "-I$rooms/$room/src")
done
mkdir -p "$out"
objects=()
# Fronts are no method of this program, and their code needs an int of 32 bits.
mapfile -t sources < <(find "$rooms"/{mechanics,agent,module}/src -name '*.cpp' \
                         ! -name 'front*.cpp' | sort)
for source in "${sources[@]}" "$here/main.cpp"; do
  object=${source#"$root/"}
  object=$out/$(tr / _ <<<"${object%.cpp}").o
  if [ "$source" -nt "$object" ] || [ -n "$(find "$rooms"/{base,mechanics,agent,module} \
      -name '*.hpp' -newer "$object" -print -quit)" ]; then
    clang++-14 "${flags[@]}" -c "$source" -o "$object"
  fi
  objects+=("$object")
done
avr-g++ -mmcu=atxmega256a3 -Wl,--gc-sections "${objects[@]}" -o "$out/module_atxmega256a3.elf"
read -r text data bss _ < <(avr-size "$out/module_atxmega256a3.elf" | tail -1)
echo "atxmega256a3: $((text + data)) bytes of flash of $flash_max, $((data + bss)) of RAM of" \
     "$ram_max"
[ $((text + data)) -le $flash_max ] && [ $((data + bss)) -le $ram_max ]
