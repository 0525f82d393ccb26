"""The Python code of the README and of the guides runs, block by block."""

import json
import re
import runpy
import tomllib
from pathlib import Path
from typing import Any

import matplotlib
import pytest

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
from oracles import table
from oracles.paths import ROOT

README = (ROOT / "README.md").read_text(encoding="utf-8")
PAPER = (ROOT / "paper" / "paper.md").read_text(encoding="utf-8").partition("\n---\n")[2]
PAGES = {  # with the files that their code writes
    "README.md": {"motion.png", "roll.html"},
    "docs/index.md": set(),
    "docs/start.md": {"motion.png", "roll.gif", "friction.gif"},
    "docs/explore.md": {"strike.html"},
    "docs/many.md": {"motions"},
    "docs/speed.md": set(),
    "docs/constraints.md": set(),
    "docs/film.md": set(),
    "docs/recipes.md": {
        "motion.npz", "motion.csv", "plain.csv", "mine.png", "slow.html", "slow.gif", "still.png",
        "forces.pdf", "strike.html", "motions",
    },
    "docs/embed.md": {"roll.html", "schlag.html", "roll.gif", "motion.png"},
}  # fmt: skip


@pytest.mark.filterwarnings("ignore::rolling_ellipse.StabilityWarning")  # the guides show it
@pytest.mark.parametrize("page", PAGES)
def test_the_code_on_a_page_runs(page: str, tmp_path: Path, monkeypatch: Any) -> None:
    monkeypatch.chdir(tmp_path)
    text = (ROOT / page).read_text(encoding="utf-8")
    blocks = re.findall(r"```python\n(.*?)```", text, flags=re.DOTALL)
    names: dict[str, object] = {}
    for block in blocks:
        exec(block.replace("max_seconds=10", "max_seconds=2"), names)
    plt.close("all")
    assert blocks and {path.name for path in tmp_path.iterdir()} == PAGES[page]
    assert max(len(line) for block in blocks for line in block.splitlines()) <= 94  # fit the column


@pytest.mark.filterwarnings("ignore::rolling_ellipse.StabilityWarning")
def test_the_residuals_in_a_guide_agree_with_its_printed_output(capsys: Any) -> None:
    """A factor of 2 is allowed, because other C libraries may round differently."""
    page = (ROOT / "docs" / "constraints.md").read_text(encoding="utf-8")
    exec("".join(re.findall(r"```python\n(.*?)```", page, flags=re.DOTALL)), {})
    plt.close("all")
    number = r"(\d\S*) "
    printed = re.findall(rf"^(\S+) +{number}m {number}{number}rad$", capsys.readouterr().out, re.M)
    shown = re.findall(rf'^\| `"(.+?)"`.*?\| {number}m \| {number}\| {number}rad \|$', page, re.M)
    assert len(shown) == 5 and [row[0] for row in shown] == [row[0] for row in printed]
    ratios = np.array([row[1:] for row in shown], float) / np.array([r[1:] for r in printed], float)
    assert np.all((ratios >= 0.5) & (ratios <= 2))


def test_the_reference_tables_have_the_stated_number_of_motions() -> None:
    """A motion has three lines in the table of slopes, and a line per event in the last two
    tables."""
    page = (ROOT / "docs" / "benchmark.md").read_text(encoding="utf-8")
    said = dict(re.findall(r"\| `(\w+)_reference\.csv` \| (\d+) ", page))
    level, slope, gentle, *events = (table.rows(f"{name}_reference") for name in said)
    motions = [len(level), len(slope) / 3, len(gentle)]
    motions += [len({row["name"] for row in rows}) for rows in events]
    assert [*map(int, said.values())] == motions
    assert f"tables of {sum(motions):.0f} motions" in PAPER


def test_the_readme_is_short_and_its_links_work() -> None:
    linked = re.findall(r"\]\((?:https://.+?/(?:raw|blob)/main/)?([^)#]+)", README)
    assert len(linked) > 20 and all((ROOT / path).exists() for path in linked)
    assert len(README.splitlines()) <= 132


def test_the_paper_has_its_sections_a_reference_for_each_citation_and_the_scores() -> None:
    assert re.findall("^# (.+)", PAPER, re.MULTILINE) == [
        "Summary", "Statement of need", "State of the field", "Software design",
        "Research impact statement", "Limits", "AI usage disclosure", "Acknowledgements",
        "References",
    ]  # fmt: skip
    assert 750 <= len(PAPER.split()) <= 1750
    books = (ROOT / "paper" / "paper.bib").read_text(encoding="utf-8").split("\n@")
    named = {re.findall(r"{(\w+),", book)[0] for book in books if "doi = {10." in book}
    assert len(named) == len(books) and named == {*re.findall(r"@(\w+)", PAPER)}
    engines = json.loads((ROOT / "docs" / "data" / "engines.json").read_text(encoding="utf-8"))
    for name, found in engines["engines"].items():
        passed = sum(each["passed"] for each in found["scores"] if each["setting"] == 1e-3)
        assert f"{name} {found['version']} passes {passed} " in PAPER.replace(",", " ")


def test_one_command_writes_the_site_address_everywhere(tmp_path: Path) -> None:
    """A second address replaces the first, and no placeholder is left."""
    names = ("README.md", "pyproject.toml", "CITATION.cff", "recipe/recipe.yaml", "SECURITY.md",
             "CODE_OF_CONDUCT.md")  # fmt: skip
    (tmp_path / "recipe").mkdir()
    write = runpy.run_path(str(ROOT / "tools" / "address.py"))["write"]
    for name in names:
        (tmp_path / name).write_bytes((ROOT / name).read_bytes())
    for address in ("https://one.example/who/re", "https://two.example/re"):
        write(tmp_path, address, "https://site.example", ["ada", "bea"])
        texts = [(tmp_path / name).read_text(encoding="utf-8") for name in names]
        assert all(address in text and "https://site.example" in texts[1] for text in texts)
        assert "](docs/" not in texts[0] and tomllib.loads(texts[1])["project"]["urls"]
    left = re.compile(r"one\.example|to.be.filled|\]\(\.\./", re.IGNORECASE)
    assert not any(left.search(text) for text in texts)
    assert texts[3].endswith("    - ada\n    - bea\n")
