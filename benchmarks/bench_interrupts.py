"""Delay of Ctrl-C in long work: single runs of every model, batches, and a notebook.

    python benchmarks/bench_interrupts.py [--tries 50] [--only WORDS]

Each kind of work is started and interrupted many times, at moments spread over half a second. The
table shows the median, the 95th percentile and the maximum of the time from the signal to the
KeyboardInterrupt. A later call must give the same result as before, bit for bit. The exit code is 1
if this result differs, or if a 95th percentile is more than 200 ms. In the notebook, tracebacks are
cut to one line, since Jupyter takes longer to show source code. The last line of the table is the
delay with source code, which does not affect the exit code. The machine should be otherwise idle.
"""

import argparse
import signal
import sys
import time
from collections.abc import Callable
from typing import Any

import numpy as np
from jupyter_client.manager import start_new_kernel
from rolling_ellipse import (
    Impulse,
    Scene,
    Trajectory,
    classify,
    flow,
    scenes,
    simulate,
    simulate_many,
    thresholds,
)

MOST = 0.2  # largest delay allowed at the 95th percentile [s]
ANGLES = np.linspace(0.1, 1.4, 200_000)
LONG: dict[str, Any] = {"max_steps": 2**31 - 1, "max_events": 2**31 - 1}
ROLLING: dict[str, Any] = {"model": "rolling", **LONG}
MULTIPLIERS: dict[str, Any] = {"model": "multipliers", **LONG}
FREE = Scene(2.0, 1.0, friction=0.0, omega=3.0, x_dot=1.0)
SLIDING = simulate(FREE, 5.0, model="contact")
BOUNCING = Scene(2.0, 1.0, theta=0.5, z=3.0, friction=0.0, restitution=1.0)
STEEP = Scene(2.0, 1.0, slope=0.3, omega=3.0, friction=0.4, restitution=0.5)


def again(call: Callable[[], Any]) -> Callable[[], Any]:
    """A function that calls a short function a thousand times."""
    return lambda: [call() for _ in range(1000)]


WORK: dict[str, Callable[[], Any]] = {
    "exact, 2 million samples": again(lambda: simulate(scenes.rolling, TIMES)),
    "exact on a slope, 2 million samples": again(lambda: simulate(scenes.slope, TIMES / 100)),
    "flow, 2 million times": again(lambda: flow(TIMES, a=2.0, b=1.0, theta=0.1, omega=3.2)),
    "rk4": lambda: simulate(scenes.rolling, [1e5], method="rk4", step=1e-4, **ROLLING),
    "gauss": lambda: simulate(scenes.rolling, [1e5], method="gauss", step=1e-4, **ROLLING),
    "radau": lambda: simulate(scenes.rolling, [1e5], method="radau", step=1e-4, **ROLLING),
    "dop853": lambda: simulate(scenes.rolling, [1e7], method="dop853", rtol=1e-13, **ROLLING),
    "dop853 on a slope, with its proof": lambda: simulate(
        scenes.slope, [1e4], method="dop853", rtol=1e-13, **ROLLING
    ),
    "multipliers, projection": lambda: simulate(scenes.rolling, [1e6], **MULTIPLIERS),
    "multipliers, ggl": lambda: simulate(
        scenes.rolling, [1e5], method="radau", stabilization="ggl", step=1e-3, **MULTIPLIERS
    ),
    "contact, one endless slide": lambda: simulate(FREE, [1e7], model="contact", **LONG),
    "contact, bounces": lambda: simulate(BOUNCING, [1e8], **LONG),
    "contact, jumps down a slope": again(lambda: simulate(STEEP, 1e3, **LONG)),
    "contact, samples of a slide": again(lambda: SLIDING.sol(TIMES / 100)),
    "simulate_many, 2 workers, long scenes": lambda: simulate_many(
        [scenes.rolling] * 8, [1e5], workers=2, method="rk4", step=1e-4, **ROLLING
    ),
    "simulate_many, 2 workers, short scenes": again(
        lambda: simulate_many({"a": 2.0, "b": 1.0, "theta": ANGLES}, 1.0, workers=2)
    ),
    "flow, 2 workers, bodies": again(
        lambda: flow(5.0, a=2.0, b=1.0, theta=ANGLES, omega=3.2, workers=2)
    ),
    "classify, 2 workers": again(
        lambda: classify(a=2.0, b=1.0, theta=ANGLES, omega=3.2, friction=0.4, workers=2)
    ),
    "from_arrays, a million samples": lambda: Trajectory.from_arrays(
        TIMES[::2], TIMES[::2], 2 + TIMES[::2], TIMES[::2], scene=FREE
    ),
    "Impulse.press of 20 million": again(lambda: Impulse.press(FORCES, 0.1)),
    "Impulse of a list of 10 million": again(lambda: Impulse(jx=LISTED)),
    "thresholds above Painlevé's friction": lambda: [
        thresholds(2.0, 1.0, gyration2=0.0435, friction=0.25 + 1e-4 * i).lift_off_speed
        for i in range(20_000)
    ],
}
TIMES = np.linspace(0.0, 500.0, 2_000_000)
FORCES = np.linspace(1.0, 2.0, 20_000_000)
LISTED = FORCES[::2].tolist()
IN_NOTEBOOK = {  # the first entry measures Jupyter's own delay
    "notebook, a loop of Python": "while True: pass",
    "notebook, rk4": "rl.simulate(rl.scenes.rolling, [1e5], model='rolling', method='rk4', "
    "step=1e-4, max_steps=2**31 - 1)",
    "notebook, simulate_many, 2 workers": "rl.simulate_many([rl.scenes.rolling] * 8, [1e5], "
    "model='rolling', method='rk4', step=1e-4, max_steps=2**31 - 1, workers=2)",
}
CHECK = "rl.simulate(rl.scenes.drop, 2.0).theta.tobytes().hex()"


def delay(call: Callable[[], Any], after: float) -> float:
    """Time from Ctrl-C, sent `after` seconds into a call, to the end of the call [s]."""
    # the alarm calls Python's SIGINT handler
    usual = signal.signal(signal.SIGALRM, signal.default_int_handler)
    begin = time.perf_counter()
    signal.setitimer(signal.ITIMER_REAL, after)
    try:
        call()
    except KeyboardInterrupt:
        return time.perf_counter() - begin - after
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, usual)
    raise RuntimeError("it was over before the signal came")


def usable() -> bytes:
    return simulate(scenes.drop, 2.0).theta.tobytes()


class Notebook:
    """A kernel, started as Jupyter starts one."""

    def __init__(self) -> None:
        self.manager, self.client = start_new_kernel(kernel_name="python3")
        self.do("import rolling_ellipse as rl")
        self.do("%xmode Minimal")

    def do(self, code: str) -> None:
        self.client.execute(code, silent=True, reply=True, timeout=60)

    def value(self, code: str) -> str:
        """The value of an expression in the kernel, as text."""
        reply = self.client.execute("", user_expressions={"v": code}, reply=True, timeout=60)
        return str(reply["content"]["user_expressions"]["v"]["data"]["text/plain"])

    def delay(self, code: str, after: float) -> float:
        """Time from the interrupt to the reply [s]."""
        # with stop_on_error, Jupyter would drop the next request
        asked = self.client.execute(code, stop_on_error=False)
        self.wait(self.client.get_iopub_msg, asked, "execute_input")
        time.sleep(after)
        begin = time.perf_counter()
        self.manager.interrupt_kernel()
        reply = self.wait(self.client.get_shell_msg, asked, "execute_reply")
        found = time.perf_counter() - begin
        assert reply["ename"] == "KeyboardInterrupt", reply
        return found

    def wait(self, receive: Callable[..., dict[str, Any]], asked: str, kind: str) -> Any:
        """The content of the first message of type `kind` in reply to the request `asked`."""
        while True:
            message = receive(timeout=60)
            if message["msg_type"] == kind and message["parent_header"].get("msg_id") == asked:
                return message["content"]

    def close(self) -> None:
        self.client.stop_channels()
        self.manager.shutdown_kernel(now=True)


def print_delays(name: str, delays: list[float]) -> bool:
    """Print the delays of a kind of work; return whether they are short enough."""
    median, most, longest = 1e3 * np.percentile(delays, [50, 95, 100])
    print(f"{name:50} {median:7.0f} {most:7.0f} {longest:7.0f}", flush=True)
    return bool(most <= 1e3 * MOST)


def main() -> int:
    parser = argparse.ArgumentParser(description=str(__doc__).partition("\n")[0])
    parser.add_argument("--tries", type=int, default=50)
    parser.add_argument("--only", default="", help="kinds of work with these words in their names")
    options = parser.parse_args()
    moments = np.linspace(0.05, 0.5, options.tries)
    print(f"{'Ctrl-C ends it after [ms]':50}  median    95 %  longest of {options.tries}")
    good, before = True, usable()
    for name, call in WORK.items():
        if options.only in name:
            good &= print_delays(name, [delay(call, after) for after in moments])
            good &= usable() == before
    if any(options.only in name for name in IN_NOTEBOOK):
        notebook = Notebook()
        try:
            for name, code in IN_NOTEBOOK.items():
                if options.only in name:
                    delays = [notebook.delay(code, after) for after in moments]
                    good &= print_delays(name, delays)
                    good &= notebook.value(CHECK) == repr(before.hex())
            notebook.do("%xmode Context")
            delays = [notebook.delay(code, after) for after in moments]
            print_delays(f"{name}, stack drawn", delays)
        finally:
            notebook.close()
    print("usable afterwards, within 200 ms" if good else "NOT GOOD")
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
