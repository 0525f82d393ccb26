"""The border between Python and the C++ core: arrays, threads, Ctrl-C, names and help."""

import inspect
import re
import signal
import tracemalloc
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import rolling_ellipse as rl
from oracles.programs import printed
from rolling_ellipse import Scene, _core, flow, scenes, simulate, thresholds
from rolling_ellipse._ask import settings
from rolling_ellipse._ask.records import cached_property

TIMES = simulate(scenes.rolling, 1.0)._solution
SLIDES = simulate(scenes.slip, 1.0)._solution


def test_unaligned_arrays_are_copied_on_entry() -> None:
    """Unaligned numbers are copied, since reading them through a `const double*` would be undefined
    behaviour. All array arguments of the core have one type, which makes this copy."""
    aligned = np.linspace(0.0, 1.0, 100_001)
    there = np.frombuffer(b"-" + aligned.tobytes(), float, aligned.size, offset=1)
    copied = []
    for times in (aligned, there):
        tracemalloc.start()
        assert (_core.sample_times(times) is times) == times.flags.aligned
        copied.append(tracemalloc.get_traced_memory()[1] >= aligned.nbytes)
        tracemalloc.stop()
    assert not there.flags.aligned and copied == [False, True]


def test_results_are_the_same_if_threads_cannot_be_started() -> None:
    code = """
        import resource
        import numpy as np
        from rolling_ellipse import flow

        t = np.linspace(0.0, 50.0, 300_000)
        start = {"a": 2.0, "b": 1.0, "theta": 0.1, "omega": 3.2}
        alone = flow(t, **start)
        pages = int(open("/proc/self/statm").read().split()[0])
        limit = pages * resource.getpagesize() + 200 * 2**20  # about twenty stacks of 8 MiB
        resource.setrlimit(resource.RLIMIT_AS, (limit, limit))
        for one, many in zip(alone, flow(t, workers=200, **start)):
            assert np.array_equal(one, many)
        print("the same")
    """
    assert printed(code) == "the same\n"


def test_running_out_of_memory_raises_a_memory_error() -> None:
    """The memory limit grows in steps of 4 MB, the size of an array, so that each of the
    allocations in a call fails in turn."""
    code = """
        import resource
        import numpy as np
        from rolling_ellipse import Scene, classify, flow, geometry, scenes, simulate
        size, body = 500_000, {"a": 2.0, "b": 1.0}
        strided = np.linspace(0.0, 1.0, 2 * size)[::2]
        rolls, bounces = simulate(Scene(**body, omega=3.2), 1.0), simulate(scenes.bounce, 1.0)
        calls = [
            lambda t: flow(t, **body, theta=0.0, omega=1.0), rolls.sol, bounces.sol,
            lambda t: simulate(Scene(**body, omega=3.2), t),
            lambda t: classify(**body, omega=t), lambda t: geometry.support(t, **body),
        ]
        refused = 0
        for t in (strided, strided.copy(), strided[::-1]):
            for call in calls[: 3 if t[0] else None]:
                for room in range(24):
                    pages = int(open("/proc/self/statm").read().split()[0])
                    limit = pages * resource.getpagesize() + room * 8 * size
                    resource.setrlimit(resource.RLIMIT_AS, (limit, -1))
                    try:
                        call(t)
                        break
                    except MemoryError:
                        refused += 1
                    finally:
                        resource.setrlimit(resource.RLIMIT_AS, (-1, -1))
        assert refused > 20, refused
        print("no crash")
    """
    assert printed(code) == "no crash\n"


LONG: dict[str, Any] = {"max_steps": 2**31 - 1, "max_events": 2**31 - 1}


def rolled(t: float, **how: Any) -> Any:
    return simulate(scenes.rolling, [t], **{"model": "rolling", **LONG, **how})


MANY = np.linspace(0.0, 1e3, 40_000_000)
LOOPS: dict[str, Callable[[], Any]] = {
    "times of flow": lambda: flow(MANY, a=2.0, b=1.0, theta=0.1, omega=3.2),
    **{
        f"motions of flow, {workers} workers": lambda workers=workers: flow(  # type: ignore[misc]
            1.0, a=2.0, b=1.0, theta=MANY[: 4_000_000 * workers], omega=3.2, workers=workers
        )
        for workers in (1, 2)
    },
    "samples of rolling": lambda: TIMES.samples(MANY / 1e3),
    "samples of contact": lambda: SLIDES.samples(MANY / 1e3),
    "steps of a fixed size": lambda: rolled(1e4, method="rk4", step=1e-5),
    "steps of controlled error": lambda: rolled(1e6, method="dop853", rtol=1e-13),
    "steps with constraints": lambda: rolled(1e5, model="multipliers", method="dop853"),
    "implicit steps": lambda: rolled(1e4, method="radau", step=1e-4),
    "a slide": lambda: simulate(
        Scene(2.0, 1.0, friction=0.0, omega=3.0, x_dot=1.0), [1e6], model="contact", **LONG
    ),
    "bounces": lambda: simulate(
        Scene(2.0, 1.0, theta=0.5, z=3.0, friction=0.0, restitution=1.0), [1e7], **LONG
    ),
    "lift-off above Painleve's friction": lambda: [
        thresholds(2.0, 1.0, gyration2=0.0435, friction=0.25 + 1e-3 * i).lift_off_speed
        for i in range(500)
    ],
}


@pytest.mark.parametrize("loop", LOOPS.values(), ids=LOOPS.keys())
def test_ctrl_c_interrupts_every_long_loop(loop: Callable[[], Any]) -> None:
    """The third signal, after 0.3 s, raises KeyboardInterrupt; each loop would take longer. A loop
    that does not check for signals would receive only one signal, when it ends."""
    met = 0

    def third(*_: object) -> None:
        nonlocal met
        met += 1
        if met == 3:
            raise KeyboardInterrupt

    usual = signal.signal(signal.SIGALRM, third)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.1, 0.1)
        with pytest.raises(KeyboardInterrupt):
            loop()
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, usual)


def test_the_names_of_models_and_methods_equal_those_of_the_core() -> None:
    for name in ("MODELS", "METHODS", "STABILIZATIONS"):
        assert getattr(settings, name) == getattr(_core, name)


def test_dir_lists_only_public_names() -> None:
    assert dir(rl) == sorted(rl.__all__)
    for module in (rl.scenes, rl.geometry):
        assert dir(module) == sorted(module.__all__)


WITHOUT_UNITS = (
    "events", "success", "reason", "stats", "model", "method", "status", "message", "scene",
    "settings", "kept_events",
)  # fmt: skip


def test_help_states_units() -> None:
    properties = {
        name: inspect.getdoc(each)
        for name, each in vars(rl.Trajectory).items()
        if not name.startswith("_") and isinstance(each, (property, cached_property))
    }
    assert len(properties) > 25
    for name, text in properties.items():
        assert text, name
        assert re.search(r"\[.+\]", text) or name in WITHOUT_UNITS, (name, text)
    force = "Contact force on the body away from the ground [N], shape (n,)."
    assert properties["normal_force"] == force
    for name in rl.scenes.__all__:
        assert f"``{name}``" in (rl.scenes.__doc__ or ""), name


class Dial:
    """A number whose value changes."""

    def __init__(self, value: float) -> None:
        self.value = value

    def __float__(self) -> float:
        return self.value


def test_settings_seen_before_are_checked_again() -> None:
    """A number of another type is rejected after an equal number was accepted, and an object is
    read again, since its value may have changed."""
    scene, dial = rl.scenes.rolling, Dial(1e-4)
    how: dict[str, Any] = {"model": "rolling", "method": "dopri5"}
    assert rl.simulate(scene, [1.0], max_steps=500, **how).settings.max_steps == 500
    with pytest.raises(TypeError, match=r"max_steps must be a whole number, got 500\.0"):
        rl.simulate(scene, [1.0], max_steps=500.0, **how)  # type: ignore[arg-type]
    for dial.value in (1e-4, 1e-6):
        changing: Any = dial
        assert rl.simulate(scene, [1.0], rtol=changing, **how).settings.rtol == dial.value
