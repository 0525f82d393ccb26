"""The printed sheets agree with the package, and the numbers in their text are right."""

import math
import re
from typing import Any

import numpy as np
import pytest
from course.by_hand import Given
from oracles.contact import response
from oracles.paths import ROOT, made_by
from rolling_ellipse import course

FOLDER = ROOT / "docs/course"
TASK = re.compile(r"\*\*(\d+\.\d)\*\* (−?\d+\.?\d*)")


def test_sheets_without_a_seed_equal_the_pages_of_the_docs() -> None:
    for number, path in enumerate(made_by("course")["SHEETS"], 1):
        assert course.sheet(number).markdown == path.read_text(encoding="utf-8"), path.name


def test_the_sheets_state_time_tools_and_points() -> None:
    for path in FOLDER.glob("[01][0-9]_*.md"):
        text = path.read_text(encoding="utf-8")
        assert re.search(r"\*\*Time:\*\* .* h.*\*\*Before:\*\* .*\*\*Tools:\*\* ", text), path.name
        marks = text.partition("## Marks")[2]
        for number in re.findall(r"^\*\*(\d+\.\d)\*\*", text, re.MULTILINE):
            sheet, _, task = number.partition(".")
            named = re.findall(rf"{sheet}\.(\d) to {sheet}\.(\d)", marks)
            assert number in marks or any(a <= task <= b for a, b in named) or sheet == "10", number


def test_the_teachers_page_has_right_answers() -> None:
    found = TASK.findall((FOLDER / "teacher.md").read_text(encoding="utf-8"))
    assert [number for number, _ in found] == [task.number for task in course.tasks()]
    for number, text in found:
        assert course.mark(number, float(text.replace("−", "-"))), number


def test_the_marks_name_the_usual_mistakes_of_the_teachers_page() -> None:
    """The usual wrong answers of an item follow the word Often, or a semicolon after it."""
    text = (FOLDER / "teacher.md").read_text(encoding="utf-8")
    items = re.findall(r"^\* \*\*(\d+\.\d)\*\*(.*?)(?=^\*|^#|\Z)", text, re.MULTILINE | re.DOTALL)
    shown = re.compile(r"(?:^|;)\s+\+?(−?\d+\.?\d*)")
    found = [(number, wrong.replace("−", "-")) for number, item in items
             for wrong in shown.findall(item.partition("Often")[2])]  # fmt: skip
    assert len(found) > 15
    for number, wrong in found:
        assert course.mark(number, float(wrong)).mistake not in ("none", "other"), (number, wrong)


def test_friction_past_the_tip_reverses_at_the_speed_that_sheet_3_states() -> None:
    """Just past the tip the sign of F = m (h omega_dot + h' omega^2) changes at that speed."""
    text = (FOLDER / "03_normal_and_friction_force.md").read_text(encoding="utf-8")
    shown = re.search(r"body ([\d.]+) rad/s \(([\d.]+) rad/s when flat\)", text)
    body: Any = Given("4.1")
    square = body.a * body.gravity / (body.gyration2 + body.a**2 - body.b**2)
    flat = body.about_contact(math.pi / 2) * square + 2 * body.gravity * (body.a - body.b)
    both = math.sqrt(square), math.sqrt(flat / body.about_contact(0))
    assert shown and [float(v) for v in shown.groups()] == pytest.approx(both, abs=0.005)
    for share in (0.99, 1.01):
        force = body.rolling(math.pi / 2 + 1e-3, share * both[0])[2]
        assert math.copysign(1, force) == math.copysign(1, 1 - share)


def test_the_example_of_sheet_7_is_right() -> None:
    """The contact slips until v = 0 and then sticks. Compression ends at u = 0. The end of
    restitution follows from the work, which is an area in the diagram of u over the impulse."""
    hit: Any = Given("7.4", x_dot=0.4, z_dot=-2.0, omega=0.0, theta=0.25, mass=1.5)
    v, u, tangential, normal, coupling = response(hit, hit)
    stop = v / (0.3 * tangential - coupling)
    slip, stick = normal - 0.3 * coupling, normal - coupling**2 / tangential
    reached = u + slip * stop
    turn = stop - reached / stick
    work = -(u + reached) / 2 * stop - reached * (turn - stop) / 2
    back = math.sqrt(2 * 0.36 * work / stick)
    end, along = turn + back, -0.3 * stop - coupling / tangential * (turn + back - stop)
    h, lead, _ = hit.at(0.25)
    spin = -(h * along + lead * end) / hit.inertia
    numbers = {
        hit.inertia: "0.04875", h: "0.2075", lead: "0.05776", normal: "0.7351",
        tangential: "1.5500", coupling: "0.2459", slip: "0.6613", coupling - 0.3 * tangential:
        "−0.2191", stop: "1.825", reached: "−0.7928", coupling / tangential: "0.159",
        stick: "0.6961", turn: "2.964", end: "4.726", stick * back: "1.226", 0.36 * work: "1.080",
        along: "−1.008", -2 + end / 1.5: "1.151", 0.4 + along / 1.5: "−0.272", spin: "−1.310",
        -0.3 * end: "−1.418", stick * back / 2: "0.613", work: "3.000",
        -(u + reached) / 2 * stop: "2.549", -reached * (turn - stop) / 2: "0.451",
    }  # fmt: skip
    text = (FOLDER / "07_flight_and_landing.md").read_text(encoding="utf-8").replace("-", "−")
    for value, shown in numbers.items():
        digits = len(shown.partition(".")[2])
        assert shown in text and float(shown.replace("−", "-")) == pytest.approx(
            value, abs=0.5001 * 10**-digits), shown  # fmt: skip
    hit.friction, hit.restitution = 0.3, 0.6
    assert hit.hit() == pytest.approx((along, end, 0.4 + along / 1.5, -2 + end / 1.5, spin))


def test_the_gap_of_sheet_7_closes_no_faster_than_stated() -> None:
    """The slope of h is at most a - b. Ten steps of gap/c, where c bounds the closing
    speed, reach the contact."""
    fall: Any = Given("7.2")
    assert np.max(np.abs(fall.at(np.linspace(0.0, math.pi, 3143))[1])) <= fall.a - fall.b
    latest = math.sqrt(2 * (fall.z - fall.b) / fall.gravity)
    c = fall.gravity * latest + (fall.a - fall.b) * abs(fall.omega)
    t, steps, gap = 0.0, 0, 1.0
    while gap > 1e-10:
        gap = fall.z - fall.gravity * t**2 / 2 - fall.at(fall.theta + fall.omega * t)[0]
        t, steps = t + gap / c, steps + 1
    assert steps <= 10 and bool(course.mark("7.2", t))
