"""`plot_constraints`, read back from its artists."""

import dataclasses
import itertools

import matplotlib
import numpy as np
import pytest

matplotlib.use("Agg")

import rolling_ellipse as rl
from oracles.curves import data, legend_of, new_axes, seen, two_axes

pytestmark = pytest.mark.filterwarnings("ignore:the samples of a trajectory are not those")


def missing(motion: rl.Trajectory, **errors: float) -> rl.Trajectory:
    """The motion with residuals of the given size: f1 ... f4, df2 ... df4, gap, slip."""
    found = motion.constraint_residuals()
    position, velocity = found.position.copy(), found.velocity.copy()
    gap, slip = found.gap.copy(), found.slip.copy()
    columns = {"gap": gap, "slip": slip, "f1": velocity[:, 0]}
    for i in (2, 3, 4):
        columns |= {f"f{i}": position[:, i - 2], f"df{i}": velocity[:, i - 1]}
    for name, error in errors.items():
        columns[name][:] = error
    residuals = rl.ConstraintResiduals(position, velocity, gap, slip)
    other = dataclasses.replace(motion, theta=motion.theta + 1e-3)  # samples of its own
    object.__setattr__(other, "constraint_residuals", lambda: residuals)
    return other


def test_constraints_have_a_line_each(trajectory: rl.Trajectory) -> None:
    shown = rl.plot_constraints(trajectory, ax=two_axes())
    names = [[text.removesuffix(" = 0") for text in legend_of(ax)] for ax in shown.axes]
    assert names == [
        ["f2", "f3", "f4", "gap"],
        ["f1", "df2/dt", "df3/dt", "df4/dt", "slip"],
    ]
    for line in itertools.chain(*shown.lines):
        assert np.array_equal(data(line)[0], seen(trajectory, line).t)
        # the motion is exact: a few hundred roundings, and 2/0.02 times as many for the thin body
        assert np.all(data(line)[1] < 1e-13)


def test_errors_of_constraints_have_no_unit(report: rl.Trajectory) -> None:
    position = {"f2": -1e-3, "f3": 2e-5, "f4": -1e-7, "gap": -4e-3}
    velocity = {"f1": 3e-3, "df2": 1e-4, "df3": -1e-6, "df4": 1e-5, "slip": -7e-3}
    shown = rl.plot_constraints(missing(report, **position, **velocity), ax=two_axes())
    rate = np.abs(report.omega).max()
    lengths = [2.0, 2.0, 1.0, 2.0], [2 * rate, 2 * rate, 2 * rate, rate, 2 * rate]
    for lines, errors, units in zip(shown.lines, (position, velocity), lengths, strict=True):
        for line, error, unit in zip(lines, errors.values(), units, strict=True):
            assert data(line)[1] == pytest.approx(abs(error) / unit, rel=1e-12)


def test_several_motions_show_the_worst_of_their_constraints(report: rl.Trajectory) -> None:
    motions = [report, missing(report, f2=1e-6, f3=1e-3), missing(report, f1=1e-2, f4=1e-5)]
    positions, velocities = rl.plot_constraints(motions, ax=two_axes()).lines
    largest = [[data(line)[1].max() for line in panel] for panel in (positions, velocities)]
    speed = 2 * np.abs(report.omega).max()
    assert largest[0][1:] == pytest.approx([5e-4, 1e-5], rel=1e-12)
    assert largest[1][2] == pytest.approx(1e-2 / speed, rel=1e-12)
    assert max(largest[0][0], largest[1][0], largest[1][1]) < 1e-14
    (all_of_it,) = rl.plot_constraints(motions, ax=new_axes()).lines
    worst = [data(line)[1].max() for line in all_of_it]
    assert worst[1:] == pytest.approx([5e-4, 1e-2 / speed], rel=1e-12)


def test_one_motion_in_one_axes_shows_the_worst_of_each_kind(report: rl.Trajectory) -> None:
    shown = rl.plot_constraints(missing(report, f1=1e-2, f3=1e-3), ax=new_axes())
    assert legend_of(shown.axes[0]) == ["positions", "velocities"]
    position, velocity = (data(line)[1] for line in shown.lines[0])
    speed = 2 * np.abs(report.omega).max()
    assert position.max() == pytest.approx(5e-4) and velocity.max() == pytest.approx(1e-2 / speed)
