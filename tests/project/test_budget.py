"""Code lines of the core and of the package stay within a budget; `pytest -rP` shows the lines of
each folder.

A code line is not blank and is part of neither a comment nor a docstring. The commit of a change
that needs a larger budget states what the change replaces; a change that shrinks the code lowers
the budget here.
"""

import ast
import re
from collections import Counter

import pytest
from oracles.paths import ROOT

CODE_LINES = {"src": 13_290, "python/rolling_ellipse": 14_800}
SLACK = 1.02
SUFFIXES = (".py", ".pyi", ".js", ".cpp", ".hpp")
COMMENT = re.compile(r"^[ \t]*(?://[^\n]*|/\*.*?\*/)", re.DOTALL | re.MULTILINE)
DOCUMENTED = (ast.Module, ast.ClassDef, ast.FunctionDef)


def code_lines(text: str, suffix: str) -> int:
    if not suffix.startswith(".py"):
        return sum(bool(line.strip()) for line in COMMENT.sub("", text).splitlines())
    lines = text.splitlines()
    code = {n for n, line in enumerate(lines, 1) if line.strip() and line.lstrip()[0] != "#"}
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, DOCUMENTED) and ast.get_docstring(node) is not None:
            code -= set(range(node.body[0].lineno, (node.body[0].end_lineno or 0) + 1))
    return len(code)


@pytest.mark.parametrize(
    ("text", "suffix", "count"),
    [
        ('"""One.\n\nTwo."""\n\n# three\nX = """\nfour"""\n', ".py", 2),
        ('def f() -> None:\n    """One."""\n    g()  # two\n', ".pyi", 2),
        ("// one\n#pragma once\n\n/* two\n * three */\nint x = 2 * y;  // four\n", ".hpp", 2),
        ('/** one */\nconst way = "https://two";\n', ".js", 1),
    ],
)
def test_a_line_counts_if_it_is_code(text: str, suffix: str, count: int) -> None:
    assert code_lines(text, suffix) == count


@pytest.mark.parametrize("tree", CODE_LINES)
def test_the_code_stays_within_its_budget(tree: str) -> None:
    rooms: Counter[str] = Counter()
    for path in sorted((ROOT / tree).rglob("*")):
        if path.suffix in SUFFIXES:
            room = path.relative_to(ROOT / tree).parent.as_posix()
            own = code_lines(path.read_text(encoding="utf-8"), path.suffix)
            rooms[room if tree == "src" else room.partition("/")[0]] += own
    print(*(f"{room:16} {count:6}" for room, count in rooms.items()), sep="\n")
    print(f"{tree}: {rooms.total()} code lines; {CODE_LINES[tree]} and 2 % are allowed")
    assert len(rooms) > 5 and rooms.total() <= SLACK * CODE_LINES[tree]
