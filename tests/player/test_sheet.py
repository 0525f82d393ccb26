"""The page of an exercise sheet gives the same marks as Python and needs no network."""

import math
import random
import re
from collections.abc import Callable
from io import StringIO
from typing import Any

import pytest
from oracles.paths import ROOT
from rolling_ellipse import course
from rolling_ellipse.course import _marks

SEED = 20261
MARKS = """answers => answers.map(([task, text]) => {
    const field = document.querySelector(`[data-task="${task}"]`);
    field.value = text;
    field.dispatchEvent(new Event("change"));
    const mark = markOf(key, task, text);
    return [field.closest("label").querySelector("output").textContent, mark];
})"""


@pytest.mark.parametrize("number", [3, 7, 8])
def test_browser_and_python_give_the_same_marks(number: int, opened: Callable[..., Any]) -> None:
    """The answers are random, or close to a value at which the mark changes, or not numbers."""
    html = course.sheet(number, seed=SEED).html
    assert "http" not in html.replace("http://www.w3.org", "")
    page = opened(html)
    draw = random.Random(number)
    answers: list[tuple[str, str]] = []
    for task in course.tasks(SEED):
        if task.number.startswith(f"{number}."):
            size = 10.0 ** draw.uniform(-2, 2)
            values = [draw.choice((-1, 1)) * size * draw.uniform(0.5, 2) for _ in range(10)]
            values += known(task.number)
            answers += [(task.number, spelled(value, draw)) for value in values]
    answers += [(f"{number}.1", text) for text in ("0x1", "1e999", "two", "1 2", "١", "Infinity")]
    seen = page.evaluate(MARKS, answers)
    assert len(answers) > 100
    for (number_of, text), (shown, mark) in zip(answers, seen, strict=True):
        table = f'student,seed,task,answer\nx,{SEED},{number_of},"{text}"'
        rows = course.mark_table(StringIO(table))
        if rows.refused:
            assert mark is None and shown == "This is not a number."
        else:
            ours = rows.marks["x"][number_of]
            assert mark == [ours.points, ours.sentence, ours.mistake], (number_of, text)
            assert shown.endswith(ours.sentence)


def known(number: str) -> list[float]:
    """The answers at which the mark changes, and the doubles next to each."""
    ends = _marks.key(number, SEED).ends
    return [v for end in ends for v in (end, math.nextafter(end, 9e9), math.nextafter(end, -9e9))]


def spelled(value: float, draw: random.Random) -> str:
    text = draw.choice((repr, "{:.4g}".format, "{:.3e}".format))(value)
    return draw.choice((text, text.replace(".", ","), f" {text} ", text.replace("-", "−", 1)))


def test_a_page_has_every_formula_and_the_fields_of_its_tasks(opened: Callable[..., Any]) -> None:
    """No TeX source is left in the text, and nothing is wider than the page."""
    for number in range(1, 11):
        page = opened(course.sheet(number, seed=SEED).html)
        page.evaluate("document.querySelectorAll('pre').forEach(code => code.remove())")
        text = page.locator("body").inner_text()
        assert not re.search(r"[$\\\0]|\*\*|^\||<[a-z]", text, re.MULTILINE), number
        here = [t for t in course.tasks(SEED) if t.number.startswith(f"{number}.")]
        assert page.locator("[data-task]").count() == len(here)
        assert page.evaluate("document.documentElement.scrollWidth") <= 1000
        source = next(ROOT.glob(f"docs/course/{number:02}_*.md")).read_text(encoding="utf-8")
        source = re.sub(r"```.*?```|`[^`]+`", "", source, flags=re.DOTALL)
        drawn = page.locator("svg path").count()
        assert drawn >= len(re.findall(r"\$\$?[^$]+\$\$?", source)) > 5
