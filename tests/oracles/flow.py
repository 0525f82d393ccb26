"""Units of the answers of `flow`: the effect of one rounding of every input, plus two ulp."""

from typing import Any

# One unit is the unavoidable error of a backward stable method that rounds every input once; four
# units allow some more roundings.
LARGEST_ERROR = 4.0

PARAMETERS = ("a", "b", "gyration2", "gravity", "theta", "omega")
Motion = tuple[float, ...]


def arguments(motion: Motion) -> dict[str, Any]:
    """Keyword arguments of `flow`."""
    return dict(zip(PARAMETERS, motion, strict=True))
