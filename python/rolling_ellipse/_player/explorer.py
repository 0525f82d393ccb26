"""A page that shows at once how a body moves as the user changes a blow, without a kernel."""

from __future__ import annotations

import math
import warnings
from collections.abc import Mapping
from dataclasses import dataclass, field
from os import PathLike
from typing import Any, overload

import numpy as np

from .. import _core
from .._ask.check import file_name, flag, positive, require_near
from .._ask.records import FieldsOnly, cached_property
from .._ask.scene import Scene, require_scene
from .._ask.words import filled, joined
from .._core import Outcome
from .._motion.export.atomic import write
from .._motion.trajectory import Trajectory
from .._pictures.phase_map import COLOURS
from . import blows
from .page import core, document, escaped, fragment, packaged, words

LONGEST = 40.0  # maximum t_end, in units of sqrt(longer semi-axis / gravity)
_FILM = {"fps": 60, "speed": 1, "decimals": 2, "follows": "edge", "waits": True}
# Colours of the map by first outcome, and for a body that stays in the air
_COLOURS = {outcome.name: COLOURS[outcome] for outcome in Outcome}
_COLOURS["IN_THE_AIR"] = COLOURS[Outcome.LOSES_CONTACT]


def explore(
    scene: Scene,
    *,
    t_end: float | None = None,
    language: str | Mapping[str, str] = "en",
    live: bool | None = None,
) -> Explorer:
    """Create a page on which the body can be struck by dragging a hand over it.

    The hand sets the point and the strength of the blow, and can strike the moving body again. The
    page shows the motion with its forces, its first outcome after the last blow with the reason,
    its events, and a map of the outcomes of all blows. It needs no kernel and no network.

    Parameters
    ----------
    scene : Scene
        The body before the blow, on the ground or in the air; if it has an impulse, the vertical
        component and the point of application are used as the first blow.
    t_end : float, optional
        How long each motion is followed [s], up to 40 sqrt(longer semi-axis / gravity); default:
        12 times that root.
    language : str or mapping of str to str, optional
        "en" or "de"; or all texts, as in `explore(scene).words`, with placeholders in braces.
    live : bool, optional
        Deprecated and without effect: every page contains the core.

    Returns
    -------
    Explorer
        A notebook displays it; `to_html(path)` writes a page.

    Raises
    ------
    TypeError
        If `scene` is not a Scene, `t_end` not a number, `live` not a bool, or `language` neither
        a name nor a mapping of strings.
    ValueError
        If `t_end` is out of range, the body is so far away that a double cannot resolve a
        thousandth of its size, or `language` is unknown or lacks one of the keys.

    Notes
    -----
    The page contains the core, compiled to WebAssembly, and computes all blows with the same
    results as `simulate` with ``blows``. A button copies the Python code that simulates them. The
    whole page can be used with a keyboard alone. If a browser or a policy forbids WebAssembly, or
    the installed package lacks the compiled core, the page only plays the film of the first blow,
    and says so.

    The page follows the light or dark theme of the user's system, unless it is inside an element
    (such as `<html>`) with the attribute `data-theme="light"` or `"dark"`.

    Inside a frame, the page reports its height to its parent, which needs only this script::

        <iframe src="strike.html" style="width: 100%; border: 0"></iframe>
        <script>
        addEventListener("message", ({ data, source }) => {
          const frame = [...document.querySelectorAll("iframe")]
            .find(({ contentWindow }) => contentWindow === source);
          if (frame && data.rollingEllipse) frame.style.height = `${data.rollingEllipse.height}px`;
        });
        </script>

    Examples
    --------
    >>> page = rl.explore(rl.Scene(2.0, 1.0, mass=10.0, friction=0.7))
    >>> page.save("strike.html")
    >>> rl.explore(rl.scenes.report, language="de").words["title"]
    'Stoß eine Ellipse an'
    """
    require_scene(scene)
    require_near("scene", max(scene.a, scene.b), max(abs(scene.x), scene.initial_state.z))
    unit = math.sqrt(max(scene.a, scene.b) / scene.gravity)
    longest = LONGEST * unit
    chosen = float(f"{12 * unit:.2g}") if t_end is None else positive("t_end", t_end)
    if chosen > longest:
        raise ValueError(f"t_end must be at most {longest:.6g} s for this body, got {t_end!r}")
    if live is not None:
        flag("live", live)
        text = "live has no effect and will be removed: every page contains the core"
        warnings.warn(text, DeprecationWarning, stacklevel=2)
    return Explorer(scene, chosen, words(language))


@dataclass(frozen=True)
class Explorer(FieldsOnly):
    """A page on which the body can be struck, created by `explore`; a notebook displays it.

    Attributes
    ----------
    scene : Scene
        The body before the blow.
    t_end : float
        How long each motion is followed [s].
    words : dict of str to str
        All texts of the page.

    Examples
    --------
    >>> page = rl.explore(rl.scenes.report, t_end=5.0)
    >>> page.scene.mass, page.t_end
    (10.0, 5.0)
    >>> mine = rl.explore(page.scene, language=page.words | {"title": "Strike the egg"})
    """

    scene: Scene
    t_end: float
    words: dict[str, str] = field(hash=False, repr=False, default_factory=lambda: words("en"))

    @overload
    def to_html(self) -> str: ...
    @overload
    def to_html(self, path: str | PathLike[str]) -> None: ...
    def to_html(self, path: str | PathLike[str] | None = None) -> str | None:
        """Return a self-contained page, or write it if there is a path.

        Raises
        ------
        ValueError
            If the path does not end in .html.
        TypeError
            If `path` is not a path.
        OSError
            If the file cannot be written; an existing file is preserved.

        Examples
        --------
        >>> page = rl.explore(rl.scenes.report)
        >>> page.to_html("strike.html")
        >>> page.to_html()[:15]
        '<!DOCTYPE html>'
        """
        if path is None:
            return document(self.words["title"], self._repr_html_(), self.words["lang"])
        self.save(path)
        return None

    def save(self, path: str | PathLike[str]) -> None:
        """Write the page to a file; the errors are those of `to_html`.

        Examples
        --------
        >>> page = rl.explore(rl.scenes.report)
        >>> page.save("strike.html")
        """
        name = file_name("path", path)
        if not name.lower().endswith((".html", ".htm")):
            raise ValueError(f"path must end in .html, got {name!r}")
        write(name, self.to_html().encode())

    def _repr_html_(self) -> str:
        return self._html

    @cached_property
    def _html(self) -> str:
        return self._fragment("Explorer")

    def _fragment(self, starts: str, module: str = "", **more: Any) -> str:
        """Return the page's content; the JavaScript class named `starts` starts it.

        The class may be defined in `module`, and `more` has further data for it. The content
        includes the film of the first blow, for browsers that cannot run the core.
        """
        axes = blows.axes(self.scene)
        blow = blows.first_blow(self.scene, *axes)
        motion = blows.struck(self.scene, blow, self.t_end)
        strip = blows.strip(motion)
        left, right, bottom, top = strip["window"]
        data = {
            **_FILM,
            "end": self.t_end,
            "shape": (top - bottom) / (right - left),
            "strips": [strip],
            "words": self.words,
            "wasm": core(),
            "scene": blows.numbers(self.scene),
            "axes": axes,
            "given": {"d": blow.dx, "F": -blow.jz},
            "strongest": axes[1]["most"],
            "outcomes": _COLOURS,
            "code": blows.code(self.scene, self.t_end),
            **more,
        }
        shown = motion.sol(np.linspace(0.0, motion.t_end, 61))
        text = filled(self.words, "poster", F=-blow.jz, d=blow.dx)
        return fragment(data, [shown], text, starts, self._markup(motion), module)

    def _markup(self, motion: Trajectory) -> str:
        """Return the markup around the player, with texts that describe the film."""
        texts = escaped(self.words)
        _, headline, reasons = _core.describe(motion.scene.core, motion._solution)
        texts |= {
            "player": "{player}",
            "headline": joined(texts, headline, 3),
            "reasons": joined(texts, reasons, 3),
            "card": blows.card(self.scene, texts),
            "legend": "".join(
                f'<span data-outcome="{name}" hidden><i style="background: {colour}"></i>'
                f"{texts[name]}</span>\n"
                for name, colour in _COLOURS.items()
            ),
        }
        return packaged("explorer.html").format(**texts)
