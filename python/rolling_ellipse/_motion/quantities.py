"""Units and meanings of the arrays of a trajectory, and attributes for enum codes."""

from __future__ import annotations

import enum
from typing import Any, NamedTuple

import numpy as np


class Quantity(NamedTuple):
    """An array of a trajectory: attribute name, unit and meaning."""

    name: str
    unit: str
    meaning: str
    shape: str = "(n,)"

    @property
    def sentence(self) -> str:
        """Docstring with the meaning, unit and shape."""
        return f"{self.meaning[0].upper()}{self.meaning[1:]} [{self.unit}], shape {self.shape}."


TIME = Quantity("t", "s", "time")
QUANTITIES = (
    Quantity("x", "m", "position of the centre along the ground"),
    Quantity("z", "m", "height of the centre above the ground"),
    Quantity("theta", "rad", "angle of the body, clockwise positive"),
    Quantity("psi", "rad", "angle in the body from its axis b to the contact"),
    Quantity("r", "m", "distance from the centre to the contact"),
    Quantity("x_dot", "m/s", "velocity of the centre along the ground"),
    Quantity("z_dot", "m/s", "velocity of the centre away from the ground"),
    Quantity("omega", "rad/s", "angular velocity, clockwise positive"),
    Quantity("psi_dot", "rad/s", "rate of psi"),
    Quantity("r_dot", "m/s", "rate of r"),
    Quantity("x_ddot", "m/s^2", "acceleration of the centre along the ground"),
    Quantity("z_ddot", "m/s^2", "acceleration of the centre away from the ground"),
    Quantity("omega_dot", "rad/s^2", "angular acceleration, clockwise positive"),
    Quantity("psi_ddot", "rad/s^2", "second derivative of psi with respect to time"),
    Quantity("r_ddot", "m/s^2", "second derivative of r with respect to time"),
    Quantity("contact_x", "m", "position of the contact along the ground"),
    Quantity("turns", "1", "number of turns since the start of the scene"),
    Quantity("normal_force", "N", "contact force on the body away from the ground"),
    Quantity("friction_force", "N", "contact force on the body along the ground"),
    Quantity("friction_needed", "1", "friction force over normal force"),
    Quantity("energy", "J", "sum of kinetic and potential energy"),
    Quantity("kinetic_energy", "J", "kinetic energy"),
    Quantity("translational_energy", "J", "kinetic energy of translation"),
    Quantity("rotational_energy", "J", "kinetic energy of rotation about the centre"),
    Quantity("potential_energy", "J", "potential energy"),
)
MATRICES = (
    Quantity("q", "m, m, rad, rad, m", "coordinates x, z, theta, psi, r", "(n, 5)"),
    Quantity("q_dot", "m/s, m/s, rad/s, rad/s, m/s", "rates of `q`", "(n, 5)"),
    Quantity("multipliers", "N, N, N, N m", "multipliers of f1 to f4, F and N first", "(n, 4)"),
)
MULTIPLIERS = (
    Quantity("lambda1", "N", "multiplier of the constraint f1: the friction force"),
    Quantity("lambda2", "N", "multiplier of the constraint f2: the normal force"),
    Quantity("lambda3", "N", "multiplier of the constraint f3"),
    Quantity("lambda4", "N m", "multiplier of the constraint f4"),
)
MODE = Quantity("mode", "1", "code of the mode of motion")


def flags(kind: type[enum.IntEnum]) -> dict[str, Any]:
    """Return attributes that name the codes of an enum, following the CF conventions."""
    names = " ".join(each.name for each in kind)
    return {"flag_values": np.array(list(kind), dtype=np.int8), "flag_meanings": names}
