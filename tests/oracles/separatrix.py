"""A 2:1 disc on Earth, started from its flat position at a speed close to the roll-over speed.

mpmath gives the sign and size of the difference from the roll-over speed. The energy integral of
reference/make_rolling_reference.py gives the time until the body lies flat again.
"""

from functools import cache
from typing import Any, NamedTuple

import make_rolling_reference as reference
import mpmath as mp

from oracles.numbers import DIGITS

A, B, GYRATION2, GRAVITY = 2.0, 1.0, 1.25, 9.81  # exact in doubles, except GRAVITY


class Throw(NamedTuple):
    """A start from theta = 0 with a double omega."""

    omega: float  # [rad/s]
    distance: float  # omega/omega_R - 1
    half: float  # time until the body lies flat again [s], at theta = pi or 0

    @property
    def rolls_over(self) -> bool:
        return self.distance > 0


@cache
def rule() -> reference.Rule:
    """Gauss rule with 30 nodes on each panel, and panels that grow by a factor of 1.8. Its error is
    1e-25."""
    with mp.workdps(DIGITS):
        return reference.gauss_rule(30, 1.8)


def roll_over_speed() -> Any:
    """omega_R^2 = 2 g (a - b)/(k^2 + b^2) [rad/s]."""
    return mp.sqrt(2 * mp.mpf(GRAVITY) * (mp.mpf(A) - B) / (mp.mpf(GYRATION2) + B * B))


def tip_rate() -> float:
    """Growth rate lambda of the fall from the tip, g (a^2 - b^2)/(a (k^2 + a^2)) = lambda^2
    [1/s]."""
    with mp.workdps(DIGITS):
        return float(mp.sqrt(mp.mpf(GRAVITY) * (A * A - B * B) / (A * (mp.mpf(GYRATION2) + A * A))))


@cache
def throw(k: int, side: int) -> Throw:
    """The throw with omega = omega_R (1 + side 10^-k), rounded to a double."""
    with mp.workdps(DIGITS):
        exact = roll_over_speed()
        omega = float(exact * (1 + side * mp.mpf(10) ** -k))
        scene = reference.Scene(A, B, GYRATION2, GRAVITY, 0.0, omega)
        moving = reference.RollingEllipse(scene, rule())
        thrown = Throw(omega, float(mp.mpf(omega) / exact - 1), float(2 * moving.quarter_time))
        assert moving.rocks != thrown.rolls_over  # the energy gives the same answer
        return thrown
