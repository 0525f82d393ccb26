"""The lists "To add ..." of docs/architecture.md name every file that an addition must change.

For each kind of addition, the list must have exactly the sources that name all existing things of
that kind. For the kinds in PLACES, a pattern finds the sources that depend on the kind; their
lists may name functions instead of files. A test fails if a file on a list moves.
"""

import ast
import re
from dataclasses import fields
from pathlib import Path
from typing import NamedTuple

import peers
import pytest
from oracles.paths import ROOT
from rolling_ellipse import EventKind, Scene, _core
from rolling_ellipse._ask.settings import Settings
from rolling_ellipse._motion.quantities import QUANTITIES

PAGE = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
CORE, PACKAGE, PEERS = ROOT / "src", ROOT / "python" / "rolling_ellipse", ROOT / "benchmarks/peers"
ROOMS = {path for path in PACKAGE.iterdir() if path.is_dir() and path.name != "report"}
NAME = re.compile(r"`([\w/.]+\.(?:hpp|cpp|pyi|py|rst))`")


def of_room(room: str) -> list[str]:
    """Public names that the package imports from a room (folder), according to `__init__.pyi`."""
    lines = ast.parse((PACKAGE / "__init__.pyi").read_text(encoding="utf-8")).body
    imports = [line for line in lines if isinstance(line, ast.ImportFrom)]
    of = [line for line in imports if (line.module or "").startswith(room)]
    return [each.name for line in of for each in line.names]


PLOTS = [name for name in of_room("_pictures") if name.startswith("plot_")]
PEER_MODULES = [
    path.stem for path in PEERS.glob("*.py") if "def peers(" in path.read_text(encoding="utf-8")
]


class Kind(NamedTuple):
    """Words that identify the files of a list, and files of the list without these words."""

    words: list[str]
    beside: tuple[str, ...] = ()


KINDS = {
    "an event": Kind([kind.name for kind in EventKind], (
        "tests/border/test_stub.py", "tests/core/golden.cpp",
        "tests/contact/test_contact_reference.py", "tests/core/test_core.py", "src/describe.cpp",
        "reference/contact_motion.py", "reference/make_contact_reference.py", "tools/same_bits.py",
        "python/rolling_ellipse/benchmark/_equations.py", "docs/api/motion.rst",
        "python/rolling_ellipse/benchmark/_events.py", "python/rolling_ellipse/_motion/growth.py",
        "python/rolling_ellipse/_motion/passages.py", "tests/trajectory/test_event_table.py",
        "tests/player/test_site.py", "src/contact/slide.cpp", "src/contact/flight.cpp",
        "src/simulate.cpp", "src/bindings/batch.cpp", "python/rolling_ellipse/_motion/chain.py",
        "python/rolling_ellipse/_pictures/forces.py",
        "python/rolling_ellipse/_motion/constraints.py", "tests/sensitivity/chain.py",
    )),
    "a status": Kind([ending.name for ending in _core.Ending], (
        "tests/border/test_stub.py", "src/messages.cpp", "src/describe.cpp",
        "src/bindings/batch.cpp", "python/rolling_ellipse/__main__.py",
        *(f"python/rolling_ellipse/{name}.py" for name in (
            "_motion/status", "_motion/trajectory", "_motion/differences", "_motion/sensitivity",
            "_motion/export/files", "_verbs/work_precision/race",
            "_pictures/panels", "_verbs/batches/answers", "_verbs/batches/ends",
            "_verbs/simulate")),
    )),
    "a method": Kind(
        ["dopri5"],  # the tableaus call it DormandPrince5
        ("src/integrator/explicit_tableaus.hpp", "src/integrator/steps.hpp",
         "src/integrator/runge_kutta.hpp", "tests/integrator/test_tableaus.py",
         "tests/integrator/test_integrators.py", "tools/fuzz/scenes.py",
         "tests/core/golden.cpp", "tests/core/test_core.py", "tests/oracles/losses.py",
         "tests/oracles/passages.py",
         "benchmarks/bench_calls.py"),
    ),
    "a picture": Kind([name for name in PLOTS if name != "plot_phase_map"],
                      ("python/rolling_ellipse/_pictures/comparison.py",
                       "tests/player/test_site.py", "tests/project/test_docstrings.py",
                       "tests/project/test_gallery.py", "docs/api/pictures.rst")),
    "a verb": Kind(of_room("_verbs"), (
        "python/rolling_ellipse/__init__.py", "tests/project/test_docstrings.py",
        "tests/border/test_layout.py", "tests/border/test_stub.py", "tests/oracles/every_verb.py",
        "tests/player/test_site.py", "python/rolling_ellipse/_command_line.py",
        "python/rolling_ellipse/__main__.py", "tests/project/test_command_line.py",
    )),
    "a computed quantity of a motion": Kind([each.name for each in QUANTITIES],
                                 ("tests/export/test_tables.py", "src/outcome/passages.hpp",
                                  "python/rolling_ellipse/_pictures/errors.py",
                                  "python/rolling_ellipse/_pictures/panels.py",
                                  "python/rolling_ellipse/_motion/samples.py",
                                  "src/bindings/solution.cpp", "tests/oracles/units.py",
                                  "src/outcome/stretches.cpp", "tests/trajectory/test_samples.py",
                                  "python/rolling_ellipse/_core.pyi",
                                  "python/rolling_ellipse/_motion/passages.py")),
    "a setting": Kind([field.name for field in fields(Settings)], (
        "tests/border/test_fields.py", "tests/batches/test_simulate_many.py",
        "tests/core/motions.hpp", "tests/export/test_old_files.py", "tools/live/live.cpp",
        "tools/fuzz/scenes.py", "python/rolling_ellipse/_command_line.py",
        "python/rolling_ellipse/__main__.py", "python/rolling_ellipse/_verbs/batches/ends.py",
    )),
    "a field of Scene": Kind([field.name for field in fields(Scene)], (
        "python/rolling_ellipse/_command_line.py",
        "python/rolling_ellipse/_motion/export/files.py",
        "python/rolling_ellipse/_verbs/batches/folders.py", "tests/border/test_fields.py",
        "python/rolling_ellipse/_verbs/work_precision/results.py", "tests/refusals/files.py",
        "tests/batches/test_folders.py",
        "tests/outcome/test_thresholds.py", "tests/impacts/test_laws_and_fit.py",
        "tests/core/motions.hpp", "tests/core/golden.cpp", "tests/core/test_core.py",
        "tests/oracles/golden.py", "tools/fuzz/calls.py", "docs/makers/live.py",
        "python/rolling_ellipse/_motion/export/strict.py", "tests/export/test_old_files.py",
        "python/rolling_ellipse/_verbs/films/film.py",
        "python/rolling_ellipse/_verbs/films/starts.py",
        "python/rolling_ellipse/_verbs/films/camera.py", "src/contact/flight.cpp",
        "python/rolling_ellipse/benchmark/_equations.py", "tests/oracles/units.py",
        "python/rolling_ellipse/benchmark/_events.py", "src/scene/field.hpp",
        "python/rolling_ellipse/_motion/constraints.py", "tests/scene/test_texts.py",
        "tests/batches/test_simulate_many.py", "src/contact/contact.cpp", "src/simulate.cpp",
        "src/multipliers/equations.cpp", "src/describe.cpp", "reference/contact_motion.py",
        "python/rolling_ellipse/_motion/from_arrays.py", "python/rolling_ellipse/_ask/xml.py",
        "tests/oracles/drawn.py", "tests/oracles/contact.py",
        "python/rolling_ellipse/_pictures/overview.py",
        "python/rolling_ellipse/_pictures/phase.py",
    )),
    "a law of restitution": Kind(["Stronge", "Poisson", "Newton"], (
        "src/contact/contact.cpp", "src/contact/flight.cpp", "tests/border/test_stub.py",
        "tests/impacts/test_laws_and_fit.py", "tools/fuzz/calls.py",
        "reference/contact_motion.py", "reference/make_benchmark.py",
        "tests/benchmark/test_problems.py",
    )),
    "a peer": Kind(PEER_MODULES, ("tests/project/test_lists.py",)),
}  # fmt: skip

# Patterns of code that depends on a kind of addition. Each file with the pattern must be on the
# list of that kind, or contain a name that is on the list.
PLACES = {
    "a friction law": r"scene_?\.friction\b|double friction[,)]|friction_share",
    "lanes of another processor": r"__x86_64__|cpu_supports|_mm\d+_|\"sse2\"|HAS_LANES",
    "a kind of stretch on a slope": r"\bRepeat\b",
    "a model": r"Model::multipliers|SteppedMultipliers|model == \"multipliers\"",
    "a field of Scene": r"\bScene \w+\{\}|level_scene\(",
}
UNTESTED = {
    "another law of rolling resistance", "another shape than the ellipse", "an export",
    "a word of a page", "a language", "a sentence of a reason", "a value stored in files",
    "a renamed field", "a format of films",
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
    """Sources that contain every word, ignoring case."""
    found = set()
    inner = (path for room in (CORE, PEERS, *ROOMS) for path in room.rglob("*"))
    for path in (*PACKAGE.glob("*"), *inner):
        if path.suffix in (".cpp", ".hpp", ".py", ".pyi"):
            held = {each.lower() for each in re.findall(r"\w+", path.read_text(encoding="utf-8"))}
            found |= {path} if {word.lower() for word in words} <= held else set()
    return found


@pytest.mark.parametrize("kind", KINDS)
def test_the_page_names_every_file_that_an_addition_must_change(kind: str) -> None:
    words, beside = KINDS[kind]
    expected = holding(words) | {ROOT / name for name in beside}
    if kind == "a method":  # peers have methods of that name
        expected = {path for path in expected if PEERS not in path.parents}
    assert words and named_by_the_page(kind) == expected


def test_every_peer_is_loaded() -> None:
    assert set(peers.MODULES) == set(PEER_MODULES)


def named(text: str) -> set[str]:
    """Names of code in a text: words with a capital, an underscore or parentheses."""
    return set(re.findall(r"`(\w*[A-Z_]\w*|\w+(?=\(\)`))", text))


def words_of(path: Path) -> set[str]:
    return set(re.findall(r"\w+", path.read_text(encoding="utf-8")))


@pytest.mark.parametrize("kind", PLACES)
def test_the_page_names_every_file_that_depends_on_each_kind_of_addition(kind: str) -> None:
    files = named_by_the_page(kind)
    names = set() if kind == "a model" else named(entry(kind))  # its list has every file
    sources = [ROOT / "CMakeLists.txt", *CORE.rglob("*.[ch]pp"), *PACKAGE.rglob("*.py")]
    found = [path for path in sources if re.search(PLACES[kind], path.read_text(encoding="utf-8"))]
    assert len(found) >= 3
    found = [path for path in found if path.parent.name != "multipliers"]  # the folder of a model
    assert not [path for path in found if path not in files and not names & words_of(path)]


def test_every_name_on_the_page_occurs_in_the_sources() -> None:
    folders = (CORE, PACKAGE, PEERS, ROOT / "tests")
    sources = (path for folder in folders for path in folder.rglob("*"))
    known = [words_of(path) for path in sources if path.suffix in (".cpp", ".hpp", ".py", ".pyi")]
    names = named(PAGE.partition("## To add")[2])
    assert len(names) > 50
    assert names <= set().union(*known)


def test_every_list_is_tested_and_in_the_index() -> None:
    """The exceptions are lists for things that do not exist yet, or whose files share no word."""
    text = PAGE.partition("## To add")[2]
    listed = re.findall(r"\n\* \*\*(.+?)\*\*", text)
    index = " ".join(text.partition("The lists: ")[2].partition(".\n")[0].split())
    assert listed == index.split(" · ") and {*listed} == {*KINDS, *PLACES, *UNTESTED}
    assert all(named_by_the_page(kind) for kind in {*listed} - {"another shape than the ellipse"})
