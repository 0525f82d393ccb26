"""The equation for libraries whose compiled right-hand side writes its result into an argument."""

from typing import Any

import numba

from .problem import RATES

_rates = numba.njit(RATES)


def right_hand_side(t: float, y: Any, dy: Any, body: Any) -> None:
    """dy = f(t, y) for y = (theta, omega, x), to be compiled by the caller."""
    dy[0] = y[1]
    dy[1], dy[2] = _rates(y[0], y[1], body)
