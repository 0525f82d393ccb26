"""The motions of one picture, and how they are told apart.

Several motions differ in colour (hue and lightness), and in dashes where one quantity is drawn or
in markers where dashes tell the quantities apart: the pictures read in grey.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import is_color_like, to_hex
from matplotlib.lines import Line2D

from .._ask.check import shown
from .._ask.scene import SCENE_UNITS, Impulse, Scene
from .._motion.trajectory import Trajectory
from . import sampling
from .axes import listed
from .legends import quantity_handles, some_of
from .palette import Palette, palette_of

MOST_FACTS = 3  # in one label; more would be longer than a small picture is wide
_DASHES: tuple[Any, ...] = ("-", (0, (5, 2)), (0, (7, 2, 1.5, 2)), (0, (1.5, 1.5)), (0, (9, 3)))
_MARKERS = (".", "x", "+", "1", "2")


@dataclass(frozen=True)
class Style:
    """How one motion of several looks; without a colour, its quantities have theirs."""

    label: str = ""
    colour: Any = None
    dash: Any = "-"
    marker: str = ""


PLAIN = Style()


class Comparison:
    """One motion or several of one picture, in the order given, each with samples.

    Iteration gives each motion with its style. A motion that is alone, and has no colour given, is
    `PLAIN`: then colours are free to tell its quantities apart. `options` are properties of Line2D
    that the curves of all motions are to have.
    """

    def __init__(
        self,
        trajectories: Trajectory | Sequence[Trajectory],
        labels: Sequence[str] | None = None,
        colors: Sequence[Any] | None = None,
        *,
        ax: Any = None,
        options: dict[str, Any] | None = None,
    ) -> None:
        self.motions = _motions(trajectories)
        first = next(iter(listed(ax)), None)
        self.palette = palette_of(first if isinstance(first, Axes) else None)
        self.options = options or {}
        names = labels_of(self.motions, labels)
        self.styles = _styles(names, self.palette, _colors(colors, len(names)))
        self.alone = len(self.motions) == 1
        self._plain = self.alone and colors is None

    def __iter__(self) -> Iterator[tuple[Trajectory, Style]]:
        return zip(self.motions, [PLAIN] if self._plain else self.styles, strict=True)

    def over_time(self) -> Comparison:
        """Sample the motions as finely as curves over time are drawn, and return itself."""
        self.motions = tuple(map(sampling.over_time, self.motions))
        return self

    def for_dots(self) -> Comparison:
        """Take the motions at what dots are drawn at, and return itself."""
        self.motions = tuple(map(sampling.for_dots, self.motions))
        return self

    def restyle(self, *artists: Artist | None) -> None:
        """Give artists the properties that all curves are to have."""
        for artist in artists:
            if artist is not None and self.options:
                artist.set(**self.options)

    def handles(self, ax: Axes, quantities: Sequence[tuple[str, str]]) -> list[Any]:
        """Entries of a legend: the curves of one motion, else motions and (name, dash) of each."""
        if self.alone:
            return list(ax.get_legend_handles_labels()[0])
        return [*self.motion_handles(solid=True), *quantity_handles(quantities, self.palette)]

    def motion_handles(self, *, solid: bool) -> list[Line2D]:
        """Entries of a legend for the motions: their dashes, or `solid` lines with markers."""
        found = [
            Line2D(
                [], [], color=style.colour, label=style.label, ms=3, mew=0.8,
                ls="-" if solid else style.dash, marker=style.marker if solid else "",
            )
            for style in some_of(self.styles)
        ]  # fmt: skip
        self.restyle(*found)
        return found


def require_motion(trajectory: object) -> None:
    """Raise TypeError for what is no Trajectory, ValueError for one without samples."""
    if not isinstance(trajectory, Trajectory):
        raise TypeError(f"trajectory must be a Trajectory, got {shown(trajectory)}")
    if trajectory.t.size == 0:
        raise ValueError("trajectory must have samples, got none")


def _motions(trajectories: Trajectory | Sequence[Trajectory]) -> tuple[Trajectory, ...]:
    wanted = "trajectories must be a Trajectory or a sequence of them"
    if isinstance(trajectories, Trajectory):
        trajectories = [trajectories]
    if not isinstance(trajectories, Sequence):
        raise TypeError(f"{wanted}, got {shown(trajectories)}")
    for motion in trajectories:
        if not isinstance(motion, Trajectory):
            raise TypeError(f"{wanted}, got {shown(motion)} among them")
        if motion.t.size == 0:
            raise ValueError(f"every trajectory must have samples, got {motion!r}")
    if not trajectories:
        raise ValueError(f"{wanted}, got none")
    return tuple(trajectories)


def _colors(colors: Any, count: int) -> tuple[Any, ...] | None:
    """Return the colours given for so many motions, if they are."""
    if colors is None:
        return None
    wanted = f"colors must be a sequence of {count} matplotlib colours, one for each trajectory"
    try:
        found = () if isinstance(colors, str) else tuple(colors)
    except TypeError:
        found = ()
    if len(found) != count or not all(map(is_color_like, found)):
        raise ValueError(f"{wanted}, got {shown(colors)}")
    return found


def _styles(
    labels: Sequence[str], palette: Palette, colors: tuple[Any, ...] | None
) -> tuple[Style, ...]:
    count = len(labels)
    colours = colors or palette.curves[:count]
    if count > len(colours):  # from light to dark
        colours = tuple(to_hex(palette.times(share)) for share in np.linspace(0, 1, count))
    markers = _MARKERS if count > 1 else ("",)
    return tuple(
        Style(label, colours[i], _DASHES[i % len(_DASHES)], markers[i % len(markers)])
        for i, label in enumerate(labels)
    )


def labels_of(trajectories: Sequence[Trajectory], labels: Sequence[str] | None) -> list[str]:
    """Return one name for each trajectory: the given ones, or what differs among them.

    Without `labels`, a name holds the method, the model and the fields of the scene, as far as
    they differ: "rk4", or "omega = 3.2 rad/s, friction = 0.8". More than three of them end in an
    ellipsis. Where that does not tell all apart, the names are "1", "2", "3"; a single
    trajectory needs no name and has an empty one.
    """
    count = len(trajectories)
    if labels is not None:
        several = isinstance(labels, Sequence) and not isinstance(labels, str)
        if not several or not all(isinstance(label, str) for label in labels):
            raise ValueError(f"labels must be a sequence of strings, got {shown(labels)}")
        if len(labels) != count:
            raise ValueError(
                f"labels must be {count}, one for each trajectory, got {len(labels)}: "
                f"{shown(labels)}"
            )
        return list(labels)
    if count == 1:
        return [""]
    facts: list[list[str]] = [[each.method for each in trajectories]]
    facts.append([each.model for each in trajectories])
    for field in fields(Scene):
        facts.append(_texts(field.name, [getattr(each.scene, field.name) for each in trajectories]))
    facts = [texts for texts in facts if len(set(texts)) > 1]
    names = [", ".join(parts) for parts in zip(*facts[:MOST_FACTS], strict=True)]
    if len(set(names)) < count:
        return [str(i + 1) for i in range(count)]
    return [f"{name}, …" if len(facts) > MOST_FACTS else name for name in names]


def _texts(name: str, values: list[Any]) -> list[str]:
    """Texts of one field of several scenes, with the digits that tell its values apart."""
    texts: list[str] = []
    for digits in (6, 12, 17):
        texts = [_text(name, value, digits) for value in values]
        if len(set(texts)) == len(set(values)):
            break
    return texts


def _text(name: str, value: float | Impulse | None, digits: int) -> str:
    def figure(number: float) -> str:
        return f"{number:.{digits}g}".replace("-", "−").replace("inf", "∞")

    if isinstance(value, Impulse):
        force, lever = (
            f"({figure(x)}, {figure(z)})" for x, z in ((value.jx, value.jz), (value.dx, value.dz))
        )
        return f"impulse {force} N s at {lever} m"
    if value is None:
        return "no impulse" if name == "impulse" else f"{name} by default"
    return f"{name} = {figure(value)} {SCENE_UNITS[name]}".rstrip()
