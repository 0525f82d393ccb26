"""Call everything public with random arguments, extremes of every argument included.

A case is a few lines: a call, then methods of what it returned. It runs in a process of its own,
so that what crashes or never comes back is a finding like any other; the same seed and index draw
the same case. What is drawn is in `fuzz/calls.py` (the table), `fuzz/follow.py`, `fuzz/scenes.py`
and `fuzz/values.py`; what must not happen in `fuzz/judge.py` and `fuzz/promises.py`.

Run:  python tools/fuzz_api.py --calls 200000 --seed 1 --workers 2 --report findings.json
      python tools/fuzz_api.py --seed 1 --index 123        (that case alone)
"""

import sys

from fuzz.__main__ import main

if __name__ == "__main__":
    sys.exit(main())
