"""A StabilityWarning is given if and only if a motion loses energy or violates its constraints."""

import math
import warnings
from typing import Any, NamedTuple

import numpy as np
import pytest
import rolling_ellipse as rl
from oracles import losses
from oracles.margins import told
from oracles.numbers import EPS
from rolling_ellipse import Scene, StabilityWarning, simulate
from rolling_ellipse._motion.constraints import energy_error

SCENE = Scene(2.0, 1.0, mass=3.0, theta=0.2, omega=3.2, x=1.0)
DRIFTING: dict[str, Any] = {"model": "multipliers", "method": "rk4", "stabilization": "none"}


def advice(scene: Scene, t: Any, **how: Any) -> tuple[rl.Trajectory, list[str]]:
    """A motion and the texts of its StabilityWarnings."""
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        motion = simulate(scene, t, **how)
    return motion, [str(w.message) for w in said if w.category is StabilityWarning]


class Losses(NamedTuple):
    """Losses of a stepped motion, as the core reports them."""

    energy: float
    constraints: float
    projected: float


def lost(motion: rl.Trajectory) -> Losses:
    """Losses of a stepped motion, which are also printed."""
    found = motion._solution.losses()
    assert found is not None
    told(*found)
    return Losses(*found)


def eight_steps(scene: Scene, t_end: float, **how: Any) -> tuple[rl.Trajectory, Any]:
    """A motion of eight steps, all checked for losses, and its samples at the checks: at the ends
    of steps and in the middle of the last step."""
    step = t_end / 8
    motion, _ = advice(scene, [t_end], step=step, **how)
    return motion, motion.sol([*(step * np.arange(8)), 7.5 * step, t_end])


@pytest.mark.parametrize("slope", [0.0, 0.05])
@pytest.mark.parametrize("how", [{"model": "rolling", "method": "rk4"}, DRIFTING])
@pytest.mark.filterwarnings("ignore::rolling_ellipse.ValidityWarning")
def test_reported_losses_agree_with_the_samples(how: dict[str, Any], slope: float) -> None:
    """Losses agree with the energies and constraints of the trajectory, which are computed in
    another way, to some roundings of the largest term of the energy."""
    scene = Scene(2.0, 1.0, mass=3.0, theta=0.2, omega=3.2, slope=slope)
    motion, seen = eight_steps(scene, 2.0, **how)
    found = lost(motion)
    size = np.max(seen.kinetic_energy + np.abs(seen.potential_energy))
    energy = np.max(np.abs(seen.energy - seen.energy[0])) / size
    f2, f3, f4 = np.max(np.abs(seen.constraint_residuals().position), axis=0)
    assert found.energy == pytest.approx(energy, abs=16 * EPS)
    assert found.constraints == pytest.approx(max(f2 / 2, f3 / 2, f4), abs=16 * EPS)
    assert found.energy > 1e-6


def test_the_constraint_loss_is_the_largest_of_three_errors() -> None:
    """Each of f2, f3 and f4 is the largest error in one of the motions."""
    worst = set()
    for b, omega, t in ((0.9, 3.0, 1.5), (0.3, 1.0, 0.15), (0.3, 1.0, 0.4)):
        motion, seen = eight_steps(Scene(1.0, b, theta=0.2, omega=omega), t, **DRIFTING)
        missed = np.abs(seen.constraint_residuals().position)  # the long semi-axis is 1
        worst.add(int(np.unravel_index(np.argmax(missed), missed.shape)[1]))
        assert lost(motion).constraints == pytest.approx(np.max(missed), abs=16 * EPS)
    assert worst == {0, 1, 2}


@pytest.mark.parametrize(
    "how",
    [
        {"model": "rolling", "method": "rk4", "step": 0.1},
        {"model": "rolling", "method": "dop853"},
        *(
            {"model": "multipliers", "method": "rk4", "step": 0.05, "stabilization": kind}
            for kind in ("none", "projection", "projection+energy")
        ),
        {"model": "multipliers", "method": "dopri5", "rtol": 1e-6},
        {"model": "multipliers", "method": "radau", "step": 0.02, "stabilization": "ggl"},
    ],
)
@pytest.mark.filterwarnings("ignore::rolling_ellipse.ValidityWarning")
def test_losses_do_not_depend_on_the_origin_of_x(how: dict[str, Any]) -> None:
    """A shift of x changes no bit of the rest of the motion, its losses or its warnings; x itself
    is known to an ulp of its start at best."""
    scene = Scene(2.0, 1.0, slope=0.3, theta=0.3, omega=3.5)
    here, said = advice(scene, [1.0, 3.0], **how)
    expected = lost(here)
    for x in (-1.0, 1e4, 1e9, 1e17):
        there, said_there = advice(scene.replace(x=x), [1.0, 3.0], **how)
        found = lost(there)
        assert said_there == said
        assert (found.energy, found.constraints) == (expected.energy, expected.constraints)
        assert np.array_equal(there.theta, here.theta) and np.array_equal(there.omega, here.omega)
        assert np.all(np.abs(there.x - here.x - x) <= np.spacing(np.abs(there.x) + abs(x)))


@pytest.mark.filterwarnings("ignore::rolling_ellipse.ValidityWarning")
@pytest.mark.filterwarnings("ignore::rolling_ellipse.StabilityWarning")
def test_the_plotted_energy_error_does_not_depend_on_the_origin_of_x() -> None:
    """Energy errors depend on the origin of x only by an ulp of x times m g sin(slope) / scale."""
    scene = Scene(2.0, 1.0, mass=3.0, slope=0.3, theta=0.3, omega=3.5)
    times = np.linspace(0, 6, 101)
    how: dict[str, Any] = {"model": "rolling", "method": "rk4", "step": 0.1}
    here = energy_error(simulate(scene, times, **how))
    told(np.max(here), lost(simulate(scene, times, **how)))
    assert np.max(here) > 0.2
    for x in (1.0, -1e4, 1e7):
        there = simulate(scene.replace(x=x), times, **how)
        step_of_x = 3.0 * 9.81 * math.sin(0.3) * np.spacing(np.max(np.abs(there.x)))
        least_size = there.kinetic_energy[0] + 3.0 * 9.81 * there.z[0] * math.cos(0.3)
        allowed = 2 * step_of_x / least_size + 16 * EPS
        assert np.max(np.abs(energy_error(there) - here)) <= allowed


def test_large_losses_give_a_warning_and_losses_within_the_limits_do_not() -> None:
    """Only some steps are checked, so a temporary loss may be seen below its maximum: a warning is
    certain only above three times the limit."""
    seen = {True: 0, False: 0}
    for seed in range(70):
        run = losses.drawn(seed)
        motion, said = advice(run.scene, [0.0, run.t_end], raise_on_failure=False, **run.how)
        stopped = motion.status not in (rl.Status.COMPLETED, rl.Status.VALIDITY_LOST)
        gains = any("is unstable with the gains" in text for text in said)  # soon lost
        if stopped or gains or not 0 < motion.stats["steps"] <= 3000:
            continue
        found = losses.lost(run, motion)
        told(seed, found, said)
        assert found > 1 if said else found < 3, run
        seen[bool(said)] += 1
    assert seen[True] >= 5 and seen[False] >= 30, seen


def test_steps_that_are_too_large_give_a_warning_in_spite_of_projection() -> None:
    """Energy and constraints hold at the ends of steps, but the motion is wrong: its angle reaches
    -22 rad and more than 60 rad, while the true angle only increases, to 38.4 rad."""
    scene = Scene(2.0, 1.0, theta=0.2, omega=3.2)
    how: dict[str, Any] = {"model": "multipliers", "stabilization": "projection+energy"}
    motion, (said,) = advice(scene, np.arange(0, 20.1, 0.2), method="rk4", step=0.2, **how)
    assert motion.success and np.min(np.diff(motion.theta)) < -1
    assert "a step has missed the constraints by" in said and "take smaller steps" in said
    assert lost(motion).projected > 1 and lost(motion).energy < 1e-10
    assert advice(scene, 20.0, method="rk4", step=0.05, **how)[1] == []
    (said,) = advice(scene, 20.0, method="dopri5", rtol=0.5, atol=0.5, **how)[1]
    assert "take smaller rtol and atol" in said


def test_a_warning_is_given_if_and_only_if_a_loss_exceeds_its_limit() -> None:
    """Coarse steps lose the constraints or the energy, fine steps do not."""
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
            found = lost(motion)
            assert bool(said) == (found.constraints > 1e-3 or found.energy > 1e-2), step
            seen.add(getattr(found, quantity) > least)
        assert seen == {True, False}


def test_a_warning_states_the_loss_and_a_remedy() -> None:
    (said,) = advice(SCENE, 20.0, step=0.02, **DRIFTING)[1]
    assert "by t = 20 s with stabilization 'none'" in said and "use 'projection'" in said
    (said,) = advice(SCENE, 20.0, step=0.2, model="rolling", method="rk4")[1]
    assert "the relative change of the energy has reached 0.15 by t = 20 s" in said
    assert "or method 'exact'" in said
    slope = Scene(2.0, 1.0, slope=0.01, omega=2.0)
    motion, (said,) = advice(slope, 3.0, step=0.4, model="rolling", method="rk4")
    assert "or method 'exact'" in said and motion.success


def test_losses_within_a_loose_tolerance_give_no_warning() -> None:
    """Energy losses up to ten times a requested rtol give no warning; larger ones do."""
    motion, said = advice(SCENE, 3.0, model="rolling", method="dop853", rtol=5e-3)
    assert 1e-2 < lost(motion).energy < 5e-2 and said == []
    with pytest.warns(StabilityWarning, match="take smaller rtol and atol"):
        simulate(SCENE, 10.0, model="rolling", method="dopri5", rtol=1e-3)


def test_a_warning_points_to_the_calling_line() -> None:
    with pytest.warns(StabilityWarning) as said:
        simulate(SCENE, 20.0, step=0.02, **DRIFTING)
    assert said[0].filename == __file__
    assert issubclass(StabilityWarning, UserWarning)


def test_a_warning_for_rolling_mentions_no_constraints() -> None:
    """The coordinates of a rolling motion follow from theta, so they lose no constraints."""
    motion, (said,) = advice(
        Scene(2.0, 1.0, theta=0.1), 300.0, model="rolling", method="rk4", step=2.0,
        raise_on_failure=False,
    )  # fmt: skip
    told(motion.status, lost(motion))
    assert "the relative change of the energy" in said and "constraints" not in said
