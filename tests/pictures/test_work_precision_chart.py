"""The work-precision chart: a run stands at its numbers, or on the rim with its reason."""

import math
from dataclasses import replace
from itertools import pairwise
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from rolling_ellipse import Scene, WorkPrecision, work_precision
from rolling_ellipse._verbs.work_precision import Errors

SCENE = Scene(2.0, 1.0, theta=0.2, omega=3.2)
FOUND = work_precision(
    SCENE, [1.0, 3.0], rounds=2, samples=8, tolerances=[1e-2, 1e-6, 1e-10], steps=[0.4, 0.02],
    methods=["flow", "dop853", "rk4", "multipliers/rk4/none", "multipliers/radau/ggl"],
)  # fmt: skip
# times of the methods: no picture depends on the load of the machine; NaN stays NaN
TIMES = {"flow": 2e-6, "dop853": 2e-5, "rk4": 1e-5}
FOUND = replace(
    FOUND,
    runs=tuple(
        replace(
            run,
            time=TIMES.get(run.name, 1e-3) * (1 + run.steps / 100) + 0 * run.time,
            setup=1e-5 + 0 * run.setup,
        )
        for run in FOUND.runs
    ),
)
FAILED = {run.name for run in FOUND.of() if not run.completed}


@pytest.fixture
def chart() -> Any:
    return FOUND.plot(ax=Figure().add_subplot())


def test_every_answer_is_drawn_and_every_gap_is_marked(chart: Any) -> None:
    floor, _ = FOUND.reference.limits("largest")
    for name in FOUND.names:
        answers = [run for run in FOUND.of() if run.name == name and run.completed]
        x = [min(max(run.errors.final, run.errors.linf, floor), 10.0) for run in answers]
        drawn = chart.lines[name].get_xydata()
        assert np.array_equal(drawn, np.transpose([x, [run.time for run in answers]]))
    assert FAILED and chart.failures.keys() == FAILED
    for name in FAILED:
        reason = next(r.reason for r in FOUND.of() if r.name == name and not r.completed)
        line = next(
            each for each in chart.reasons.get_text().splitlines() if each.startswith(f"× {name}")
        )
        assert reason[:40] in line


def test_small_errors_are_on_the_right_and_what_cannot_be_known_is_grey(chart: Any) -> None:
    first, last = chart.ax.get_xlim()
    floor, attainable = FOUND.reference.limits("largest")
    assert first > 1e-2 > attainable > last
    assert chart.ax.get_xscale() == chart.ax.get_yscale() == "log"
    assert chart.attainable.get_xdata()[0] == attainable
    left, right = chart.floor.get_x(), chart.floor.get_x() + chart.floor.get_width()
    assert max(left, right) == pytest.approx(floor)


def test_set_up_is_a_hollow_mark_above_the_most_accurate_run(chart: Any) -> None:
    line, hollow = chart.lines["flow"], chart.setups["flow"]
    run = next(run for run in FOUND.of() if run.name == "flow")
    assert hollow.get_xydata()[0].tolist() == [line.get_xdata()[0], run.time + run.setup]
    assert hollow.get_markerfacecolor() == "#ffffff"


def test_names_stand_apart_in_the_margin() -> None:
    chart: Any = FOUND.plot()
    figure = chart.ax.figure
    figure.canvas.draw()
    boxes = [chart.names[name].get_window_extent() for name in chart.lines]
    assert {text.get_text() for text in chart.names.values()} == set(FOUND.names)
    tops = sorted((box.y0, box.y1) for box in boxes)
    assert all(below[1] <= above[0] + 1 for below, above in pairwise(tops))
    width, height = figure.canvas.get_width_height()
    for text in (*chart.names.values(), chart.reasons, chart.stamp):
        box = text.get_window_extent()
        assert box.x0 >= 0 and box.y0 >= 0 and box.x1 <= width and box.y1 <= height, text
    plt.close(figure)


def test_kinds_of_ways_differ_in_grey_and_ways_of_a_kind_in_their_marks(chart: Any) -> None:
    def grey(colour: Any) -> float:
        return float(np.dot(to_rgb(colour), (0.299, 0.587, 0.114)))

    kinds = {n: grey(chart.lines[n].get_color()) for n in ("flow", "rk4", "multipliers/rk4/none")}
    shades = sorted(kinds.values())
    assert all(abs(b - a) > 0.07 for a, b in pairwise(shades))
    assert chart.lines["rk4"].get_marker() != chart.lines["dop853"].get_marker()


def test_the_stamp_says_what_it_was_taken_on() -> None:
    chart: Any = FOUND.plot()
    text = chart.stamp.get_text().replace("\n", " ")
    for name in ("processor", "compiler", "flags", "python", "numpy", "date", "rounds"):
        assert f"{name} {FOUND.machine[name]}" in text
    plt.close(chart.ax.figure)


@pytest.mark.parametrize("x", ["linf", "energy", "gap", "steps", "evaluations", "setting"])
@pytest.mark.parametrize("y", ["time", "samples_time", "final", "setup"])
def test_any_quantity_goes_on_either_axis(x: str, y: str) -> None:
    chart: Any = FOUND.plot(x, y, ax=Figure().add_subplot())
    line = chart.lines["dop853"].get_xydata()
    runs = [run for run in FOUND.of() if run.name == "dop853"]
    last = runs[-1].value(y)
    assert line[-1, 1] == (max(last, FOUND.reference.floor) if y == "final" else last)
    if x in ("steps", "evaluations", "setting"):  # axes without a rim
        assert line[-1, 0] == runs[-1].value(x)
    chart.ax.figure.canvas.draw()


def test_over_the_span_each_setting_has_its_line() -> None:
    chart: Any = FOUND.plot("t_end", "final", tags=["dop853"], ax=Figure().add_subplot())
    assert chart.lines.keys() == {("dop853", s) for s in (1e-2, 1e-6, 1e-10)}
    for line in chart.lines.values():
        assert line.get_xdata().tolist() == [1.0, 3.0]
    everything: Any = FOUND.plot("t_end", "time", ax=Figure().add_subplot())
    for mark in everything.failures.values():
        assert set(mark.get_xdata()) <= {1.0, 3.0}


def test_tags_choose() -> None:
    chart: Any = FOUND.plot(tags=["multipliers"], ax=Figure().add_subplot())
    assert {*chart.lines, *chart.failures} == {"multipliers/rk4/none", "multipliers/radau/ggl"}
    with pytest.raises(ValueError, match=r"tags must be among dop853, exact, flow, .*got 'peer'"):
        FOUND.plot(tags="peer", ax=Figure().add_subplot())


def test_who_was_not_run_is_named_with_an_arrow_and_is_no_failure() -> None:
    """In a chart of errors at samples an arrow also names methods judged at the end only."""
    of = {name: [run for run in FOUND.of() if run.name == name] for name in FOUND.names}
    late = of["dop853"][1:] + of["rk4"]
    runs = [
        replace(run, status="NOT_RUN", errors=Errors(), time=math.nan) if run in late else run
        for run in FOUND.of()
    ]
    flow = next(i for i, run in enumerate(runs) if run.name == "flow")
    runs[flow] = replace(runs[flow], errors=Errors(final=runs[flow].errors.final))
    found = replace(FOUND, runs=tuple(runs), references=FOUND.references[1:])
    chart: Any = found.plot(ax=Figure().add_subplot())
    titles = {name: text.get_text() for name, text in chart.names.items()}
    assert titles.pop("dop853") == "dop853 →" and titles.pop("flow") == "flow (end alone)"
    assert set(titles) == set(titles.values()) == set(FOUND.names) - {"dop853", "flow", "rk4"}
    assert chart.failures.keys() == FAILED - {"rk4"}
    assert "→ finer settings were not run, for want of time" in chart.reasons.get_text()
    alone: Any = found.plot("final", ax=Figure().add_subplot())
    assert alone.names["flow"].get_text() == "flow"


def test_a_chart_without_an_answer_still_says_why() -> None:
    gap: dict[str, Any] = {"status": "MAX_STEPS", "time": math.nan}
    reasons = ["", *["too many"] * len(FOUND.runs)]
    pairs = zip(FOUND.runs, reasons, strict=False)
    runs = tuple(replace(run, reason=reason, **gap) for run, reason in pairs)
    found: WorkPrecision = replace(FOUND, runs=runs)
    chart: Any = found.plot()
    assert not chart.lines and chart.failures.keys() == set(FOUND.names)
    assert "too many" in chart.reasons.get_text()
    chart.ax.figure.canvas.draw()
    plt.close(chart.ax.figure)
