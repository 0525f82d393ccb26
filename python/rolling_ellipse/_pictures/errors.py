"""Plots of energies, constraint errors and distances from the exact motion over time."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from .._ask.check import FloatArray, choice, shown
from .._ask.settings import DEFAULTS
from .._motion.constraints import constraint_errors, energy_error, losses, may_lose_energy, worst
from .._motion.trajectory import Trajectory
from .axes import Artists, axes_of, name_curves, panels_of, picture, some_of
from .comparison import MARKERS, Comparison, Style
from .palette import palette_of
from .panels import DASHES, dot, draw_curves, finish, label_of
from .sampling import are_ranges, for_dots, over_time, ranges

KINDS = ("energies", "error", "losses")
ENERGIES = {"energy": "total", "kinetic_energy": "kinetic", "potential_energy": "potential"}
LOSSES = {"rolling": "by rolling", "sliding": "by sliding", "impacts": "by impacts"}
QUANTITIES = (
    "theta", "omega", "x", "z", "x_dot", "z_dot", "contact_x", "turns", "normal_force",
    "friction_force", "energy", "kinetic_energy", "potential_energy",
)  # fmt: skip
_ROUNDING = 1e-13  # the error axis extends to at least ten times this, so rounding looks small
_LEAST = 1e-17  # lower end of the error axis


def draw_errors(
    ax: Axes, shown: Comparison, errors: Iterable[Mapping[str, FloatArray]], label: str,
    none: str = "exactly 0 throughout", *, dashed: bool = False,
) -> tuple[Line2D, ...]:  # fmt: skip
    """Draw the named errors of each motion on a logarithmic axis, as lines if `dashed`.

    Otherwise the errors are drawn as dots, because rounding errors jump. The axis extends from
    below rounding to above the largest error. Exact zeros are left out: the label of an error that
    is always 0, or of an unconstrained quantity, says so. If no error can be shown, a text in the
    axes says why.
    """
    palette, lines = palette_of(ax), list[Line2D]()
    colours = *palette.curves[:3], palette.plum, palette.grey
    for (motion, style), own in zip(shown, errors, strict=True):
        for rank, (name, values) in enumerate(own.items()):
            t = motion.t
            if not np.nan_to_num(values).any():
                name += " = 0" if np.isfinite(values).any() else " not held"
            if are_ranges(motion):
                t, _, values = ranges(t, values)
            how: dict[str, Any] = {"ls": "none", "marker": style.marker or MARKERS[rank]}
            how = {"ls": style.dash} | dot(t) if dashed else how | {"ms": 3, "mew": 0.7}
            lines += ax.plot(t, values, color=style.colour or colours[rank], label=name, **how)
    shown.restyle(*lines)
    largest = max(float(np.max(np.nan_to_num(np.asarray(line.get_ydata())))) for line in lines)
    ax.set_ylim(_LEAST, 10 * max(largest, _ROUNDING))  # a log axis cannot fit zeros
    ax.set_yscale("log", nonpositive="mask")
    ax.set_ylabel(label)
    if largest < _LEAST:
        ax.text(
            0.5, 0.5, f"less than {_LEAST:g} throughout" if largest else none, ha="center",
            va="center", transform=ax.transAxes, fontsize="small", color=palette.text,
            bbox={"fc": palette.background, "ec": "none"},
        )  # fmt: skip
    return tuple(lines)


@dataclass(frozen=True, repr=False)
class Energy(Artists):
    """Artists of `plot_energy`; item i of each tuple of lines belongs to motion i.

    `lost` has three such tuples: the losses by rolling, by sliding and by impacts. Fields that the
    chosen `kind` does not draw are empty.
    """

    total: tuple[Line2D, ...]
    kinetic: tuple[Line2D, ...]
    potential: tuple[Line2D, ...]
    error: tuple[Line2D, ...]
    lost: tuple[tuple[Line2D, ...], ...]
    marks: tuple[Artist, ...]


@picture
def plot_energy(
    trajectories: Trajectory | Sequence[Trajectory],
    *,
    ax: Axes | None = None,
    figsize: tuple[float, float] | None = None,
    labels: Sequence[str] | None = None,
    colors: Sequence[Any] | None = None,
    kind: Literal["energies", "error", "losses"] | None = None,
    **options: Any,
) -> Energy:
    """Draw energies of motions [J], their losses, or the error of the conserved energy.

    The error is ``|E - E0|`` divided by the largest ``|kinetic| + |potential|`` energy of the
    motion, where E0 is the energy of the first sample; the scale is logarithmic and cannot show
    exact zeros. Losses by friction and impacts are not errors: after an event that may dissipate
    energy, E0 is the energy of the next sample, and no error is shown while the body slides or
    rolls with resistance. Losses by rolling resistance, sliding friction and impacts are drawn
    separately, each summed from the first sample on.

    Parameters
    ----------
    trajectories : Trajectory or sequence of Trajectory
    kind : {"energies", "error", "losses"}, optional
        What to draw; default: "energies" for one motion, or for several if any loses energy,
        otherwise "error".
    {ax}
    {motions}

    {returns}

    Notes
    -----
    Dots show the samples or, if there are fewer than 100, the points of a curve.
    Modes, events, lost validity and long spans are drawn as in `plot_forces`.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> motion = rl.simulate(rl.scenes.drop, 4.0)
    >>> energies, losses = rl.plot_energy(motion), rl.plot_energy(motion, kind="losses")
    >>> below = losses.ax.secondary_xaxis(-0.3, functions=(lambda t: 1e3 * t, lambda t: t / 1e3))
    >>> label = below.set_xlabel("t [ms]")
    >>> plt.show()
    """
    shown = Comparison(trajectories, labels, colors, ax, options)
    if kind is None:
        kind = "energies" if shown.alone or any(map(may_lose_energy, shown.motions)) else "error"
    drawn = choice("kind", kind, KINDS)
    shown.sampled(for_dots if drawn == "error" else over_time)
    ax = axes_of(ax, (7, 3.4), figsize)
    if drawn == "losses":
        lost = draw_curves(ax, shown, "energy lost [J]", LOSSES, losses)
        handles = shown.handles(ax, list(zip(LOSSES.values(), DASHES, strict=True)))
        return Energy((ax,), (), (), (), (), lost, finish([ax], shown, handles))
    if drawn == "energies":
        total, kinetic, potential = draw_curves(ax, shown, "energy [J]", ENERGIES)
        handles = shown.handles(ax, list(zip(ENERGIES.values(), DASHES, strict=True)))
        return Energy((ax,), total, kinetic, potential, (), (), finish([ax], shown, handles))
    errors = [{style.label or "energy error": energy_error(motion)} for motion, style in shown]
    kept = any(np.isfinite(values).any() for own in errors for values in own.values())
    none = "exactly 0 throughout" if kept else "friction takes energy throughout"
    lines = draw_errors(ax, shown, errors, "relative energy error", none)
    return Energy((ax,), (), (), (), lines, (), finish([ax], shown, some_of(lines)))


@dataclass(frozen=True, repr=False)
class Constraints(Artists):
    """Artists of `plot_constraints`: lines[i] are the labelled lines in axes[i]."""

    lines: tuple[tuple[Line2D, ...], ...]
    marks: tuple[Artist, ...]


@picture
def plot_constraints(
    trajectories: Trajectory | Sequence[Trajectory],
    *,
    ax: Axes | Sequence[Axes] | None = None,
    figsize: tuple[float, float] | None = None,
    labels: Sequence[str] | None = None,
    colors: Sequence[Any] | None = None,
    **options: Any,
) -> Constraints:
    """Draw the dimensionless constraint errors of motions on a logarithmic scale.

    Lengths are divided by the longer semi-axis, and rates also by the largest ``|omega|`` of the
    motion, so that rounding errors are about 1e-16 for any body. The upper panel shows f2, f3, f4
    and the gap; the lower panel shows f1, the rates of the others and the slip (see
    `ConstraintResiduals`). For several motions each panel shows the largest error. Exact zeros are
    not shown, nor the slip of a sliding body or the gap in flight, which are not constrained.
    Dots show the samples or, if there are fewer than 100, the points of a curve.
    Modes, events, lost validity and long spans are drawn as in `plot_forces`.

    Parameters
    ----------
    trajectories : Trajectory or sequence of Trajectory
    ax : matplotlib Axes or two of them, optional
        Where to draw the panels; a single Axes shows the largest errors of both panels. Default: a
        new pyplot figure.
    {figsize}
    {motions}

    {returns}

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> how = {"model": "multipliers", "method": "rk4", "step": 0.01}
    >>> ways = ("none", "projection")
    >>> motions = [rl.simulate(rl.scenes.report, 5.0, **how, stabilization=way) for way in ways]
    >>> errors = rl.plot_constraints(motions, labels=ways)
    >>> plt.show()
    """
    shown = Comparison(trajectories, labels, colors, ax, options).sampled(for_dots)
    panels = panels_of(ax, figsize)
    names = ("positions", "velocities") if len(panels) == 2 else ("constraint error",)
    errors = zip(*(_errors_of(*each, len(panels)) for each in shown), strict=True)
    lines = tuple(
        draw_errors(panel, shown, of_all, name)
        for panel, of_all, name in zip(panels, errors, names, strict=True)
    )
    if shown.alone:
        name_curves(panels[-1], some_of(lines[-1]))
    marks = finish(panels, shown, some_of(lines[0]))
    return Constraints(tuple(panels), lines, marks)


def _errors_of(motion: Trajectory, style: Style, panels: int) -> list[Mapping[str, FloatArray]]:
    """Return the named errors of each panel, or only the largest if the motion has a label."""
    positions, velocities = constraint_errors(motion)
    if style.label:
        of_panels = [positions, velocities] if panels == 2 else [{**positions, **velocities}]
        return [{style.label: worst(errors)} for errors in of_panels]
    if panels == 2:
        return [positions, velocities]
    return [{"positions": worst(positions), "velocities": worst(velocities)}]


@dataclass(frozen=True, repr=False)
class Error(Artists):
    """Artists of `plot_error`; item i of `errors` and of `references` belongs to motion i."""

    errors: tuple[Line2D, ...]
    references: tuple[Trajectory, ...]
    marks: tuple[Artist, ...]


@picture
def plot_error(
    trajectories: Trajectory | Sequence[Trajectory],
    quantity: str = "theta",
    reference: Trajectory | None = None,
    *,
    ax: Axes | None = None,
    figsize: tuple[float, float] | None = None,
    labels: Sequence[str] | None = None,
    colors: Sequence[Any] | None = None,
    **options: Any,
) -> Error:
    """Draw the error of one quantity of motions over time, on a logarithmic scale.

    Each motion is compared with the exact motion of its scene: exact rolling if the model of the
    motion is a rolling model, otherwise the contact motion. Exact zeros are not shown.
    Modes, events, lost validity and long spans are drawn as in `plot_forces`.

    Parameters
    ----------
    trajectories : Trajectory or sequence of Trajectory
    quantity : str
        "theta", "omega", "x", "z", "x_dot", "z_dot", "contact_x", "turns", "normal_force",
        "friction_force", "energy", "kinetic_energy" or "potential_energy".
    reference : Trajectory, optional
        The motion with which every trajectory is compared, at the times of the trajectory. It must
        last at least as long as all of them. It is required for a motion that started from given
        coordinates or lasts longer than 1e15 half turns. The returned artists include the
        references used.
    {ax}
    {motions}

    {returns}

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> steps = (0.04, 0.02, 0.01)
    >>> runs = [rl.simulate(rl.scenes.report, 9.0, method="rk4", step=step) for step in steps]
    >>> errors = rl.plot_error(runs, labels=[f"step {step} s" for step in steps])
    >>> plt.show()
    """
    quantity = choice("quantity", quantity, QUANTITIES)
    compared = Comparison(trajectories, labels, colors, ax, options)
    references = tuple(_reference_of(motion, reference) for motion in compared.motions)
    compared.sampled(over_time)
    ax = axes_of(ax, (7, 3.4), figsize)
    missed = (
        {style.label or "error": _error(motion, right, quantity)}
        for (motion, style), right in zip(compared, references, strict=True)
    )
    none = f"no error beside the {'exact motion' if reference is None else 'reference'}"
    label = f"error of {label_of(quantity)}"
    errors = draw_errors(ax, compared, missed, label, none, dashed=True)
    marks = finish([ax], compared, [] if compared.alone else some_of(errors))
    return Error((ax,), errors, references, marks)


def _reference_of(motion: Trajectory, reference: Trajectory | None) -> Trajectory:
    last = float(np.max(motion.t))
    if reference is not None:
        if not isinstance(reference, Trajectory):
            raise TypeError(f"reference must be a Trajectory or None, got {shown(reference)}")
        if reference.t_end < last:
            raise ValueError(
                f"reference must reach the last time of every trajectory, {last:g} s, got one to "
                f"{reference.t_end:g} s"
            )
        return reference
    if motion.start is not None:
        raise ValueError(
            "reference must be given for a trajectory that starts from coordinates of its own"
        )
    how: dict[str, Any] = {"model": "contact"}
    if motion.model != "contact":
        how = {"model": "rolling", "method": "exact"}
    try:
        return Trajectory.computed(motion.scene, replace(DEFAULTS, **how), np.array([last]))
    except ValueError as error:  # the core rejects times beyond 1e15 half turns
        raise ValueError(
            f"reference must be given where no exact motion reaches {last:g} s: {error}"
        ) from error


def _error(motion: Trajectory, right: Trajectory, quantity: str) -> FloatArray:
    """Return |error| at the times of a motion; NaN after the end of the reference `right`."""
    there = right.sol(np.minimum(motion.t, right.t_end))
    error = np.abs(getattr(motion, quantity) - getattr(there, quantity))
    return np.where(motion.t <= right.t_end, error, np.nan)
