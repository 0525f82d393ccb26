"""How far a long race has come, told where somebody looks."""

from __future__ import annotations

import importlib
import sys
from importlib.util import find_spec
from types import TracebackType
from typing import Any, Self

_DELAY = 2.0  # a race that takes less says nothing [s]


class Progress:
    """A bar on a terminal, or in a notebook that has widgets; nothing elsewhere."""

    def __init__(self, total: int) -> None:
        self.bar: Any = None
        if find_spec("tqdm") is None:
            return
        widgets = "ipykernel" in sys.modules and find_spec("ipywidgets") is not None
        kind = importlib.import_module("tqdm.notebook" if widgets else "tqdm")
        quiet = not widgets and not sys.stderr.isatty()
        self.bar = kind.tqdm(total=total, delay=_DELAY, leave=False, disable=quiet)

    def advance(self, what: str) -> None:
        """Go on by one."""
        if self.bar is not None:
            self.bar.set_postfix_str(what, refresh=False)
            self.bar.update()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:  # fmt: skip
        if self.bar is not None:
            self.bar.close()
