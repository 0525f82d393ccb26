"""The numbered formulas are defined and verified in the physics notebook, and cited by the core.

A comment of the core that says ``physics (12)`` means the formula under the heading ``### (12)`` of
notebooks/02_physics.ipynb; ``physics (23, 24)`` means two formulas.
"""

import re
from itertools import pairwise

import nbformat
from oracles.paths import ROOT

SOURCES = sorted((ROOT / "src").rglob("*.[ch]pp"))
CELLS = nbformat.read(ROOT / "notebooks" / "02_physics.ipynb", 4).cells


def headings(cell: nbformat.NotebookNode) -> list[int]:
    found = re.findall(r"^### \((\d+)\) \S", cell.source, re.MULTILINE)
    return [int(number) for number in found] if cell.cell_type == "markdown" else []


def citations(text: str) -> list[int]:
    found = re.findall(r"\bphysics \(([^)]*)\)", re.sub(r"\n *// ", " ", text))
    return [int(number) for numbers in found for number in numbers.split(",")]


DEFINED = [number for cell in CELLS for number in headings(cell)]
CITED = {str(path): citations(path.read_text(encoding="utf-8")) for path in SOURCES}


def test_citations_are_distinguished_from_other_brackets() -> None:
    text = "// h: physics (1)\n x = f(2);  // physics (23, 24); eq (5), physics of (6), (7)"
    assert citations(text) == [1, 23, 24]


def test_each_formula_number_is_defined_once_and_none_is_missing() -> None:
    assert list(range(1, len(DEFINED) + 1)) == DEFINED
    assert len(DEFINED) >= 30  # fewer if the search no longer recognises headings


def test_every_formula_is_cited_by_the_core() -> None:
    assert set(DEFINED).difference(*CITED.values()) == set()


def test_every_citation_is_defined() -> None:
    undefined = {name: set(numbers).difference(DEFINED) for name, numbers in CITED.items()}
    assert {name: numbers for name, numbers in undefined.items() if numbers} == {}


def test_the_core_explains_its_formula_numbers_in_one_file_only() -> None:
    texts = [(path.name, path.read_text(encoding="utf-8")) for path in SOURCES]
    assert [name for name, text in texts if "02_physics.ipynb" in text] == ["simulate.hpp"]


def test_every_formula_is_checked_by_the_cell_below_it() -> None:
    """Each text cell has at most one formula; the code cell below it checks the same number."""
    for text, below in pairwise(CELLS):
        for number in headings(text):
            assert headings(text) == [number], f"({number}) shares its cell"
            assert below.cell_type == "code" and f"check({number}, " in below.source, number
