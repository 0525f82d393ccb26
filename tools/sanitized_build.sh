#!/bin/sh
# Build the extension with the address and undefined-behaviour sanitizers of g++, apart from the
# ordinary installation, and run a command of Python under it:
#
#   tools/sanitized_build.sh                                   (builds only)
#   tools/sanitized_build.sh tools/fuzz_api.py --calls 5000 --seconds-per-call 20 --no-memory-limit
#   tools/sanitized_build.sh -m pytest tests/contact/test_contact.py
#
# PYTHON names the interpreter (default python3; it must have the build requirements); the build
# lies in build/sanitized. Reads out of bounds, undefined arithmetic and the like end the process
# with a report; the fuzzer counts that as a crash.
set -eu
cd "$(dirname "$0")/.."
python=${PYTHON:-python3}
folder=$PWD/build/sanitized
flags="-fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer -O1 -g1"

"$python" -m pip install --quiet --no-build-isolation --no-deps --upgrade \
    --target "$folder/site" -Cbuild-dir="$folder/objects" -Cinstall.strip=false \
    -Ccmake.build-type=None -Ccmake.define.CMAKE_CXX_FLAGS="$flags" .

# Python itself is not built so: the runtime has to be there before it, and with it libstdc++, whose
# exceptions the runtime watches.
preload="$(g++ -print-file-name=libasan.so) $(g++ -print-file-name=libstdc++.so.6)"
export PYTHONPATH="$folder/site${PYTHONPATH:+:$PYTHONPATH}"
export ASAN_OPTIONS="detect_leaks=0:allocator_may_return_null=1:handle_segv=1${ASAN_OPTIONS:+:$ASAN_OPTIONS}"
export UBSAN_OPTIONS="print_stacktrace=1${UBSAN_OPTIONS:+:$UBSAN_OPTIONS}"
export PYTHONMALLOC=malloc # so that arrays of NumPy and bytes have their bounds

if [ $# -eq 0 ]; then
    echo "LD_PRELOAD='$preload' PYTHONPATH='$PYTHONPATH' ASAN_OPTIONS='$ASAN_OPTIONS' \\"
    echo "UBSAN_OPTIONS='$UBSAN_OPTIONS' PYTHONMALLOC=malloc $python ..."
    exit
fi
LD_PRELOAD="$preload" exec "$python" "$@"
