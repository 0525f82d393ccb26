"""Bounds for the difference of two answers that are equal to within rounding.

They are computed from answers of the package to inputs that are changed by their rounding.
Therefore they bound differences between answers of the package, not errors.
"""

import math
from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray
from rolling_ellipse import flow

from oracles.numbers import EPS

Floats = NDArray[np.float64]
Inputs = Mapping[str, float]
Answer = Callable[..., Floats]

# A backward stable method is exact for inputs that are off by one rounding each. Four roundings
# leave some room.
ROUNDINGS = 4


def roundings(inputs: Inputs) -> dict[str, float]:
    """Four roundings of every number; an angle counts as 1 rad at least."""
    return {
        name: ROUNDINGS * EPS * (max(abs(value), 1.0) if name == "theta" else abs(value))
        for name, value in inputs.items()
    }


def spread(answer: Answer, inputs: Inputs, errors: Inputs) -> Floats:
    """Sum of the changes of an answer when each input changes by its error in the worse direction,
    plus four ulps of the answer."""
    middle = answer(**inputs)
    total = ROUNDINGS * np.spacing(np.abs(middle))
    for name, error in errors.items():
        if error == 0 or not math.isfinite(inputs[name]):
            continue
        ends = [answer(**{**inputs, name: inputs[name] + side * error}) for side in (1, -1)]
        total += np.maximum(*(np.abs(end - middle) for end in ends))
    return total


def known_to(answer: Answer, inputs: Inputs) -> Floats:
    """Bound of the effect of rounding on an answer."""
    return spread(answer, inputs, roundings(inputs))


def state(t: float, **motion: float) -> Floats:
    """theta, omega and x after time t."""
    return np.array(flow(t, **motion))


def path_grain(motion: Inputs) -> Floats:
    """Additional rounding of (theta, omega, x): x is the difference of two rounded lengths, which
    are of the size of the body."""
    return np.array([0.0, 0.0, ROUNDINGS * EPS * max(motion["a"], motion["b"])])


def known_to_in_two_moves(first: float, second: float, motion: dict[str, float]) -> Floats:
    """Bound on the rounding error of a motion that is continued from its state after the first
    time: the propagated errors of that state, plus those of the second move."""
    theta, omega, _ = state(first, **motion)
    error = known_to(state, {"t": first} | motion)
    inputs = {"t": second} | motion | {"theta": float(theta), "omega": float(omega)}
    errors = {"theta": float(error[0]), "omega": float(error[1])}
    return known_to(state, inputs) + spread(state, inputs, errors) + [0, 0, error[2]]
