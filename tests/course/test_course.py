"""Marks of the course for right and wrong answers; `pytest -rP -k marks` prints all marks."""

import math
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from course.by_hand import FILMED, NOISE, THROWN, TRUE, USUAL, Given, allowed, answer, film_fit
from rolling_ellipse import course
from rolling_ellipse.course import _answers

IMPACTS = ("theta", "x_dot", "y_dot", "omega", "x_dot_after", "y_dot_after", "omega_after")
DATA_IN_DEGREES = ("degrees", "Degrees", "dEGREES")  # at most one of these is made at a time
TASKS = {task.number: task for task in course.tasks()}


def spelled(names: set[str]) -> list[tuple[str, ...]]:
    """The mistakes in `by_hand` that a mark describes by these names. The name degrees stands for
    degrees in the data, in the answer or in both."""
    others = tuple(names - {"degrees"})
    if "degrees" not in names:
        return [others]
    return [(*others, *way, *last) for way in ((), *combinations(DATA_IN_DEGREES, 1))
            for last in ((), ("DEGREES",)) if way or last]  # fmt: skip


@pytest.mark.parametrize("number", TASKS)
def test_marks_name_the_mistakes_that_were_made(number: str) -> None:
    """A mark names the mistakes that were made, and others only if they lead to the same number.

    Mistakes that do not change the number are not named. The tolerances agree to within 30 % with
    those of `allowed`. They are at most 0.5 %, so that two answers with the same mark may differ by
    1 %.
    """
    right, near, task = answer(number), allowed(number), TASKS[number]
    off = min(1.3 * near, near + 4e-3 * abs(right))
    nearly = "by hand" if number in FILMED else "per mille"
    for miss, word in ((0.7 * near, "none"), (off, nearly), (-off, nearly)):
        mark = course.mark(number, right + miss)
        print(f"{number:5}{word:20}{right + miss:11.4g}  {mark.mistake}")
        assert mark.mistake.split(" or ")[-1] == word, miss
        assert mark.right == bool(mark) == (word == "none")
        assert mark.points == (task.points if mark else max(1, task.points - 1))
    assert not any(map(str.isdigit, mark.sentence)), "it would give the answer away"
    assert course.mark(number, 1.73 * right).mistake == "other"
    twins = [f"task {n}" for n, t in TASKS.items() if n != number and t.unit == task.unit
             and n[:-1] == number[:-1]]  # fmt: skip
    for made in (*combinations((*USUAL, *twins), 1), *combinations(USUAL, 2)):
        if len({*made} & {*DATA_IN_DEGREES}) > 1:
            continue
        given = answer(number, made)
        least = next(m for k in range(3) for m in combinations(made, k)
                     if math.isclose(answer(number, m), given, rel_tol=1e-9))  # fmt: skip
        mistake = course.mark(number, given).mistake
        if made == least:
            print(f"{number:5}{' and '.join(made):20}{given:11.4g}  {mistake}")
        named = [set(names.split(" and ")) for names in mistake.split(" or ")]
        if abs(given - right) < 0.7 * near:
            assert mistake == "none"
        elif least == ("angle",) and number in ("2.2", "2.4", "3.5"):
            assert mistake == "other"  # at the angle 0 the body rests, and there is no answer
        elif number in ("10.1", "10.2", "10.3", "10.5") and "inertia" in least:
            assert "inertia" not in mistake  # noise or an estimate by hand has as large an effect
        else:
            assert any(names <= {*map(str.lower, made)} for names in named), mistake
            for names in named:
                assert names == {nearly} or any(
                    math.isclose(answer(number, way), given, rel_tol=0.01) for way in spelled(names)
                ), mistake


def test_the_time_to_rest_agrees_to_eight_digits() -> None:
    assert _answers.answer(TASKS["3.5"]) == pytest.approx(answer("3.5"), rel=1e-8)


def test_the_noise_of_the_film_is_as_stated() -> None:
    """The film is computed from known numbers. chi^2 is within three standard deviations of 31, its
    degrees of freedom, and each fitted number is within two standard errors of its true value."""
    t, *tracks = course.film().values()
    noise = np.random.default_rng(2).normal(0, NOISE, (3, t.size))
    thrown: Any = Given("10.1").but(**THROWN)
    shown = thrown.frames(t) + noise
    for row, made, digits in zip(tracks, shown, (4, 4, 3), strict=True):
        assert np.array_equal(row, np.round(made, digits))
    known, off = film_fit()
    assert abs(known["chi2"] - 1) < 3 * math.sqrt(2 / 31)
    assert all(abs(known[name] - true) < 2 * off[name] for name, true in THROWN.items())


def test_marks_state_which_impacts_were_used(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    rows, names = np.vstack(course.measured_impacts()).T, ",".join(IMPACTS)
    np.savetxt(tmp_path / "seen.csv", rows[::-2], delimiter=",", header=names, comments="")
    for ending in ("(Synthetic impacts.)", "(Measured impacts.)"):
        mark = course.mark("8.2", TRUE["8.2"](Given("8.2")))
        assert mark and mark.sentence.endswith(ending)
        monkeypatch.setenv("ROLLING_ELLIPSE_IMPACTS", str(tmp_path / "seen.csv"))


def test_marks_follow_a_changed_file_of_impacts(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    rows, names = np.vstack(course.measured_impacts()).T, ",".join(IMPACTS)
    monkeypatch.setenv("ROLLING_ELLIPSE_IMPACTS", str(tmp_path / "seen.csv"))
    for kept in (rows[::2], rows[1::2]):
        np.savetxt(tmp_path / "seen.csv", kept, delimiter=",", header=names, comments="")
        assert course.mark("8.1", TRUE["8.1"](Given("8.1")))


def test_decimal_commas_in_a_table_of_impacts_are_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = "\n".join((",".join(IMPACTS), ",".join(["0,5"] * 7)))
    (tmp_path / "commas.csv").write_text(text)
    monkeypatch.setenv("ROLLING_ELLIPSE_IMPACTS", str(tmp_path / "commas.csv"))
    with pytest.raises(ValueError, match=r"^ROLLING_ELLIPSE_IMPACTS must .* 7 fields, got 14"):
        course.measured_impacts()


@pytest.mark.parametrize("task", ["8.1", "8.2", "8.3", "8.4", "8.5", "8.6"])
@pytest.mark.parametrize("kept", ["zero", "none", "unknown", "one"])
def test_tables_of_impacts_without_an_answer_are_rejected(
    kept: str, task: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Rows of zeros, no rows and NaNs are rejected with a message. A single row has an answer."""
    rows = np.vstack(course.measured_impacts()).T
    table = {"zero": 0 * rows, "none": rows[:0], "unknown": rows * np.nan, "one": rows[1:2]}[kept]
    path, names = tmp_path / f"{kept}.csv", ",".join(IMPACTS)
    np.savetxt(path, table, delimiter=",", header=names, comments="")
    monkeypatch.setenv("ROLLING_ELLIPSE_IMPACTS", str(path))
    if kept == "one":
        assert [each.shape for each in course.measured_impacts()] == [(4, 1), (3, 1)]
        assert not course.mark(task, 1.7)
    else:
        with pytest.raises(ValueError, match="ROLLING_ELLIPSE_IMPACTS must name a table of"):
            course.mark(task, 1.0)
