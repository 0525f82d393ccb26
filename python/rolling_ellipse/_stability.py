"""What a computed motion has lost of what it should keep, and what would keep it."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

from . import _core

if TYPE_CHECKING:
    from ._settings import Settings
    from ._trajectory import Trajectory

_LOST_ENERGY = 1e-2  # beside the energy itself
_MISSED = 1e-3  # of the constraints, in long semi-axes and rad: a pixel of a picture of the body
_OF_RTOL = 10.0  # times rtol are no surprise


def advice(motion: Trajectory) -> str | None:
    """Return a sentence on what to use instead, where a motion has lost what it should keep."""
    if motion.method == "exact" or motion.model == "contact" or motion.t.size == 0:
        return None
    settings = motion.settings
    step = settings.step
    if settings.stabilization == "baumgarte" and step is not None:
        settings = replace(settings, method=motion.method)  # not "auto"
        if (growth := _core.feedback_growth(settings.core)) > 1:
            return _too_stiff(settings, step, growth)
    losses = motion._solution.losses()
    if motion.model == "multipliers" and losses["constraints"] > _MISSED:
        return (
            f"the constraints are missed by {losses['constraints']:.2g} of the long semi-axis "
            f"{_when(motion)} with stabilization {settings.stabilization!r}: use 'projection', "
            "which keeps them, or the model 'rolling', which has none to miss"
        )
    expected = 0.0 if settings.step else _OF_RTOL * settings.rtol
    if losses["energy"] > max(_LOST_ENERGY, expected):
        finer = "smaller steps" if settings.step else "smaller rtol and atol"
        return (
            f"the energy has changed by {losses['energy']:.2g} of itself {_when(motion)} with "
            f"method {settings.method!r}: take {finer}, {_better(motion)}"
        )
    return None


def _when(motion: Trajectory) -> str:
    return f"by t = {motion.t_end:g} s"


def _better(motion: Trajectory) -> str:
    if motion.model == "multipliers":
        return "or stabilization 'projection+energy'"
    return "or method 'exact', which takes none"


def _too_stiff(settings: Settings, step: float, growth: float) -> str:
    """The step is too large for the feedback: say for which it is not."""
    stable, unstable = 0.0, step
    for _ in range(60):
        middle = (stable + unstable) / 2
        if _core.feedback_growth(replace(settings, step=middle).core) > 1:
            unstable = middle
        else:
            stable = middle
    return (
        f"each step of {step:g} s multiplies what the constraints are missed by by "
        f"{growth:.3g}, as method {settings.method!r} does not bear the gains {settings.baumgarte} "
        f"there: take steps of at most {math.floor(stable * 1e6) / 1e6:g} s, smaller gains, or "
        "stabilization 'projection'"
    )
