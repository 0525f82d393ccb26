"""A page where the reader moves a blow and sees the motion at once, without a Python kernel."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from os import PathLike
from typing import Any, overload

import numpy as np

from .._ask.check import FloatArray, file_name, flag, positive, require_near
from .._ask.records import FieldsOnly, cached_property
from .._ask.scene import Impulse, Scene, require_scene
from .._ask.words import filled
from .._motion.export.atomic import replacing
from . import blows
from .page import core, document, escaped, fragment, packaged, words

LONGEST = 40.0  # longest time shown, in units of sqrt(longer semi-axis / gravity)


def explore(
    scene: Scene,
    *,
    t_end: float | None = None,
    language: str | Mapping[str, str] = "en",
    live: bool = False,
) -> Explorer:
    """Let the reader strike the body: where and how hard, by dragging a hand over it.

    The page shows the motion with its forces, its first outcome with the reason, its events, and a
    map of the outcomes of all blows. It carries a table of them, 25 places by 16 strengths, so that
    it works without a kernel and without a network; the nearest one is shown. A button copies the
    lines of Python that simulate it. All of it can be used with a keyboard alone.

    Parameters
    ----------
    scene : Scene
        The body before the blow, on the ground or in the air; if it has an impulse, that is only
        where the hand begins.
    t_end : float, optional
        How long each motion is followed [s], up to 40 sqrt(longer semi-axis / gravity); without
        it 12 times that root.
    language : str or mapping of str to str, optional
        "en" or "de"; or all texts, as `explore(scene).words` has them, with numbers in braces.
    live : bool, optional
        Whether the page carries the core itself, compiled to WebAssembly (0.4 MB more), so that it
        computes any blow between those of the table, too, with the numbers of `simulate`. Where a
        browser or a policy forbids WebAssembly, or this installation came without the file, it
        shows the nearest blow of its table, and says so.

    Returns
    -------
    Explorer
        Shows itself in a notebook; `to_html(path)` writes a page.

    Raises
    ------
    TypeError
        If `scene` is no Scene, `t_end` no number, `live` no bool, or `language` no name and no
        mapping of strings.
    ValueError
        If `t_end` is out of range, the body so far away that a double does not know a thousandth
        of it there, or `language` unknown, or without one of the keys.

    Notes
    -----
    The page follows the light or dark theme of the reader's system, unless it stands in an element
    (such as `<html>`) with the attribute `data-theme="light"` or `"dark"`.

    In a frame it tells the page around it how high it is. This is all that the other page needs::

        <iframe src="strike.html" style="width: 100%; border: 0"></iframe>
        <script>
        addEventListener("message", ({ data, source }) => {
          const frame = [...document.querySelectorAll("iframe")]
            .find(({ contentWindow }) => contentWindow === source);
          if (frame && data.rollingEllipse) frame.style.height = `${data.rollingEllipse.height}px`;
        });
        </script>
    """
    require_scene(scene)
    require_near("scene", max(scene.a, scene.b), max(abs(scene.x), scene.initial_state.z))
    unit = math.sqrt(max(scene.a, scene.b) / scene.gravity)
    longest = LONGEST * unit
    chosen = float(f"{12 * unit:.2g}") if t_end is None else positive("t_end", t_end)
    if chosen > longest:
        raise ValueError(f"t_end must be at most {longest:.6g} s for this body, got {t_end!r}")
    return Explorer(scene, chosen, words(language), flag("live", live))


@dataclass(frozen=True)
class Explorer(FieldsOnly):
    """The result of `explore`; a notebook shows it by itself.

    Attributes
    ----------
    scene : Scene
        The body before the blow.
    t_end : float
        How long each motion is followed [s].
    words : dict of str to str
        All texts of the page.
    live : bool
        Whether it carries the core itself, if this installation has it as WebAssembly.
    """

    scene: Scene
    t_end: float
    words: dict[str, str] = field(hash=False, repr=False, default_factory=lambda: words("en"))
    live: bool = False

    @cached_property
    def distances(self) -> FloatArray:
        """Places of the blows in the table, from the centre along the ground, (25,) [m]."""
        return blows.ranges(self.scene)[0]

    @cached_property
    def strengths(self) -> FloatArray:
        """Strengths of the blows in the table, downwards, (16,) [N s]."""
        return blows.ranges(self.scene)[1]

    @overload
    def to_html(self) -> str: ...
    @overload
    def to_html(self, path: str | PathLike[str]) -> None: ...
    def to_html(self, path: str | PathLike[str] | None = None) -> str | None:
        """Return a page that needs nothing but itself, or write it if there is a path.

        Raises
        ------
        ValueError
            If the path does not end in .html.
        TypeError
            If it is no path.
        OSError
            If it cannot be written; what was there then stays.
        """
        if path is None:
            return document(self.words["title"], self._repr_html_(), self.words["lang"])
        self.save(path)
        return None

    def save(self, path: str | PathLike[str]) -> None:
        """Write the page; errors are those of `to_html`."""
        name = file_name("path", path)
        if not name.lower().endswith((".html", ".htm")):
            raise ValueError(f"path must end in .html, got {name!r}")
        page = self.to_html()
        with replacing(name) as new:
            new.write_text(page, encoding="utf-8")

    def _repr_html_(self) -> str:
        return self._html

    @cached_property
    def _html(self) -> str:
        return self._fragment("Live" if self.live else "Explorer")

    def _fragment(self, starts: str, module: str = "", **more: Any) -> str:
        """Return the page's content; a class of a module may start it, with more data."""
        strip = blows.view(self.scene)
        left, right, bottom, top = strip["window"]
        shape = (top - bottom) / (right - left)
        at = self._first_blow()
        table = blows.table(self.scene, self.t_end, self.distances, self.strengths)
        data = {
            "end": self.t_end,
            "fps": 60,
            "speed": 1,
            "decimals": 2,
            "shape": shape,
            "follows": "edge",
            "waits": True,
            "strips": [strip],
            "first": at,
            "words": self.words,
            "table": table,
            "cut": blows.CUT,
            "least": blows.LEAST,
            **more,
        }
        if self.live:
            data["live"] = {"wasm": core(), "scene": blows.numbers(self.scene)}
        blow = Impulse.press(float(self.strengths[at[1]]), float(self.distances[at[0]]))
        motion = blows.struck(self.scene, blow, self.t_end)
        motion = motion.sol(np.linspace(0.0, motion.t_end, 61))
        text = filled(self.words, "poster", F=-blow.jz, d=blow.dx)
        return fragment(data, [motion], text, starts, self._markup(table), module)

    def _markup(self, table: dict[str, Any]) -> str:
        """Return the parts around the player with their texts."""
        texts, count = escaped(self.words), self.strengths.size
        texts |= {
            "player": "{player}",
            "card": blows.card(self.scene, texts),
            "last_place": str(self.distances.size - 1),
            "last_strength": str(count - 1),
            "blows": str(self.distances.size * count),
            "nearest": filled(texts, "nearest", places=self.distances.size, strengths=count),
            "legend": "".join(
                f'<span><i style="background: {table["colours"][code]}"></i>'
                f"{texts[blows.NAMES[code]]}</span>\n"
                for code in sorted(set(table["outcomes"]))
            ),
        }
        return packaged("explorer.html").format(**texts)

    def _first_blow(self) -> tuple[int, int]:
        """Return place and strength of the first blow: the scene's own, or a strong one."""
        own: Any = self.scene.impulse
        d, F = (own.dx, -own.jz) if own is not None else (0.75 * self.distances[-1], 0.0)
        if F <= 0:
            F = self.strengths[self.strengths.size // 2]
        return int(np.argmin(abs(self.distances - d))), int(np.argmin(abs(self.strengths - F)))
