#!/usr/bin/env bash
# link_test.sh BUILD COMPILER REPOSITORY   What integrations/visiblesim/build.sh links the block
# code with leaves nothing undefined. VisibleSim itself is a stub: build.sh writes its Makefile, and
# all of the archives that this names is linked.
set -euo pipefail
build=$1
compiler=$2
repository=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fault() {
  printf 'FAULT: %s\n' "$*"
  exit 1
}

tree=$work/tree
mkdir -p "$tree/simulatorCore/src/base" "$tree/simulatorCore/lib" "$work/bin"
echo 'void addMessageEventFunc2();' >"$tree/simulatorCore/src/base/blockCode.h"
: >"$tree/simulatorCore/lib/libsimBlinkyBlocks.a"
printf '#!/bin/sh\n' >"$work/bin/make" # The block code cannot be compiled here.
chmod +x "$work/bin/make"
echo 'int main() {}' >"$work/main.cpp"

# variable NAME   as the Makefile sets it
variable() { sed -n "s/^$1 = //p" "$tree/applicationsSrc/holdfast/Makefile"; }

# links BUILD   links everything that the Makefile for this build names; what is missing is in log
links() {
  PATH=$work/bin:$PATH "$repository/integrations/visiblesim/build.sh" "$1" "$tree" >/dev/null
  local archives libraries
  read -ra archives < <(variable ARCHIVES | sed "s|\$(BUILD)|$1|g")
  read -ra libraries < <(variable LIBRARIES)
  "$compiler" "$work/main.cpp" -o "$work/main" -Wl,--whole-archive "${archives[@]}" \
    -Wl,--no-whole-archive "${libraries[@]}" >"$work/log" 2>&1
}

links "$build" || fault "as it is built: $(grep -m3 undefined "$work/log")"
echo "visiblesim: linked"
