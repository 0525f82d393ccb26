"""The printable page of a sheet, which also marks answers in the browser, with formulas as SVG."""

from __future__ import annotations

import base64
import json
import re
from html import escape
from importlib.resources import files
from itertools import cycle
from string import Template
from typing import Any

from ._marks import key
from ._tasks import DATA

_SIZE = 10.0  # font size of a formula, in units of its picture
_SPELLED = (  # replacements for TeX that matplotlib does not accept
    (r"\\tfrac", r"\\frac"), (r"\\frac(\w)", r"\\frac{\1}"), (r"(\\frac{\w})(\w)", r"\1{\2}"),
    (r"\\mathrm (\w)", r"\\mathrm{\1}"), (r"\\([lg])e\b", r"\\\1eq"), (r"\\Big\b|\n", " "),
)  # fmt: skip
_ASIDE = re.compile(  # code, pictures and formulas, in which no other markup applies
    r"^```\w*\n(?P<pre>.*?)^```$|`(?P<code>[^`]+)`|!\[(?P<alt>.*?)\]\((?P<name>.*?)\)|"
    r"\$\$(?P<display>.+?)\$\$|\$(?P<inline>.+?)\$",
    re.DOTALL | re.MULTILINE,
)
_MARKUP = (  # Markdown and its HTML; links, which would lead to other pages, become text
    (r"\*\*(.+?)\*\*", r"<strong>\1</strong>"), (r"\*(.+?)\*", r"<em>\1</em>"),
    (r"\[([^\]]+)\]\([^)]*\)", r"\1"), (r"\\$", "<br>"), (r"^# (.*?)$", r"<h1>\1</h1>"),
    (r"^## (.*?)$", r"<h2>\1</h2>"), (r"^\|( --- \|)+\n|^\|(---\|)+\n", ""), (r" \| ", "<td>"),
    (r"^\| (.*?) \|$", r"<tr><td>\1"), (r"^\d+\. ", "<li>"),
)  # fmt: skip
_AROUND = {"<tr>": "table", "<li>": "ol", "<h1>": "header", "<h2>": "header"}
_FIELD = (
    r'\g<0><label class="answer">\1: <input data-task="\1" inputmode="decimal"> <output></output>'
    "</label>"
)


def page(markdown: str, seed: int | None, pictures: dict[str, bytes]) -> str:
    body = html_of(markdown, pictures)
    tasks = r"<p><strong>(\d+\.\d)</strong> \(.*?</p>"
    keys = {number: _marks(number, seed) for number in re.findall(tasks, body, re.DOTALL)}
    ours = files(__package__)
    return Template(ours.joinpath("sheet.html").read_text("utf-8")).substitute(
        title=markdown.partition("\n")[0].lstrip("# "),
        body=re.sub(tasks, _FIELD, body, flags=re.DOTALL),
        hidden=_hidden({"number": DATA["number"], "tasks": keys}, f"sheet of {seed}".encode()),
        script=ours.joinpath("sheet.js").read_text("utf-8"),
    )


def _marks(number: str, seed: int | None) -> dict[str, Any]:
    """Return the numbers at which the mark changes, and the different marks between them."""
    ends, marks = key(number, seed)
    distinct = list(dict.fromkeys(marks))
    shown = [[mark.points, mark.sentence, mark.mistake] for mark in distinct]
    return {"ends": ends, "which": [distinct.index(mark) for mark in marks], "marks": shown}


def _hidden(key: dict[str, Any], salt: bytes) -> str:
    """Return the key as text that cannot be read at a glance; it is not a secret."""
    mixed = bytes(a ^ b for a, b in zip(json.dumps(key).encode(), cycle(salt), strict=False))
    return json.dumps([base64.b64encode(text).decode() for text in (salt, mixed)])


def html_of(text: str, pictures: dict[str, bytes]) -> str:
    """Return the HTML of headings, paragraphs, lists, tables, code, pictures and formulas."""
    kept: list[str] = []

    def aside(found: re.Match[str]) -> str:
        kept.append(_written(found, pictures))
        return f"\0{len(kept) - 1}\0"

    text = _ASIDE.sub(aside, re.sub(r"<!--.*?-->\n?", "", text))
    text = escape(text.strip(), quote=False)
    for pattern, html in _MARKUP:
        text = re.sub(pattern, html, text, flags=re.DOTALL | re.MULTILINE)
    blocks = [(_AROUND.get(block[:4], "p"), block) for block in re.split(r"\n{2,}", text)]
    text = "\n".join(f"<{around}>{block}</{around}>" for around, block in blocks)
    return re.sub("\0(\\d+)\0", lambda found: kept[int(found[1])], text)


def _written(found: re.Match[str], pictures: dict[str, bytes]) -> str:
    kind = str(found.lastgroup)
    if kind == "name":
        data = base64.b64encode(pictures[found["name"]]).decode()
        return f'<img src="data:image/png;base64,{data}" alt="{escape(found["alt"])}">'
    if kind in ("pre", "code"):
        return f"<{kind}>{escape(found[kind])}</{kind}>"
    return f'<span class="{kind}">{formula(found[kind])}</span>'


def formula(tex: str) -> str:
    """Return a formula as the outlines of its letters, in SVG."""
    from matplotlib.font_manager import FontProperties
    from matplotlib.textpath import TextPath, text_to_path

    spelled = f"${tex.strip()}$"
    for pattern, ours in _SPELLED:
        spelled = re.sub(pattern, ours, spelled)
    font = FontProperties(size=_SIZE, math_fontfamily="stix")
    width, height, depth = text_to_path.get_text_width_height_descent(spelled, font, ismath=True)
    outline = "".join(
        "MLQC"[code - 1] + " ".join(f"{v:.2f}" for v in points)
        for points, code in TextPath((0, 0), spelled, prop=font).iter_segments(simplify=False)
        if code < 5  # CLOSEPOLY has a larger code
    )
    style = f"height:{height / _SIZE:.3f}em;vertical-align:{-depth / _SIZE:.3f}em"
    box = f"0 {depth - height:.2f} {width:.2f} {height:.2f}"
    return (
        f'<svg role="img" aria-label="{escape(tex)}" style="{style}" viewBox="{box}">'
        f'<path transform="scale(1 -1)" d="{outline}"/></svg>'
    )
