"""Objects print with units and with the names of codes. Their HTML sets no colours."""

import copy
import dataclasses
import io
import json
import pickle
import re
from collections.abc import Callable
from html.parser import HTMLParser
from itertools import chain
from operator import eq, ne
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rolling_ellipse as rl
from oracles.pickles import fitted
from rolling_ellipse._motion.events import Events

SCENES = {name: getattr(rl.scenes, name) for name in rl.scenes.__all__}
RACE = Path(__file__).parents[2] / "docs" / "data" / "peers_R_1.37.json"
WEIRD = rl.Scene(
    3e-20, 2e-17, mass=1e30, gravity=1e-30, inertia=1e-5, slope=-1.5, friction=0.0, theta=1e50,
    omega=-0.0, x=-1e50,
)  # fmt: skip


def sliding() -> Events:
    """The 54 events of a body that moves down a slope for 30 s."""
    return rl.simulate(rl.scenes.slope, 30.0).events


LISTED: dict[str, Callable[[], Any]] = {
    "scene": lambda: rl.scenes.report,
    "weird scene": lambda: WEIRD,
    "state": lambda: rl.scenes.report.initial_state,
    "certificate": lambda: rl.certify(rl.scenes.jump),
    "no proof": lambda: rl.certify(rl.scenes.drop),
    "downhill": lambda: rl.certify(rl.scenes.slope),
    "thresholds": lambda: rl.thresholds(2.0, 1.0, friction=3.0),
    "thresholds of a circle": lambda: rl.thresholds(1.0, 1.0),
    "fit": fitted,
}
each_listed = pytest.mark.parametrize("make", LISTED.values(), ids=LISTED)


class Reader(HTMLParser):
    """Parser of table cells. Elements must be closed in order and must not set colours."""

    def __init__(self, html: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.cells: list[str] = []
        self.feed(html)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.open.append(tag)
        assert not any("color" in (value or "").replace("currentColor", "") for _, value in attrs)
        if tag in ("td", "th"):
            self.cells.append("")

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        if self.open[-1] in ("td", "th"):
            self.cells[-1] += data


@pytest.mark.parametrize("kind", [rl.Outcome, rl.Mode, rl.EventKind, rl.Validity])
def test_codes_print_their_names(kind: Any) -> None:
    for each in kind:
        name = f"{kind.__name__}.{each.name}"
        assert str(each) == repr(each) == f"{each}" == name and str([each]) == f"[{name}]"
        assert f"{each:>30}" == name.rjust(30)
        assert eval(repr(each), vars(rl)) is each
    assert f"{rl.Outcome.ROLLS_OVER:d}" == "2" and int(rl.Outcome.ROLLS_OVER) == 2


@pytest.mark.parametrize("kind", [rl.Outcome, rl.Mode, rl.EventKind, rl.Validity, rl.Status])
def test_members_equal_only_their_names_and_codes(kind: Any) -> None:
    coded = issubclass(kind, int)
    for each in kind:
        for other in (each.name, np.str_(each.name), each, kind[each.name], copy.copy(each)):
            assert eq(each, other) and eq(other, each) and not ne(each, other) | ne(other, each)
        for other in (each.name.lower(), f"{each.name} ", None, 1.5, b"SLIP", object()):
            assert ne(each, other) and ne(other, each) and not eq(each, other) | eq(other, each)
        assert [one == each for one in kind].count(True) == 1
        assert pickle.loads(pickle.dumps(each)) is copy.deepcopy(each) is each
        assert hash(each) == hash(each.value if coded else each.name)
        assert ({each.name: 7}.get(each) == 7) != coded and {each: 7}[each] == 7
        if coded:
            codes = np.array([each, *kind])
            assert json.dumps([each]) == f"[{each.value}]" and codes.dtype.kind == "i"
            assert each == each.value == np.int8(each.value) == each and not ne(each, np.int8(each))
            assert (codes == each).sum() == (each == codes).sum() == 2
    members = np.array(list(kind))
    if not coded:
        assert [(members == each.name).sum() for each in kind] == [1] * len(kind)


def test_public_objects_are_immutable() -> None:
    public = (vars(each).values() for each in (rl.benchmark, rl.impacts, rl.course, rl.report))
    named = (getattr(rl, name) for name in rl.__all__)
    kinds = [each for each in (*named, *chain(*public)) if isinstance(each, type)]
    kinds = [each for each in kinds if dataclasses.is_dataclass(each)]
    assert len(kinds) > 25
    for kind in kinds:
        with pytest.raises(dataclasses.FrozenInstanceError):
            setattr(object.__new__(kind), dataclasses.fields(kind)[0].name, None)


REPORT, JUMP = rl.scenes.report, rl.simulate(rl.scenes.jump, 2.0)


@pytest.mark.parametrize(
    ("word", "call"),
    [
        ("lift_off", lambda word: JUMP.when(event=word)),
        ("roll_over", lambda word: JUMP.when(event=word)),
        ("rolling", lambda word: rl.simulate(REPORT, 1.0, model=word).x),
        ("dop853", lambda word: rl.simulate(REPORT, 1.0, method=word).x),
        ("baumgarte", lambda word: rl.simulate(REPORT, 1.0, model="multipliers",
                                               stabilization=word).x),
        ("poisson", lambda word: rl.impacts.collide(0.3, 1, -2, 1, a=2, b=1, friction=1,
                                                    restitution=0.5, law=word)),
        ("rest", lambda word: rl.required_friction(rl.Scene(2.0, 1.0, slope=0.1), to=word)),
        ("x", lambda word: rl.simulate_many([REPORT], 1.0, returns=word)[word.lower()]),
        ("omega", lambda word: JUMP.sensitivity(wrt=word).state),
        ("corrected", lambda word: rl.report.simulate(
            *rl.kinematics(0.3, 1.0, a=2.0, b=1.0), a=2.0, b=1.0, t=1.0, equations=word).t),
        ("roll.rock", lambda word: rl.benchmark.problem(word).times),
    ],
)  # fmt: skip
def test_words_are_accepted_in_upper_or_lower_case(word: str, call: Callable[[str], Any]) -> None:
    for typed in (word.upper(), word.title()):
        assert np.array_equal(call(typed), call(word))


@pytest.mark.parametrize("encoding", ["ascii", "latin-1", "cp1252", "cp437", "utf-8"])
def test_a_console_of_any_encoding_shows_everything(encoding: str, monkeypatch: Any) -> None:
    found, console = sliding(), io.TextIOWrapper(io.BytesIO(), encoding=encoding)
    monkeypatch.setattr("sys.stdout", console)
    print(*(make() for make in LISTED.values()), found, *found[:2], *rl.report.errata())
    print(found[:1], [fitted()], rl.WorkPrecision.load(RACE).verdict(), rl.benchmark.problem("jam"))
    print(rl.fit_motion(JUMP.t, JUMP.x, scene=JUMP.scene, free="omega", sigma=1e-3), repr(JUMP))
    console.seek(0)
    shown = console.read()
    arrow, marks = ("→", "…±×µ") if encoding == "utf-8" else ("->", "")
    assert f"ROLLING {arrow} SLIDING" in shown and all(mark in shown for mark in marks)
    assert "\\u" not in shown and ("x_ddot" in shown) == (encoding != "utf-8")


@each_listed
def test_text_and_html_show_the_same_content(make: Callable[[], Any]) -> None:
    found = make()
    html = Reader(found._repr_html_())
    lines = str(found).splitlines()
    assert lines[0] == type(found).__name__ and len(lines) == 1 + len(html.cells) // 2
    for line, name, value in zip(lines[1:], html.cells[::2], html.cells[1::2], strict=True):
        assert re.fullmatch(rf"{re.escape(name)} +{re.escape(value)}", line)


@each_listed
def test_every_repr_fits_on_one_line(make: Callable[[], Any]) -> None:
    text = repr(make())
    assert "\n" not in text and len(text) < 420 and " object at 0x" not in text


@each_listed
def test_values_are_compared_by_content(make: Callable[[], Any]) -> None:
    one, other = make(), make()
    _ = one._repr_html_()  # cached values are not compared
    for same in (other, copy.deepcopy(one), pickle.loads(pickle.dumps(one))):
        assert one == same and hash(one) == hash(same)
    for thing in (None, repr(one), rl.thresholds(3.0, 1.0), rl.Scene(1.0, 1.0)):
        assert one != thing


def test_objects_with_different_fields_are_unequal() -> None:
    things: Any = (rl.certify(rl.scenes.jump), rl.thresholds(2.0, 1.0), sliding()[3], fitted())
    for made in things:
        for field in filter(lambda each: each.init, dataclasses.fields(made)):
            if field.name in ("measured", "predicted", "covariance"):
                continue  # these fields are not compared
            value = np.zeros(2) if field.name == "errors" else -7.0
            assert dataclasses.replace(made, **{field.name: value}) != made, field.name
    assert sliding() == sliding() and sliding()[:3] != sliding()[:4]


def test_a_scene_shows_its_arguments_and_derived_quantities() -> None:
    assert repr(rl.scenes.circle) == "Scene(a=1.0, b=1.0, omega=2.0)"
    assert str(rl.scenes.report).splitlines()[1:] == [
        "a        2 m",
        "b        1 m",
        "mass     10 kg",
        "impulse  (0, -48) N s at (1.5, 0) m from the centre",
        "start    on the ground, rolling, omega = 3.2 rad/s after the blow",
    ]
    starts = {
        "drop": "in the air", "slip": "on the ground, sliding", "rocking": "on the ground, rolling"
    }  # fmt: skip
    for name, start in starts.items():
        assert str(SCENES[name]).endswith(f"  {start}")
    assert str(rl.Scene(2.0, 1.0)).endswith("  on the ground, at rest")
    assert "restitution  1\n" in str(rl.scenes.bounce)


def test_values_are_printed_with_their_units() -> None:
    bounds = rl.thresholds(2.0, 1.0, gyration2=0.0435, friction=0.505)  # a body that may jam
    lines = dict(line.split(None, 1) for line in str(bounds).splitlines()[1:])
    assert lines["roll_over_speed"] == f"{bounds.roll_over_speed:.6g} rad/s"
    assert lines["tip_rate"] == f"{bounds.tip_rate:.6g} 1/s"
    assert lines["friction_to_roll_over"] == f"{bounds.friction_to_roll_over:.6g}"
    (low, high), *_ = bounds.jam_speeds
    assert lines["jam_speeds"].startswith(f"{low:.6g} to {high:.6g}")
    assert lines["jam_speeds"].endswith("rad/s")
    circle = rl.thresholds(1.0, 1.0)
    assert re.search(r"^contact_loss_angle +none$", str(circle), re.MULTILINE)
    assert re.search(r"^jam_speeds +none$", str(circle), re.MULTILINE)


def test_html_is_escaped() -> None:
    found = rl.Certificate(rl.Validity.VALID, 1.0, 0.0, None, None, None, '<b>&"bold"</b>')
    html = found._repr_html_()
    assert "<b>" not in html and Reader(html).cells[-1] == '<b>&"bold"</b>'


def test_events_are_a_tuple_that_prints_as_a_table() -> None:
    events = sliding()
    assert isinstance(events, tuple) and type(events) is Events and len(events) == 54
    assert events == tuple(events) and hash(events) == hash(tuple(events))
    lines = repr(events).splitlines()
    assert lines[0] == "54 events"
    assert lines[1].split("  ")[0] == "t [s]" and lines[1].endswith("what changes")
    assert len(lines) == 2 + 12 + 1 + 4 and len(repr(events)) < 2500
    assert lines[14].split() == ["…", "and", "38", "more"]
    for line, event in zip(lines[2:14] + lines[15:], events[:12] + events[-4:], strict=True):
        t, kind, theta, x, *_ = line.split()
        assert kind == event.kind.name and float(t) == pytest.approx(event.t, rel=1e-8)
        assert float(theta) == pytest.approx(event.state_after.theta, rel=1e-5)
        assert float(x) == pytest.approx(event.state_after.x, rel=1e-5)
        before, after = event.state_before.mode.name, event.state_after.mode.name
        assert f"{before} → {after}" in line


def test_the_repr_of_an_impact_shows_its_effect() -> None:
    hit = next(each for each in sliding() if each.kind is rl.EventKind.IMPACT)
    row = repr(hit)
    assert row.startswith(f"<Event IMPACT at t = {hit.t:.9g} s, theta = ")
    after = hit.state_after
    impulse = f"{after.reaction_x:.4g} N s along, {after.reaction_z:.4g} N s up"
    assert row.endswith(f", {impulse}, {after.energy_lost:.4g} J lost>")


@pytest.mark.parametrize(("count", "rows"), [(0, 0), (1, 1), (16, 16), (17, 17), (18, 17)])
def test_rows_are_omitted_only_if_that_shortens_the_table(count: int, rows: int) -> None:
    events = sliding()[:count]
    assert type(events) is Events
    cells = Reader(events._repr_html_()).cells
    assert len(cells) == 5 + 5 * rows
    assert (f"and {count - 16} more" in cells) == (count == 18)
    if count == 0:
        assert repr(events) == "no events"
    if count == 1:
        assert repr(events).splitlines()[0] == "1 event"


def test_slices_and_copies_of_events_are_events() -> None:
    events = sliding()
    assert type(events[3:9:2]) is Events and events[3:9:2] == tuple(events)[3:9:2]
    assert events[-1] is tuple(events)[-1]
    for again in (copy.copy(events), copy.deepcopy(events), pickle.loads(pickle.dumps(events))):
        assert type(again) is Events and again == events


def test_a_dataframe_of_events_has_all_columns_of_their_table() -> None:
    events, none = sliding(), Events().to_dataframe()
    frame = events.to_dataframe()
    for name, values in events.table.items():
        if not name.startswith(("kind", "mode")):
            assert np.array_equal(frame[name], values), name
    assert list(frame["kind"]) == [each.kind.name for each in events]
    assert list(frame["mode_after"]) == [each.state_after.mode.name for each in events]
    units = frame.attrs["units"]
    assert set(units) == set(frame.columns)
    assert (units["t"], units["omega_before"], units["reaction_x"]) == ("s", "rad/s", "N s")
    assert list(none.columns) == list(frame.columns) and len(none) == 0
    assert none["t"].dtype == frame["t"].dtype == float


def test_infinite_friction_is_not_given_as_the_reason_of_a_slip() -> None:
    """With infinite friction, the slip just before a lift-off has another reason."""
    events = rl.simulate(rl.Scene(2.0, 1.0, omega=5.2), 1.0).events
    kinds = [each.kind for each in events]
    assert kinds[:2] == [rl.EventKind.SLIP, rl.EventKind.LIFT_OFF]
    assert "pull" in events[0].state_after.reason
    limited = rl.simulate(rl.scenes.jump, 1.0).events[0]
    assert "friction can no longer hold" in limited.state_after.reason


MOTIONS = {
    **SCENES,
    "steep": rl.Scene(2.0, 1.0, slope=1.4, friction=0.8, omega=3.0),
    "far": rl.Scene(2.0, 1.0, omega=3.2, x=1e9),
    "high": rl.Scene(2.0, 1.0, z=1e5, omega=3.2, x_dot=5.0),
    "a needle": rl.Scene(1e-3, 1.0, theta=1.0, omega=3.0),
    "uphill": rl.Scene(1.0, 2.0, slope=-0.3, omega=3.0),
}


def drawn(motion: rl.Trajectory) -> tuple[list[float], list[tuple[float, ...]], list[float]]:
    """Width and height of a picture; x, y and rotation [deg] of its bodies; their semi-axes."""
    html = motion._repr_html_()
    Reader(html)
    view = re.search(r'viewBox="0 0 (\S+) (\S+)"', html)
    ellipse = re.search(r'<ellipse rx="(\S+)" ry="(\S+)"', html)
    assert view and ellipse
    places = re.findall(r'"translate\((\S+) (\S+)\) rotate\((\S+)\)"', html)
    size, axes = (list(map(float, match.groups())) for match in (view, ellipse))
    return size, [tuple(map(float, each)) for each in places], axes


@pytest.mark.parametrize("scene", MOTIONS.values(), ids=MOTIONS)
def test_the_html_of_a_motion_has_a_picture_of_its_body(scene: rl.Scene) -> None:
    motion = rl.simulate(scene, 3.0)
    html = motion._repr_html_()
    assert 2500 < len(html) < 6000 and repr(motion)[1:-1] in html
    (width, height), places, axes = drawn(motion)
    assert 30 < width <= 480 and 15 < height <= 180 and len(places) == 9
    for x, y, _ in places:  # positions are rounded to 0.1 px
        assert max(axes) - 0.1 <= x <= width - max(axes) + 0.1
        assert max(axes) - 0.1 <= y <= height - min(axes) + 0.1


def test_the_body_is_drawn_at_its_sampled_positions() -> None:
    """Positions are rounded to 0.1 pixels, and clockwise rotations are clockwise in the picture."""
    motion = rl.simulate(rl.scenes.report, 3.0)
    _, places, (rx, ry) = drawn(motion)
    assert rx == pytest.approx(2 * ry, rel=0.01)  # a = 2 b
    at = motion.sol(np.linspace(0.0, 3.0, 9))
    scale = rx / 2.0  # pixels per metre; rounding rx gives a relative error of up to 0.05/rx
    for (x, y, turn), centre, z, theta in zip(places, at.x, at.z, at.theta, strict=True):
        allowed = 0.1 + 0.05 / rx * scale * abs(centre)
        assert abs((x - places[0][0]) - scale * centre) <= allowed
        assert abs((places[0][1] - y) - scale * (z - 1.0)) <= allowed
        assert turn == pytest.approx(np.degrees(theta), abs=0.06)


def test_the_ground_of_a_slope_is_drawn_at_its_true_angle() -> None:
    """The first line is the ground: about 400 pixels long, with ends rounded to 0.1 pixels."""
    html = rl.simulate(rl.scenes.slope, 3.0)._repr_html_()
    ground = re.search(r'points="(\S+) (\S+) (\S+) (\S+)"', html)
    assert ground
    x0, y0, x1, y1 = map(float, ground.groups())
    assert x1 > x0 + 300 and (y1 - y0) / (x1 - x0) == pytest.approx(np.tan(0.1), abs=0.1 / 300)


@pytest.mark.parametrize("t", [[0.0, 1e9], [1e9], 0.0, [0.0, 1e-300]])
def test_a_motion_with_few_samples_still_has_a_picture(t: Any) -> None:
    motion = rl.simulate(rl.scenes.rolling, t)
    assert len(drawn(motion)[1]) in (1, 9)


BOUNCES_AWAY = rl.Scene(1.0, 1e-3, theta=3.54, omega=-1e-3, slope=-1.5, restitution=1.0)


@pytest.mark.parametrize(
    ("scene", "t", "most"),
    [(BOUNCES_AWAY, np.linspace(1e60, 2e60, 15), 10_000), (rl.scenes.bounce, [5.0], 1)],
    ids=["too far away", "no samples"],
)
def test_a_motion_without_visible_samples_has_no_picture(
    scene: rl.Scene, t: Any, most: int
) -> None:
    """Bounces down a steep slope grow until neighbouring doubles of x are farther apart than the
    length of the body."""
    motion = rl.simulate(scene, t, max_events=most, raise_on_failure=False)
    html = motion._repr_html_()
    Reader(html)
    assert "<svg" not in html and motion.status.name in html
    assert ("at the end" in html) == (motion.t.size > 0)
