"""The report's equations as printed, its errata in numbers, and its simulation.

Arrays have the report's coordinates q = (x, z, theta, psi, r) along the last axis [m, m, rad, rad,
m], in the order of its section 2. Its constraint matrix, with columns (x, r, psi, theta, z), and
its state space, (x, z, r, theta, psi), are reordered accordingly. Each function
evaluates either what the report prints or the correct equation, as its docstring states. Quantities
are in SI units, and theta is positive clockwise.

Common arguments are ``q``, ``q_dot``, ``q_ddot``, array_like of shape (..., 5) whose leading axes
broadcast; the semi-axes ``a``, ``b`` [m]; ``mass`` [kg]; and ``gravity`` [m/s^2]. All functions
raise ValueError, naming the argument, for a wrong shape or a number out of range.

Examples
--------
>>> motion = rl.simulate(rl.scenes.report, 2.0)
>>> off = abs(rl.report.f1(motion.q, motion.q_dot)).max()
>>> print(f"f1 as printed is off by {off:.1f} m/s")
f1 as printed is off by 12.8 m/s
"""

from . import _equations
from ._equations import *  # noqa: F403
from ._errata import Comparison, Erratum, errata, errata_table
from ._motion import PrintedMotion, Start
from ._rows import CODE, EQ_32, MATRIX, MISPRINTS, consistent_rates, constraint_matrix
from ._simulate import InconsistentStartWarning, simulate

__all__ = [
    "CODE", "EQ_32", "MATRIX", "MISPRINTS", "Comparison", "Erratum", "InconsistentStartWarning",
    "PrintedMotion", "Start", "consistent_rates", "constraint_matrix", "errata", "errata_table",
    "simulate",
]  # fmt: skip
__all__ += _equations.__all__
