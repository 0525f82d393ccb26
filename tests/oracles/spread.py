"""By how much two answers may differ that are equal but for rounding.

Nothing here is a derivative of the package's own: answers at inputs that were moved by their
rounding are looked at as they are. Such bounds may stand between answers of the package, and never
between an answer and its truth.
"""

import math
from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray

from oracles.numbers import EPS

Floats = NDArray[np.float64]
Inputs = Mapping[str, float]
Answer = Callable[..., Floats]

# A backward stable method answers a question whose every number is off by a rounding; four leave
# room for some roundings inside. A wrong digit anywhere in front of them shows.
ROUNDINGS = 4


def roundings(inputs: Inputs) -> dict[str, float]:
    """What four roundings move every number by; angles are known to no more than those of 1."""
    return {
        name: ROUNDINGS * EPS * (max(abs(value), 1.0) if name == "theta" else abs(value))
        for name, value in inputs.items()
    }


def spread(answer: Answer, inputs: Inputs, errors: Inputs) -> Floats:
    """How far an answer goes when one input after the other is off by its error, both ways."""
    middle = answer(**inputs)
    total = ROUNDINGS * np.spacing(np.abs(middle))
    for name, error in errors.items():
        if error == 0 or not math.isfinite(inputs[name]):
            continue
        ends = [answer(**{**inputs, name: inputs[name] + side * error}) for side in (1, -1)]
        total += np.maximum(*(np.abs(end - middle) for end in ends))
    return total


def known_to(answer: Answer, inputs: Inputs) -> Floats:
    """What rounding may make of an answer."""
    return spread(answer, inputs, roundings(inputs))
