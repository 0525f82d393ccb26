"""`flow` of many scenes, side by side in the lanes of a vector, against one scene at a time.

All levels do the same operations, so their bits are equal. They differ from one scene alone by
roundings: both are within LARGEST_ERROR units of the truth (test_flow_reference.py has the truth),
so they are within twice that of each other.
"""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from oracles.flow import LARGEST_ERROR, PARAMETERS, Motion, grain
from oracles.margins import told
from rolling_ellipse import _core, flow, thresholds

LEVELS = _core.flow_levels()
LANES = LEVELS[1:]
Columns = dict[str, Any]

each_lane_level = pytest.mark.parametrize(
    "level", LANES or [pytest.param("", marks=pytest.mark.skip(reason="no lanes on this machine"))]
)


def states(level: str, motions: Columns, workers: int = 1) -> np.ndarray:
    """theta, omega, x (3, n) of `flow` at a level."""
    names = ("t", "a", "b", "theta", "omega", "gravity", "gyration2")
    columns = [np.ascontiguousarray(motions[name], dtype=float) for name in names]
    return np.array(_core.flow_array(max(map(len, columns)), columns, workers, level))


def scenes(count: int, seed: int, *, ratio: float, half_turns: float) -> Columns:
    """Random bodies of aspect ratios up to `ratio`, and times up to about so many half turns."""
    rng = np.random.default_rng(seed)
    long_axis = 10 ** rng.uniform(-1, 1, count)
    short_axis = long_axis * 10 ** -rng.uniform(0, math.log10(ratio), count)
    stands = rng.random(count) < 0.5
    gravity = 10 ** rng.uniform(0, 1.5, count)
    rate = np.sqrt(gravity / long_axis)
    rests = rng.random(count) < 0.2
    return {
        "a": np.where(stands, short_axis, long_axis),
        "b": np.where(stands, long_axis, short_axis),
        "theta": rng.uniform(-4, 4, count),
        "omega": np.where(rests, 0.0, rng.choice([-1, 1], count) * 10 ** rng.uniform(-2, 1, count))
        * rate,
        "gravity": gravity,
        "gyration2": long_axis**2 * 10 ** rng.uniform(-1, 0.3, count),
        "t": rng.choice([-1, 1], count) * 10 ** rng.uniform(-2, math.log10(half_turns), count)
        / rate,
    }  # fmt: skip


def one_scene(motions: Columns, i: int) -> tuple[float, Motion]:
    t, *motion = (float(motions[name][i]) for name in ("t", *PARAMETERS))
    return t, tuple(motion)


def apart(motions: Columns, found: np.ndarray, expected: np.ndarray) -> np.ndarray:
    """How many units they are apart, (n, 3)."""
    units = np.array([grain(*one_scene(motions, i)) for i in range(found.shape[1])])
    return np.abs(found - expected).T / units.reshape(-1, 3)


@each_lane_level
@pytest.mark.parametrize(
    ("ratio", "half_turns"), [(10.0, 10.0), (1e3, 10.0), (10.0, 1e6)], ids=["few", "thin", "long"]
)
def test_a_scene_in_a_lane_is_that_scene_alone(level: str, ratio: float, half_turns: float) -> None:
    motions = scenes(400, 1, ratio=ratio, half_turns=half_turns)
    off = apart(motions, states(level, motions), states(LEVELS[0], motions))
    told(f"{np.median(off):.2g} units, at most {off.max():.3g}")
    assert off.max() <= 2 * LARGEST_ERROR


@each_lane_level
def test_the_levels_have_the_same_bits(level: str) -> None:
    motions = scenes(3000, 2, ratio=1e3, half_turns=1e6)
    assert np.array_equal(states(level, motions), states(LANES[0], motions))


@each_lane_level
def test_neighbours_and_workers_do_not_change_a_bit(level: str) -> None:
    """In any order, any number of threads, and any part of the lanes filled."""
    motions = scenes(3000, 3, ratio=1e3, half_turns=1e3)
    found = states(level, motions)
    assert np.array_equal(states(level, motions, workers=2), found)
    order = np.random.default_rng(3).permutation(3000)
    shuffled = {name: values[order] for name, values in motions.items()}
    assert np.array_equal(states(level, shuffled), found[:, order])
    for count in range(1, 18):
        few = {name: values[:count] for name, values in motions.items()}
        assert np.array_equal(states(level, few), found[:, :count])


def test_lanes_are_what_flow_takes() -> None:
    """The lanes' bits are not those of one scene alone: no test here compares a road to itself."""
    motions = scenes(3000, 4, ratio=10.0, half_turns=100.0)
    best = states("best", motions)
    assert np.array_equal(best, np.array(flow(**motions)))
    assert np.array_equal(best, states(LEVELS[-1], motions))
    if LANES:
        assert np.mean(best[0] != states(LEVELS[0], motions)[0]) > 0.05


ROLL_OVER = thresholds(2.0, 1.0).roll_over_speed
EXTREMES: dict[str, Callable[[], Columns]] = {
    "beside the separatrix": lambda: {
        "omega": ROLL_OVER * (1 + np.outer([-1, 1], 10.0 ** -np.arange(1, 17)).ravel()),
        "t": np.linspace(-3, 3, 32),
    },
    "at rest": lambda: {"theta": np.linspace(-8, 8, 17) * math.pi / 2, "t": 1e9},
    "hardly moving": lambda: {"theta": 0.3, "omega": 10.0 ** -np.arange(2, 120, 6), "t": 2.0},
    "released, soon after": lambda: {"theta": 0.7, "t": 10.0 ** -np.arange(0.0, 13.0)},
    "moving, soon after": lambda: {"theta": 0.7, "omega": 1.0, "t": 10.0 ** -np.arange(0.0, 13.0)},
    "hardly rocking": lambda: {"theta": 10.0 ** -np.arange(1, 30), "t": 1.0},
    "a hair beside the circle": lambda: {
        "a": 1 + 10.0 ** -np.arange(1, 16), "b": 1.0, "theta": 0.5, "omega": 0.1, "t": 3.0,
    },
    "a circle": lambda: {"a": 1.5, "b": 1.5, "omega": np.linspace(-2, 2, 9), "t": 3.0},
    "all aspects": lambda: {
        "a": 10.0 ** np.linspace(-2.9999, 2.9999, 61), "b": 1.0, "theta": 0.8, "t": 0.3,
    },
    "all aspects, turning": lambda: {
        "a": 10.0 ** np.linspace(-2.9999, 2.9999, 61), "b": 1.0, "omega": -90.0, "t": -0.3,
    },
    "all inertias": lambda: {"gyration2": 10.0 ** np.arange(-5, 6), "omega": 3.0, "t": 0.2},
    "all sizes": lambda: {
        "a": 2 * 10.0 ** np.arange(-29, 29, 2), "b": 10.0 ** np.arange(-29, 29, 2),
        "gyration2": 10.0 ** np.arange(-58, 58, 4), "gravity": 10.0 ** np.arange(-29, 29, 2),
        "omega": 3.0, "t": 0.2,
    },
    # the way from 45 degrees to the tip of a thin body is 2.4 times that to its flat position
    "from beside 45 degrees past the flat": lambda: {
        "b": 0.02, "theta": -0.79, "omega": 3.0, "t": np.linspace(0.15, 0.35, 41),
    },
    # omega changes by less than the rounding of the time since the flat position does to it
    "thin, beside the flat, soon after": lambda: {
        "a": 1.0, "b": 2.86e-3, "gyration2": 7.73e-6, "theta": -1.776e-4, "omega": 3.68,
        "t": np.geomspace(1e-9, 1e-6, 61),
    },
    "very fast": lambda: {"omega": 10.0 ** np.arange(1, 7), "t": 10.0 ** -np.arange(1, 7)},
    "no time at all": lambda: {"theta": 0.3, "omega": np.linspace(-2, 2, 9), "t": 0.0},
}  # fmt: skip


@each_lane_level
@pytest.mark.parametrize("case", EXTREMES)
def test_extremes(level: str, case: str) -> None:
    """Units of `flow` alone say how much a scene grants; where a scene is so extreme that its
    derivatives are no numbers, both roads are the same one."""
    ordinary: Columns = {
        "a": 2.0, "b": 1.0, "gyration2": 1.25, "gravity": 9.81, "theta": 0.0, "omega": 0.0,
    }  # fmt: skip
    columns = ordinary | EXTREMES[case]()
    count = max(np.size(values) for values in columns.values())
    motions = {name: np.broadcast_to(values, count) for name, values in columns.items()}
    found, alone = states(level, motions), states(LEVELS[0], motions)
    assert np.all(np.isfinite(found))
    differs = np.flatnonzero(np.any(found != alone, axis=0))
    some = {name: values[differs] for name, values in motions.items()}
    off = apart(some, found[:, differs], alone[:, differs])
    told(f"{len(differs)} of {count} in lanes")
    assert np.all(off <= 2 * LARGEST_ERROR), off.max(axis=0)


@each_lane_level
@pytest.mark.parametrize("half_turns", [1e3, 1e9, 1e14, 0.99e15])
def test_very_long_times(level: str, half_turns: float) -> None:
    """The phase is known as well as the period: one more half turn than the phase says, in lanes
    as alone, would be pi in the angle; energy and the angle within the half turn hold to roundings.
    """
    speeds = np.linspace(5.0, 9.0, 40)
    motions: Columns = {
        "a": np.full(40, 2.0), "b": np.ones(40), "gyration2": np.full(40, 1.25),
        "gravity": np.full(40, 9.81), "theta": np.zeros(40), "omega": speeds,
        "t": half_turns * math.pi / speeds * np.linspace(-1, 1, 40),
    }  # fmt: skip
    theta, omega, _ = states(level, motions)
    alone = states(LEVELS[0], motions)
    # A few roundings of the period for every half turn, and of the angle.
    phase = 16 * np.finfo(float).eps * (np.abs(theta) + 1)
    assert np.all(np.abs(theta - alone[0]) <= phase)
    if half_turns <= 1e9:  # the angle resolves the place within the turn
        h2 = 4 * np.sin(theta) ** 2 + np.cos(theta) ** 2
        slope2 = (3 * np.sin(theta) * np.cos(theta)) ** 2 / h2
        energy = (1.25 + h2 + slope2) * omega**2 / 2 + 9.81 * np.sqrt(h2)
        at_start = (1.25 + 1) * speeds**2 / 2 + 9.81
        # d energy/d theta at fixed omega is below 9 omega^2, and theta is rounded.
        allowed = (32 * np.finfo(float).eps + np.spacing(np.abs(theta)) * 9) * at_start
        assert np.all(np.abs(energy - at_start) <= allowed)


WRONG = {
    "a": (-1.0, r"^a\[700\] must be a positive finite length \[m\], got -1.0$"),
    "b": (math.nan, r"^b\[700\] must be a positive finite length \[m\], got nan$"),
    "theta": (math.inf, r"^theta\[700\] must be a finite number \[rad\] of at most 1e50, got inf$"),
    "omega": (
        1e60,
        r"^omega\[700\] must be a finite number \[rad/s\] of at most 1e50, got 1e",
    ),
    "gravity": (0.0, r"^gravity\[700\] must be a positive finite acceleration "),
    "gyration2": (-0.1, r"^gyration2\[700\] must be a positive finite area \[m\^2\], got -0.1$"),
    "t": (math.nan, r"^t\[700\] must be finite \[s\], got nan$"),
}


@pytest.mark.parametrize("level", LEVELS)
@pytest.mark.parametrize("workers", [1, 2])
@pytest.mark.parametrize("name", WRONG)
def test_a_wrong_number_is_told_by_name_and_place(level: str, workers: int, name: str) -> None:
    """The first of them, also where later chunks, or later steps of this one, have more."""
    motions = scenes(3000, 5, ratio=10.0, half_turns=10.0)
    wrong, message = WRONG[name]
    motions[name][[700, 2900]] = wrong
    motions["t"][[705, 2901]] = 1e30
    with pytest.raises(ValueError, match=message):
        states(level, motions, workers)


@pytest.mark.parametrize("level", LEVELS)
def test_a_time_that_is_too_long_is_told_before_later_wrong_numbers(level: str) -> None:
    motions = scenes(40, 6, ratio=10.0, half_turns=10.0)
    motions["t"][3], motions["a"][5] = 1e30, -1.0
    with pytest.raises(ValueError, match=r"^t\[3\] must be at most 1e15 half turns or swings, "):
        states(level, motions)


def test_ratios_name_the_arrays_among_their_two() -> None:
    lengths = np.array([1.0, 1.0, 1e4])
    with pytest.raises(ValueError, match=r"^a\[2\]/b must be between 1e-3 and 1e3, got 10000.0$"):
        flow(1.0, a=lengths, b=1.0, theta=0.0, omega=1.0)
    with pytest.raises(ValueError, match=r"^a/b must be between 1e-3 and 1e3, got 10000.0$"):
        flow(np.zeros(3), a=1e4, b=np.ones(1), theta=0.0, omega=1.0)


def test_places_are_those_of_the_common_shape() -> None:
    omega = np.array([[1.0], [math.nan]])
    with pytest.raises(ValueError, match=r"^omega\[1, 0\] must be a finite number"):
        flow(np.arange(3.0), a=2.0, b=1.0, theta=0.0, omega=omega)


def test_a_level_that_is_none_is_refused() -> None:
    with pytest.raises(ValueError, match=r"^level must be one of 'best', 'one by one'.*got 'mmx'$"):
        states("mmx", scenes(2, 7, ratio=10.0, half_turns=10.0))
