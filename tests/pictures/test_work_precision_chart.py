"""Fronts, factors and names of the work-precision chart agree with made-up runs and are
readable."""

import itertools
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.text import Text
from rolling_ellipse import Scene, WorkPrecision
from rolling_ellipse._verbs.work_precision.run import Errors, Reference, Run

LIBRARIES = "SciPy", "heyoka", "Boost", "SUNDIALS", "diffrax"
DECADES = [10.0**-k for k in range(2, 15)]
LIMIT = 3e-13


def run(name: str, error: float, time: float, **how: Any) -> Run:
    tags = ("peer",) if name.split()[0] in LIBRARIES else ("own",)
    return Run(
        name, "rolling", how.pop("method", name), "", how.pop("setting", error), time=time,
        errors=Errors(error, error, error), tags=tags, t_end=2.0, setup=0.01, samples_time=time,
        **how,
    )  # fmt: skip


def made(count: int, best: float = 1e-13, kind: str = "ladders") -> WorkPrecision:
    """A race of `count` contenders: "flow" with a single answer, and own methods and peers of
    various orders and costs."""
    runs = [run("flow", best / 10, 2e-6, method="exact", setting=math.nan)]
    for i in range(1, count):
        own = i % 4 == 2
        name = f"method{i}" if own else f"{LIBRARIES[i % 5]} method {i}"
        order, unit = 3 + i % 6, 1e-6 * 1.4 ** (i % 13) * (1 + i % 3)
        errors = (
            [10.0**-k for k in range(-2, 16) if 10.0**-k > best] if kind == "ladders" else [1e-5]
        )
        for error in errors:
            # the number of steps is error^(-1/order); a fixed cost of 10 units is added
            runs.append(run(name, error, unit * (10 + error ** (-1 / order))))
    reference = Reference("made", 2.0, 0.0, LIMIT if best < LIMIT else 3 * best)
    return WorkPrecision(Scene(2.0, 1.0, omega=3.2), tuple(runs), (reference,), {"rounds": "9"})


FOUND = made(23)
OWN = {each.name for each in FOUND.runs if "own" in each.tags}
READ = {
    **{f"{count}": made(count) for count in (2, 7, 30)},
    "7 of a thin body, whose errors stay large": made(7, 3e-4),
    "7 with one answer each": made(7, kind="single"),
}


@pytest.fixture
def chart() -> Any:
    return FOUND.plot(ax=Figure().add_subplot())


def height(line: Any, error: float) -> float:
    x, y = line.get_data()
    return float(next(value for at, value in zip(x, y, strict=True) if at <= error))


def test_fronts_show_the_least_times_of_each_camp_and_factors_their_ratios() -> None:
    chart: Any = FOUND.plot(ax=Figure(figsize=(8, 5)).add_subplot())
    for decade in DECADES[:11]:
        least = FOUND.least(decade)
        own = min(time for name, time in least.items() if name in OWN)
        peers = min(time for name, time in least.items() if name not in OWN)
        assert height(chart.fronts["highlight"], decade) == own
        assert height(chart.fronts["others"], decade) == peers
        if decade in chart.factors:
            shown = chart.factors[decade].get_text()
            loser = next(name for name, time in least.items() if time == peers)
            assert shown.split(maxsplit=1)[1] == f"× faster\nthan {loser}"
            assert float(shown.split()[0]) == pytest.approx(peers / own, rel=0.05)
            assert {min(least, key=least.__getitem__)} <= set(chart.names)
    assert list(chart.factors) == [1e-2, 1e-6, 1e-10] and len(chart.names) <= 8


def test_the_chart_says_which_camp_is_ahead_or_that_they_tie() -> None:
    slow = next(name for name in FOUND.names if name not in OWN)
    chart: Any = FOUND.plot(highlight=slow, ax=Figure(figsize=(8, 5)).add_subplot())
    assert {text.get_text().split()[2] for text in chart.factors.values()} == {"slower"}
    runs = run("one", 1e-5, 1e-3), run("SciPy two", 1e-5, 1.1e-3)
    tie: Any = replace(FOUND, runs=runs).plot(ax=Figure().add_subplot())
    assert {text.get_text() for text in tie.factors.values()} == {"equal"}


def test_highlights_are_names_or_tags_of_the_race() -> None:
    def camp(**how: Any) -> Any:
        found = how.pop("found", FOUND)
        chart: Any = found.plot(ax=Figure().add_subplot(), **how)
        own = chart.fronts["highlight"].get_color()
        return {name for name, line in chart.lines.items() if line.get_color() == own}

    assert camp() == OWN == camp(highlight="own") == camp(highlight=["own"])
    assert camp(highlight=["flow", "Boost method 7"]) == {"flow", "Boost method 7"}
    alone = replace(FOUND, runs=tuple(each for each in FOUND.runs if each.name in OWN))
    assert camp(found=alone) == {"flow"}  # without peers, the exact methods
    with pytest.raises(ValueError, match=r"highlight must be among .*flow.*own.*peer.*'nobody'"):
        camp(highlight="nobody")
    assert camp(tags="own", highlight="method2") == {"method2"}


def test_errors_are_drawn_from_ten_down_to_the_attainable_limit(chart: Any) -> None:
    first, last = chart.ax.get_xlim()
    assert first == 10 and LIMIT / 10 < last < LIMIT == chart.limit.get_xdata()[0]
    for line in chart.lines.values():
        x = line.get_xdata()
        assert np.all(np.diff(x) < 0) and np.min(x) >= LIMIT
        assert np.sum(x == 10.0) <= 1  # an error of 100 is not moved into view
    assert {"10 µs", "1 ms"} <= {tick.get_text() for tick in chart.ax.get_yticklabels()}


def test_camps_can_be_told_apart_in_greyscale(chart: Any) -> None:
    def grey(line: Any) -> float:
        return float(np.dot(to_rgb(line.get_color()), (0.299, 0.587, 0.114)))

    rest = next(line for name, line in chart.lines.items() if name not in OWN)
    shades = [grey(line) for line in (*chart.fronts.values(), rest)]
    assert all(abs(one - other) > 0.15 for one, other in itertools.combinations(shades, 2))
    assert min(line.get_linewidth() for line in chart.fronts.values()) > 2 * rest.get_linewidth()


@pytest.mark.parametrize("found", READ.values(), ids=READ)
@pytest.mark.parametrize("width", [3.4, 5.0, 8.0, 12.0])
def test_no_text_overlaps_another(width: float, found: WorkPrecision) -> None:
    """The widths are those of a printed column, of 500 and 800 pixels, and of a slide."""
    with plt.rc_context({"figure.figsize": (width, 0.7 * width), "figure.dpi": 100}):
        chart: Any = found.plot()
    figure = chart.ax.figure
    figure.draw_without_rendering()
    ax = chart.ax
    ticks = {
        tick.label1: limits()[0] <= tick.get_loc() <= limits()[1]
        for axis, limits in ((ax.xaxis, lambda: sorted(ax.get_xlim())), (ax.yaxis, ax.get_ylim))
        for tick in axis.get_major_ticks()
    }  # ticks out of view are not drawn
    texts = [text for text in figure.findobj(Text) if ticks.get(text, text.get_visible())]
    boxes = {text: text.get_window_extent() for text in texts if text.get_text()}
    for (one, left), (other, right) in itertools.combinations(boxes.items(), 2):
        assert not left.padded(-0.5).overlaps(right.padded(-0.5)), (one, other)
    whole = figure.bbox.padded(1)
    for text, box in boxes.items():
        assert whole.x0 <= box.x0 and box.x1 <= whole.x1, text
        assert whole.y0 <= box.y0 and box.y1 <= whole.y1, text
        assert text.get_fontsize() >= 8
    plt.close(figure)
    assert 2 <= len(chart.names) <= 8 and "flow" in chart.names


LOST: dict[str, Any] = {"errors": Errors(), "time": math.nan, "status": "FAILED"}
FAILED = replace(run("method2", 1e-3, 1.0), **LOST, reason="singular")
LACKING = replace(FOUND, runs=(*FOUND.runs, FAILED))


def test_the_table_of_gaps_is_drawn_below_the_chart_if_there_is_room() -> None:
    table = str(LACKING.gaps())
    assert table.splitlines()[1] == "method2       1e-03       FAILED, singular"
    for width, drawn in ((8.0, True), (3.4, False)):
        with plt.rc_context({"figure.figsize": (width, 5.0)}):
            chart: Any = LACKING.plot()
        assert (table in chart.below.get_text()) == drawn
        assert str(chart.gaps) == table and "least of 9 rounds" in chart.below.get_text()
        plt.close(chart.ax.figure)
    assert LACKING.plot(ax=Figure().add_subplot()).below is None


def test_a_chart_without_any_result_still_names_every_failure() -> None:
    runs = tuple(replace(each, **LOST, reason="too many") for each in FOUND.runs)
    chart: Any = replace(FOUND, runs=runs).plot(ax=Figure().add_subplot())
    assert not chart.lines and {gap.name for gap in chart.gaps} == set(FOUND.names)
    chart.ax.figure.draw_without_rendering()


def test_small_multiples_show_one_library_each_and_share_their_limits() -> None:
    chart: Any = FOUND.plot(by="library")
    titles = [ax.get_title(loc="left") for ax in chart.axes]
    assert sorted(titles) == sorted([*LIBRARIES, "rolling_ellipse"])
    assert len({(ax.get_xlim(), ax.get_ylim()) for ax in chart.axes}) == 1
    assert set(chart.lines) == set(FOUND.names)
    for name, line in chart.lines.items():
        title = line.axes.get_title(loc="left")
        assert title == ("rolling_ellipse" if name in OWN else name.split()[0])
        assert len(line.axes.lines) >= len(FOUND.names)  # other libraries are drawn in grey
    plt.close(chart.ax.figure)


@pytest.mark.parametrize(("x", "y"), [("linf", "samples_time"), ("gap", "evaluations")])
def test_any_cost_can_be_plotted_against_any_error(x: str, y: str) -> None:
    found = replace(FOUND, runs=(run("method2", 1e-3, 2.0, evaluations=7),))
    found = replace(found, runs=(replace(found.runs[0], errors=Errors(*[1e-3] * 6)),))
    line: Any = found.plot(x, y, ax=Figure().add_subplot()).lines["method2"]
    assert line.get_xydata()[-1].tolist() == [1e-3, found.runs[0].value(y)]


def test_the_chart_has_axes_and_can_be_saved(chart: Any, tmp_path: Path) -> None:
    chart.savefig(tmp_path / "chart.svg", transparent=True)
    assert (tmp_path / "chart.svg").stat().st_size > 1000
    assert chart.axes == (chart.ax,) and "23 lines, 2 fronts" in repr(chart)
