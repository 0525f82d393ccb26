"""A lock for what exists once in a process."""

import os
from threading import RLock


class Alone:
    """A lock for all threads, free in a forked process: `with alone(): ...`."""

    def __init__(self) -> None:
        self._renew()
        if hasattr(os, "register_at_fork"):
            os.register_at_fork(after_in_child=self._renew)

    def _renew(self) -> None:
        self._lock = RLock()

    def __call__(self) -> RLock:
        return self._lock
