"""The border to the C++ core: sizes of arrays, times, threads and Ctrl-C."""

import signal
import subprocess
import sys
import textwrap
import tracemalloc
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from rolling_ellipse import Scene, _core, flow, scenes, simulate, thresholds

SCENE = scenes.rolling.core
TWO, THREE, FIVES = np.ones(2), np.ones(3), np.ones((2, 5))
TIMES = simulate(scenes.rolling, 1.0)._solution
SLIDES = simulate(scenes.slip, 1.0)._solution
COORDINATES = simulate(scenes.rolling, 0.1, model="multipliers")
SETTINGS = COORDINATES.settings.core


def numbered(count: int, wrong: int) -> list[Any]:
    """Arguments of two numbers each, but for one of three."""
    return [THREE if i == wrong else TWO for i in range(count)]


# ------------------------------------------------------------------------- sizes of arrays

CALLS: dict[str, tuple[Callable[[], Any], str]] = {
    "detail of rolling, omega": (
        lambda: _core.rolling_detail(SCENE, THREE, TWO, THREE),
        r"^omega must have shape \(3,\), got \(2,\)$",
    ),
    "detail of rolling, x": (
        lambda: _core.rolling_detail(SCENE, TWO, TWO, THREE),
        r"^x must have shape \(2,\), got \(3,\)$",
    ),
    "forces of rolling": (
        lambda: _core.rolling_contact(SCENE, THREE, TWO),
        r"^omega must have shape \(3,\), got \(2,\)$",
    ),
    "equation of rolling": (
        lambda: _core.rolling_equation(SCENE, THREE, TWO),
        r"^omega must have shape \(3,\), got \(2,\)$",
    ),
    "detail of contact": (
        lambda: _core.contact_detail(SCENE, *numbered(8, 6)),
        r"^normal_force must have shape \(2,\), got \(3,\)$",
    ),
    "detail of multipliers": (
        lambda: _core.multiplier_detail(SCENE, SETTINGS, FIVES, FIVES[:1]),
        r"^q_dot must have shape \(2, 5\), got \(1, 5\)$",
    ),
    "columns of multipliers": (
        lambda: _core.multiplier_detail(SCENE, SETTINGS, FIVES[:, :4], FIVES[:, :4]),
        r"^q must have shape \(n, 5\), got \(2, 4\)$",
    ),
    "start in coordinates": (
        lambda: _core.simulate_coordinates(SCENE, FIVES, FIVES, SETTINGS, 1.0),
        r"^q must have shape \(1, 5\), got \(2, 5\)$",
    ),
    "projection": (
        lambda: _core.project(SCENE, FIVES[:1], FIVES),
        r"^q_dot must have shape \(1, 5\), got \(2, 5\)$",
    ),
    "constraints": (
        lambda: _core.constraints(FIVES, TWO, 2.0, 1.0),
        r"^q_dot must have shape \(2, 5\), got \(2,\)$",
    ),
    "rows of constraints": (
        lambda: _core.constraint_system(FIVES[0], FIVES, 2.0, 1.0),
        r"^q must have shape \(n, 5\), got \(5,\)$",
    ),
    "kinematics": (
        lambda: _core.kinematics(2, TWO, THREE, 2.0, 1.0),
        r"^omega must have shape \(2,\), got \(3,\)$",
    ),
    "geometry": (
        lambda: _core.support(3, [TWO, np.ones(1), np.ones(1)]),
        r"^theta must have shape \(3,\), got \(2,\)$",
    ),
    "flow": (
        lambda: _core.flow_array(2, numbered(7, 4), 1),
        r"^omega must have shape \(2,\), got \(3,\)$",
    ),
    "flow of many times": (
        lambda: _core.flow_times(FIVES, 2.0, 1.0, 0.1, 1.0, 9.81, None, 1),
        r"^t must have shape \(10,\), got \(2, 5\)$",
    ),
    "classify": (
        lambda: _core.classify_array(2, numbered(7, 6), 1),
        r"^gyration2 must have shape \(2,\), got \(3,\)$",
    ),
    "collisions": (
        lambda: _core.collide_arrays(2, numbered(9, 8), _core.Restitution.STRONGE),
        r"^restitution must have shape \(2,\), got \(3,\)$",
    ),
    "samples": (
        lambda: TIMES.sample_rolling(FIVES),
        r"^t must have shape \(10,\), got \(2, 5\)$",
    ),
}


@pytest.mark.parametrize(("call", "message"), CALLS.values(), ids=CALLS.keys())
def test_arrays_of_another_size_are_refused_by_name(call: Callable[[], Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        call()


@pytest.mark.parametrize("t", [-1e-9, 1.0 + 1e-9, np.nan, np.inf])
def test_times_that_a_solution_does_not_know_are_refused(t: float) -> None:
    for sample in (
        TIMES.sample_rolling,
        SLIDES.sample_contact,
        COORDINATES._solution.sample_coordinates,
    ):
        with pytest.raises(ValueError, match=r"^t must be within \[0, "):
            sample(np.array([0.0, t]))


def test_numbers_that_are_not_aligned_are_copied_on_their_way_in() -> None:
    """A `const double*` to them would be undefined behaviour, wherever the core reads them: all its
    arguments are of one type, which is seen here to copy."""
    aligned = np.linspace(0.0, 1.0, 100_001)
    there = np.frombuffer(b"-" + aligned.tobytes(), float, aligned.size, offset=1)
    copied = []
    for times in (aligned, there):
        tracemalloc.start()
        assert _core.are_sample_times(times)
        copied.append(tracemalloc.get_traced_memory()[1] >= aligned.nbytes)
        tracemalloc.stop()
    assert not there.flags.aligned and copied == [False, True]


# --------------------------------------------------------------------------------- threads


@pytest.mark.parametrize("workers", [0, -2, 1025, 2**40])
def test_no_more_threads_than_a_machine_may_have(workers: int) -> None:
    with pytest.raises(ValueError, match=rf"^workers must be .* 1 to 1024.*, got {workers}$"):
        flow(1.0, a=2.0, b=1.0, theta=0.0, omega=1.0, workers=workers)


def test_threads_that_cannot_start_are_not_missed() -> None:
    """With memory for a few stacks only: the same bits as by one thread, and no end of Python."""
    code = """
        import resource
        import numpy as np
        from rolling_ellipse import flow

        t = np.linspace(0.0, 50.0, 300_000)
        start = {"a": 2.0, "b": 1.0, "theta": 0.1, "omega": 3.2}
        alone = flow(t, **start)
        pages = int(open("/proc/self/statm").read().split()[0])
        limit = pages * resource.getpagesize() + 200 * 2**20  # some twenty stacks of 8 MiB
        resource.setrlimit(resource.RLIMIT_AS, (limit, limit))
        for one, many in zip(alone, flow(t, workers=200, **start)):
            assert np.array_equal(one, many)
        print("the same")
    """
    done = subprocess.run(
        [sys.executable, "-c", textwrap.dedent(code)], capture_output=True, text=True, timeout=120
    )
    assert done.returncode == 0 and done.stdout == "the same\n", done.stderr


# ---------------------------------------------------------------------------------- Ctrl-C

LONG: dict[str, Any] = {"max_steps": 2**31 - 1, "max_events": 2**31 - 1}
MANY = np.linspace(0.0, 1e3, 40_000_000)
LOOPS: dict[str, Callable[[], Any]] = {
    "times of flow": lambda: flow(MANY, a=2.0, b=1.0, theta=0.1, omega=3.2),
    "motions of flow": lambda: flow(
        1.0, a=2.0, b=1.0, theta=MANY[:4_000_000], omega=3.2, workers=2
    ),
    "samples of rolling": lambda: TIMES.sample_rolling(MANY / 1e3),
    "samples of contact": lambda: SLIDES.sample_contact(MANY / 1e3),
    "steps of a fixed size": lambda: simulate(
        scenes.rolling, [1e4], model="rolling", method="rk4", step=1e-5, **LONG
    ),
    "steps of controlled error": lambda: simulate(
        scenes.rolling, [1e6], model="rolling", method="dop853", rtol=1e-13, **LONG
    ),
    "steps with constraints": lambda: simulate(
        scenes.rolling, [1e5], model="multipliers", method="dop853", **LONG
    ),
    "implicit steps": lambda: simulate(
        scenes.rolling, [1e4], model="rolling", method="radau", step=1e-4, **LONG
    ),
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
def test_ctrl_c_ends_every_long_loop(loop: Callable[[], Any]) -> None:
    """Each would go on for many seconds more than the quarter after which the signal comes."""
    usual = signal.signal(signal.SIGALRM, signal.default_int_handler)  # what SIGINT does
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.25)
        with pytest.raises(KeyboardInterrupt):
            loop()
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, usual)
