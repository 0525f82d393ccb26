"""What a timing was taken on."""

from __future__ import annotations

import datetime
import os
import platform
from importlib.metadata import version
from pathlib import Path

import numpy as np

from ... import _core

_LEVELS = {"avx512f": "AVX-512", "avx2": "AVX2", "avx": "AVX", "asimd": "NEON"}


def machine() -> dict[str, str]:
    """Return the processor, the compiler of the core, and versions, by name."""
    facts = _processor()
    return {
        "processor": facts.get("model name") or platform.processor() or platform.machine(),
        "vectors": _vectors(facts.get("flags") or facts.get("Features") or ""),
        "cores": str(os.cpu_count() or 1),
        "system": platform.platform(),
        **_core.build(),
        "python": platform.python_version(),
        "numpy": np.__version__,
        "rolling_ellipse": version("rolling-ellipse"),
        "date": datetime.date.today().isoformat(),
    }


def _vectors(flags: str) -> str:
    """Return the widest vectors that a processor says it has."""
    known = flags.split()
    return next((name for flag, name in _LEVELS.items() if flag in known), "unknown")


def _processor() -> dict[str, str]:
    """Return what Linux tells of the first processor."""
    try:
        text = Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace")
    except OSError:  # not there on other systems
        return {}
    lines = (line.partition(":") for line in text.partition("\n\n")[0].splitlines())
    return {name.strip(): value.strip() for name, _, value in lines}
