"""Measurements quoted in text, charts and notebooks agree with the data in docs/data."""

import hashlib
import json
import re
from pathlib import Path
from typing import Any

import pytest
from oracles.paths import ROOT, made_by
from PIL import Image
from rolling_ellipse import WorkPrecision

DOCS = ROOT / "docs"
DATA = DOCS / "data"
PROSE = {
    name: (ROOT / name).read_text(encoding="utf-8")
    for name in ("README.md", "docs/index.md", "docs/start.md", "docs/speed.md",
                 "docs/constraints.md", "docs/many.md", "docs/benchmark.md")
}  # fmt: skip
RACE = DATA / "peers_R_10.37.json"
NOTEBOOK = ROOT / "notebooks" / "06_speed_and_accuracy.ipynb"
# pattern of a time below a second, or a ratio ("25 × 16" is a size)
MEASURED = re.compile(r"\d\s*(?:µs|us|ms|ns|microseconds?|nanoseconds?)\b|\d\s*×(?!\s*\d)")
MARKED = re.compile(r"<!-- (\w+): made by .*?<!-- end of \1 -->", flags=re.DOTALL)


@pytest.fixture(scope="module")
def make() -> dict[str, Any]:
    pytest.importorskip("nbclient")  # its dependencies have no wheels for Python without the GIL
    return made_by("make")


def cells(path: Path, kind: str) -> list[Any]:
    found = json.loads(path.read_text(encoding="utf-8"))["cells"]
    return [cell for cell in found if cell["cell_type"] == kind]


def test_figures_on_the_pages_agree_with_the_data(make: dict[str, Any]) -> None:
    for name in make["PAGES"]:
        page = PROSE[f"{name}.md"]
        assert make["quoted"](page) == page, "docs/makers/make.py text"


def test_a_figure_edited_by_hand_is_detected(make: dict[str, Any]) -> None:
    page = PROSE["docs/speed.md"]
    part = next(found.group() for found in MARKED.finditer(page))
    digit = re.search(r"(\d)(?=\.\d)", part)
    assert digit is not None
    changed = part[: digit.start()] + str(9 - int(digit.group())) + part[digit.end() :]
    wrong = page.replace(part, changed)
    assert wrong != page and make["quoted"](wrong) == page


def test_every_race_of_the_data_is_quoted(make: dict[str, Any]) -> None:
    text = make["speed"]()
    rows = sum(text.count(f"| {name.partition(',')[0]},") for name in make["MOTIONS"].values())
    assert rows == len(list(DATA.glob("peers_*.json"))) > 0


@pytest.mark.parametrize("name", ["speed", "engine_mujoco", "engine_drake", "engine_pymunk"])
def test_the_chart_shows_the_data(name: str) -> None:
    with Image.open(DOCS / f"{name}.png") as picture:
        source = picture.info["Source"]
    data = (RACE if name == "speed" else DATA / "engines.json").read_bytes()
    assert source == hashlib.sha256(data).hexdigest(), "docs/makers/make.py pictures"


def test_the_problem_pages_agree_with_their_data(make: dict[str, Any]) -> None:
    made = made_by("problems")
    page = (DOCS / "benchmark.md").read_text(encoding="utf-8")
    listed = make["with_part"](page, "problems", made["listed"](), "make.py")
    assert listed == page, "docs/makers/make.py problems"
    pages, folder = made["pages"](), DOCS / "problems"
    assert {path.stem for path in folder.glob("*.md")} == set(pages) and len(pages) == 22
    for name, page in pages.items():
        assert (folder / f"{name}.md").read_text(encoding="utf-8") == page, name
    assert sum((folder / f"{name}.png").stat().st_size for name in pages) < 1.5e6


def test_the_notebook_shows_the_data() -> None:
    outputs = [output for cell in cells(NOTEBOOK, "code") for output in cell["outputs"]]
    printed = "".join("".join(output.get("text", "")) for output in outputs)
    assert WorkPrecision.load(RACE).verdict() in printed, "docs/makers/make.py notebooks"


@pytest.mark.parametrize("path", sorted((ROOT / "notebooks").glob("*.ipynb")), ids=lambda p: p.stem)
def test_no_measured_figure_is_typed_into_a_notebook(path: Path) -> None:
    prose = "\n".join("".join(cell["source"]) for cell in cells(path, "markdown"))
    assert MEASURED.search(prose) is None


@pytest.mark.parametrize("name", [name for name in PROSE if "benchmark" not in name])
def test_no_measured_figure_is_typed_into_a_page(name: str) -> None:
    assert MEASURED.search(MARKED.sub("", PROSE[name])) is None


@pytest.mark.parametrize("text", ["takes 3.1 µs", "12.9 × at 1e-02", "14 ns a sample", "0.2 ms"])
def test_a_measured_figure_is_recognized(text: str) -> None:
    assert MEASURED.search(text) and not MEASURED.search("25 × 16 blows in 6 s, 450 bytes, 1e-9 m")
