"""The error of a motion over time, beside the exact one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from .._ask.check import FloatArray, choice, shown
from .._ask.settings import DEFAULTS
from .._motion.quantities import QUANTITIES as UNITS_AND_MEANINGS
from .._motion.trajectory import Trajectory
from .axes import Artists, axes_of, picture
from .comparison import Comparison
from .legends import some_of
from .panels import draw_errors, finish
from .sampling import over_time

QUANTITIES = {  # quantities and their symbols
    "theta": "θ", "omega": "ω", "x": "x", "z": "z", "x_dot": "x_dot", "z_dot": "z_dot",
    "contact_x": "contact", "turns": "turns", "normal_force": "N", "friction_force": "F",
    "energy": "energy", "kinetic_energy": "kinetic energy", "potential_energy": "potential energy",
}  # fmt: skip
_UNITS = {each.name: "" if each.unit == "1" else f" [{each.unit}]" for each in UNITS_AND_MEANINGS}


@dataclass(frozen=True, repr=False)
class Error(Artists):
    """Artists of `plot_error`; item i of `errors` and of `references` belongs to motion i."""

    ax: Axes
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
    """Draw by how much one quantity of motions is off over time, on a logarithmic scale.

    Each motion is held against the exact one from the same scene: exact rolling where the motion
    is of a model that rolls, else the contact motion. An exact zero has no place on the scale.
    Modes, events, lost validity and long spans are drawn as in `plot_forces`.

    Parameters
    ----------
    trajectories : Trajectory or sequence of Trajectory
    quantity : str
        "theta", "omega", "x", "z", "x_dot", "z_dot", "contact_x", "turns", "normal_force",
        "friction_force", "energy", "kinetic_energy" or "potential_energy".
    reference : Trajectory, optional
        What all motions are held against, at the times of each: it must reach as far. It must be
        given for a motion that started from coordinates of its own or lasts longer than 1e15 half
        turns; those that are taken for right are among the artists.
    {ax}
    {motions}
    """
    quantity = choice("quantity", quantity, tuple(QUANTITIES))
    compared = Comparison(trajectories, labels, colors, ax=ax, options=options)
    references = tuple(_reference_of(motion, reference) for motion in compared.motions)
    compared.sampled(over_time)
    ax = axes_of(ax, (7, 3.4), figsize)
    found = (
        {style.label or "error": _error(motion, right, quantity)}
        for (motion, style), right in zip(compared, references, strict=True)
    )
    none = f"no error beside the {'exact motion' if reference is None else 'reference'}"
    label = f"error of {QUANTITIES[quantity]}{_UNITS[quantity]}"
    errors = draw_errors(ax, compared, found, label, none, dashed=True)
    marks = finish([ax], compared, [] if compared.alone else some_of(errors))
    return Error(ax, errors, references, marks)


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
    except ValueError as error:  # the core refuses times beyond 1e15 half turns
        raise ValueError(
            f"reference must be given where no exact motion reaches {last:g} s: {error}"
        ) from error


def _error(motion: Trajectory, right: Trajectory, quantity: str) -> FloatArray:
    """Return |error| at the times of a motion; NaN after the end of the right one."""
    known = motion.t <= right.t_end
    error = np.full(motion.t.shape, np.nan)
    there = getattr(right.sol(motion.t[known]), quantity)
    error[known] = np.abs(getattr(motion, quantity)[known] - there)
    return error
