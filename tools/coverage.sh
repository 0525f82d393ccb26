#!/bin/sh
# Coverage of the suite: lines and branches of C++ (g++ -Og --coverage, gcovr) and of Python
# (coverage.py, with the processes and threads that tests start), in a build separate from the
# ordinary installation:
#
#   tools/coverage.sh                                   (the whole suite, in one process)
#   tools/coverage.sh tests/contact tests/proof         (a part of it; any argument of pytest)
#
# PYTHON names the interpreter (default python3; it must have the extras test and coverage and the
# build requirements). The results are in build/coverage: code that was not run is listed by file
# and line in lines.txt and branches.txt (C++) and python.txt. Each run starts from zero. Edges
# taken only by exceptions are not counted as branches, since nearly every call has one.
set -eu
cd "$(dirname "$0")/.."
python=${PYTHON:-python3}
folder=$PWD/build/coverage
# An inlined function would be counted at each call; without inlining it is counted once.
once=-Dalways_inline=noinline
# The filter selects the project's sources; counting lines in Eigen, too, takes ten times as long.
here=-fprofile-filter-files=src/.*

"$python" -m pip install --quiet --no-build-isolation --no-deps --upgrade \
    --target "$folder/site" -Cbuild-dir="$folder/objects" -Cinstall.strip=false \
    -Ccmake.build-type=None \
    -Ccmake.define.CMAKE_CXX_FLAGS="-Og --coverage -fprofile-update=atomic $here $once" .
find "$folder/objects" -name '*.gcda' -delete
rm -f "$folder"/data.*

export PYTHONPATH="$folder/site${PYTHONPATH:+:$PYTHONPATH}"
export COVERAGE_FILE="$folder/data"
status=0
"$python" -m coverage run -m pytest -p no:cacheprovider "$@" || status=$?

"$python" -m coverage combine --quiet
"$python" -m coverage report --show-missing >"$folder/python.txt"
"$python" -m gcovr --root . --filter src/ --exclude-throw-branches \
    --gcov-ignore-parse-errors suspicious_hits.warn_once_per_file --json "$folder/core.json" \
    "$folder/objects"
"$python" -m gcovr --root . --add-tracefile "$folder/core.json" --merge-lines \
    --txt-metric line --txt "$folder/lines.txt"
echo "C++"
"$python" -m gcovr --root . --add-tracefile "$folder/core.json" --merge-lines \
    --txt-metric branch --txt "$folder/branches.txt" --print-summary
echo "Python"
tail -n 1 "$folder/python.txt"
exit $status
