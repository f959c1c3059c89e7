#!/usr/bin/env bash
# address_sanitizer.sh [PYTEST OPTIONS]   the tests with the extension's own sources compiled with
# AddressSanitizer, and every allocation of Python, numpy and the library watched by it. The library
# itself is what ./dev python has built; ./dev test has it with sanitizers.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
out=$PWD/build/python-asan
rm -rf "$out"
mkdir -p "$out/objects"
cp -r build/python "$out/package"
cd build/release
ninja -t commands holdfast_python | grep 'python/CMakeFiles/holdfast_python.dir' |
  sed -e "s# -o python/CMakeFiles/holdfast_python.dir/src/# -o $out/objects/#" \
      -e "s#python/CMakeFiles/holdfast_python.dir/src/\([a-z_]*\.cpp\.o\)#$out/objects/\1#g" \
      -e "s# -o python/_core# -o $out/package/holdfast/_core#" \
      -e 's# -O3 # -O1 -g1 -fsanitize=address -fno-omit-frame-pointer #' \
      -e 's# -shared # -shared -fsanitize=address #' |
  while read -r command; do
    eval "$command"
  done
cd ../..
LD_PRELOAD="$(g++ -print-file-name=libasan.so) $(g++ -print-file-name=libstdc++.so)" \
  ASAN_OPTIONS=detect_leaks=0 PYTHONMALLOC=malloc PYTHONDONTWRITEBYTECODE=1 \
  HOLDFAST_TEST_PATIENCE=50 PYTHONPATH="$out/package" \
  /usr/bin/python3 -m pytest -k 'not types and not stubs' "$@"
