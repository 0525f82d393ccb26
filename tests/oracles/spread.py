"""Bounds of the difference of two answers that are equal but for rounding.

They are computed from answers of the package at inputs changed by their rounding. So they bound
differences between answers of the package, never an error.
"""

import math
from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray

from oracles.numbers import EPS

Floats = NDArray[np.float64]
Inputs = Mapping[str, float]
Answer = Callable[..., Floats]

# A backward stable method is exact for inputs that are off by one rounding each; four roundings
# allow some more.
ROUNDINGS = 4


def roundings(inputs: Inputs) -> dict[str, float]:
    """Four roundings of every number; an angle counts as 1 rad at least."""
    return {
        name: ROUNDINGS * EPS * (max(abs(value), 1.0) if name == "theta" else abs(value))
        for name, value in inputs.items()
    }


def spread(answer: Answer, inputs: Inputs, errors: Inputs) -> Floats:
    """Sum of the changes of an answer when each input changes by its error, in both directions."""
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
