"""Slowdown of long calls beside a busy Python thread.

    python benchmarks/bench_company.py

A call asks Python for signals every 50 ms, and then waits 5 ms until the busy thread releases the
GIL. The call and the thread share the processor: on one core the least possible ratio is 2.
"""

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
from common import seconds
from rolling_ellipse import flow, scenes, simulate

ROUNDS = 5
TIMES = np.linspace(0.0, 500.0, 20_000_000)
ANGLES = np.linspace(0.1, 1.4, 200_000)
LONG: dict[str, Any] = {"max_steps": 2**31 - 1, "max_events": 2**31 - 1}

CALLS: dict[str, Callable[[], Any]] = {
    "flow, 20 million times": lambda: flow(TIMES, a=2.0, b=1.0, theta=0.1, omega=3.2),
    "flow, 200 000 motions": lambda: flow(5.0, a=2.0, b=1.0, theta=ANGLES, omega=3.2),
    "rk4, a million steps": lambda: simulate(
        scenes.rolling, [1e3], model="rolling", method="rk4", step=1e-3, **LONG
    ),
    "dop853, 600 000 steps": lambda: simulate(
        scenes.rolling, [6e4], model="rolling", method="dop853", rtol=1e-13, **LONG
    ),
}


@contextmanager
def company() -> Iterator[None]:
    """A thread that holds the GIL as long as Python allows."""
    over = threading.Event()

    def busy() -> None:
        while not over.is_set():
            sum(range(1000))

    thread = threading.Thread(target=busy)
    thread.start()
    try:
        yield
    finally:
        over.set()
        thread.join()


def main() -> None:
    print(f"{'beside a busy thread':36}  alone     ratio, least of {ROUNDS} rounds")
    for name, call in CALLS.items():
        alone, together = [], []
        for _ in range(ROUNDS):
            alone.append(seconds(call))
            with company():
                together.append(seconds(call))
        print(f"{name:36} {min(alone):6.2f} s {min(together) / min(alone):8.2f}")


if __name__ == "__main__":
    main()
