"""Facts and small tools that the timings share."""

from __future__ import annotations

import datetime
import os
import platform
from contextlib import suppress
from importlib.metadata import version
from pathlib import Path

import numpy as np
from rolling_ellipse import _core

_LEVELS = {"avx512f": "AVX-512", "avx2": "AVX2", "avx": "AVX", "asimd": "NEON"}


def machine() -> dict[str, str]:
    """Return the processor and its widest vectors, the compiler of the core, versions, by name."""
    text = ""
    with suppress(OSError):  # not there but on Linux
        text = Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace")
    lines = (line.partition(":") for line in text.partition("\n\n")[0].splitlines())
    facts = {name.strip(): value.strip() for name, _, value in lines}
    flags = (facts.get("flags") or facts.get("Features") or "").split()
    return {
        "processor": facts.get("model name") or platform.processor() or platform.machine(),
        "vectors": next((name for flag, name in _LEVELS.items() if flag in flags), "unknown"),
        "cores": str(os.cpu_count() or 1),
        "system": platform.platform(),
        **_core.build(),
        "python": platform.python_version(),
        "numpy": np.__version__,
        "rolling_ellipse": version("rolling-ellipse"),
        "date": datetime.date.today().isoformat(),
    }
