"""The lists "To add ..." of docs/architecture.md name every file that a new thing of a kind needs.

Existing things of that kind prove it: the files that name all of them, found in the sources, must
be the files on the page. A moved file breaks its list, too.
"""

import ast
import re
from dataclasses import fields
from pathlib import Path
from typing import NamedTuple

import peers
import pytest
from oracles.paths import ROOT
from rolling_ellipse import EventKind
from rolling_ellipse._ask.settings import Settings
from rolling_ellipse._motion.quantities import QUANTITIES

PAGE = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
CORE, PACKAGE, PEERS = ROOT / "src", ROOT / "python" / "rolling_ellipse", ROOT / "benchmarks/peers"
ROOMS = {path for path in PACKAGE.iterdir() if path.is_dir() and path.name != "report"}
NAME = re.compile(r"`([\w/.]+\.(?:hpp|cpp|pyi|py))`")


def of_room(room: str) -> list[str]:
    """Public names that the package imports from a room, by `__init__.pyi`."""
    lines = ast.parse((PACKAGE / "__init__.pyi").read_text(encoding="utf-8")).body
    imports = [line for line in lines if isinstance(line, ast.ImportFrom)]
    return [line.names[0].name for line in imports if (line.module or "").startswith(room)]


PLOTS = [name for name in of_room("_pictures") if name.startswith("plot_")]
PEER_MODULES = [
    path.stem for path in PEERS.glob("*.py") if "def peers(" in path.read_text(encoding="utf-8")
]


class Kind(NamedTuple):
    """Words that each file of a list must contain, and its files with other words."""

    words: list[str]
    beside: tuple[str, ...] = ()


KINDS = {
    "an event": Kind([kind.name for kind in EventKind]),
    "a method": Kind(
        ["dopri5"],  # the tableaus call it DormandPrince5
        ("src/integrator/explicit_tableaus.hpp", "src/integrator/steps.hpp",
         "src/integrator/runge_kutta.hpp", "tests/integrator/test_tableaus.py",
         "tests/integrator/test_integrators.py"),
    ),
    "a picture": Kind([name for name in PLOTS if name != "plot_phase_map"]),
    "a verb": Kind(of_room("_verbs")),
    "a column of a motion": Kind([each.name for each in QUANTITIES]),
    "a setting": Kind([field.name for field in fields(Settings)]),
    "a peer": Kind(PEER_MODULES),
}  # fmt: skip


def entry(kind: str) -> str:
    found = re.search(rf"\n\* \*\*{re.escape(kind)}\*\*(.+?)(?=\n\* |\Z)", PAGE, flags=re.DOTALL)
    assert found, f"the page has no list for {kind}"
    return found[1]


def named_by_the_page(kind: str) -> set[Path]:
    """The files of an entry, by their paths from src, the package or the checkout."""
    found = set()
    for name in NAME.findall(entry(kind)):
        places = [folder / name for folder in (CORE, PACKAGE, ROOT) if (folder / name).is_file()]
        assert len(places) == 1, f"{kind}: {name} is no file"
        found.add(places[0])
    return found


def holding(words: list[str]) -> set[Path]:
    """Sources that contain every word, in any case."""
    found = set()
    inner = (path for room in (CORE, PEERS, *ROOMS) for path in room.rglob("*"))
    for path in (*PACKAGE.glob("*"), *inner):
        if path.suffix in (".cpp", ".hpp", ".py", ".pyi"):
            held = {each.lower() for each in re.findall(r"\w+", path.read_text(encoding="utf-8"))}
            found |= {path} if {word.lower() for word in words} <= held else set()
    return found


@pytest.mark.parametrize("kind", KINDS)
def test_the_page_names_the_files_that_a_new_one_needs(kind: str) -> None:
    words, beside = KINDS[kind]
    expected = holding(words) | {ROOT / name for name in beside}
    if kind == "a method":  # peers have methods of that name
        expected = {path for path in expected if PEERS not in path.parents}
    assert words and named_by_the_page(kind) == expected


def test_every_peer_is_loaded() -> None:
    assert set(peers.MODULES) == set(PEER_MODULES)


def test_every_list_is_held() -> None:
    """Every list has a test, except lists with one example or with a test in tests/border."""
    listed = set(re.findall(r"\n\* \*\*(.+?)\*\*", PAGE.partition("## To add")[2]))
    assert listed == {*KINDS, "a model", "a way out of Python", "a field of Scene"}
