"""The colours of the player, on light paper and on dark."""

from __future__ import annotations

from .._pictures.palette import BLUE, EARTH, GREY, INK, ORANGE, PLUM, SKY

LIGHT = {
    "paper": "#ffffff", "ink": INK, "blue": BLUE, "orange": ORANGE, "grey": GREY, "earth": EARTH,
    "plum": PLUM, "sky": SKY, "body": "#cadbe5", "faint": "#c9d0d8", "panel": "#f4f5f7",
}  # fmt: skip
DARK = {
    "paper": "#10161f", "ink": "#e8edf4", "blue": "#63b1dd", "orange": "#ffa23e",
    "grey": "#8c99a8", "earth": "#2b2a28", "plum": "#e27fa6", "sky": "#2d5d7c",
    "body": "#23415a", "faint": "#3a4653", "panel": "#1a222d",
}  # fmt: skip
