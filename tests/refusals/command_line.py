"""Refusals of the command line."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from rolling_ellipse.__main__ import _motion
from rolling_ellipse._command_line import motion_parser

from refusals import Row


def told(*arguments: str) -> Callable[[Path], Any]:
    """A call of the command line with these arguments."""
    return lambda _: _motion(motion_parser().parse_args(list(arguments)))


REFUSALS: list[Row] = [
    ("--plot", told("--plot=no/such/folder.png")),
    ("--press", told("--press", "-1", "1")),
    ("impulse", told("--a=1e-2", "--b=1e-2")),
]
