"""What company costs: long calls beside a busy Python thread, and how soon Ctrl-C ends them.

    python tests/benchmarks/bench_interrupts.py

A call that computes asks Python for signals every 50 ms, for which it has to wait until the busy
thread hands the GIL over, after 5 ms. It shares the processor with that thread, too: on one core
nothing could be better than a ratio of 2.
"""

import signal
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
from rolling_ellipse import Scene, classify, flow, scenes, simulate, thresholds

ROUNDS = 5
TIMES = np.linspace(0.0, 500.0, 20_000_000)
ANGLES = np.linspace(0.1, 1.4, 200_000)
LONG: dict[str, Any] = {"max_steps": 2**31 - 1, "max_events": 2**31 - 1}
FREE = Scene(2.0, 1.0, friction=0.0, omega=3.0, x_dot=1.0)
SLIDING = simulate(FREE, 5.0, model="contact")
BOUNCING = Scene(2.0, 1.0, theta=0.5, z=3.0, friction=0.0, restitution=1.0)

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
ENDLESS: dict[str, Callable[[], Any]] = {
    "flow, times": lambda: [CALLS["flow, 20 million times"]() for _ in range(100)],
    "flow, motions, two threads": lambda: flow(
        5.0, a=2.0, b=1.0, theta=np.tile(ANGLES, 50), omega=3.2, workers=2
    ),
    "classify": lambda: classify(a=2.0, b=1.0, theta=np.tile(ANGLES, 200), omega=3.2),
    "rk4": lambda: simulate(
        scenes.rolling, [1e5], model="rolling", method="rk4", step=1e-4, **LONG
    ),
    "gauss": lambda: simulate(
        scenes.rolling, [1e5], model="rolling", method="gauss", step=1e-3, **LONG
    ),
    "radau": lambda: simulate(
        scenes.rolling, [1e5], model="rolling", method="radau", step=1e-3, **LONG
    ),
    "dop853": lambda: simulate(
        scenes.rolling, [1e7], model="rolling", method="dop853", rtol=1e-13, **LONG
    ),
    "dop853 on a slope, with its watch": lambda: simulate(
        scenes.slope, [1e4], model="rolling", method="dop853", rtol=1e-13, **LONG
    ),
    "multipliers, projection": lambda: simulate(
        scenes.rolling, [1e6], model="multipliers", method="dop853", **LONG
    ),
    "multipliers, ggl": lambda: simulate(
        scenes.rolling, [1e5], model="multipliers", method="radau", stabilization="ggl", step=1e-3,
        **LONG,
    ),
    "contact, one endless slide": lambda: simulate(FREE, [1e7], model="contact", **LONG),
    "contact, bounces": lambda: simulate(BOUNCING, [1e8], **LONG),
    "thresholds": lambda: [
        thresholds(2.0, 1.0, gyration2=0.0435, friction=0.25 + 1e-4 * i).lift_off_speed
        for i in range(2000)
    ],
    "samples": lambda: [SLIDING.sol(TIMES / 100) for _ in range(20)],
}  # fmt: skip


@contextmanager
def company() -> Iterator[None]:
    """A thread that keeps the GIL as long as Python lets it."""
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


def seconds(call: Callable[[], Any]) -> float:
    begin = time.perf_counter()
    call()
    return time.perf_counter() - begin


def delay(call: Callable[[], Any]) -> float:
    """From Ctrl-C, half a second after the beginning, to its end."""
    usual = signal.signal(signal.SIGALRM, signal.default_int_handler)  # what SIGINT does
    begin = time.perf_counter()
    signal.setitimer(signal.ITIMER_REAL, 0.5)
    try:
        call()
    except KeyboardInterrupt:
        return time.perf_counter() - begin - 0.5
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, usual)
    raise RuntimeError("it was over before the signal came")


def main() -> None:
    print(f"{'beside a busy thread':36}  alone     ratio, least of {ROUNDS} rounds")
    for name, call in CALLS.items():
        alone, together = [], []
        for _ in range(ROUNDS):
            alone.append(seconds(call))
            with company():
                together.append(seconds(call))
        print(f"{name:36} {min(alone):6.2f} s {min(together) / min(alone):8.2f}")
    print(f"\n{'Ctrl-C ends it after':36}  alone  beside a busy thread")
    for name, call in ENDLESS.items():
        alone_delay = delay(call)
        with company():
            together_delay = delay(call)
        print(f"{name:36} {alone_delay:6.3f} s {together_delay:6.3f} s")


if __name__ == "__main__":
    main()
