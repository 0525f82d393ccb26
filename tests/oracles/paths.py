"""Folders of the checkout, and the programs that make the pages of the site."""

import runpy
from pathlib import Path
from typing import Any

import pytest

TESTS = Path(__file__).resolve().parents[1]
ROOT = TESTS.parent
REFERENCE = ROOT / "reference"
MAKERS = ROOT / "docs" / "makers"


def made_by(name: str) -> dict[str, Any]:
    """Run docs/makers/NAME.py, which may import its neighbours, and return its globals."""
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(MAKERS)
        return runpy.run_path(str(MAKERS / f"{name}.py"))
