"""English text for the reasons that the core returns, and for the numbers of a blow."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from .words import Sentence, joined, table

if TYPE_CHECKING:
    from .impulse import Impulse

_ASCII = str.maketrans({"θ": "theta", "°": " deg", "é": "e", "−": "-", "∞": "inf"})


def in_words(sentences: Sequence[Sentence]) -> str:
    """Return sentences as English text in ASCII, which every console can display."""
    return joined(table("en"), sentences, 6).translate(_ASCII)


def blow_in_words(impulse: Impulse) -> str:
    """Return the components [N s] and the point of application [m] of an impulse as text."""
    return (
        f"({impulse.jx:g}, {impulse.jz:g}) N s at ({impulse.dx:g}, {impulse.dz:g}) m from the "
        "centre"
    )
