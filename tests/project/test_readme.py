"""The Python code of the README runs, one block after another."""

import re
from pathlib import Path

import matplotlib
import pytest

matplotlib.use("Agg")

import matplotlib.pyplot as plt
from oracles import table
from oracles.paths import ROOT

README = (ROOT / "README.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"```python\n(.*?)```", README, flags=re.DOTALL)


@pytest.mark.filterwarnings("ignore::rolling_ellipse.StabilityWarning")  # README shows it
def test_the_lines_of_the_readme_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert len(BLOCKS) >= 4
    names: dict[str, object] = {}
    for block in BLOCKS:
        exec(block.replace("max_seconds=10", "max_seconds=2"), names)
    plt.close("all")
    made = {path.name for path in tmp_path.iterdir()}
    assert made == {"roll.gif", "friction.gif", "strike.html", "motions"}


def test_the_tables_of_reference_have_as_many_motions_as_it_says() -> None:
    """A motion has three lines in the table of slopes, and one for each event in the last table."""
    said = dict(re.findall(r"\[`(\w+)_reference\.csv`\]\S+ \((\d+) ", README))
    level, slope, contact = (table.rows(f"{name}_reference") for name in said)
    names = {row["name"] for row in contact}
    assert [*map(int, said.values())] == [len(level), len(slope) / 3, len(names)]


def test_its_pictures_are_there() -> None:
    shown = re.findall(r"!\[.+?\]\((.+?)\)", README)
    assert len(shown) >= 6 and all((ROOT / path).is_file() for path in shown)
    linked = re.findall(r"\]\(((?:notebooks|tests|docs)/.+?)\)", README)
    assert all((ROOT / path).is_file() for path in linked)
