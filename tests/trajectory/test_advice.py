"""A StabilityWarning comes where a motion has lost what it keeps, says by how much; only there."""

import warnings
from typing import Any

import numpy as np
import pytest
import rolling_ellipse as rl
from oracles.margins import told
from oracles.numbers import EPS
from rolling_ellipse import Scene, StabilityWarning, simulate

SCENE = Scene(2.0, 1.0, mass=3.0, theta=0.2, omega=3.2, x=1.0)
DRIFTING: dict[str, Any] = {"model": "multipliers", "method": "rk4", "stabilization": "none"}


def advice(scene: Scene, t: Any, **how: Any) -> tuple[rl.Trajectory, list[str]]:
    """A motion and what was said of its stability."""
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        motion = simulate(scene, t, **how)
    return motion, [str(w.message) for w in said if w.category is StabilityWarning]


@pytest.mark.parametrize("slope", [0.0, 0.05])
@pytest.mark.parametrize("how", [{"model": "rolling", "method": "rk4"}, DRIFTING])
@pytest.mark.filterwarnings("ignore::rolling_ellipse.ValidityWarning")
def test_losses_are_what_the_samples_say(how: dict[str, Any], slope: float) -> None:
    """From the energies and constraints of the trajectory, which take another road: equal to some
    roundings of the terms of the energy, beside the largest of them."""
    scene = Scene(2.0, 1.0, mass=3.0, theta=0.2, omega=3.2, x=1.0, slope=slope)
    motion, _ = advice(scene, [0.0, 0.7, 2.0], step=0.05, **how)
    losses = motion._solution.losses()
    size = np.max((motion.kinetic_energy + np.abs(motion.potential_energy))[[0, -1]])
    energy = abs(motion.energy[-1] - motion.energy[0]) / size
    f2, f3, f4 = np.abs(motion.constraint_residuals().position[-1])
    told(losses)
    assert losses["energy"] == pytest.approx(energy, abs=16 * EPS)
    assert losses["constraints"] == pytest.approx(max(f2 / 2, f3 / 2, f4), abs=16 * EPS)
    assert losses["energy"] > 1e-6


def test_the_constraints_lost_are_the_worst_of_three() -> None:
    """f2, f3 and f4 are each the worst once."""
    worst = set()
    for t in (0.15, 0.4, 2.0):
        motion, _ = advice(Scene(1.0, 0.3, theta=0.2, omega=1.0), [0.0, t], step=0.02, **DRIFTING)
        missed = np.abs(motion.constraint_residuals().position[-1])  # the long semi-axis is 1
        worst.add(int(np.argmax(missed)))
        lost = motion._solution.losses()["constraints"]
        assert lost == pytest.approx(np.max(missed), abs=16 * EPS)
    assert worst == {0, 1, 2}


def test_it_comes_with_the_loss_and_not_before() -> None:
    """Finer and finer steps, up to which the constraints or the energy are lost."""
    for how, quantity, least in (
        (DRIFTING, "constraints", 1e-3),
        ({"model": "rolling", "method": "rk4"}, "energy", 1e-2),
    ):
        told(how["method"], quantity)
        seen = set()
        for step in np.geomspace(0.004, 0.25, 14):
            motion, said = advice(SCENE, [10.0], step=float(step), raise_on_failure=False, **how)
            if not motion.success:
                continue
            losses = motion._solution.losses()
            lost = losses["constraints"] > 1e-3 or losses["energy"] > 1e-2
            assert bool(said) == lost, (step, losses)
            seen.add(losses[quantity] > least)
        assert seen == {True, False}


def test_it_says_how_much_is_lost_and_what_to_use() -> None:
    (said,) = advice(SCENE, 20.0, step=0.02, **DRIFTING)[1]
    assert "by t = 20 s with stabilization 'none'" in said and "use 'projection'" in said
    (said,) = advice(SCENE, 20.0, step=0.2, model="rolling", method="rk4")[1]
    assert (
        "the energy has changed by 0.16 of itself by t = 20 s" in said
        and "or method 'exact'" in said
    )
    slope = Scene(2.0, 1.0, slope=0.01, omega=2.0)
    motion, (said,) = advice(slope, 3.0, step=0.4, model="rolling", method="rk4")
    assert "or method 'exact'" in said and motion.success


@pytest.mark.parametrize(
    "how",
    [
        {},
        {"model": "contact"},
        {"model": "rolling", "method": "dop853"},
        {"model": "rolling", "method": "gauss", "step": 0.1},
        {"model": "multipliers"},
        {"model": "multipliers", "stabilization": "none"},
        {"model": "multipliers", "stabilization": "baumgarte", "method": "rk4", "step": 0.01},
        {"model": "multipliers", "stabilization": "ggl", "method": "radau", "step": 0.02},
    ],
)
def test_what_is_fine_is_not_warned_of(how: dict[str, Any]) -> None:
    assert advice(SCENE, 5.0, **how)[1] == []


def test_loose_tolerances_are_taken_at_their_word() -> None:
    """Up to ten times rtol of the energy are no surprise to who has asked for it; more is."""
    motion, said = advice(SCENE, 3.0, model="rolling", method="dop853", rtol=5e-3)
    losses = motion._solution.losses()
    told(losses)
    assert 1e-2 < losses["energy"] < 5e-2 and said == []
    with pytest.warns(StabilityWarning, match="take smaller rtol and atol"):
        simulate(SCENE, 10.0, model="rolling", method="dopri5", rtol=1e-3)


def test_it_points_to_the_call() -> None:
    with pytest.warns(StabilityWarning) as said:
        simulate(SCENE, 20.0, step=0.02, **DRIFTING)
    assert said[0].filename == __file__
    assert issubclass(StabilityWarning, UserWarning)


def test_what_has_no_constraints_is_not_told_of_them() -> None:
    """However far a rolling motion has gone astray: its coordinates follow from theta."""
    motion, (said,) = advice(
        Scene(2.0, 1.0, theta=0.1), 300.0, model="rolling", method="rk4", step=2.0,
        raise_on_failure=False,
    )  # fmt: skip
    told(motion.status, motion._solution.losses())
    assert "the energy has changed" in said and "constraints" not in said
