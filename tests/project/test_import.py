"""Importing and using the package leave the state of the process unchanged."""

import os
import platform
import subprocess
import sys

import pytest

# State of a process. MXCSR of x86-64 contains the rounding mode, masks and the flushing of
# subnormal numbers; its six lowest bits record exceptions, which any sum may set.
STATE = """
import ctypes, os, platform, signal, struct, sys, threading, warnings
import matplotlib, numpy as np

LIBC = ctypes.CDLL(None) if sys.platform == "linux" else None
HAS_MXCSR = LIBC is not None and platform.machine() == "x86_64"
MXCSR = 7  # the place in glibc's fenv_t of x86-64, in words of 32 bits

def control_word():
    environment = (ctypes.c_uint32 * 16)()
    ctypes.CDLL("libm.so.6").fegetenv(environment)
    return environment[MXCSR] & ~0x3F

def state():
    one, small, tiny = float("1"), float("1e-30"), float("2.3e-308")
    return {
        "rcParams": dict.__repr__(matplotlib.rcParams.copy()),
        "warnings": list(warnings.filters),
        "numpy": (np.geterr(), np.geterrcall(), np.get_printoptions()),
        "rounding": (one + small, one - small, -one - small),
        "tiny numbers": struct.pack("dd", tiny / 4, (tiny / 4) * one),  # which may count as 0
        "control word": control_word() if HAS_MXCSR else None,
        "signals": {n: signal.getsignal(n) for n in signal.valid_signals()},
        "environment": dict(os.environ),
        "threads": len(os.listdir("/proc/self/task")) if LIBC else threading.active_count(),
        "folder": os.getcwd(),
        "hooks": (sys.excepthook, sys.unraisablehook, sys.displayhook, list(sys.path)),
        "recursion": sys.getrecursionlimit(),
    }

before = state()
{deed}
after = state()
print(*(name for name in before if before[name] != after[name]), sep=",")
"""

IMPORT = "import rolling_ellipse"
EVERY_NAME = "import rolling_ellipse as rl; [getattr(rl, name) for name in rl.__all__]"
USE = """
import rolling_ellipse as rl
scene = rl.scenes.slip
motion = rl.simulate(scene, 2.0)
rl.simulate_many([scene, scene], 1.0, workers=2)
rl.flow(np.linspace(0.0, 9.0, 1000), a=2.0, b=1.0, theta=0.1, omega=3.2, workers=2)
rl.classify(a=2.0, b=1.0, omega=np.linspace(0.0, 9.0, 1000), workers=2)
rl.simulate(scene.replace(omega=np.nextafter(0.0, 1.0)), 1.0)
motion.plot()
rl.plot_forces(motion)
"""

DISTURBANCES = {
    "rcParams": "matplotlib.rcParams['lines.linewidth'] = 7.0",
    "warnings": "warnings.simplefilter('ignore')",
    "numpy": "np.seterr(divide='ignore')",
    "rounding,control word": "ctypes.CDLL('libm.so.6').fesetround(0x800)",
    "signals": "signal.signal(signal.SIGINT, signal.SIG_IGN)",
    "environment": "os.environ['A_NAME_OF_ITS_OWN'] = '1'",
    "threads": "threading.Thread(target=threading.Event().wait, daemon=True).start()",
    "folder": "os.chdir('/')",
    "hooks": "sys.path.append('elsewhere')",
    "recursion": "sys.setrecursionlimit(5000)",
    "tiny numbers,control word": """
environment = (ctypes.c_uint32 * 16)()
ctypes.CDLL("libm.so.6").fegetenv(environment)
environment[MXCSR] |= 0x8040  # FTZ and DAZ
ctypes.CDLL("libm.so.6").fesetenv(environment)
""",
}


def changed(deed: str) -> str:
    """Names of the parts of the state that a program changes in a separate process."""
    done = subprocess.run(
        [sys.executable, "-c", STATE.replace("{deed}", deed)],
        env=os.environ | {"MPLBACKEND": "agg"}, capture_output=True, text=True, timeout=300,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


@pytest.mark.parametrize(
    "deed", [IMPORT, EVERY_NAME, USE], ids=["import", "every name", "motions and pictures"]
)
def test_the_package_leaves_the_process_state_unchanged(deed: str) -> None:
    assert changed(deed) == ""


def test_no_backend_is_chosen_without_a_picture() -> None:
    """Importing the pictures leaves the choice of backend open, as matplotlib itself does."""
    script = f"import matplotlib; {EVERY_NAME}; print(matplotlib.get_backend(auto_select=False))"
    environment = {name: value for name, value in os.environ.items() if name != "MPLBACKEND"}
    done = subprocess.run(
        [sys.executable, "-c", script], env=environment, capture_output=True, text=True, timeout=300
    )
    assert done.stdout == "None\n", done.stderr


@pytest.mark.skipif(
    sys.platform != "linux" or platform.machine() != "x86_64",
    reason=f"numbers of x86-64 Linux, not of {sys.platform} on {platform.machine()}",
)
@pytest.mark.parametrize(("names", "deed"), DISTURBANCES.items(), ids=DISTURBANCES.keys())
def test_a_disturbed_state_is_detected(names: str, deed: str) -> None:
    assert changed(deed) == names
