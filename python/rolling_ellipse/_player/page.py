"""HTML that contains the player: a fragment for notebooks, a page for files."""

from __future__ import annotations

import base64
import gzip
import hashlib
import html
import json
from functools import cache
from importlib.resources import files
from typing import Any

from .colours import DARK, LIGHT


@cache
def _script(name: str) -> str:
    return files(__package__).joinpath(name).read_text(encoding="utf-8")


def fragment(data: dict[str, Any], poster: str, text: str, *, explorer: bool = False) -> str:
    """Return a `div` with a poster, an SVG, whose script replaces it by the player.

    If scripts are not run, the poster and its text stay. A page may have the same fragment several
    times.
    """
    known = json.dumps(data | {"colours": {"light": LIGHT, "dark": DARK}}, separators=(",", ":"))
    packed = base64.b64encode(gzip.compress(known.encode(), mtime=0)).decode()  # half the length
    name = hashlib.sha256((known + poster).encode()).hexdigest()[:12]
    scripts = ("track.js", "strip.js", "player.js", "explorer.js")[: 3 + explorer]
    module = "\n".join(_script(each) for each in scripts)
    picture = base64.b64encode(poster.encode()).decode()
    starts = "Explorer" if explorer else "Player"
    return (
        f'<div class="rolling-ellipse" data-film="{name}">'
        f'<img alt="{html.escape(text)}" style="max-width:100%" '
        f'src="data:image/svg+xml;base64,{picture}">\n'
        f'<script type="module">\n{module}\n'
        f'const free = `.rolling-ellipse[data-film="{name}"]:not([data-ready])`;\n'
        f'const film = await unzipped("{packed}");\n'
        f"new {starts}(document.querySelector(free), film);\n</script></div>"
    )


def document(title: str, content: str) -> str:
    """Return a page that needs no other file and no network."""
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        '<link rel="icon" href="data:,">\n'
        f"<title>{html.escape(title)}</title>\n"
        "<style>:root { color-scheme: light dark }\n"
        "body { margin: 1.5rem auto; max-width: 1100px; padding: 0 1rem }</style>\n"
        f"</head>\n<body>\n{content}\n</body>\n</html>\n"
    )
