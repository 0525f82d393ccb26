"""Advice for a computed motion that has lost energy or drifted off its constraints."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

from .. import _core

if TYPE_CHECKING:
    from .._ask.settings import Settings
    from .trajectory import Trajectory

_LOST_ENERGY = 1e-2  # largest accepted relative change of the energy
# Largest accepted constraint error relative to the long semi-axis: about a pixel in a picture
_MISSED = 1e-3
_MOVED = 0.1  # largest accepted constraint error of a step before projection [long semi-axes]
_OF_RTOL = 10.0  # largest accepted relative change of the energy under error control [rtol]


def advice(motion: Trajectory) -> str | None:
    """Return a sentence of advice if a motion has lost energy or left its constraints, or None.

    The energy and the constraint errors are checked at the steps and between them. The change of
    the energy, which rolling conserves, is divided by the largest kinetic plus |potential| energy,
    with x = 0 at the start. A projection enforces the constraints for any step size and so hides
    the local error, but the constraint error before the projection is of the same order. If this
    error exceeds a tenth of the long semi-axis, the projected state belongs to another motion.
    """
    losses = motion._solution.losses()
    if losses is None:
        return None
    energy, constraints, projected = losses
    settings = motion.settings
    step = settings.step
    accepted = max(_LOST_ENERGY, 0.0 if step else _OF_RTOL * settings.rtol)
    if settings.stabilization == "baumgarte" and step is not None:
        if settings.method == "auto":
            settings = replace(settings, method=motion.method)
        if (growth := _core.feedback_growth(settings.core)) > 1:
            return _too_stiff(settings, step, growth)
    if not (energy > accepted or constraints > _MISSED or projected > _MOVED):
        return None
    by = f"by t = {motion.t_end:g} s"
    finer = "smaller steps" if step else "smaller rtol and atol"
    if projected > _MOVED:
        return (
            f"a step has missed the constraints by {projected:.2g} of the long semi-axis "
            f"before stabilization {settings.stabilization!r}, which leads to another motion: "
            f"take {finer}"
        )
    if constraints > _MISSED:
        return (
            f"the constraint error has reached {constraints:.2g} of the long semi-axis "
            f"{by} with stabilization {settings.stabilization!r}: use 'projection', "
            "which enforces the constraints, or the model 'rolling', which has none"
        )
    better = "method 'exact', which takes none"
    if motion.model == "multipliers":
        better = "stabilization 'projection+energy'"
    return (
        f"the relative change of the energy has reached {energy:.2g} {by} with "
        f"method {settings.method!r}: take {finer}, or {better}"
    )


def _too_stiff(settings: Settings, step: float, growth: float) -> str:
    """Return the advice to use the largest step at which Baumgarte's feedback is stable."""
    stable, unstable = 0.0, step
    for _ in range(60):
        middle = (stable + unstable) / 2
        if _core.feedback_growth(replace(settings, step=middle).core) > 1:
            unstable = middle
        else:
            stable = middle
    return (
        f"each step of {step:g} s multiplies the constraint error by {growth:.3g}, because "
        f"method {settings.method!r} is unstable with the gains {settings.baumgarte} at this step: "
        f"take steps of at most {math.floor(stable * 1e6) / 1e6:g} s, smaller gains, or "
        "stabilization 'projection'"
    )
