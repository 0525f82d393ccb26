"""`plot_phase`, read back from its artists."""

import dataclasses
import math

import matplotlib
import numpy as np
import pytest

matplotlib.use("Agg")

import rolling_ellipse as rl
from oracles.curves import data, legend_of, new_axes
from oracles.pictures import ORDINARY_SCENES, figure_of
from rolling_ellipse._pictures import sampling


def test_phase_is_the_trajectory(trajectory: rl.Trajectory) -> None:
    shown = rl.plot_phase(trajectory, ax=new_axes(), fold=False)
    theta, omega = data(shown.motions[0])
    drawn = sampling.between(trajectory, 0.0, 4.0, sampling.half_turns(trajectory))
    assert np.array_equal(theta, drawn.theta) and np.array_equal(omega, drawn.omega)
    assert data(shown.starts[0]) == (trajectory.theta[:1], trajectory.omega[:1])


@pytest.mark.parametrize(("a", "b"), [(2.0, 1.0), (0.7, 1.9), (2.0, 0.02)])
def test_separatrix_is_between_rocking_and_rolling_over(a: float, b: float) -> None:
    shown = rl.plot_phase(rl.simulate(rl.Scene(a, b, omega=1.0), 3.0), ax=new_axes())
    theta, omega = data(shown.separatrices[0])
    flat = 0.0 if a > b else math.pi / 2
    # nearer to a tip, rounding of max(a, b) - h is no longer small against that difference
    ours = (np.abs(theta - flat) < 1.5) & (omega != 0)
    assert np.count_nonzero(ours) > 800
    theta, omega = theta[ours], omega[ours]
    # from a millionth beside it the way to the tip takes some ln(1e6)/lambda = 8 s at most
    for factor, over in ((1 + 1e-6, True), (1 - 1e-6, False)):
        later, _, _ = rl.flow(30.0, a=a, b=b, theta=theta, omega=factor * omega)
        assert np.all((np.abs(later - flat) > math.pi / 2) == over)


def test_separatrix_goes_through_the_tips(report: rl.Trajectory) -> None:
    shown = rl.plot_phase(report, ax=new_axes())
    theta, omega = data(shown.separatrices[0])
    centres, saddles = shown.equilibria
    for tip in data(saddles)[0]:
        assert np.any((np.abs(theta - tip) < 1e-12) & (np.abs(omega) < 1e-7))
    flats = data(centres)[0]
    assert flats == pytest.approx(np.pi * np.arange(-1, 5), abs=1e-12)
    assert omega.max() == pytest.approx(rl.thresholds(2.0, 1.0).roll_over_speed, rel=1e-12)


def test_separatrix_keeps_the_spike_of_a_thin_body() -> None:
    shown = rl.plot_phase(rl.simulate(rl.Scene(1.0, 1e-3, theta=0.3), 1.0), ax=new_axes())
    _, omega = data(shown.separatrices[0])
    peak = rl.thresholds(1.0, 1e-3).roll_over_speed
    assert omega.max() == pytest.approx(peak, rel=1e-12)
    # |d omega| <= peak per point of the curve: a tenth is no visible corner
    assert np.max(np.abs(np.diff(omega))) < 0.1 * peak


def test_no_separatrix_for_a_circle_or_on_a_slope() -> None:
    circle = rl.simulate(rl.scenes.circle, 2.0)
    downhill = rl.simulate(rl.scenes.slope, 1.0)
    for motion in (circle, downhill):
        shown = rl.plot_phase(motion, ax=new_axes())
        assert shown.separatrices == () and shown.equilibria == ()
        assert legend_of(shown.ax) == []


def test_one_separatrix_for_each_body(report: rl.Trajectory) -> None:
    same = rl.simulate(rl.scenes.rocking, 1.0)
    other = rl.simulate(rl.Scene(1.5, 1.0, omega=1.0), 1.0)
    assert len(rl.plot_phase([report, same], ax=new_axes()).separatrices) == 1
    assert len(rl.plot_phase([report, same, other], ax=new_axes()).separatrices) == 2


def test_a_small_swing_fills_the_picture() -> None:
    ax = rl.plot_phase(rl.simulate(rl.Scene(2.0, 1.0, theta=0.01), 3.0), ax=new_axes()).ax
    assert 0.01 < ax.get_xlim()[1] < 0.012
    assert legend_of(ax) == []  # the separatrix is far outside


@pytest.mark.parametrize("scene", [rl.scenes.rolling, ORDINARY_SCENES["standing"]])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_long_rotation_is_folded_into_half_a_turn(scene: rl.Scene, sign: float) -> None:
    start = dataclasses.replace(scene, theta=0.1, omega=sign * scene.omega)
    motion = rl.simulate(start, 40.0)
    motion = sampling.between(motion, 0.0, 40.0, sampling.half_turns(motion))
    theta, omega = data(rl.plot_phase(motion, ax=new_axes()).motions[0])
    flat = 0.0 if scene.a > scene.b else math.pi / 2
    breaks = np.flatnonzero(np.isnan(theta))
    half_turns = np.floor((motion.theta - flat) / math.pi + 0.5)
    assert breaks.size == np.count_nonzero(np.diff(half_turns)) > 10
    assert np.array_equal(np.isnan(omega), np.isnan(theta))
    # the line leaves at one side and comes back at the other, with the same speed
    assert theta[breaks - 1] == pytest.approx(np.full(breaks.size, flat + sign * math.pi / 2))
    assert theta[breaks + 1] == pytest.approx(np.full(breaks.size, flat - sign * math.pi / 2))
    assert omega[breaks - 1] == pytest.approx(omega[breaks + 1], rel=1e-12)
    # all else are the samples
    ours = np.setdiff1d(np.arange(theta.size), np.concatenate([breaks + i for i in (-1, 0, 1)]))
    assert np.array_equal(omega[ours], motion.omega)
    turned = (motion.theta - theta[ours]) / math.pi
    assert turned == pytest.approx(np.round(turned), abs=1e-12)


def test_folding_is_a_choice(report: rl.Trajectory) -> None:
    folded = data(rl.plot_phase(report, ax=new_axes(), fold=True).motions[0])[0]
    assert np.nanmax(np.abs(folded)) <= math.pi / 2 < report.theta.max()


def test_ticks_of_the_phase_plane_are_quarter_turns(report: rl.Trajectory) -> None:
    ax = rl.plot_phase(report, ax=new_axes(9.0, 4.0)).ax
    figure_of(ax).draw_without_rendering()
    texts = [label.get_text() for label in ax.get_xticklabels()]
    assert texts == ["−π/2", "0", "π/2", "π", "3π/2", "2π", "5π/2", "3π", "7π/2"]
