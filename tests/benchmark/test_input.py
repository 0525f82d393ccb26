"""Ids in place of problems, suggestions for misspelt names, and numbers that are not finite."""

import math
from pathlib import Path

import numpy as np
import pytest
from oracles.simulators import STATE, exact, score_of, write_states
from rolling_ellipse import benchmark
from rolling_ellipse.benchmark.adapters import engine


def test_ids_are_accepted_in_place_of_problems() -> None:
    several = benchmark.run(exact, problems=["slide.slope", benchmark.problem("roll.rock")])
    assert [score.problem for score in several] == ["slide.slope", "roll.rock"]
    (alone,) = benchmark.run(exact, problems="hit.settle", tags="flight, restitution,spin,stiction")
    assert alone.answer == "right"
    one = benchmark.problem("roll.rock")
    assert benchmark.problem(one) is one and several.order(one)[1] == ""
    (score,) = benchmark.score({"roll.rock": exact(one, one.output_times)}, problems="roll.rock")
    assert score.passed
    for tags in ("flight,non-round", ["flight", "non-round"]):
        assert [one.id for one in benchmark.problems(tags)] == ["hit.drop_slip"]


def test_an_adapter_accepts_an_id_in_place_of_a_problem() -> None:
    one, t = benchmark.problem("roll.rock"), np.arange(3) / 100
    simulate = engine(lambda scene, step: (lambda steps: None, lambda: [scene.theta] * 6))
    for given in (one.id, one, one.scene):
        assert np.all(simulate(given, t).states == one.scene.theta)
    with pytest.raises(ValueError, match=r"did you mean roll\.rock"):
        simulate("roll.rok", t)


def test_a_missing_column_is_named() -> None:
    one = benchmark.problem("roll.rock")
    states = one.exact(one.output_times)
    for count, lost in ((5, "omega"), (3, "x_dot, z_dot, omega")):
        with pytest.raises(ValueError, match=rf"states of roll\.rock .*, without {lost}$"):
            score_of(one, states[:, :count])


@pytest.mark.parametrize(
    ("typed", "near"),
    [
        ("slide.slop", "slide.slope"), ("slide", "slide.stick"), ("stick", "slide.stick"),
        ("Roll_Rok", "roll.rock"), ("roll_rock", "roll.rock"), ("hit.drop", "hit.drop_slip"),
        ("hit.bounceflat", "hit.bounce_flat"), ("rock", "roll.rock"), ("law", "law.which"),
    ],
)  # fmt: skip
def test_the_nearest_name_is_suggested(typed: str, near: str) -> None:
    for call in (
        lambda: benchmark.problem(typed),
        lambda: benchmark.run(exact, problems=typed),
        lambda: benchmark.score({typed: []}),
    ):
        with pytest.raises(ValueError, match=rf"got '{typed}'; did you mean .*{near}"):
            call()


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize(("row", "column"), [(0, 0), (7, 3), (123, 5), (500, 1)])
def test_values_that_are_not_finite_are_named(
    bad: float, row: int, column: int, tmp_path: Path
) -> None:
    """The message names the row and the column for arrays and for files, even if the known answer
    has no row at that time."""
    one = benchmark.problem("slide.stick")
    states = one.exact(one.output_times)
    states[row, column] = bad
    write_states(tmp_path, one, states)
    (by_file,) = benchmark.score(tmp_path, problems=one)
    for score in (score_of(one, states), by_file):
        assert score.answer == "failed" and not score.passed
        assert f"{STATE[column]} is {bad} in row {row} (t = {row / 100:g} s)" in score.reason


def test_an_infinite_force_is_named() -> None:
    one = benchmark.problem("slide.stick")
    right = exact(one, one.output_times)
    normal = right.normal_force.copy()
    normal[7] = math.inf
    score = score_of(one, benchmark.Result(right.states, normal_force=normal))
    assert score.answer == "failed" and "normal_force is inf in row 7" in score.reason
