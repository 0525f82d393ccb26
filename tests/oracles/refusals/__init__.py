"""Every message with which the package refuses something, and one call that provokes it.

A table is a list of (pattern, call); the pattern is looked for in the message. Calls that need a
folder take a path. `tests/border/test_messages.py` makes the calls, and compares with the sources.
"""

from collections.abc import Callable
from pathlib import Path
from typing import Any

Refusal = tuple[str, Callable[[Path], Any]]
