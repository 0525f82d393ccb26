"""Single impacts of a body that touches the ground: predicted, and fitted to measured ones.

``theta`` is the clockwise rotation [rad]; ``x_dot``, ``z_dot`` [m/s] are the velocity of the
centre along the ground and away from it, ``omega`` [rad/s] is positive clockwise. The mass enters
only through k^2 = I/m, ``gyration2`` [m^2].
"""

from ._collide import LAWS, collide, kinetic_speed
from ._fit import FittedImpacts, fit

__all__ = ["LAWS", "FittedImpacts", "collide", "fit", "kinetic_speed"]
