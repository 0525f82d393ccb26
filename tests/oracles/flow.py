"""Motions on which `flow` is tested, and the largest error allowed."""

from typing import Any

from rolling_ellipse import thresholds

# A unit is the unavoidable error of a backward stable method: the effect of rounding every input
# once, plus two ulps. Four units allow for a few more roundings.
LARGEST_ERROR = 4.0

PARAMETERS = ("a", "b", "gyration2", "gravity", "theta", "omega")
Motion = tuple[float, ...]

ROLL_OVER = thresholds(2.0, 1.0).roll_over_speed
MOTIONS = {
    "libration": (2.0, 1.0, 1.25, 9.81, 0.2, 1.0),
    "small libration": (2.0, 1.0, 1.25, 9.81, 1e-3, 0.0),
    "rotation": (2.0, 1.0, 1.25, 9.81, 0.2, 3.2),
    "backwards": (2.0, 1.0, 1.25, 9.81, -1.1, -4.0),
    "fast": (1.5, 1.0, 0.3, 3.7, 0.4, 1e4),
    "just over the tip": (2.0, 1.0, 1.25, 9.81, 0.0, ROLL_OVER * (1 + 1e-9)),
    "just not over it": (2.0, 1.0, 1.25, 9.81, 0.0, ROLL_OVER * (1 - 1e-9)),
    "thin": (2.0, 0.02, 1.0001, 9.81, 0.3, 0.0),
    "thin turning": (1.0, 1.1e-3, 0.25, 9.81, 0.1, 7.0),
    "standing": (0.7, 1.9, 1.025, 9.81, 1.3, 0.8),
    "standing turning": (0.7, 1.9, 1.025, 9.81, 0.1, -2.5),
    "hoop": (1.1, 1.0, 1.21, 1.62, 0.7, 0.3),
    "circle + 1e-8": (1.0 + 1e-8, 1.0, 0.5, 9.81, 0.3, 2.0),
}


def arguments(motion: Motion) -> dict[str, Any]:
    return dict(zip(PARAMETERS, motion, strict=True))
