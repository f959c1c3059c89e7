#!/usr/bin/env bash
# consumer_test.sh BUILD COMPILER   installs BUILD into a folder of its own and moves that; then the
# installed programs run, and a program is built against the library: by CMake's find_package and by
# pkg-config, shared and static.
set -euo pipefail
build=$1
compiler=$2
here=$(cd "$(dirname "$0")" && pwd)
repository=$here/../..
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fault() {
  printf 'FAULT: %s\n' "$*"
  exit 1
}

# uses_shared yes|no PROGRAM   runs it, and looks which library it has loaded
uses_shared() {
  "$2" || fault "$2 fails"
  local loaded=no
  # grep reads all, as -q would not: then ldd may end by a broken pipe, which counts here.
  ! ldd "$2" | grep 'libholdfast\.so' >/dev/null || loaded=yes
  [ "$1" = "$loaded" ] || fault "$2: loads the shared library: expected $1, found $loaded"
}

cmake --install "$build" --prefix "$work/first" >/dev/null
mv "$work/first" "$work/moved"
prefix=$work/moved

"$prefix/bin/holdfast" check --quiet "$repository/scenarios/arm_breaks_a.json"
"$prefix/bin/holdfast" check --quiet --certificate "$work/proof" \
  "$repository/scenarios/arm_breaks_a.json"
"$prefix/bin/holdfast-checker" "$work/proof" | grep '^PROVED' >/dev/null
if [ -f "$prefix/share/holdfast/holdfast.html" ]; then
  "$prefix/bin/holdfast" view --out - "$repository/scenarios/arm_breaks_a.json" >"$work/page.html"
  grep -q arm_breaks_a "$work/page.html" || fault "view does not fill the installed page"
else
  echo "consumer: no page is built, so view is not tried"
fi
# Emulated modules run with what was installed, or it is said what is missing and what brings it.
for board in v2 v1; do
  code=0
  "$prefix/bin/holdfast" emulate --quiet --board $board "$repository/scenarios/arm_tips_a.json" \
    2>"$work/log" || code=$?
  image=$prefix/share/holdfast/firmware/module_stm32f0.elf
  [ $board = v2 ] || image=$prefix/share/holdfast/firmware/v1/module_stm32f0.elf
  if grep -q '^HOLDFAST_UNICORN:.*NOTFOUND' "$build/CMakeCache.txt"; then
    grep -q "without Unicorn .* './dev firmware' in its sources" "$work/log"
  elif [ ! -f "$image" ]; then
    grep -q "no firmware image is here; the package holdfast-firmware has it" "$work/log"
  else
    [ $code -eq 0 ]
  fi || fault "emulate --board $board: exit $code, $(cat "$work/log")"
  rm -f "$image"
  code=0
  "$prefix/bin/holdfast" emulate --board $board "$repository/scenarios/arm_tips_a.json" \
    2>"$work/log" || code=$?
  if [ $code -ne 65 ] ||
    ! grep -Eq "without Unicorn|the package holdfast-firmware" "$work/log"; then
    fault "emulate without an image: exit $code, $(cat "$work/log")"
  fi
done
for file in bin/holdfast share/holdfast/structure.schema.json \
  share/holdfast/schemas/check.schema.json share/man/man1/holdfast.1.gz \
  share/man/man1/holdfast-checker.1.gz share/bash-completion/completions/holdfast \
  share/zsh/vendor-completions/_holdfast share/fish/vendor_completions.d/holdfast.fish; do
  [ -s "$prefix/$file" ] || fault "$file is not installed"
done

library=$(echo "$prefix"/lib*/libholdfast.so)
nm -D --defined-only "$library" >"$work/names"
! grep -Ev ' (_Z(N|NK|T.N)8holdfast|hf_)' "$work/names" || fault "$library exports others' names"

for kind in shared static; do
  # Who links the shared library needs nothing of what is within.
  alone=()
  [ $kind = static ] ||
    alone=(-DCMAKE_DISABLE_FIND_PACKAGE_fmt=ON -DCMAKE_DISABLE_FIND_PACKAGE_pugixml=ON)
  cmake -S "$here" -B "$work/$kind" -G Ninja -DCMAKE_PREFIX_PATH="$prefix" -DKIND=$kind \
    -DCMAKE_CXX_COMPILER="$compiler" ${alone[@]+"${alone[@]}"} >"$work/log" 2>&1 ||
    { cat "$work/log"; exit 1; }
  cmake --build "$work/$kind" >"$work/log" || { cat "$work/log"; exit 1; }
done
uses_shared yes "$work/shared/consumer"
uses_shared no "$work/static/consumer"

PKG_CONFIG_PATH=$(dirname "$library")/pkgconfig
export PKG_CONFIG_PATH
read -ra flags < <(pkg-config --cflags holdfast)
"$compiler" -std=c++20 "${flags[@]}" -c "$here/main.cpp" -o "$work/main.o"
read -ra libraries < <(pkg-config --libs holdfast)
"$compiler" "$work/main.o" "${libraries[@]}" -o "$work/by_pkg_config"
LD_LIBRARY_PATH=$(dirname "$library") uses_shared yes "$work/by_pkg_config"
# The linker takes the shared one where both are there, unless the archive is named.
read -ra libraries < <(pkg-config --static --libs holdfast | sed 's/-lholdfast/-l:libholdfast.a/')
"$compiler" "$work/main.o" "${libraries[@]}" -o "$work/by_pkg_config_static"
uses_shared no "$work/by_pkg_config_static"
# The program of a module, in C.
"$compiler" -x c -std=c99 "${flags[@]}" -c "$repository/examples/module/on_terminals.c" \
  -o "$work/module.o"
read -ra libraries < <(pkg-config --libs holdfast)
"$compiler" "$work/module.o" "${libraries[@]}" -o "$work/module"
code=0
LD_LIBRARY_PATH=$(dirname "$library") "$work/module" "$here/main.cpp" 2>"$work/log" || code=$?
if [ $code -ne 65 ] || ! grep -q "no configuration of this version" "$work/log"; then
  fault "on_terminals takes a page that is none: exit $code, $(cat "$work/log")"
fi
echo "consumer: installed, moved, linked in five ways"
