#!/usr/bin/env bash
# build.sh FOLDER   builds the program of a module as a library (holdfast.h) for all cores, installs
# it into FOLDER/<core>, and checks that it asks for nothing but the compiler's arithmetic, memcpy,
# memset and hf_panic; then the example for the Cortex-M4, FOLDER/on_cortex_m4.elf, by
# find_package, and FOLDER/on_cortex_m4_whole.elf from the sources, with the whole program.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
mkdir -p "$1"
out=$(cd "$1" && pwd)

# quietly COMMAND...   what it says only if it fails
quietly() { "$@" >"$out/log" 2>&1 || { cat "$out/log"; exit 1; }; }

# configure SOURCE CORE FOLDER OPTIONS...
configure() {
  local toolchain=()
  [ "$2" = host ] || toolchain=(-DCMAKE_TOOLCHAIN_FILE="$here/../cores/$2.cmake")
  quietly cmake -S "$1" -B "$3" -G Ninja "${toolchain[@]}" "${@:4}"
  quietly cmake --build "$3"
}

# flash_of CORE ARCHIVE   bytes, with all functions of holdfast.h and the compiler's arithmetic.
flash_of() {
  local compiler=(arm-none-eabi-gcc -mthumb)
  case $1 in
    cortex_m0) compiler+=(-mcpu=cortex-m0) ;;
    cortex_m3) compiler+=(-mcpu=cortex-m3) ;;
    cortex_m4f) compiler+=(-mcpu=cortex-m4 -mfloat-abi=hard -mfpu=fpv4-sp-d16) ;;
    rv32imac) compiler=(riscv64-unknown-elf-gcc -march=rv32imac -mabi=ilp32
                        --specs=picolibc.specs '-Wl,--defsym=__flash_size=1M') ;;
  esac
  printf 'void hf_panic(void) { for (;;) {} }' >"$out/panic.c"
  quietly "${compiler[@]}" -Os -nostartfiles -Wl,--gc-sections,-e,hf_init,-z,noexecstack \
    -Wl,-u,hf_poll,-u,hf_receive,-u,hf_plan,-u,hf_withdraw,-u,hf_withdraw_all \
    -Wl,-u,hf_get_status,-u,hf_verdict_name,-u,hf_reason_name \
    "$out/panic.c" "$2" -o "$out/all.elf"
  size "$out/all.elf" | awk 'NR == 2 {print $1 + $2}'
}

fault=0
: >"$out/sizes"
for core in cortex_m0 cortex_m3 cortex_m4f rv32imac host; do
  configure "$here" $core "$out/build/$core" -DCMAKE_COMPILE_WARNING_AS_ERROR=ON
  quietly cmake --install "$out/build/$core" --prefix "$out/$core"
  archive=$(echo "$out/$core"/lib*/libholdfast-module.a)
  # Names of the compilers' own arithmetic have two underlines.
  asked=$(nm -u "$archive" | awk '$1 == "U" {print $2}' | sort -u |
          grep -Ev '^(_ZN?K?[0-9NK]*8holdfast|__|memcpy$|memset$|hf_panic$)' || true)
  [ -z "$asked" ] || { printf 'library for %s asks for:\n%s\n' $core "$asked"; fault=1; }
  [ $core = host ] || echo "$core $(flash_of $core "$archive")" >>"$out/sizes"
done
echo "library: bytes of flash for $(paste -sd, "$out/sizes" | sed 's/,/, /g')"
configure "$root/examples/module" cortex_m4f "$out/build/example" \
  -DCMAKE_COMPILE_WARNING_AS_ERROR=ON -DCMAKE_PREFIX_PATH="$out/cortex_m4f" \
  -DCMAKE_FIND_ROOT_PATH="$out/cortex_m4f"
configure "$root/examples/module" cortex_m4f "$out/build/example_whole" \
  -DHOLDFAST="$root" -DHOLDFAST_MODULE_SMALL=OFF
for kind in '' _whole; do
  cp "$out/build/example$kind/on_cortex_m4.elf" "$out/on_cortex_m4$kind.elf"
  read -r text data bss _ < <(arm-none-eabi-size "$out/on_cortex_m4$kind.elf" | tail -1)
  echo "on_cortex_m4$kind: $((text + data)) bytes of flash, $((data + bss)) of RAM"
done
exit $fault
