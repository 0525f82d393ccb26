"""The motions of one picture and their styles.

Several motions differ in colour (hue and lightness) and in dashes, so that pictures remain readable
in grey. Where dashes distinguish quantities, motions differ in markers instead.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import astuple, dataclass, fields
from itertools import islice
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import is_color_like, to_hex
from matplotlib.lines import Line2D

from .._ask.check import shown
from .._ask.scene import SCENE_UNITS, Impulse, Scene
from .._motion.trajectory import Trajectory
from .axes import listed, some_of
from .palette import Palette, palette_of

_ABOUT = "method", "model"
MOST_FACTS = 3  # maximum number of facts in a label; more would not fit
_DASHES: tuple[Any, ...] = ("-", (0, (5, 2)), (0, (7, 2, 1.5, 2)), (0, (1.5, 1.5)), (0, (9, 3)))
MARKERS = (".", "x", "+", "1", "2")


@dataclass(frozen=True)
class Style:
    """The style of one motion; if `colour` is None, the quantities differ in colour."""

    label: str = ""
    colour: Any = None
    dash: Any = "-"
    marker: str = ""


class Comparison:
    """The motions of one picture in the given order, each with samples.

    Iteration yields each motion with its style. A single motion without a given colour has the
    plain `Style()`, so that its quantities can differ in colour. `options` are properties of Line2D
    for the curves of all motions.
    """

    def __init__(
        self,
        trajectories: Trajectory | Sequence[Trajectory],
        labels: Sequence[str] | None = None,
        colors: Sequence[Any] | None = None,
        ax: Any = None,
        options: dict[str, Any] | None = None,
    ) -> None:
        self.motions = _motions(trajectories)
        self.palette = palette_of(next(iter(listed(ax)), None))
        self.options = options or {}
        names = labels_of(self.motions, labels)
        self.styles = _styles(names, self.palette, colors)
        self.alone = len(self.motions) == 1
        self._plain = self.alone and colors is None

    def __iter__(self) -> Iterator[tuple[Trajectory, Style]]:
        return zip(self.motions, [Style()] if self._plain else self.styles, strict=True)

    def sampled(self, sample: Callable[[Trajectory], Trajectory]) -> Comparison:
        """Sample all motions with a function, and return self."""
        self.motions = tuple(map(sample, self.motions))
        return self

    def restyle(self, *artists: Artist) -> None:
        """Give artists the properties common to all curves."""
        for artist in artists:
            artist.set(**self.options)

    def handles(self, ax: Axes, quantities: Sequence[tuple[str, str]]) -> list[Any]:
        """Return legend entries: the curves of a single motion, or all motions and quantities."""
        if self.alone:
            return list(ax.get_legend_handles_labels()[0])
        return [*self.motion_handles(solid=True), *self.quantity_handles(*quantities)]

    def quantity_handles(self, *quantities: tuple[str, str]) -> list[Line2D]:
        """Return legend entries for quantities (name, dash), common to all motions."""
        grey = self.palette.grey
        return [Line2D([], [], color=grey, ls=dash, label=name) for name, dash in quantities]

    def motion_handles(self, *, solid: bool) -> list[Line2D]:
        """Return legend entries for the motions: dashes, or `solid` lines with markers."""
        handles = [
            Line2D(
                [], [], color=style.colour, label=style.label, ms=3, mew=0.8,
                ls="-" if solid else style.dash, marker=style.marker if solid else "",
            )
            for style in some_of(self.styles)
        ]  # fmt: skip
        self.restyle(*handles)
        return handles


def require_motion(trajectory: object) -> None:
    """Raise TypeError unless the argument is a Trajectory, or ValueError if it has no samples."""
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


def _one_each(
    name: str, given: Any, count: int, kind: str, fits: Callable[[Any], bool]
) -> list[Any]:
    """Return the given labels or colours, one for each motion, or raise ValueError."""
    values: list[Any] = []
    with suppress(TypeError):
        values = [] if isinstance(given, str) else list(islice(given, count + 1))
    if len(values) != count or not all(map(fits, values)):
        wanted = f"{name} must be a sequence of {count} {kind}{'s' * (count != 1)}"
        raise ValueError(f"{wanted}, one for each trajectory, got {shown(given)}")
    return values


def _styles(labels: Sequence[str], palette: Palette, colors: Any) -> tuple[Style, ...]:
    count = len(labels)
    colours: Sequence[Any] = palette.curves
    if colors is not None:
        colours = _one_each("colors", colors, count, "matplotlib colour", is_color_like)
    elif count > len(colours):  # more motions than colours: shades from light to dark
        colours = [to_hex(palette.times(share)) for share in np.linspace(0, 1, count)]
    markers = MARKERS if count > 1 else ("",)
    return tuple(
        Style(label, colours[i], _DASHES[i % len(_DASHES)], markers[i % len(markers)])
        for i, label in enumerate(labels)
    )


def labels_of(trajectories: Sequence[Trajectory], labels: Sequence[str] | None) -> list[str]:
    """Return a name for each trajectory: its label, or else its distinguishing facts.

    Without `labels` a name consists of the method, the model and the fields of the scene that
    differ: "rk4", or "omega = 3.2 rad/s, friction = 0.8". If more than three facts differ, the name
    has the first three and an ellipsis. If two such names are equal, the names are "1", "2", "3".
    The name of a single trajectory is empty.
    """
    count = len(trajectories)
    if labels is not None:
        return _one_each("labels", labels, count, "string", lambda label: isinstance(label, str))
    if count == 1:
        return [""]
    facts: list[list[str]] = [[getattr(m, name) for m in trajectories] for name in _ABOUT]
    for field in fields(Scene):
        facts.append(_texts(field.name, [getattr(m.scene, field.name) for m in trajectories]))
    facts = [texts for texts in facts if len(set(texts)) > 1]
    names = [", ".join(parts) for parts in zip(*facts[:MOST_FACTS], strict=True)]
    if len(set(names)) < count:
        return [str(i + 1) for i in range(count)]
    return [f"{name}, …" if len(facts) > MOST_FACTS else name for name in names]


def _texts(name: str, values: list[Any]) -> list[str]:
    """Return the values of one field of several scenes as texts, with enough digits to differ."""
    texts: list[str] = []
    for digits in (4, 6, 12, 17):
        texts = [_text(name, value, digits) for value in values]
        if len(set(texts)) == len(set(values)):
            break
    return texts


def _text(name: str, value: float | Impulse | None, digits: int) -> str:
    if value is None:
        return "no impulse" if name == "impulse" else f"{name} by default"
    numbers = astuple(value) if isinstance(value, Impulse) else [value]
    texts = [f"{number:.{digits}g}".replace("-", "−").replace("inf", "∞") for number in numbers]
    if isinstance(value, Impulse):
        return "impulse ({}, {}) N s at ({}, {}) m".format(*texts)
    return f"{name} = {texts[0]} {SCENE_UNITS[name]}".rstrip()
