"""The stub of the core agrees with the extension: names, arguments, members, codes."""

import ast
import enum
import inspect
import re
from pathlib import Path

import pytest
import rolling_ellipse
from matplotlib import pyplot
from oracles.every_verb import use
from rolling_ellipse import _core

STUB = ast.parse((Path(rolling_ellipse.__file__).parent / "_core.pyi").read_text(encoding="utf-8"))
FUNCTIONS = {each.name: each for each in STUB.body if isinstance(each, ast.FunctionDef)}
CLASSES = {
    each.name: each
    for each in STUB.body
    if isinstance(each, ast.ClassDef) and not each.name.startswith("_")
}
CONSTANTS = {ast.unparse(each.target) for each in STUB.body if isinstance(each, ast.AnnAssign)}


def declared(function: ast.FunctionDef) -> list[str]:
    arguments = function.args
    return [each.arg for each in (*arguments.args, *arguments.kwonlyargs) if each.arg != "self"]


def bound(function: object) -> list[str]:
    """Names of the arguments in the signature that pybind11 writes into the docstring."""
    signature = (inspect.getdoc(function) or "").splitlines()[0]
    inside = signature[signature.index("(") + 1 : signature.rindex(")")]
    return [name for name in re.findall(r"(?:^|, )(\w+): ", inside) if name != "self"]


def public(of: object) -> set[str]:
    return {name for name in dir(of) if not name.startswith("_")}


def test_the_stub_has_the_names_of_the_extension() -> None:
    assert public(_core) == FUNCTIONS.keys() | CLASSES.keys() | CONSTANTS
    assert len(FUNCTIONS) > 20 and len(CLASSES) > 10


def test_functions_of_the_stub_take_the_arguments_of_the_extension() -> None:
    for name, function in FUNCTIONS.items():
        assert bound(getattr(_core, name)) == declared(function), name


def test_classes_of_the_stub_have_the_members_of_the_extension() -> None:
    for name, declaration in CLASSES.items():
        kind = getattr(_core, name)
        if issubclass(kind, enum.Enum):
            values = {
                line.targets[0].id: line.value.value
                for line in declaration.body
                if isinstance(line, ast.Assign)
                and isinstance(line.targets[0], ast.Name)
                and isinstance(line.value, ast.Constant)
            }
            assert values == {member.name: member.value for member in kind}, name
            continue
        body = declaration.body
        attributes = {ast.unparse(each.target) for each in body if isinstance(each, ast.AnnAssign)}
        methods = {each.name: each for each in body if isinstance(each, ast.FunctionDef)}
        assert public(kind) == attributes | methods.keys() - {"__init__"}, name
        for method, function in methods.items():
            assert bound(getattr(kind, method)) == declared(function), f"{name}.{method}"


def test_a_typed_script_with_every_verb_runs(tmp_path: Path) -> None:
    """mypy --strict checks the types of the script. This test runs it, and requires that every verb
    appears in it."""
    for package in ("scipy", "pandas", "xarray"):
        pytest.importorskip(package)  # optional; not installed when a wheel is tried out
    assert all(isinstance(number, float | int) for number in use(tmp_path))
    script = inspect.getsource(use)
    for name in rolling_ellipse.__all__:
        of = getattr(rolling_ellipse, name)
        if inspect.isfunction(of) and "._verbs" in of.__module__:
            assert f"rl.{name}(" in script, name
    pyplot.close("all")
