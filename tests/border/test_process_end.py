"""A process can end or fork without waiting for a thread that is still working."""

from pathlib import Path

import pytest
from oracles.programs import run

# Calls of every kind: long ones, and short ones that are repeated until the main thread ends.
# Pictures are left out, since matplotlib itself aborts (a static map of ft2font outlives Python).
LONG = {
    "rk4": "simulate(R, [1e5], model='rolling', method='rk4', step=1e-4, **ON)",
    "gauss": "simulate(R, [1e5], model='rolling', method='gauss', step=1e-4, **ON)",
    "radau": "simulate(R, [1e5], model='rolling', method='radau', step=1e-4, **ON)",
    "dop853": "simulate(R, [1e7], model='rolling', rtol=1e-13, method='dop853', **ON)",
    "projection": "simulate(R, [1e6], model='multipliers', **ON)",
    "ggl": "simulate(R, [1e5], **M, method='radau', stabilization='ggl', step=1e-3)",
    "contact": "simulate(FREE, [1e7], model='contact', **ON)",
    "thresholds": "rl.thresholds(2., 1., gyration2=.0435, friction=.25).lift_off_speed",
    "classify": "rl.classify(a=2., b=1., theta=ANGLES, omega=3.2, friction=.4, workers=2)",
    "blows": "rl.outcome(rl.scenes.report, rl.Impulse(jx=ANGLES[:5000]))",
    "flow, times": "rl.flow(TIMES, a=2., b=1., theta=.1, omega=3.2)",
    "flow, bodies": "rl.flow(5., a=2., b=1., theta=ANGLES, omega=3.2, workers=2)",
    "exact": "simulate(R, TIMES)",
    "simulate_many": "simulate_many([R, FREE] * 50, 2., workers=1)",
    "simulate_many, 2 workers": "simulate_many([R, FREE] * 50, 2., workers=2)",
    "simulate_many, out": "simulate_many([R, FREE] * 50, 2., workers=2, out=f'out{next(COUNT)}')",
    "sol": "DROP.sol(np.linspace(0., 2., 10**5)).energy",
    "sol, loaded": "pickle.loads(LOADED).sol([1.])",
    "when": "(DROP.when(z=1.), DROP.scene_at(1.))",
    "constraints": "DROP.sol(np.linspace(0., 2., 50000)).constraint_residuals()",
    "work_precision": "rl.work_precision(R, 4., rounds=2, max_seconds=3)",
    "explore": "rl.explore(rl.scenes.report).to_html('explorer.html')",
    "film": "DROP.animate('film.html')",
}
DAEMON = """
import itertools, pickle, sys, threading, time, warnings
import numpy as np, rolling_ellipse as rl
from rolling_ellipse import simulate, simulate_many
warnings.simplefilter("ignore")
ON = {"max_steps": 2**31 - 1, "max_events": 2**31 - 1}
M = {"model": "multipliers", **ON}
R, FREE = rl.scenes.rolling, rl.Scene(2., 1., friction=0., omega=3., x_dot=1.)
TIMES, ANGLES = np.linspace(0., 500., 10**6), np.linspace(.1, 1.4, 20000)
DROP, COUNT = simulate(rl.scenes.drop, 2.), itertools.count()
LOADED = pickle.dumps(DROP)

def work():
    while True:
        {call}

thread = threading.Thread(target=work, daemon=True)
thread.start()
time.sleep({seconds})
assert thread.is_alive()
"""


@pytest.mark.parametrize("call", LONG.values(), ids=LONG)
def test_a_daemon_thread_does_not_block_the_end_of_the_process(call: str, tmp_path: Path) -> None:
    """The main thread ends 0.15 s or 0.22 s after the call starts. The exit code is 0."""
    for seconds in ("0.15", "0.22"):
        script = DAEMON.replace("{call}", call).replace("{seconds}", seconds)
        done = run(script, cwd=tmp_path)
        assert (done.returncode, done.stderr) == (0, "")


# A thread is held while it draws a figure. Meanwhile the process forks. The child, in which that
# thread does not exist, draws the figure of another motion. The alarm kills the child if it waits
# for the thread.
FORK = """
import os, pickle, signal, sys, threading, types, warnings
import matplotlib.pyplot as plt
import rolling_ellipse as rl
warnings.simplefilter("ignore")  # newer Pythons warn of a fork beside threads
file = pickle.dumps(rl.simulate(rl.scenes.drop, 2.0))
held, other = pickle.loads(file), pickle.loads(file)
begun, released = threading.Event(), threading.Event()
main = threading.current_thread()

def wait(*_):
    if threading.current_thread() is not main:
        begun.set()
        released.wait()

sys.modules["hooks"] = types.SimpleNamespace(wait=wait)
plt.rcParams["figure.hooks"] = ["hooks:wait"]
thread = threading.Thread(target=held.plot_energy)
thread.start()
begun.wait()
child = os.fork()
if child == 0:
    signal.alarm(30)
    other.plot_energy()
    os._exit(0)
code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
released.set()
thread.join()
raise SystemExit(code)
"""


def test_a_forked_child_does_not_wait_for_a_figure_drawn_in_another_thread() -> None:
    assert run(FORK).returncode == 0


# The forking thread becomes the main thread of the child, which receives Ctrl-C.
FORKED_BY_A_THREAD = """
import os, signal, threading, warnings
import rolling_ellipse as rl
warnings.simplefilter("ignore")
rl.simulate(rl.scenes.rolling, 1.0)  # loads NumPy, which turns a Ctrl-C meanwhile into ImportError

def fork():
    global code
    child = os.fork()
    if child == 0:
        threading.Timer(60.0, os._exit, [2]).start()
        signal.signal(signal.SIGALRM, signal.default_int_handler)
        signal.setitimer(signal.ITIMER_REAL, 0.25)
        try:
            rl.simulate(rl.scenes.rolling, [1e6], model="rolling", method="rk4", step=1e-4,
                        max_steps=2**31 - 1)
        except KeyboardInterrupt:
            os._exit(0)
        os._exit(1)
    code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])

thread = threading.Thread(target=fork)
thread.start()
thread.join()
raise SystemExit(code)
"""


def test_ctrl_c_interrupts_long_work_in_a_child_process_forked_by_a_thread() -> None:
    assert run(FORKED_BY_A_THREAD).returncode == 0
