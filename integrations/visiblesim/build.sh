#!/usr/bin/env bash
# build.sh BUILD PATH: compiles the block code beside the VisibleSim at PATH, which its user has and
# has built, with what BUILD (build/release) has of holdfast. Writes PATH/applicationsSrc/holdfast
# and PATH/applicationsBin/holdfast, nothing else.
set -euo pipefail

fail() {
  echo "visiblesim: $*" >&2
  exit 1
}

[ $# -eq 2 ] || { echo "usage: build.sh BUILD PATH" >&2; exit 64; }
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
build=$(cd "$1" && pwd)
[ -d "$2" ] || fail "there is no folder $2"
tree=$(cd "$2" && pwd)
core=$tree/simulatorCore
header=$core/src/base/blockCode.h
library=$core/lib/libsimBlinkyBlocks.a
source=$tree/applicationsSrc/holdfast
binary=$tree/applicationsBin/holdfast
mark='# Written by ./dev visiblesim of holdfast.'

[ -f "$header" ] || fail "$tree is no VisibleSim: it has no simulatorCore/src/base/blockCode.h"
grep -q addMessageEventFunc2 "$header" ||
  fail "this VisibleSim is too old: its BlockCode has no addMessageEventFunc2"
[ -f "$library" ] ||
  fail "this VisibleSim is not built, simulatorCore/lib/libsimBlinkyBlocks.a is missing: build it" \
    "as its README.md says, then come again"
if [ -e "$source" ] && ! grep -qsF "$mark" "$source/Makefile"; then
  fail "$source is there already and not ours: move it away"
fi

includes=
for room in "$root"/libs/*/include; do
  includes+=" -I$room"
done
mkdir -p "$source" "$binary"
# Rules are written with a blank before their commands, which make wants as a tab.
sed 's/^ \(\$\|rm\)/\t\1/' >"$source/Makefile" <<MAKEFILE
$mark
# The block code's sources stay in holdfast; remove this folder and ../../applicationsBin/holdfast
# and nothing of it is left.
HOLDFAST = $here
BUILD = $build
CORE = ../../simulatorCore
OUT = ../../applicationsBin/holdfast/holdfast
OBJECTS = main.o session.o holdfast_code.o change_event.o
ARCHIVES = \$(BUILD)/integrations/visiblesim/libholdfast_visiblesim.a \$(BUILD)/libholdfast.a
LIBRARIES = -lfmt -lpugixml -ldeflate -pthread
FLAGS = -std=c++20 -O2 -Wall -Wextra -MMD \\
  -I\$(HOLDFAST)/src -I\$(HOLDFAST)/block_code $includes -isystem \$(CORE)/src
VISIBLESIM = -L\$(CORE)/lib -lsimBlinkyBlocks -lglut -lGL -lGLU -lGLEW -lmuparser -ldl

all: \$(OUT)

\$(OUT): \$(OBJECTS) \$(ARCHIVES) \$(CORE)/lib/libsimBlinkyBlocks.a
 \$(CXX) -o \$@ \$(OBJECTS) \$(ARCHIVES) \$(VISIBLESIM) \$(LIBRARIES)

%.o: \$(HOLDFAST)/block_code/%.cpp
 \$(CXX) \$(FLAGS) -c \$< -o \$@

clean:
 rm -f \$(OBJECTS) \$(OBJECTS:.o=.d) \$(OUT)

-include \$(OBJECTS:.o=.d)

.PHONY: all clean
MAKEFILE
make -C "$source" --no-print-directory

cat <<TEXT

The block code is $binary/holdfast; to run it, without a display or in a window:
  cd $binary
  ./holdfast -t -c CONFIGURATION.xml
  ./holdfast -R -s inf -c CONFIGURATION.xml
Written: applicationsSrc/holdfast (a Makefile and objects), applicationsBin/holdfast (the program).
To remove it all: rm -r $source $binary
TEXT
