"""Motions to draw, and a check that no picture opens a window or leaves a pyplot figure open."""

import warnings
from collections.abc import Callable, Iterator
from typing import Any

import matplotlib
import pytest

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import rolling_ellipse as rl
from oracles.curves import PICTURES
from oracles.pictures import ORDINARY_SCENES


@pytest.fixture(params=list(PICTURES.values()), ids=list(PICTURES))
def picture(request: pytest.FixtureRequest) -> Callable[..., Any]:
    return request.param


@pytest.fixture(params=list(ORDINARY_SCENES.values()), ids=list(ORDINARY_SCENES))
def trajectory(request: pytest.FixtureRequest) -> rl.Trajectory:
    return rl.simulate(request.param, 4.0, model="rolling")


@pytest.fixture(scope="session")
def report() -> rl.Trajectory:
    return rl.simulate(rl.scenes.report, 6.0)


@pytest.fixture
def several(report: rl.Trajectory) -> list[rl.Trajectory]:
    """A rolling motion, and two simulations of it with Lagrange multipliers, whose steps are so
    long that the constraints drift."""
    how: dict[str, Any] = {"model": "multipliers", "method": "rk4", "stabilization": "none"}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", rl.StabilityWarning)
        return [report, *(rl.simulate(report.scene, 6.0, step=h, **how) for h in (0.05, 0.1))]


@pytest.fixture(autouse=True)
def nothing_left_open(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Fail a test that calls plt.show() or leaves a pyplot figure open."""

    def show(*_: object, **__: object) -> None:
        raise AssertionError("plt.show() was called")

    monkeypatch.setattr(plt, "show", show)
    yield
    assert plt.get_fignums() == []
