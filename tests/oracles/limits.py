"""Context managers for a Ctrl-C after some time and for a full disk."""

import resource
import signal
from collections.abc import Iterator
from contextlib import contextmanager

import pytest


@contextmanager
def ctrl_c_after(seconds: float) -> Iterator[None]:
    """Require that the block ends with a KeyboardInterrupt. A negative time sets no alarm."""
    usual = signal.signal(signal.SIGALRM, signal.default_int_handler)  # the handler of SIGINT
    try:
        if seconds >= 0:
            signal.setitimer(signal.ITIMER_REAL, seconds)
        with pytest.raises(KeyboardInterrupt):
            yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, usual)


@contextmanager
def files_of_at_most(size: int) -> Iterator[None]:
    """Limit the size of files [bytes]. Larger writes raise an OSError, as on a full disk."""
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    usual = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    try:
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, limits[1]))
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
        signal.signal(signal.SIGXFSZ, usual)
