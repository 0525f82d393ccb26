"""A motion as HTML for notebooks: a table of its facts, and a small picture."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .._ask.printing import Row, brief, html_table
from .._motion.strobe_svg import strobe_svg

if TYPE_CHECKING:
    from .._motion.trajectory import Trajectory


def _repr_html_(trajectory: Trajectory) -> str:
    """Return a table of the motion's facts and, if there are samples, the picture `strobe_svg`."""
    return f"{html_table(repr(trajectory)[1:-1], _rows(trajectory))}{strobe_svg(trajectory)}"


def _rows(trajectory: Trajectory) -> list[Row]:
    rows: list[Row] = [
        ("scene", repr(trajectory.scene)),
        ("status", f"{trajectory.status.name}: {trajectory.message}"),
        ("reason", trajectory.reason),
    ]
    if trajectory.t.size:
        theta, x, omega = (getattr(trajectory, name)[-1] for name in ("theta", "x", "omega"))
        rows.append(
            ("at the end", f"theta = {theta:.6g} rad, omega = {omega:.6g} rad/s, x = {x:.6g} m")
        )
    if trajectory.events:
        last = trajectory.events[-1]
        count = f"{len(trajectory.events)}, the last {last.kind.name} at t = {brief(last.t)} s"
        rows.append(("events", count))
    return rows
