"""What a phase map says of uniform discs without a call for each: their a/b and roll-over speed."""

from __future__ import annotations

import functools
import math
from typing import Any

import numpy as np

from ..._ask.check import uniform_disc
from ..._verbs.classify import thresholds

TIP_ASPECT = math.sqrt(3)
"""Up to this a/b of a uniform disc the N of rolling vanishes at the tip first.

Exactly: at the speed at which N(h) of physics (33) vanishes at the tip, its slope there, with
k^2 = (a^2 + b^2)/4, has the sign of a^2 - 3 b^2: beyond, N is least before the tip.
"""

LAST_WITHIN = 9.0, 10.0
"""Bounds of `last_aspect_to_roll_over`, between which it is looked for."""


def roll_over_speed(aspect: Any, b: float, gravity: float) -> Any:
    """Return the omega at the flat position that just rolls a disc over [rad/s], physics (44)."""
    aspect = np.asarray(aspect)
    inertia = uniform_disc(aspect, 1.0) + 1.0
    return np.sqrt(2 * gravity / b * (aspect - 1) / inertia)


@functools.cache
def last_aspect_to_roll_over() -> float:
    """Return the a/b above which rolling ends before the tip, whatever the friction.

    There the speed that N > 0 allows is the one that rolling over takes, both from `thresholds`:
    by secants. Neither length nor gravity matters.
    """

    def spare(aspect: float) -> float:
        found = thresholds(aspect, 1.0, friction=0.0)
        return found.contact_loss_speed / found.roll_over_speed - 1

    before, here = LAST_WITHIN
    then, now = spare(before), spare(here)
    while abs(here - before) > 1e-9 and now != then:  # the next step is of rounding
        before, here = here, here - now * (here - before) / (now - then)
        then, now = now, spare(here)
    return here
