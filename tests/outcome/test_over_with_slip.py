"""The recipe for the least speed at which a slipping body passes the tip gives known speeds."""

import re
from typing import Any

import pytest
from oracles.paths import ROOT
from rolling_ellipse import Scene, simulate, thresholds

PAGE = (ROOT / "docs" / "many.md").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def recipe() -> dict[str, Any]:
    block = re.search(r"<!-- over the tip -->\n```python\n(.*?)```", PAGE, re.DOTALL)
    assert block
    names: dict[str, Any] = {"Scene": Scene}
    exec(block[1], names)
    return names


@pytest.mark.parametrize(
    ("friction", "speed"),
    [
        (0.05, 3.705407360274),  # still slides when it passes the tip
        (0.1, 3.475473717038),  # starts to roll before the tip
        (0.2, 3.106752254887),
        (0.3, 2.955400074211),
    ],
)
def test_the_least_speed_has_known_values(recipe: Any, friction: float, speed: float) -> None:
    """The speed agrees to all known digits. A simulated motion passes the tip if its speed is 1e-9
    higher, and does not if it is 1e-9 lower. This change is a thousand times the error of the
    motion after 20 s near the tip, where errors grow most."""
    assert recipe["least_speed"](friction) == pytest.approx(speed, abs=1e-12)
    for change, times in ((1e-9, 1), (-1e-9, 0)):
        scene = Scene(2.0, 1.0, omega=speed + change, friction=friction)
        assert simulate(scene, 20.0).when(event="roll_over").size == times


def test_with_enough_friction_the_least_speed_is_that_of_rolling(recipe: Any) -> None:
    """The bisection ends at two neighbouring doubles, and `outcome` is exact to within rounding."""
    assert recipe["least_speed"](1.0) == pytest.approx(
        thresholds(2.0, 1.0).roll_over_speed, rel=4e-16
    )
