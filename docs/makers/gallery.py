"""Draw the pictures of the gallery with the code of its page: python docs/makers/gallery.py [DIR]

Each block of docs/gallery.md continues those before it. The value of its last statement, a picture
or an animation, is written to the file that the page shows below the block; an animation is written
as a single frame.
"""

import ast
import re
import sys
import warnings
from collections.abc import Iterator
from io import BytesIO
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import rolling_ellipse as rl
from PIL import Image

DOCS = Path(__file__).resolve().parents[1]
BLOCK = re.compile(r"```python\n(.*?)```\n(?:\n!\[[^\]]+\]\(gallery/(\w+\.png)\))?", re.DOTALL)
MOMENT = 0.45  # time of the frame of an animation, as a fraction of its length


def blocks() -> list[tuple[str, str]]:
    """Return the code and the picture's name of each block; the first block has no picture."""
    return BLOCK.findall((DOCS / "gallery.md").read_text(encoding="utf-8"))


def drawn() -> Iterator[tuple[str, Any]]:
    """Yield the name of each picture, and the value of the last statement of its block."""
    known: dict[str, Any] = {}
    for code, name in blocks():
        *before, last = ast.parse(code).body
        exec(compile(ast.Module(before, []), name, "exec"), known)
        if not name:
            exec(compile(ast.Module([last], []), name, "exec"), known)
        elif isinstance(last, ast.Assign | ast.Expr):
            yield name, eval(compile(ast.Expression(last.value), name, "eval"), known)
        plt.close("all")


def main(folder: Path = DOCS / "gallery") -> None:
    folder.mkdir(exist_ok=True)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", rl.StabilityWarning)  # some pictures show unstable methods
        for name, made in drawn():
            picture = BytesIO()
            if hasattr(made, "frame"):
                made.draw(round(MOMENT * made.t.size))
                made.figure.savefig(picture, dpi=100)
            else:
                made.savefig(picture, dpi=100)
            colours = Image.open(picture).convert("RGB").quantize(96)
            colours.save(folder / name, optimize=True)


if __name__ == "__main__":
    plt.switch_backend("Agg")
    main(*map(Path, sys.argv[1:]))
