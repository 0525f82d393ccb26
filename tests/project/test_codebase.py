"""Checks of the sources: linters, formatters, types, generated files, version, order of imports.

All paths are relative to this file: the suite runs from a source checkout with an installed
package.
"""

import ast
import os
import platform
import re
import subprocess
import sys
import sysconfig
import tomllib
from collections.abc import Callable, Iterator, Sequence
from graphlib import CycleError, TopologicalSorter
from pathlib import Path
from typing import Any

import pytest
import rolling_ellipse
from oracles.paths import ROOT, TESTS
from oracles.quick import QUICK

SOURCES = sorted((ROOT / "src").rglob("*.[ch]pp"))
GENERATED = {
    ROOT / "src" / "numerics" / "gauss_legendre.hpp": ROOT / "tools" / "make_gauss_legendre.py",
    ROOT / "src" / "integrator" / "collocation.hpp": ROOT / "tools" / "make_collocation.py",
}
PYTHON_FOLDERS = ("python", "tests", "tools", "docs", "benchmarks", "reference")
BINDINGS = ROOT / "src" / "bindings"
CORE = [path for path in SOURCES if path.parent != BINDINGS]
# Folders in the order of dependence: a folder includes only itself and earlier ones; "" is src.
FOLDERS = (
    "numerics", "integrator", "geometry", "scene", "rolling/level", "rolling/slope",
    "rolling/stepped", "proof", "multipliers", "contact", "outcome", "", "bindings",
)  # fmt: skip
# Rooms (folders) and single modules of the package in the same order; "" is the package itself.
# Functions may import a later room if it is slow to load.
PACKAGE = ROOT / "python" / "rolling_ellipse"
ROOMS = (
    "_core", "_ask", "geometry", "scenes", "_motion", "_verbs", "impacts", "report", "benchmark",
    "course", "_pictures", "_player", "_command_line", "", "__main__",
)  # fmt: skip
SLOW = "_pictures"
COMPLEX_PRODUCTS = """
void one(const double* x, const double* y, double* z) {
    const double re = x[0] * y[0] - x[1] * y[1];
    const double im = x[0] * y[1] + x[1] * y[0];
    z[0] = re;
    z[1] = im;
}
void many(const double* __restrict x, const double* __restrict y, double* __restrict z) {
    for (int i = 0; i < 64; ++i) one(x + 2 * i, y + 2 * i, z + 2 * i);
}
"""


def run(*command: str | Path) -> str:
    """Output of a command in the checkout; a failure shows the output."""
    done = subprocess.run(
        [str(part) for part in command], cwd=ROOT, capture_output=True, text=True, timeout=300
    )
    assert done.returncode == 0, f"{command[0]}:\n{done.stdout}\n{done.stderr}"
    return done.stdout


SCRIPTS = Path(sysconfig.get_path("scripts"))  # folder with the programs of the test extra


# -------------------------------------------------------------------------------- tools


RUFF = [sys.executable, "-m", "ruff"]
# Only the Python folders are checked for their format: newer versions of `ruff format` also format
# code in Markdown, where comments are aligned.
CHECKS: dict[str, tuple[list[str | Path], list[str | Path], str, str]] = {
    "ruff": ([*RUFF, "check", "--no-cache"], ["."], "unused.py", "import os\n"),
    "ruff format": (
        [*RUFF, "format", "--no-cache", "--check"], [*PYTHON_FOLDERS], "quotes.py", "x = 'one'\n",
    ),
    "mypy": (
        [sys.executable, "-m", "mypy", "--cache-dir=/dev/null", "--strict"], [], "untyped.py",
        "def f(x):\n    return x\n",
    ),
    "clang-format": (
        [SCRIPTS / "clang-format", "-n", "-Werror", f"--style=file:{ROOT / '.clang-format'}"],
        [path for path in SOURCES if path not in GENERATED], "wide.cpp", "int   f( ){return 1;}\n",
    ),
    "oxlint": (
        [SCRIPTS / "oxlint", "--deny-warnings"],
        ["python/rolling_ellipse/_player", "python/rolling_ellipse/course", "docs/live"],
        "unused.js", "const x = 1;\n",
    ),
}  # fmt: skip
each_tool = pytest.mark.parametrize(
    ("command", "sources", "name", "text"), CHECKS.values(), ids=CHECKS.keys()
)


@each_tool
def test_the_tools_accept_the_sources(command: Any, sources: Any, name: str, text: str) -> None:
    run(*command, *sources)


@each_tool
def test_the_tools_reject_faulty_sources(
    command: list[str], sources: list[str], name: str, text: str, tmp_path: Path
) -> None:
    (tmp_path / name).write_text(text)
    done = subprocess.run([*command, name], cwd=tmp_path, capture_output=True, timeout=300)
    assert done.returncode == 1, done.stderr


def test_the_contributing_page_formats_every_source_of_the_core() -> None:
    if not (ROOT / ".git").exists():
        pytest.skip("no checkout, whose files git could list")
    page = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    (listing,) = re.findall(r"^(git ls-files .*) \| xargs .*clang-format", page, re.MULTILINE)
    assert {ROOT / name for name in run("sh", "-c", listing).split()} >= {*SOURCES} - {*GENERATED}


# -------------------------------------------------------------- generated files and numbers


@pytest.mark.parametrize(("table", "script"), GENERATED.items(), ids=lambda path: path.stem)
def test_tables_match_the_output_of_their_scripts(table: Path, script: Path) -> None:
    assert table.read_text(encoding="utf-8") == run(sys.executable, script)


def test_the_version_is_the_same_everywhere() -> None:
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    version = settings["project"]["version"]
    for name in ("CITATION.cff", "recipe/recipe.yaml"):
        text = (ROOT / name).read_text(encoding="utf-8")
        assert re.findall(r"^ *version: ([\w.]+)$", text, re.MULTILINE) == [version], name
    assert f"\n## {version}" in (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    assert rolling_ellipse.__version__ == version
    # no other source contains the version
    literal = f'"{version}"'
    for path in (*SOURCES, *(ROOT / "python").rglob("*.py"), ROOT / "CMakeLists.txt"):
        assert literal not in path.read_text(encoding="utf-8"), path


def test_the_conda_recipe_requires_what_the_package_requires() -> None:
    rattler = pytest.importorskip("rattler_build", reason="there is no py-rattler-build")
    variant = rattler.VariantConfig({"c_stdlib": ["sysroot"], "cxx_compiler": ["gxx"]})
    (made,) = rattler.Stage0Recipe.from_file(ROOT / "recipe" / "recipe.yaml").render(variant)
    needed = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]["dependencies"]
    there = [each.replace(" ", "").replace("-base", "") for each in made.recipe.requirements.run]
    assert there == ["python", *needed]


def test_every_list_of_python_versions_matches_the_classifiers() -> None:
    """CPython can run without the GIL since 3.13; wheels for 3.13t are left out by name."""
    workflow = ROOT / ".github" / "workflows" / "test.yml"
    if not workflow.exists():
        pytest.skip("no checkout: the source distribution has no workflows")
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    words = "\n".join(settings["project"]["classifiers"])
    minors = re.findall(r"^Programming Language :: Python :: 3\.(\d+)$", words, re.MULTILINE)
    free = [each for each in minors if int(each) >= 13] if ":: Free Threading" in words else []
    known = [*minors, *(f"{each}t" for each in free)]
    wheels = settings["tool"]["cibuildwheel"]
    assert wheels["build"].split() == [f"cp3{each}-*" for each in known if each != "13t"]
    assert "cp313t-*" in wheels["skip"].split()
    matrix = re.findall(r"python: \[(.+)\]", workflow.read_text(encoding="utf-8"))
    assert sorted(re.findall(r"3\.(\w+)", " ".join(matrix))) == sorted(known)
    span = f"CPython 3.{minors[0]} to 3.{minors[-1]}"
    for page in ("README.md", "CONTRIBUTING.md", "docs/promises.md", "docs/release.md"):
        assert span in " ".join((ROOT / page).read_text(encoding="utf-8").split()), page
    release = (ROOT / "docs" / "release.md").read_text(encoding="utf-8")
    assert " ".join(f"python3.{each}" for each in minors) in release
    floor = settings["project"]["requires-python"].removeprefix(">=")
    assert floor == f"3.{minors[0]}"


def test_every_requirement_states_its_oldest_version() -> None:
    """tools/oldest_versions.py runs the suite with these versions."""
    versions = run(sys.executable, ROOT / "tools" / "oldest_versions.py", "--list").split()
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    for needed in settings["project"]["dependencies"]:
        assert needed.replace(">=", "==") in versions


# --------------------------------------------------------------------------------- tests


def test_no_test_imports_another() -> None:
    """Shared helpers are in tests/oracles."""
    files = sorted(TESTS.glob("*/test_*.py"))
    assert len(files) > 40 and len({path.name for path in files}) == len(files)
    for path in files:
        text = path.read_text(encoding="utf-8")
        assert not re.search(r"^\s*(?:from|import) test_", text, re.MULTILINE), path.name


def test_quick_tests_come_from_every_folder() -> None:
    for name in QUICK:
        file, _, test = name.partition("::")
        text = (TESTS / file).read_text(encoding="utf-8")
        assert f"def {test or 'test_'}" in text, name
    folders = {path.parent.name for path in TESTS.glob("*/test_*.py")}
    assert {name.partition("/")[0] for name in QUICK} == folders


def test_wheels_are_tested_with_existing_tests() -> None:
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    words = settings["tool"]["cibuildwheel"]["test-command"].split()
    names = [word.partition("}/")[2] for word in words if word.startswith("{project}/")]
    assert len(names) > 5
    for name in names:
        file, _, test = name.partition("::")
        assert f"def {test or 'test_'}" in (ROOT / file).read_text(encoding="utf-8"), name


# ---------------------------------------------------------------------- order of imports


def included(path: Path) -> list[str]:
    text = path.read_text(encoding="utf-8")
    return re.findall(r"^\s*#\s*include\s*[<\"]([^>\"]+)[>\"]", text, re.MULTILINE)


def test_only_the_bindings_depend_on_python() -> None:
    assert any(name.startswith("pybind11/") for name in included(BINDINGS / "arrays.hpp"))
    assert len(CORE) > 20
    for path in CORE:
        for name in included(path):
            assert not name.startswith(("pybind11", "Python.h", "numpy")), f"{path.name}: {name}"
        assert "PyObject" not in path.read_text(encoding="utf-8")


def folder_of(name: str) -> int:
    """Place of a source in the order of the folders, by its path from src."""
    return FOLDERS.index(name.rpartition("/")[0])


def test_no_folder_includes_a_later_folder() -> None:
    between = 0
    for path in SOURCES:
        name = path.relative_to(ROOT / "src").as_posix()
        for other in re.findall(r'#include "(.+)"', path.read_text(encoding="utf-8")):
            assert (ROOT / "src" / other).is_file(), f"{name}: {other} is not a path from src"
            assert folder_of(other) <= folder_of(name), f"{name} includes {other}"
            between += folder_of(other) < folder_of(name)
    assert between > 50  # fewer if the search no longer recognises includes


def statements(body: Sequence[ast.stmt]) -> Iterator[tuple[ast.ImportFrom, bool]]:
    """Imports within the package, except those for type checkers, each with True if it is in a
    function."""
    for statement in body:
        if isinstance(statement, ast.ImportFrom) and statement.level:
            yield statement, False
        elif not (isinstance(statement, ast.If) and "TYPE_CHECKING" in ast.unparse(statement.test)):
            inner = [part for part in ast.iter_child_nodes(statement) if isinstance(part, ast.stmt)]
            is_call = isinstance(statement, ast.FunctionDef)
            yield from ((found, is_call or late) for found, late in statements(inner))


def imported(path: Path) -> Iterator[tuple[str, bool]]:
    """Files that a file imports, by path in the package, each with True if a function does so."""
    here = path.relative_to(PACKAGE).parts
    for statement, late in statements(ast.parse(path.read_text(encoding="utf-8")).body):
        module = [*here[: -statement.level], *(statement.module or "").split(".")]
        place = PACKAGE.joinpath(*module)
        for name in statement.names:
            files = (place / f"{name.name}.py", place / f"{name.name}.pyi",
                     place / name.name / "__init__.py", place.with_suffix(".py"),
                     place.with_suffix(".pyi"), place / "__init__.py")  # fmt: skip
            yield next(f for f in files if f.is_file()).relative_to(PACKAGE).as_posix(), late


def room_of(file: str) -> int:
    first = file.split("/")[0].partition(".")[0]
    return ROOMS.index("" if first == "__init__" else first)


def test_no_room_imports_a_later_room() -> None:
    between = 0
    for path in PACKAGE.rglob("*.py"):
        name = path.relative_to(PACKAGE).as_posix()
        for other, late in imported(path):
            is_slow = late and ROOMS[room_of(other)] == SLOW
            assert is_slow or room_of(other) <= room_of(name), f"{name} imports {other}"
            between += room_of(other) < room_of(name)
    assert between > 200  # fewer if the search no longer recognises imports


def test_the_architecture_page_names_every_room() -> None:
    page = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
    for room in (*FOLDERS, *ROOMS):
        assert f"`{room}" in page or not room, room


def test_no_files_import_each_other_circularly() -> None:
    """Neither imports at load time nor imports in functions form a cycle. Imports for type checkers
    may."""
    graph = {
        path.relative_to(PACKAGE).as_posix(): {other for other, _ in imported(path)}
        for path in PACKAGE.rglob("*.py")
    }
    assert len(list(TopologicalSorter(graph).static_order())) == len(graph) + 1  # the core's .pyi
    graph["_ask/scene.py"] |= {"_motion/events.py"}
    with pytest.raises(CycleError, match=r"_ask/scene\.py"):
        TopologicalSorter(graph).prepare()


def test_no_flag_lets_the_compiler_change_the_arithmetic() -> None:
    """-ffast-math breaks the compensated sums; -march=native would not run on other machines."""
    build = (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
    for setting in ("-ffp-contract=off", "-fno-tree-vectorize", "EIGEN_DONT_VECTORIZE"):
        assert setting in build
    settings = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    for text in (build, settings, *(path.read_text(encoding="utf-8") for path in SOURCES)):
        for flag in ("-ffast-math", "-Ofast", "-funsafe-math", "-march=native", "fast_math"):
            assert flag not in text


@pytest.fixture
def fused(tmp_path: Path) -> Callable[..., list[str]]:
    """A function that finds fused instructions in a source, compiled with the flags of
    CMakeLists.txt plus -mavx2 and -mfma."""
    if platform.machine() != "x86_64":
        pytest.skip(f"-mfma is a flag of x86-64, not of {platform.machine()}")
    build = (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
    found = re.search(r"target_compile_options\(rolling_ellipse_core PUBLIC (.+)\n", build)
    assert found
    flags = ["-std=c++17", "-O3", "-mavx2", "-mfma", "-Isrc", *found[1].split()]

    def instructions(source: Path, *more: str) -> list[str]:
        assembly = tmp_path / f"{source.stem}.s"
        run(os.environ.get("CXX", "c++"), *flags, *more, "-S", source, "-o", assembly)
        return re.findall(r"\bvfn?m(?:add|sub)\w+", assembly.read_text())

    return instructions


def test_the_compiler_fuses_only_what_is_written_as_fused(
    fused: Callable[..., list[str]], tmp_path: Path
) -> None:
    product = tmp_path / "product.cpp"
    product.write_text(COMPLEX_PRODUCTS)
    assert fused(product) == []
    written = tmp_path / "written.cpp"
    written.write_text("double f(double x) { return __builtin_fma(x, x, x); }")
    assert len(fused(written)) == 1


def test_vectorization_fuses_no_further_operations(fused: Callable[..., list[str]]) -> None:
    """A compiler that vectorizes could fuse operations on packed numbers. Operations that are fused
    even without vectorization are written as fused in the source."""
    build = (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
    properties = r"set_source_files_properties\(([^)]*)PROPERTIES [^)]*COMPILE_OPTIONS (-f\S+)\)"
    vectorized = [(name, flag) for names, flag in re.findall(properties, build)
                  for name in names.split()]  # fmt: skip
    assert len(vectorized) == 5 and build.count("COMPILE_OPTIONS -ftree-vectorize") == 2
    for name, flag in vectorized:
        packed, written = (
            [each for each in fused(ROOT / name, *more) if not each.endswith("sd")]
            for more in ([flag], [])
        )
        assert packed == written and not any("addsub" in each for each in packed), name


def test_every_source_is_built_and_included_only_once() -> None:
    build = (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
    build = "".join(re.findall(r"(?:add_library|add_module|target_sources)\([^)]*\)", build))
    for path in SOURCES:
        if path.suffix == ".cpp":
            name = path.relative_to(ROOT).as_posix()
            assert len(re.findall(rf"\b{re.escape(name)}\b", build)) == 1, name
        else:
            assert "#pragma once" in path.read_text(encoding="utf-8"), path.name
