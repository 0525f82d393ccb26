#!/bin/sh
# Build the core with clang's libFuzzer, AddressSanitizer and UndefinedBehaviorSanitizer, and search
# for inputs that break it (tools/fuzz_core/fuzz_core.cpp checks every answer):
#
#   tools/fuzz_core.sh                          (ten minutes)
#   tools/fuzz_core.sh -max_total_time=3600     (an hour; all options are libFuzzer's)
#   tools/fuzz_core.sh crash-0123abcd           (that input alone)
#
# CXX names the compiler (default clang++, with its compiler-rt: Debian's libclang-rt-dev), PYTHON an
# interpreter that has the build requirements. Inputs that reached new code are kept in
# build/fuzz_core/corpus; a run begins with them.
set -eu
source=$(cd "$(dirname "$0")/.." && pwd)
folder=$source/build/fuzz_core
compiler=${CXX:-clang++}
python=${PYTHON:-python3}
# Bytes become numbers by arithmetic: recording the comparisons of these numbers takes two thirds of
# the time and does not help libFuzzer.
untraced="-fno-sanitize-coverage=trace-cmp"
checks="address,undefined -fno-sanitize-recover=all"
eigen=$("$python" -c "import os, sys; print(';'.join(
    f'{p}/cmeel.prefix' for p in sys.path if os.path.isdir(f'{p}/cmeel.prefix')))")

mkdir -p "$folder/corpus"
cmake -S "$source" -B "$folder" -DCMAKE_CXX_COMPILER="$compiler" -DROLLING_ELLIPSE_PYTHON=OFF \
    -DCMAKE_BUILD_TYPE=None -DCMAKE_PREFIX_PATH="$eigen" \
    -DCMAKE_CXX_FLAGS="-O2 -g1 -fsanitize=fuzzer-no-link,$checks $untraced" > "$folder/build.log"
cmake --build "$folder" --target rolling_ellipse_core --parallel "${JOBS:-1}" >> "$folder/build.log"
"$compiler" -std=c++17 -O2 -g1 -fsanitize=fuzzer,$checks -DEIGEN_DONT_VECTORIZE -ffp-contract=off \
    -I "$source/src" $(echo "$eigen" | tr ';' '\n' | sed 's|^..*|-isystem &/include/eigen3|') \
    "$source/tools/fuzz_core/fuzz_core.cpp" "$folder/librolling_ellipse_core.a" -pthread \
    -o "$folder/fuzz_core"

cd "$folder"
[ $# -gt 0 ] || set -- -max_total_time=600
case $1 in
-*) exec ./fuzz_core "$@" -max_len=256 -len_control=0 -timeout=60 -print_final_stats=1 corpus ;;
*) exec ./fuzz_core "$@" ;;
esac
