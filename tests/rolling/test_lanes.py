"""`flow` of many scenes in the lanes of a vector equals `flow` of one scene bit for bit.

test_flow_reference.py compares the answers for one scene with 40 digits.
"""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from rolling_ellipse import _core, flow, thresholds

ONE_BY_ONE, *LANES = LEVELS = _core.flow_levels()
Columns = dict[str, Any]

each_level = pytest.mark.parametrize("level", LANES or [ONE_BY_ONE])


def states(level: str, motions: Columns, workers: int = 1) -> np.ndarray:
    """theta, omega, x (3, n) of `flow` at a vector level."""
    names = ("t", "a", "b", "theta", "omega", "gravity", "gyration2")
    columns = [np.ascontiguousarray(motions[name], dtype=float) for name in names]
    return np.array(_core.flow_array(max(map(len, columns)), columns, workers, level))


def scenes(count: int, seed: int, *, ratio: float, half_turns: float) -> Columns:
    """Random bodies of aspects up to `ratio`; times of at most about `half_turns` half turns."""
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


def same(found: np.ndarray, expected: np.ndarray) -> bool:
    return found.tobytes() == expected.tobytes()  # bytes distinguish -0.0 from 0.0


@each_level
@pytest.mark.parametrize(
    ("ratio", "half_turns"),
    [(10.0, 10.0), (1e3, 10.0), (10.0, 1e6), (1.0001, 100.0), (1e3, 0.3)],
    ids=["few", "thin", "long", "round", "short"],
)
def test_a_scene_has_the_same_bits_in_a_batch(level: str, ratio: float, half_turns: float) -> None:
    motions = scenes(2000, 1, ratio=ratio, half_turns=half_turns)
    alone = states(ONE_BY_ONE, motions)
    for workers in (1, 2):
        assert same(states(level, motions, workers), alone)


@each_level
def test_neighbouring_scenes_change_no_bit_of_a_result(level: str) -> None:
    """The order of the scenes and the number of filled lanes do not matter."""
    motions = scenes(3000, 3, ratio=1e3, half_turns=1e3)
    found = states(level, motions)
    order = np.random.default_rng(3).permutation(3000)
    shuffled = {name: values[order] for name, values in motions.items()}
    assert same(states(level, shuffled), found[:, order])
    for count in range(1, 18):
        few = {name: values[:count] for name, values in motions.items()}
        assert same(states(level, few), found[:, :count])


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
    # the start is nearer to the tip, from which the body moves away, past the flat position
    "from beside 45 degrees past the flat": lambda: {
        "b": 0.02, "theta": -0.79, "omega": 3.0, "t": np.linspace(0.15, 0.35, 41),
    },
    # rounding the time since the flat position changes omega more than the motion does
    "thin, beside the flat, soon after": lambda: {
        "a": 1.0, "b": 2.86e-3, "gyration2": 7.73e-6, "theta": -1.776e-4, "omega": 3.68,
        "t": np.geomspace(1e-9, 1e-6, 61),
    },
    "very fast": lambda: {"omega": 10.0 ** np.arange(1, 7), "t": 10.0 ** -np.arange(1, 7)},
    "very late": lambda: {"omega": np.linspace(1.0, 9.0, 17), "t": 10.0 ** np.arange(-2, 15)},
    "no time at all": lambda: {"theta": 0.3, "omega": np.linspace(-2, 2, 9), "t": 0.0},
}  # fmt: skip


@each_level
@pytest.mark.parametrize("case", EXTREMES)
def test_extreme_scenes_have_the_same_finite_results_in_lanes(level: str, case: str) -> None:
    ordinary: Columns = {
        "a": 2.0, "b": 1.0, "gyration2": 1.25, "gravity": 9.81, "theta": 0.0, "omega": 0.0,
    }  # fmt: skip
    columns = ordinary | EXTREMES[case]()
    count = max(np.size(values) for values in columns.values())
    motions = {name: np.broadcast_to(values, count) for name, values in columns.items()}
    found = states(level, motions)
    assert np.all(np.isfinite(found))
    assert same(found, states(ONE_BY_ONE, motions))


WRONG = {
    "a": -1.0, "b": math.nan, "theta": math.inf, "omega": 1e60, "gravity": 0.0, "gyration2": -0.1,
    "t": math.nan,
}  # fmt: skip


@pytest.mark.parametrize("level", LEVELS)
@pytest.mark.parametrize("workers", [1, 2])
@pytest.mark.parametrize("name", WRONG)
def test_an_invalid_value_is_reported_with_its_index(level: str, workers: int, name: str) -> None:
    """The message names the first wrong number, although later scenes contain more."""
    motions = scenes(3000, 5, ratio=10.0, half_turns=10.0)
    motions[name][[700, 2900]] = WRONG[name]
    motions["t"][[705, 2901]] = 1e30
    with pytest.raises(ValueError, match=rf"^{name}\[700\] must be .* got "):
        states(level, motions, workers)


@pytest.mark.parametrize("level", LEVELS)
def test_a_time_that_is_too_long_is_reported_before_later_invalid_values(level: str) -> None:
    motions = scenes(40, 6, ratio=10.0, half_turns=10.0)
    motions["t"][3], motions["a"][5] = 1e30, -1.0
    with pytest.raises(ValueError, match=r"^t\[3\] must be at most 1e15 half turns or half"):
        states(level, motions)


def test_an_invalid_ratio_is_reported_with_the_index_in_its_arrays() -> None:
    lengths = np.array([1.0, 1.0, 1e4])
    with pytest.raises(ValueError, match=r"^a\[2\]/b must be between 1e-3 and 1e3, got 10000.0$"):
        flow(1.0, a=lengths, b=1.0, theta=0.0, omega=1.0)
    with pytest.raises(ValueError, match=r"^a/b must be between 1e-3 and 1e3, got 10000.0$"):
        flow(np.zeros(3), a=1e4, b=np.ones(1), theta=0.0, omega=1.0)


def test_reported_indices_follow_the_shape_of_the_argument() -> None:
    omega = np.array([[1.0], [math.nan]])
    with pytest.raises(ValueError, match=r"^omega\[1, 0\] must be a finite number"):
        flow(np.arange(3.0), a=2.0, b=1.0, theta=0.0, omega=omega)
