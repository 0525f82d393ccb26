"""HTML with the player, as a fragment for notebooks or a page for files, and its texts."""

from __future__ import annotations

import base64
import gzip
import hashlib
import html
import json
import re
from collections.abc import Mapping, Sequence
from functools import cache
from importlib.resources import files
from string import Template
from typing import Any

from .._ask.check import choice, shown
from .._ask.words import BRACES, LANGUAGES, table
from .._motion.strobe_svg import strobe_svg
from .._motion.trajectory import Trajectory
from .._pictures.palette import BLUE, EARTH, GREY, INK, ORANGE, PLUM, SKY

_COMMENT = re.compile(r"^ *(?://[^\n]*|/\*\*.*?\*/)\n", re.MULTILINE | re.DOTALL)  # in JavaScript
_FILM = ("track", "strip", "player")
SCRIPTS = {  # modules and style sheets by the class that starts the page
    "Player": (_FILM, ("player",)),
    "Explorer": ((*_FILM, "charts", "core", "explorer"), ("player", "explorer")),
}
LIGHT = {
    "paper": "#ffffff", "ink": INK, "blue": BLUE, "orange": ORANGE, "grey": GREY, "earth": EARTH,
    "plum": PLUM, "sky": SKY, "body": "#cadbe5", "faint": "#c9d0d8", "panel": "#f4f5f7",
}  # fmt: skip
DARK = {
    "paper": "#10161f", "ink": "#e8edf4", "blue": "#63b1dd", "orange": "#ffa23e",
    "grey": "#8c99a8", "earth": "#2b2a28", "plum": "#e27fa6", "sky": "#2d5d7c",
    "body": "#23415a", "faint": "#3a4653", "panel": "#1a222d",
}  # fmt: skip


def fragment(
    data: dict[str, Any],
    motions: Sequence[Trajectory],
    text: str,
    starts: str = "Player",
    around: str = "{player}",
    module: str = "",
) -> str:
    """Return a `div` with pictures of the motions, and a script that replaces them with the player.

    If scripts are disabled, the pictures and the text remain. A page may contain the same fragment
    several times. If `data` has no words, the English ones are added. `around` is HTML around the
    player. `starts` is the class to start; `module` is JavaScript that defines it, if the package
    does not. The player stops all key events, and a marker for JupyterLab on the `div` keeps the
    notebook from acting on keys.
    """
    scripts, sheets = SCRIPTS.get(starts, SCRIPTS["Explorer"])
    texts = data.get("words") or words("en")
    data = data | {
        "colours": {"light": LIGHT, "dark": DARK},
        "style": "".join(packaged(f"{name}.css") for name in sheets) + data.get("style", ""),
        "markup": with_player(around, texts),
        "words": texts,
    }
    known = json.dumps(data, separators=(",", ":"))
    packed = base64.b64encode(gzip.compress(known.encode(), mtime=0)).decode()  # half as long
    name = hashlib.sha256(known.encode()).hexdigest()[:12]
    modules = "\n".join([*(packaged(f"{each}.js") for each in scripts), module])
    modules = _COMMENT.sub("", modules)  # pages need no comments
    light, dark = (Template(packaged("poster.css")).substitute(each) for each in (LIGHT, DARK))
    style = f"<style>{light}@media (prefers-color-scheme: dark) {{ {dark}}}</style>"
    images = [
        f'<img alt="{html.escape(text)}" style="width: 100%" src="data:image/svg+xml;base64,'
        f'{base64.b64encode(picture.encode()).decode()}">'
        for motion in motions
        if (picture := strobe_svg(motion, style))
    ]
    named = {"name": name, "images": "".join(images), "module": modules, "packed": packed}
    return Template(packaged("fragment.html").strip()).substitute(named, starts=starts)


def with_player(around: str, texts: dict[str, str]) -> str:
    """Return HTML with the player inserted at its placeholder."""
    return around.replace("{player}", packaged("player.html").format_map(escaped(texts)))


def document(title: str, content: str, language: str = "en") -> str:
    """Return a page that needs no other file and no network.

    Inside a frame, the page posts its height [CSS px] to its parent whenever the height changes.
    """
    named = {"language": html.escape(language), "title": html.escape(title), "content": content}
    return Template(packaged("page.html")).substitute(named)


@cache
def packaged(name: str) -> str:
    """Return the text of a file next to this module."""
    return files(__package__).joinpath(name).read_text(encoding="utf-8")


@cache
def core() -> str:
    """Return the core as gzipped WebAssembly in base64, or "" if the file is missing."""
    file = files(__package__).joinpath("live.wasm.gz")
    return base64.b64encode(file.read_bytes()).decode() if file.is_file() else ""


def words(language: str | Mapping[str, str]) -> dict[str, str]:
    """Return the table of a language, or a copy of a mapping with the same keys.

    A text must use no placeholder that the English text lacks.
    """
    if isinstance(language, str):
        return dict(table(choice("language", language, LANGUAGES)))
    if not isinstance(language, Mapping):
        raise TypeError(f"language must be a name or a mapping of texts, got {shown(language)}")
    english, texts = table("en"), dict(language)
    if odd := [*(key for key in english if key not in texts), *(texts.keys() - english.keys())]:
        raise ValueError(
            f"language must have the keys of explore(scene).words, got {len(texts)} keys, and "
            f"{shown(odd[0])} is {'missing' if odd[0] in english else 'unknown'}"
        )
    for key, text in texts.items():
        where, known = f"language[{key!r}] must", BRACES.findall(english[key])
        if not isinstance(text, str):
            raise TypeError(f"{where} be a string, got {shown(text)}")
        if re.search("[\ud800-\udfff]", text):  # cannot be encoded in UTF-8
            raise ValueError(f"{where} have no lone surrogate, got {shown(text)}")
        if not set(BRACES.findall(text)) <= set(known):
            raise ValueError(f"{where} have no braces but {known}, got {shown(text)}")
    return texts


def escaped(words: dict[str, str]) -> dict[str, str]:
    """Return the texts escaped for HTML."""
    return {key: html.escape(text) for key, text in words.items()}
