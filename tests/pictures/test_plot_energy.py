"""`plot_energy`, read back from its artists."""

import matplotlib
import numpy as np
import pytest

matplotlib.use("Agg")

import rolling_ellipse as rl
from oracles.curves import data, legend_of, new_axes, seen


def test_energies_are_the_trajectory(trajectory: rl.Trajectory) -> None:
    shown = rl.plot_energy(trajectory, ax=new_axes())
    assert shown.error == () and legend_of(shown.ax) == ["total", "kinetic", "potential"]
    at = seen(trajectory, shown.total[0])
    for (line,), values in (
        (shown.total, at.energy),
        (shown.kinetic, at.kinetic_energy),
        (shown.potential, at.potential_energy),
    ):
        assert np.array_equal(data(line)[0], at.t)
        assert np.array_equal(data(line)[1], values)


def test_several_motions_show_the_error_of_their_energies(several: list[rl.Trajectory]) -> None:
    shown = rl.plot_energy(several, ax=new_axes())
    assert shown.total == shown.kinetic == shown.potential == ()
    assert shown.ax.get_yscale() == "log"
    for line, motion in zip(shown.error, several, strict=True):
        # both energies are >= 0 on level ground from z = 0: the energy itself is the scale
        energy = seen(motion, line).energy
        expected = np.abs(energy - energy[0]) / energy.max()
        assert data(line)[1] == pytest.approx(expected, rel=1e-12, abs=1e-15)
    largest = [data(line)[1].max() for line in shown.error]
    assert largest[0] < 1e-14 and largest[1] > 1e-4 and largest[2] > 1e-3
    assert shown.ax.get_ylim()[0] < 1e-16 and shown.ax.get_ylim()[1] > max(largest)


def test_the_kind_of_energy_picture_is_a_choice(several: list[rl.Trajectory]) -> None:
    energies = rl.plot_energy(several, ax=new_axes(), kind="energies")
    assert len(energies.total) == len(energies.potential) == 3 and energies.error == ()
    assert legend_of(energies.ax)[3:] == ["total", "kinetic", "potential"]
    assert len(rl.plot_energy(several[0], ax=new_axes(), kind="error").error) == 1
    with pytest.raises(ValueError, match="kind must be one of 'energies', 'error', got 'total'"):
        rl.plot_energy(several, ax=new_axes(), kind="total")  # type: ignore[arg-type]


def test_an_energy_without_any_error_is_said_to_be_0() -> None:
    still = rl.simulate(rl.Scene(2.0, 1.0), 1.0)
    ax = rl.plot_energy([still, still], ax=new_axes(), labels=["one", "two"]).ax
    legend = ax.get_legend()
    assert legend is not None
    assert [text.get_text() for text in legend.get_texts()] == ["one = 0", "two = 0"]
