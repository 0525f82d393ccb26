"""One state of a motion in plain numbers."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING

from .._ask.check import number
from .._core import Mode

if TYPE_CHECKING:
    from .trajectory import Trajectory


@dataclass(frozen=True)
class Sample:
    """A motion at one time: numbers of the same names and units as the arrays of a Trajectory."""

    t: float
    x: float
    z: float
    theta: float
    psi: float
    r: float
    omega: float
    x_dot: float
    z_dot: float
    contact_x: float
    turns: float
    normal_force: float
    friction_force: float
    energy: float
    mode: Mode


def at(motion: Trajectory, t: float) -> Sample:
    """Return the state at time t [s] in plain floats.

    Raises
    ------
    ValueError
        If t is outside of [0, t_end].
    """
    found = motion.sol(number("t", t))
    names = [field.name for field in fields(Sample) if field.name != "mode"]
    values = {name: float(getattr(found, name)[0]) for name in names}
    return Sample(**values, mode=Mode(int(found.mode[0])))
