"""Sliding, flight, rest and events, read back from the pictures that show them."""

import dataclasses
import itertools
import math
from typing import Any

import numpy as np
import pytest
import rolling_ellipse as rl
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.text import Annotation
from oracles.curves import data, legend_of, new_axes, seen, two_axes
from oracles.pictures import figure_of, legend_in, outline, support
from rolling_ellipse._pictures import sampling

EPS = np.finfo(float).eps
SCENES = {
    "jump": rl.scenes.jump,  # rolls, slides, flies, hits the ground and rolls again
    "slope": rl.scenes.slope,  # slips three times, jumps twice
    "slip": rl.scenes.slip,  # slides first
    "bounce": rl.scenes.bounce,  # only flight, with ten impacts
    "backwards": rl.Scene(2.0, 1.0, omega=-5.2, friction=1.0),
    "settling": rl.Scene(2.0, 1.0, z=1.5, restitution=0.5, friction=0.5),  # many impacts, rest
}
COUNTED = {SCENES["bounce"]: ["10 impacts"], SCENES["settling"]: ["21 events"]}  # in 6 s
NAMES = {rl.Mode.SLIDING: "sliding", rl.Mode.FLIGHT: "flight", rl.Mode.REST: "rest"}


@pytest.fixture(params=list(SCENES.values()), ids=list(SCENES))
def motion(request: pytest.FixtureRequest) -> rl.Trajectory:
    return rl.simulate(request.param, 6.0)


@pytest.fixture
def jump() -> rl.Trajectory:
    return rl.simulate(rl.scenes.jump, 3.0)


def drawn(ax: Axes) -> Axes:
    """The axes, once their figure is drawn and laid out."""
    FigureCanvasAgg(figure_of(ax)).draw()
    return ax


def event_names(ax: Axes) -> list[Annotation]:
    return [text for text in ax.texts if isinstance(text, Annotation)]


def boxes_of(shade: Any) -> list[tuple[float, float, float, float]]:
    """Left, right, bottom and top of the rectangles of a shade."""
    ends = ((*path.vertices.min(axis=0), *path.vertices.max(axis=0)) for path in shade.get_paths())
    return [(left, right, bottom, top) for left, bottom, right, top in ends]


def shades_of(marks: tuple[Any, ...]) -> list[Any]:
    return [mark for mark in marks
            if type(mark) is not LineCollection and hasattr(mark, "get_hatch")]  # fmt: skip


def lines_of(marks: tuple[Any, ...]) -> list[list[float]]:
    """Times of the dotted lines of each motion."""
    found = [mark for mark in marks if type(mark) is LineCollection]
    return [[float(segment[0, 0]) for segment in mark.get_segments()] for mark in found]


# ------------------------------------------------------------------------------ over time


def test_every_sample_lies_in_the_shading_of_its_mode(motion: rl.Trajectory) -> None:
    shown = rl.plot_energy(motion, ax=new_axes())
    looks = {}
    for shade in shades_of(shown.marks):
        for left, right, bottom, top in boxes_of(shade):
            assert (bottom, top) == (0, 1)
            inside = (left < motion.t) & (motion.t < right)
            (mode,) = set(motion.mode[inside]) or {None}
            looks[mode] = (shade.get_hatch(), tuple(shade.get_facecolor()[0]))
    assert set(looks) - {None} == set(motion.mode) - {rl.Mode.ROLLING}
    shaded = np.zeros(motion.t.size, bool)
    for left, right, *_ in itertools.chain(*map(boxes_of, shades_of(shown.marks))):
        # both ends count: the last sample is the end of the last shade
        shaded |= (left <= motion.t) & (motion.t <= right)
    assert np.array_equal(shaded[motion.mode != rl.Mode.ROLLING], np.ones(shaded.sum(), bool))
    names = [NAMES[mode] for mode in NAMES if mode in looks]
    assert legend_of(shown.ax)[3:] == names + COUNTED.get(motion.scene, [])


def test_modes_can_be_told_apart_in_greyscale(jump: rl.Trajectory) -> None:
    settling = rl.simulate(SCENES["settling"], 6.0)
    pictures = [rl.plot_energy(motion, ax=new_axes()) for motion in (jump, settling)]
    shades = [shade for shown in pictures for shade in shades_of(shown.marks)]
    hatches = {shade.get_hatch() for shade in shades}
    assert len(shades) == 4 and len(hatches) == 3  # both have flight
    for shade in shades:
        red, green, blue = to_rgb(shade.get_facecolor()[0])
        assert red == green == blue > 0.85  # a pale grey


@pytest.mark.parametrize("picture", [rl.plot_energy, rl.plot_forces, rl.plot_constraints])
def test_events_are_drawn_as_named_lines(picture: Any, motion: rl.Trajectory) -> None:
    axes = [new_axes()] if picture is rl.plot_energy else two_axes()
    shown = picture(motion, ax=axes if len(axes) > 1 else axes[0])
    moments = [event.t for event in motion.events]
    assert moments and lines_of(shown.marks) == [moments] * len(axes)
    names = event_names(axes[0])
    crowded = motion.scene in COUNTED
    assert [name.xy[0] for name in names] == ([] if crowded else moments)
    expected = [event.kind.name.lower().replace("_", "-") for event in motion.events]
    assert [name.get_text() for name in names] == ([] if crowded else expected)
    assert len(axes) == 1 or event_names(axes[1]) == []


@pytest.mark.parametrize("name", ["jump", "slope", "slip", "backwards"])
def test_event_names_overlap_neither_one_another_nor_the_curves(name: str) -> None:
    motion = rl.simulate(SCENES[name], 6.0)
    ax = drawn(rl.plot_forces(motion, ax=two_axes()).axes[0])
    names, window = event_names(ax), ax.get_window_extent()
    boxes = [name.get_window_extent() for name in names]
    for box in boxes:
        assert window.x0 <= box.x0 and box.x1 <= window.x1 + 1 and box.y1 <= window.y1
    for one, other in itertools.combinations(boxes, 2):
        assert not one.overlaps(other)
    values = np.concatenate([motion.normal_force, motion.friction_force])
    highest = ax.transData.transform([(0, values.max())])[0, 1]
    assert min(box.y0 for box in boxes) > highest


def test_event_names_are_left_out_if_there_is_no_room(jump: rl.Trajectory) -> None:
    low = rl.plot_energy(jump, ax=Figure(figsize=(3.2, 1.0)).add_subplot()).ax
    assert event_names(low) == [] and len(event_names(rl.plot_energy(jump, ax=new_axes()).ax)) == 3


def test_only_events_within_the_sampled_time_are_marked(jump: rl.Trajectory) -> None:
    slip, lift_off, impact = (event.t for event in jump.events)
    part = jump.sol(np.linspace((slip + lift_off) / 2, (lift_off + impact) / 2, 50))
    shown = rl.plot_energy(part, ax=new_axes())
    assert lines_of(shown.marks) == [[lift_off]]
    sliding, flight = shades_of(shown.marks)
    assert boxes_of(sliding)[0][:2] == pytest.approx((part.t[0], lift_off), abs=1e-15)
    assert boxes_of(flight)[0][:2] == pytest.approx((lift_off, part.t[-1]), abs=1e-15)


def test_each_of_several_motions_has_a_row_of_shading(jump: rl.Trajectory) -> None:
    slip = rl.simulate(rl.scenes.slip, 3.0)
    report = rl.simulate(rl.scenes.report, 3.0)
    shown = rl.plot_forces([jump, report, slip], ax=two_axes(), labels=["one", "two", "three"])
    upper, lower = shown.axes
    parts = ["normal", "friction", "impulse / 0.1 s"]
    assert legend_of(upper)[3:] == [*parts, "sliding", "flight"]
    rows = [[box[2:] for box in boxes_of(shade)] for shade in shades_of(shown.marks)]
    first, third = rows[0][0], rows[2][0]
    assert rows == [[first], [first], [third]] * 2  # a row for each motion
    assert 1 >= first[1] > first[0] > third[1] > third[0] > 0.8  # a gap for the second row
    assert first[0] - third[1] > third[1] - third[0]
    assert event_names(upper) == event_names(lower) == []
    assert [len(times) for times in lines_of(shown.marks)] == [3, 1] * 2


def test_a_body_that_keeps_rolling_or_resting_has_no_shading() -> None:
    for scene in (rl.scenes.report, rl.Scene(2.0, 1.0)):
        shown = rl.plot_forces(rl.simulate(scene, 2.0), ax=two_axes())
        assert shown.marks == () and legend_of(shown.axes[0]) == ["normal", "friction"]


def test_forces_vanish_in_flight_and_friction_is_mu_n_in_sliding(motion: rl.Trajectory) -> None:
    shown = rl.plot_forces(motion, ax=two_axes())
    normal, friction = (data(line)[1] for line in (shown.normal[0], shown.friction[0]))
    motion = seen(motion, shown.normal[0])
    flying, sliding = motion.mode == rl.Mode.FLIGHT, motion.mode == rl.Mode.SLIDING
    assert np.all(normal[flying] == 0) and np.all(friction[flying] == 0)
    assert np.all(normal[~flying] >= 0)
    left = sum(event.kind is rl.EventKind.LIFT_OFF for event in motion.events)
    assert np.count_nonzero(normal[~flying] == 0) <= left  # samples at lift-off
    limit = motion.scene.friction * normal[sliding]
    assert np.abs(friction[sliding]) == pytest.approx(limit, rel=1e-14)  # rounding
    assert shown.axes[0].get_ylim()[1] > 0


def test_constraints_are_shown_only_where_the_ground_enforces_them(motion: rl.Trajectory) -> None:
    upper, lower = rl.plot_constraints(motion, ax=two_axes()).lines
    values = {str(line.get_label()).split()[0]: data(line)[1] for line in (*upper, *lower)}
    motion = seen(motion, upper[0])
    flying, sliding = motion.mode == rl.Mode.FLIGHT, motion.mode == rl.Mode.SLIDING
    for name in ("gap", "f2", "df2/dt"):
        assert np.array_equal(np.isnan(values[name]), flying)
    for name in ("slip", "f1"):
        assert np.array_equal(np.isnan(values[name]), flying | sliding)
    for name in ("f3", "f4", "df3/dt", "df4/dt"):
        assert np.all(np.isfinite(values[name]))
    # the constraints hold to within a few hundred roundings
    assert max(float(np.nanmax(value, initial=0.0)) for value in values.values()) < 1e-13


def test_energy_lost_to_the_ground_does_not_count_as_an_error(motion: rl.Trajectory) -> None:
    (line,) = rl.plot_energy(motion, ax=new_axes(), kind="error").error
    error, slides = data(line)[1], seen(motion, line).mode == rl.Mode.SLIDING
    assert np.array_equal(np.isnan(error), slides & (motion.scene.friction > 0))
    assert np.nanmax(error, initial=0.0) < 32 * EPS
    if motion.scene != SCENES["bounce"]:  # its impacts are elastic
        assert motion.energy[0] - motion.energy[-1] > 1e-3 * motion.energy[0]


def test_energy_lost_in_elastic_impacts_counts_as_an_error() -> None:
    dull = rl.simulate(SCENES["bounce"].replace(friction=0.0, restitution=0.9), 6.0)
    elastic = dataclasses.replace(dull, scene=dull.scene.replace(restitution=1.0))
    for motion, least, most in ((dull, 0.0, 32 * EPS), (elastic, 0.19, 1.0)):  # 1 - 0.9^2 = 0.19
        (line,) = rl.plot_energy(motion, ax=new_axes(), kind="error").error
        assert least <= np.max(data(line)[1]) <= most


def test_the_energy_itself_is_drawn_if_any_motion_loses_some(jump: rl.Trajectory) -> None:
    report = rl.simulate(rl.scenes.report, 3.0)
    for motions, label in (([report] * 2, "relative energy error"), ([report, jump], "energy [J]")):
        assert rl.plot_energy(motions, ax=new_axes()).ax.get_ylabel() == label


def test_the_overview_marks_changes_of_contact(motion: rl.Trajectory) -> None:
    shown = rl.plot(motion, figure=Figure(figsize=(10, 8.5), layout="constrained"))
    modes = len(set(motion.mode) - {rl.Mode.ROLLING})
    assert len(shades_of(shown.marks)) == 6 * modes
    assert lines_of(shown.marks) == [[event.t for event in motion.events]] * 6
    assert shown.energy_error.get_label() == "energy"
    shown.figure.draw_without_rendering()


# ------------------------------------------------------------------------ over the ground


def test_the_strobe_shows_the_paths_and_any_contact(motion: rl.Trajectory) -> None:
    shown = rl.plot_strobe(motion, ax=new_axes(), count=37, t_end=3.0)
    at = motion.sol(np.linspace(0.0, 3.0, 37))
    contacts, slides = (np.asarray(each.get_xydata()) for each in (shown.contacts, shown.slides))
    for i, body in enumerate(shown.bodies):
        x, z = support(body)
        if at.mode[i] == rl.Mode.FLIGHT:
            assert z > -1e-12 and np.all(np.isnan(contacts[i]))
        else:
            assert contacts[i] == pytest.approx([x, 0], abs=1e-11) and abs(z) < 1e-12
        if at.mode[i] == rl.Mode.SLIDING:
            assert np.array_equal(slides[i], contacts[i])
        else:
            assert np.all(np.isnan(slides[i]))
    assert shown.slides.get_marker() != shown.contacts.get_marker()
    path = sampling.between(motion, 0.0, 3.0, 6.0)
    skid, contact = data(shown.skid_path)[0], data(shown.contact_path)[0]
    assert np.array_equal(data(shown.centre_path), [path.x, path.z])
    sliding = path.mode == rl.Mode.SLIDING
    assert np.array_equal(np.isnan(skid), ~sliding)
    assert np.array_equal(skid[sliding], path.contact_x[sliding])
    touching = np.where(path.mode == rl.Mode.FLIGHT, np.nan, path.contact_x)
    assert np.array_equal(contact, touching, equal_nan=True)
    assert ("sliding" in legend_of(shown.ax)) == bool(sliding.any())


@pytest.mark.parametrize("width", [3.2, 6.0, 10.0])
def test_the_strobe_title_does_not_overlap_its_legend(jump: rl.Trajectory, width: float) -> None:
    ax = drawn(rl.plot_strobe(jump, ax=new_axes(width, 2.4), t_end=2.0).ax)
    (title,) = ax.findobj(lambda artist: "positions" in getattr(artist, "get_text", str)())
    assert not title.get_window_extent().overlaps(legend_in(ax).get_window_extent().padded(-1))


def test_paths_mark_events_where_the_body_touches_the_ground(motion: rl.Trajectory) -> None:
    shown = rl.plot_paths(motion, ax=new_axes())
    (lines,) = shown.events
    found = {str(line.get_label()).removeprefix("_"): line for line in lines}
    expected: dict[str, list[float]] = {}
    a, b = motion.scene.a, motion.scene.b
    for event in motion.events:
        state, name = event.state_after, event.kind.name.lower().replace("_", "-")
        # lowest point of the outline (a cos s, b sin s) turned clockwise by theta
        s = math.atan2(-b * math.cos(state.theta), a * math.sin(state.theta))
        lead = a * math.cos(s) * math.cos(state.theta) + b * math.sin(s) * math.sin(state.theta)
        expected.setdefault(name, []).append(state.x + lead)
    assert list(found) == list(expected)
    for name, places in expected.items():
        x, z = data(found[name])
        assert x == pytest.approx(places, abs=1e-9) and np.all(z == 0)
    assert legend_of(shown.ax)[3:] == list(expected)
    assert len({line.get_marker() for line in lines}) == len(lines)
    touching = np.isfinite(data(shown.contacts[0])[0])
    drawn = sampling.between(motion, 0.0, float(motion.t[-1]), 6.0)
    assert np.array_equal(touching, drawn.mode != rl.Mode.FLIGHT)


def test_events_at_the_first_and_last_sample_are_marked(jump: rl.Trajectory) -> None:
    times = [event.t for event in jump.events]
    shown = rl.plot_paths(jump.sol([times[0], times[-1]]), ax=new_axes())
    marked = [np.size(line.get_xdata()) for line in shown.events[0]]
    assert sum(marked) == len(times) > 2


def test_paths_of_several_motions_mark_events_in_their_own_colours(jump: rl.Trajectory) -> None:
    slip = rl.simulate(rl.scenes.slip, 3.0)
    shown = rl.plot_paths([jump, slip], ax=new_axes(), labels=["one", "other"])
    assert [len(lines) for lines in shown.events] == [3, 1]
    for lines, centre in zip(shown.events, shown.centres, strict=True):
        assert {line.get_markeredgecolor() for line in lines} == {centre.get_color()}
    assert legend_of(shown.ax)[-4:] == ["slip", "lift-off", "impact", "stick"]


# ------------------------------------------------------------------------------ animation


def test_every_frame_shows_the_mode_of_the_body(motion: rl.Trajectory) -> None:
    animation = rl.animate(motion, width=320)
    (strip,) = animation.strips
    slip = strip.motion.constraint_residuals().slip
    for i in range(animation.t.size):
        animation.draw(i)
        mode, points = strip.motion.mode[i], outline(strip.body, 4000)
        flies, slides = mode == rl.Mode.FLIGHT, mode == rl.Mode.SLIDING
        contact, slipping = np.ravel(data(strip.contact)), np.ravel(data(strip.slip))
        assert np.isfinite(contact[0]) == (not flies) and np.isfinite(slipping[0]) == slides
        if slides:
            assert slipping == pytest.approx(contact)
            assert strip.slip.get_marker() == (">" if slip[i] > 0 else "<")
        shadow = data(strip.shadow)[0]
        if flies:  # as wide as the body; `points` miss its ends by up to 1e-6 of its size
            ends = [points[:, 0].min(), points[:, 0].max()]
            assert shadow == pytest.approx(ends, abs=4e-6)
        assert len(shadow) == (2 if flies else 0)
        said = strip.caption.get_text()
        assert said == ("flies" if flies else "slides" if slides else "")
        skidded = np.isfinite(data(strip.skid_trace)[0])
        assert np.array_equal(skidded, strip.motion.mode[: i + 1] == rl.Mode.SLIDING)


def test_the_slip_mark_points_down_the_slope() -> None:
    sliding = rl.simulate(rl.Scene(2.0, 1.0, slope=0.5, x_dot=4.0, omega=0.0, friction=0.2), 0.1)
    (strip,) = rl.animate(sliding).strips
    # matplotlib gives no public access to the shape of a marker
    marker = strip.slip._marker  # type: ignore[attr-defined]
    head, *base = marker.get_transform().transform(marker.get_path().vertices[:3])
    pointing = head - np.mean(base, axis=0)
    downhill = [math.cos(0.5), -math.sin(0.5)]
    assert pointing / np.linalg.norm(pointing) == pytest.approx(downhill, abs=1e-12)


def test_contact_slip_and_flight_can_be_told_apart_in_greyscale(jump: rl.Trajectory) -> None:
    """The marks are white, black and a grey between these. A difference of a fifth of the scale is
    clearly visible."""
    (strip,) = rl.animate(jump).strips
    colours = (strip.contact.get_markerfacecolor(), strip.slip.get_markerfacecolor(),
               strip.shadow.get_color())  # fmt: skip
    rolling, sliding, shadow = (np.dot(to_rgb(each), (0.21, 0.72, 0.07)) for each in colours)
    assert rolling - shadow > 0.2 and shadow - sliding > 0.2


def test_losses_are_split_into_rolling_sliding_and_impacts() -> None:
    """The three losses add up to the total loss. The loss in impacts is the sum over the events,
    and without rolling resistance no energy is lost in rolling."""
    falls = rl.Scene(
        2.0, 1.0, theta=0.5, z=3.0, omega=2.0, x_dot=1.5, friction=0.25, restitution=0.5,
        rolling_resistance=0.04,
    )  # fmt: skip
    motion = rl.simulate(falls, np.linspace(0.0, 12.0, 1201))
    shown = rl.plot_energy(motion, ax=new_axes(), kind="losses")
    rolling, sliding, impacts = (data(line[0])[1][-1] for line in shown.lost)
    assert rolling + sliding + impacts == pytest.approx(motion.energy[0] - motion.energy[-1])
    assert min(rolling, sliding, impacts) > 1
    hits = [each for each in motion.events if each.kind is rl.EventKind.IMPACT]
    lost = sum(each.energy_before - each.energy_after for each in hits)
    assert impacts == pytest.approx(lost)
    free = rl.simulate(falls.replace(rolling_resistance=0.0), 12.0)
    plain = rl.plot_energy(free, ax=new_axes(), kind="losses")
    assert np.abs(data(plain.lost[0][0])[1]).max() < 1e-12 * motion.energy[0]


def test_rolling_with_resistance_shows_its_loss_and_no_energy_error() -> None:
    rocks = rl.Scene(2.0, 1.0, theta=0.5, friction=1.0, rolling_resistance=0.02)
    motion = rl.simulate(rocks, 40.0)
    shown = motion.plot(figure=Figure())
    assert shown.lost_energy is not None
    lost = data(shown.lost_energy)[1][-1]
    assert lost == pytest.approx(motion.energy[0] - motion.energy[-1])
    assert not np.isfinite(data(shown.energy_error)[1]).any()
    labels = [line.get_label() for line in rl.plot_phase(motion, ax=new_axes()).separatrices]
    assert labels == ["separatrix without resistance"]
    free = rl.simulate(rocks.replace(rolling_resistance=0.0), 4.0).plot(figure=Figure())
    assert free.lost_energy is None
