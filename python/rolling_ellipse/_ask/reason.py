"""The core's reasons and the numbers of blows, as English text."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from .words import Sentence, joined, table

if TYPE_CHECKING:
    from .impulse import Impulse

_ASCII = str.maketrans({"θ": "theta", "°": " deg", "é": "e", "−": "-", "∞": "inf"})


def in_words(sentences: Sequence[Sentence]) -> str:
    """Return the text for keys and their values, in characters that every console can show."""
    return joined(table("en"), sentences, 6).translate(_ASCII)


def blow_in_words(impulse: Impulse) -> str:
    """Return the components [N s] and the point of attack [m] of an impulse as text."""
    return (
        f"({impulse.jx:g}, {impulse.jz:g}) N s at ({impulse.dx:g}, {impulse.dz:g}) m from the "
        "centre"
    )
