#!/bin/sh
# Build the extension with sanitizers of g++, separately from the ordinary installation, and run a
# Python command with it:
#
#   tools/sanitized_build.sh                                   (builds only)
#   tools/sanitized_build.sh --suite                           (the whole suite; arguments of
#                                                              pytest may follow)
#   tools/sanitized_build.sh tools/fuzz_api.py --calls 5000 --seconds-per-call 20 --no-memory-limit
#   tools/sanitized_build.sh -m pytest tests/contact/test_contact.py
#   tools/sanitized_build.sh --threads --suite                 (tests that run several threads)
#
# Without --threads the address and undefined-behaviour sanitizers are used: a read out of bounds or
# undefined arithmetic ends the process with a report, which the fuzzer counts as a crash. With
# --threads the thread sanitizer is used: it reports data races, and the exit code is 66.
#
# PYTHON names the interpreter (default python3; it must have the build requirements, and no
# editable installation of the package); the builds are in build/sanitized and
# build/sanitized-threads.
set -eu
cd "$(dirname "$0")/.."
python=${PYTHON:-python3}
if [ "${1:-}" = --threads ]; then
    shift
    folder=$PWD/build/sanitized-threads
    flags="-fsanitize=thread"
    runtime=libtsan.so
else
    folder=$PWD/build/sanitized
    flags="-fsanitize=address,undefined -fno-sanitize-recover=undefined"
    runtime=libasan.so
fi

"$python" -m pip install --quiet --no-build-isolation --no-deps --upgrade \
    --target "$folder/site" -Cbuild-dir="$folder/objects" -Cinstall.strip=false \
    -Ccmake.build-type=None -Ccmake.define.CMAKE_CXX_FLAGS="$flags -fno-omit-frame-pointer -O1 -g1" .

# Python itself is not sanitized, so the runtime must be loaded first, together with libstdc++,
# whose exceptions it intercepts.
preload="$(g++ -print-file-name=$runtime) $(g++ -print-file-name=libstdc++.so.6)"
export PYTHONPATH="$folder/site${PYTHONPATH:+:$PYTHONPATH}"
export PYTHONMALLOC=malloc # gives NumPy arrays and bytes their own bounds
if [ $runtime = libtsan.so ]; then
    export TSAN_OPTIONS="exitcode=66:die_after_fork=0${TSAN_OPTIONS:+:$TSAN_OPTIONS}"
else
    asan="detect_leaks=0:allocator_may_return_null=1:handle_segv=1"
    export ASAN_OPTIONS="$asan${ASAN_OPTIONS:+:$ASAN_OPTIONS}"
    export UBSAN_OPTIONS="print_stacktrace=1${UBSAN_OPTIONS:+:$UBSAN_OPTIONS}"
fi

if [ $# -eq 0 ]; then
    echo "LD_PRELOAD='$preload' PYTHONPATH='$PYTHONPATH' PYTHONMALLOC=malloc \\"
    echo "TSAN_OPTIONS='${TSAN_OPTIONS:-}' ASAN_OPTIONS='${ASAN_OPTIONS:-}' \\"
    echo "UBSAN_OPTIONS='${UBSAN_OPTIONS:-}' $python ..."
    exit
fi
# An editable installation in the same Python would be found first.
LD_PRELOAD="$preload" "$python" -c "
import sys, rolling_ellipse._core as core
sys.exit(None if core.__file__.startswith('$folder/site') else f'not sanitized: {core.__file__}')"

if [ "$1" = --suite ]; then
    shift
    # The suite omits tests with limited memory, since the runtimes reserve terabytes of addresses;
    # the tests in a browser, whose processes would load the runtime; and the fuzzer, which runs as
    # above without its limit. The output of the runtimes is not captured.
    set -- -m pytest -p no:cacheprovider --capture=sys "$@" \
        --deselect tests/border/test_border.py::test_results_are_the_same_if_threads_cannot_be_started \
        --ignore tests/border/test_fuzz.py --ignore tests/player/test_browser.py
    if [ $runtime = libtsan.so ]; then
        set -- "$@" tests/border/test_threads.py tests/border/test_border.py tests/batches \
            tests/rolling/test_many_times.py tests/rolling/test_lanes.py \
            tests/outcome/test_classify.py
    fi
fi
LD_PRELOAD="$preload" exec "$python" "$@"
