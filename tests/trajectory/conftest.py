"""A motion that most tests of this folder use."""

import pytest
from oracles.trajectory import SCENES
from rolling_ellipse import Trajectory, simulate


@pytest.fixture(scope="module", params=list(SCENES.values()), ids=list(SCENES))
def motion(request: pytest.FixtureRequest) -> Trajectory:
    return simulate(request.param, 4.0)
