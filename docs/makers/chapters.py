"""Split the site's copy of a notebook into chapters, because a single page would be too long.

The notebook itself remains one file; conf.py calls `split`. On the site, its page has the cells
before the first chapter, a list of the chapters, each with its own page, and the last section.
"""

import json
import re
from pathlib import Path
from typing import Any

Cell = dict[str, Any]


def split(path: Path) -> None:
    notebook = json.loads(path.read_text(encoding="utf-8"))
    cells: list[Cell] = notebook["cells"]
    starts = [k for k, cell in enumerate(cells) if source(cell).startswith("## ")]
    names = [f"{path.stem}_{k}" for k in range(1, len(starts))]
    for name, first, end in zip(names, starts[:-1], starts[1:], strict=True):
        chapter = notebook | {"cells": [raised(cell) for cell in cells[first:end]]}
        write(path.with_name(f"{name}.ipynb"), chapter)
    listed = "\n".join(["## Chapters", "", "```{toctree}", ":maxdepth: 2", "", *names, "```"])
    links: Cell = {"cell_type": "markdown", "id": "chapters", "metadata": {}, "source": listed}
    write(path, notebook | {"cells": [*cells[: starts[0]], links, *cells[starts[-1] :]]})


def source(cell: Cell) -> str:
    return "".join(cell["source"]) if cell["cell_type"] == "markdown" else ""


def raised(cell: Cell) -> Cell:
    """Return a cell with its headings raised by one level."""
    if cell["cell_type"] != "markdown":
        return cell
    return cell | {"source": re.sub("^##", "#", source(cell), flags=re.MULTILINE)}


def write(path: Path, notebook: dict[str, Any]) -> None:
    path.write_text(json.dumps(notebook, ensure_ascii=False), encoding="utf-8")
