#!/usr/bin/env bash
# Compiles the core for web pages: tools/live/build.sh [file.wasm.gz]. This needs em++ (apt-get
# install emscripten) and takes a minute on two cores. The sources and the floating-point flags are
# those of CMakeLists.txt. Eigen is taken from the wheel cmeel-eigen of $PYTHON or, without it, from
# the system.
set -euo pipefail
cd "$(dirname "$0")/../.."
target=$(realpath -m "${1:-python/rolling_ellipse/_player/live.wasm.gz}")
eigen=$("${PYTHON:-python3}" -c "import glob, sys
print(*(p for d in sys.path for p in glob.glob(d + '/cmeel.prefix/include/eigen3')))")
list=$(sed -n '/add_library(rolling_ellipse_core/,/)/p' CMakeLists.txt)
export FLAGS="-std=c++17 -O2 -DNDEBUG -fwasm-exceptions -ffp-contract=off -fno-math-errno \
  -DEIGEN_DONT_VECTORIZE -Isrc -I${eigen:-/usr/include/eigen3}"
command -v ccache > /dev/null && export EM_COMPILER_WRAPPER=ccache  # compiles only what has changed
FOLDER=$(mktemp -d)
export FOLDER
trap 'rm -r "$FOLDER"' EXIT
printf '%s\n' $(grep -o 'src/[a-z_/]*\.cpp' <<< "$list") tools/live/live.cpp |
  xargs -P "$(nproc)" -n 1 sh -c 'em++ $FLAGS -c "$1" -o "$FOLDER/$(echo "$1" | tr / _).o"' -
em++ $FLAGS --no-entry -sSTANDALONE_WASM -sALLOW_MEMORY_GROWTH \
  -sEXPORTED_FUNCTIONS=_columns,_ask,_first,_samples,_malloc,_free \
  "$FOLDER"/*.o -o "$FOLDER/live.wasm"
gzip -9 -n < "$FOLDER/live.wasm" > "$target"
