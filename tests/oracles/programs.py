"""Python programs in separate processes."""

import os
import subprocess
import sys
import textwrap
from typing import Any


def run(code: str, *arguments: Any, **how: Any) -> subprocess.CompletedProcess[str]:
    """Run a program, for five minutes at most."""
    command = [sys.executable, "-c", textwrap.dedent(code), *map(os.fspath, arguments)]
    how |= {"env": os.environ | {"MPLBACKEND": "agg"}, "timeout": 300}
    return subprocess.run(command, capture_output=True, text=True, check=False, **how)


def printed(code: str, *arguments: Any) -> str:
    """The output of a program, whose exit code must be 0."""
    done = run(code, *arguments)
    assert done.returncode == 0, done.stderr
    return done.stdout
