"""Names that tell motions apart."""

import dataclasses
import math
from typing import Any

import numpy as np
import pytest
import rolling_ellipse as rl
from rolling_ellipse._pictures.comparison import Comparison
from rolling_ellipse._pictures.labels import labels_of

ROLLING = rl.simulate(rl.scenes.rolling, 1.0)


def motions(*scenes: rl.Scene) -> list[rl.Trajectory]:
    """Trajectories of scenes; none is integrated, labels only read what was asked for."""
    return [dataclasses.replace(ROLLING, scene=scene) for scene in scenes]


def varied(**fields: Any) -> rl.Scene:
    return dataclasses.replace(rl.scenes.rolling, **fields)


@pytest.mark.parametrize(
    ("scenes", "names"),
    [
        ([varied(), varied(omega=4.0)], ["omega = 3.2 rad/s", "omega = 4 rad/s"]),
        ([varied(), varied(friction=0.8)], ["friction = ∞", "friction = 0.8"]),
        ([varied(), varied(inertia=2.0)], ["inertia by default", "inertia = 2 kg m²"]),
        ([varied(), varied(omega=-4.0)], ["omega = 3.2 rad/s", "omega = −4 rad/s"]),
        (
            [varied(), varied(mass=2.0), varied(mass=2.0, x=1.0)],
            ["mass = 1 kg, x = 0 m", "mass = 2 kg, x = 0 m", "mass = 2 kg, x = 1 m"],
        ),
        (
            [varied(), varied(impulse=rl.Impulse.press(4.0, -0.5))],
            ["no impulse", "impulse (0, −4) N s at (−0.5, 0) m"],
        ),
        (
            [rl.scenes.thin, rl.scenes.circle],
            ["a = 2 m, b = 0.02 m, theta = 0.3 rad, …", "a = 1 m, b = 1 m, theta = 0 rad, …"],
        ),
    ],
)
def test_scenes_are_named_by_the_fields_that_differ(
    scenes: list[rl.Scene], names: list[str]
) -> None:
    assert labels_of(motions(*scenes), None) == names


@pytest.mark.parametrize("difference", [1e-3, 1e-9, 2**-52])
def test_values_have_the_digits_that_tell_them_apart(difference: float) -> None:
    other = 3.2 * (1 + difference)
    names = labels_of(motions(varied(), varied(omega=other)), None)
    shown = [float(name.removeprefix("omega = ").removesuffix(" rad/s")) for name in names]
    assert shown == pytest.approx([3.2, other], rel=difference / 2, abs=0)


def test_methods_come_first() -> None:
    other = dataclasses.replace(ROLLING, method="rk4")
    assert labels_of([ROLLING, other], None) == ["exact", "rk4"]
    faster = dataclasses.replace(other, scene=varied(omega=4.0))
    assert labels_of([ROLLING, faster], None) == [
        "exact, omega = 3.2 rad/s",
        "rk4, omega = 4 rad/s",
    ]
    model = dataclasses.replace(ROLLING, model="multipliers")
    assert labels_of([ROLLING, model], None) == ["rolling", "multipliers"]


def test_what_nothing_tells_apart_is_numbered() -> None:
    assert labels_of([ROLLING] * 3, None) == ["1", "2", "3"]
    two_alike = [ROLLING, ROLLING, dataclasses.replace(ROLLING, method="rk4")]
    assert labels_of(two_alike, None) == ["1", "2", "3"]


def test_one_motion_needs_no_name() -> None:
    assert labels_of([ROLLING], None) == [""]
    assert labels_of([ROLLING], ["mine"]) == ["mine"]


def test_names_given_are_kept() -> None:
    assert labels_of([ROLLING, ROLLING], ("same", "same")) == ["same", "same"]


@pytest.mark.parametrize(
    ("labels", "message"),
    [
        (["a"], r"labels must be 2, one for each trajectory, got 1: \['a'\]"),
        (["a", "b", "c"], "labels must be 2, one for each trajectory, got 3"),
        ("ab", "labels must be a sequence of strings, got 'ab'"),
        ([1, 2], r"labels must be a sequence of strings, got \[1, 2\]"),
        (3, "labels must be a sequence of strings, got 3"),
    ],
)
def test_wrong_labels_are_refused_by_name(labels: Any, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        labels_of([ROLLING, ROLLING], labels)


def test_one_or_several() -> None:
    assert Comparison(ROLLING).motions == (ROLLING,)
    assert Comparison([ROLLING, ROLLING]).motions == (ROLLING, ROLLING)


@pytest.mark.parametrize(
    ("trajectories", "error", "message"),
    [
        ([], ValueError, "trajectories must be a Trajectory or a sequence of them, got none"),
        (3, TypeError, "trajectories must be a Trajectory or a sequence of them, got 3"),
        ([ROLLING, 3], TypeError, "trajectories must be .*, got 3 among them"),
        (
            dataclasses.replace(
                ROLLING,
                **dict.fromkeys(("t", "theta", "omega", "x"), np.empty(0)),  # type: ignore[arg-type]
            ),
            ValueError,
            "every trajectory must have samples, got <Trajectory rolling/exact: no samples",
        ),
    ],
)
def test_what_is_no_motion_is_refused_by_name(
    trajectories: Any, error: type[Exception], message: str
) -> None:
    with pytest.raises(error, match=message):
        Comparison(trajectories)


def test_infinity_is_the_default() -> None:
    assert math.isinf(varied().friction)  # so that "friction = ∞" above is what it says
