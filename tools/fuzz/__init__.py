"""The fuzzer for the public API; `tools/fuzz_api.py` is its command."""

import sys
from pathlib import Path

# the strategies use tests/oracles
sys.path.append(str(Path(__file__).resolve().parents[2] / "tests"))
