"""Answers of a WorkPrecision with made-up runs agree with tables made by hand."""

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import rolling_ellipse as rl
from rolling_ellipse import Scene, WorkPrecision
from rolling_ellipse._verbs.work_precision.run import Errors, Reference, Run


def run(name: str, error: float, time: float, **other: Any) -> Run:
    errors = Errors(final=error / 2, l2=error / 4, linf=error, energy=error / 10)
    facts: dict[str, Any] = {
        "model": "rolling", "method": name, "stabilization": "", "setting": error,
        "errors": errors, "time": time,
        "setup": 1e-5, "spread": 0.1, "steps": 10, "rejected": 1, "evaluations": 100,
        "status": "COMPLETED", "reason": "", "tags": ("own",), "samples_time": 3 * time,
        "t_end": 2.0,
    }  # fmt: skip
    return Run(name=name, **(facts | other))


GAP: dict[str, Any] = {"status": "MAX_STEPS", "reason": "too many steps", "errors": Errors()}
RUNS = (
    run("sure", 1e-13, 1e-5, method="exact", setting=math.nan),
    run("also", 1e-13, 5e-5, method="exact", setting=math.nan),
    run("fast", 1e-3, 4e-6, tags=("peer",)),
    run("fast", 1e-6, 5e-5, tags=("peer",)),
    run("fast", 1e-9, 2e-4, tags=("peer",)),
    run("slow", 5e-4, 1e-3),
    run("slow", 1e-2, 1e-4),
    run("lost", 0.1, math.nan, **GAP),
    run("poor", 3.0, 1e-4),
)
FOUND = WorkPrecision(
    scene=Scene(2.0, 1.0, omega=3.2),
    runs=RUNS,
    references=(Reference("exact rolling", 2.0, 4e-13, 1e-13),),
    machine={"processor": "P", "rounds": "20"},
)


def test_best_is_the_fastest_run_that_is_accurate_enough() -> None:
    assert FOUND.best(1e-2) is RUNS[2] and FOUND.best(1e-3) is RUNS[2]
    assert FOUND.best(9.9e-4) is RUNS[0] and FOUND.best(1e-8) is RUNS[0]
    assert FOUND.best() is RUNS[0]
    assert FOUND.best(1e-13) is None  # below the floor of the reference
    assert FOUND.best(9.9e-4, x="final") is RUNS[2]  # its error at the end is half of its largest
    assert FOUND.best(1e-2, y="evaluations") is RUNS[0]  # all take 100, so the first one counts


def test_least_gives_the_least_time_of_each_method() -> None:
    assert FOUND.least(1e-2) == {"sure": 1e-5, "also": 5e-5, "fast": 4e-6, "slow": 1e-4}
    assert FOUND.least(1e-5) == {"sure": 1e-5, "also": 5e-5, "fast": 5e-5}
    assert FOUND.least(1e-12) == {"sure": 1e-5, "also": 5e-5}


def test_unbeaten_methods_are_those_within_the_margin() -> None:
    decades = [10.0**-k for k in range(2, 15)]
    assert FOUND.unbeaten() == {"fast": tuple(decades[:2]), "sure": tuple(decades[2:11])}
    equal = FOUND.unbeaten(2.6)
    assert equal["sure"] == tuple(decades[:11]) and equal["fast"] == tuple(decades[:2])


def test_a_notebook_shows_the_least_time_of_each_method() -> None:
    html = FOUND._repr_html_()
    assert repr(FOUND)[1:-1] in html
    for name, *cells in (
        ("sure", "1e-13", "10 µs"), ("fast", "1e-09", "4 µs"), ("slow", "0.0005", "100 µs"),
        ("lost", "no answer", ""),
    ):  # fmt: skip
        row = "".join(f'<td style="text-align:left">{cell}</td>' for cell in cells)
        assert f">{name}</th>{row}</tr>" in html


def test_the_verdict_states_no_value_that_was_not_computed() -> None:
    """The error of the reference and the attainable error are left out if they are unknown."""
    unknown = replace(FOUND.references[0], floor=0.0, attainable=float("nan"))
    said = replace(FOUND, references=(unknown,)).verdict().splitlines()[0]
    assert said == ("To t = 2 s, judged by exact rolling, at the sample times and the end:")


def test_the_verdict_agrees_with_the_table() -> None:
    first, behind, *others = FOUND.verdict().splitlines()
    lines = [first, *others]
    assert behind == (
        "fast is ahead of sure, 2.5 × at 1e-02 (10 steps), 2.5 × at 1e-03 (10 steps);"
    )
    assert lines[0].startswith("To t = 2 s, judged by exact rolling (its own error 4.0e-13;")
    assert lines[1] == "fast is unbeaten from 1e-02 to 1e-03 (4 µs, set-up 10 µs);"
    assert lines[2] == "    sure takes 2.5 × at 1e-02, 2.5 × at 1e-03"
    assert lines[3] == "sure is unbeaten from 1e-04 to 1e-12 (10 µs, set-up 10 µs);"
    assert lines[4] == (
        "    fast takes 5 × at 1e-04, 5 × at 1e-05, 5 × at 1e-06, 20 × at 1e-07, 20 × at 1e-08, "
        "20 × at 1e-09"
    )
    assert lines[5] == "    no other method reaches errors from 1e-10 to 1e-12"
    assert lines[6] == (
        "no method has reached errors from 1e-13 to 1e-14, which the reference cannot resolve"
    )
    assert lines[7] == "lost has no answer: MAX_STEPS, too many steps"
    assert lines[8] == "poor reached no error below 3.0e+00"
    assert len(lines) == 9


def test_the_verdict_begins_with_peers_that_are_ahead() -> None:
    """Peers must beat the best of the package's methods, at errors that both have reached."""
    exact = [replace(each, steps=0) if each.name == "sure" else each for each in RUNS]
    few = run("few", 1e-2, 2e-6, tags=("peer",), steps=3)
    near = run("near", 1e-14, 1e-6, tags=("peer",), steps=0)
    reason = ": so few steps cost less than the initial work of sure;"

    def second(*runs: Run) -> list[str]:
        said = replace(FOUND, runs=(*exact, *runs)).verdict().splitlines()
        return [line for line in said[1:] if "ahead" in line]

    at_three = "fast is ahead of sure, 2.5 × at 1e-03 (10 steps)" + reason
    assert second(few) == ["few is ahead of sure, 5 × at 1e-02 (3 steps)" + reason, at_three]
    every = ", ".join(f"10 × at 1e-{k:02d}" for k in range(2, 13))
    assert second(few, near) == [f"near is ahead of sure, {every};"]
    even = run("even", 1e-13, 9.5e-6, tags=("peer",))
    (_, equal) = second(even)
    assert equal.startswith("even is ahead of sure, 1.05 × at 1e-04 (10 steps), ")
    assert equal.endswith("1.05 × at 1e-12 (10 steps) (practically equal);")
    own = run("quick", 1e-3, 3e-6)
    assert second(few, own) == ["few is ahead of quick, 1.5 × at 1e-02 (3 steps);"]
    assert second(own) == []
    alone = replace(FOUND, runs=tuple(each for each in RUNS if "peer" not in each.tags))
    assert "ahead" not in alone.verdict()


LATE: dict[str, Any] = {"status": "NOT_RUN", "reason": "max_seconds", "errors": Errors()}
CUT = replace(
    FOUND,
    runs=(
        *RUNS,
        run("late", 1e-5, 1e-3, setting=1e-2),
        run("late", 1e-7, math.nan, setting=1e-3, **LATE),
        run("fast", 1e-11, math.nan, **LATE),
        run("rough", 7.9e2, 1e-7, setting=0.5),
        run("rough", 1.0, math.nan, setting=0.25, **LATE),
        run("lost", 0.01, math.nan, **LATE),
        run("never", 0.1, math.nan, **LATE),
    ),
)


def test_a_method_that_was_not_run_is_not_beaten() -> None:
    """The verdict does not judge a method at errors for which the method was not run."""
    assert CUT.not_run(1e-2) == ("rough", "lost", "never")
    assert CUT.not_run(1e-5) == ("rough", "lost", "never")
    assert CUT.not_run(1e-6) == ("late", "rough", "lost", "never")
    assert CUT.not_run(1e-10) == ("late", "fast", "rough", "lost", "never")
    assert CUT.unbeaten() == {} and FOUND.not_run(1e-10) == ()
    lines = CUT.verdict().splitlines()
    assert lines[2] == "fast is the fastest that was run from 1e-02 to 1e-03 (4 µs, set-up 10 µs);"
    assert "sure is the fastest that was run from 1e-04 to 1e-12 (10 µs, set-up 10 µs);" in lines
    assert "    no other method was seen to reach errors from 1e-10 to 1e-12" in lines
    assert lines[-7:] == [
        "lost has no answer so far: MAX_STEPS, too many steps",
        "poor reached no error below 3.0e+00",
        "fast was not run beyond 1e-09: no time left (200 µs per call so far)",
        "lost was not run beyond 1e-01: no time left",
        "late was not run beyond 1e-02: no time left (1 ms per call so far)",
        "rough was not run beyond 5e-01: no time left (100 ns per call so far)",
        "never was not run at all: no time left",
    ]
    assert not any(word in CUT.verdict() for word in ("unbeaten", "rough came", "never reached"))
    frame = CUT.gaps().to_dataframe()
    assert list(frame["name"]) == ["fast", "lost", "lost", "poor", "late", "rough", "never"]
    assert list(frame["runs"]) == [1, 1, 1, 1, 1, 1, 1] and frame["answers"][0] == 3


def test_a_method_is_unbeaten_only_where_all_were_run() -> None:
    """A method that was cut short counts at the errors that it reached."""
    found = replace(FOUND, runs=(*RUNS, *CUT.runs[9:12]))
    decades = [10.0**-k for k in range(2, 15)]
    assert found.unbeaten() == {"fast": tuple(decades[:2]), "sure": tuple(decades[2:4])}
    text = found.verdict()
    assert "sure is unbeaten from 1e-04 to 1e-05" in text
    assert "sure is the fastest that was run from 1e-06 to 1e-12" in text


def test_a_table_has_a_row_for_each_run() -> None:
    frame = FOUND.to_dataframe()
    assert list(frame["name"]) == [each.name for each in RUNS]
    assert list(frame["largest"])[:3] == [1e-13, 1e-13, 1e-3] and math.isnan(frame["final"][7])
    assert frame["tags"][2] == "peer"


def test_loading_a_file_restores_the_saved_race(tmp_path: Path) -> None:
    path = tmp_path / "race.json"
    found = replace(FOUND, scene=replace(FOUND.scene, impulse=rl.Impulse.press(1.0, 0.5)))
    found.save(path)
    again = WorkPrecision.load(path)
    assert repr(again.runs) == repr(found.runs)
    assert (again.scene, again.references, again.machine) == (
        found.scene, found.references, found.machine,
    )  # fmt: skip
    assert again.verdict() == found.verdict()

    def none(literal: str) -> float:
        raise AssertionError(literal)

    text = path.read_text(encoding="utf-8")
    json.loads(text, parse_constant=none)  # plain JSON has no NaN
    rows = [line for line in text.splitlines() if line.startswith('  { "name": ')]
    assert len(rows) == len(RUNS) + len(found.references) and '"t_end": 2.0 }' in rows[0]
