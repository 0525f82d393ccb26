"""Where things are in the checkout: the one place that counts folders upwards."""

from pathlib import Path

TESTS = Path(__file__).resolve().parents[1]
ROOT = TESTS.parent
REFERENCE = ROOT / "reference"
