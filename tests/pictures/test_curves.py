"""The pictures of one motion or several, read back from their artists."""

import dataclasses
import itertools
import math
from collections.abc import Callable, Iterator
from types import SimpleNamespace
from typing import Any

import matplotlib
import numpy as np
import pytest

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import rolling_ellipse as rl
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.text import Text
from numpy.typing import NDArray
from oracles.pictures import ORDINARY_SCENES
from rolling_ellipse._pictures import ground as drawing
from rolling_ellipse._pictures.labels import labels_of
from rolling_ellipse._pictures.styles import styles_of

Array = NDArray[np.float64]
PICTURES = {
    "phase": rl.plot_phase,
    "forces": rl.plot_forces,
    "energy": rl.plot_energy,
    "constraints": rl.plot_constraints,
    "paths": rl.plot_paths,
}
TWO_PANELS = (rl.plot_forces, rl.plot_constraints)
OVER_TIME = (rl.plot_forces, rl.plot_energy, rl.plot_constraints)


@pytest.fixture(params=PICTURES.values(), ids=PICTURES.keys())
def picture(request: pytest.FixtureRequest) -> Callable[..., Any]:
    return request.param


@pytest.fixture(params=ORDINARY_SCENES.values(), ids=ORDINARY_SCENES.keys())
def trajectory(request: pytest.FixtureRequest) -> rl.Trajectory:
    return rl.simulate(request.param, 4.0, model="rolling")


@pytest.fixture
def report() -> rl.Trajectory:
    return rl.simulate(rl.scenes.report, 6.0)


@pytest.fixture
def several(report: rl.Trajectory) -> list[rl.Trajectory]:
    return [report, drifting(report, 1e-3), drifting(report, -2e-2)]


@pytest.fixture(autouse=True)
def nothing_left_open() -> Iterator[None]:
    """A picture drawn where it was told leaves pyplot alone."""
    yield
    assert plt.get_fignums() == []


def drifting(motion: rl.Trajectory, rate: float) -> rl.Trajectory:
    """A motion that grows faster than it should."""
    grown = 1 + rate * motion.t
    return dataclasses.replace(motion, theta=motion.theta * grown, omega=motion.omega * grown)


def rough(motion: rl.Trajectory, friction: float) -> rl.Trajectory:
    return dataclasses.replace(motion, scene=dataclasses.replace(motion.scene, friction=friction))


def new_axes(width: float = 6.0, height: float = 4.0) -> Axes:
    return Figure(figsize=(width, height), layout="constrained").add_subplot()


def two_axes(width: float = 6.0, height: float = 5.0) -> list[Axes]:
    return list(Figure(figsize=(width, height), layout="constrained").subplots(2, sharex=True))


def legend_of(ax: Axes) -> list[str]:
    legend = ax.get_legend()
    return [] if legend is None else [text.get_text() for text in legend.get_texts()]


def data(line: Line2D) -> tuple[Array, Array]:
    x, y = line.get_data()
    return np.asarray(x), np.asarray(y)


# ------------------------------------------------------------------------------- every picture


def test_nothing_to_draw_is_refused(picture: Callable[..., Any], report: rl.Trajectory) -> None:
    none = np.empty(0)
    empty = dataclasses.replace(report, t=none, theta=none, omega=none, x=none)
    for wrong in (empty, [report, empty]):
        with pytest.raises(ValueError, match="every trajectory must have samples"):
            picture(wrong, ax=new_axes())
    with pytest.raises(ValueError, match=r"trajectories must .*, got none"):
        picture([], ax=new_axes())
    with pytest.raises(TypeError, match=r"trajectories must .*, got 3"):
        picture(3, ax=new_axes())
    with pytest.raises(TypeError, match=r"trajectories must .*, got 'b'"):
        picture([report, "b"], ax=new_axes())


def test_every_motion_has_its_name(
    picture: Callable[..., Any], several: list[rl.Trajectory]
) -> None:
    ax = new_axes()
    picture(several, ax=ax, labels=["one", "two", "three"])
    assert legend_of(ax)[:3] == ["one", "two", "three"]
    with pytest.raises(ValueError, match="labels"):
        picture(several, ax=new_axes(), labels=["one"])


def test_without_labels_the_name_is_what_differs(
    picture: Callable[..., Any], several: list[rl.Trajectory]
) -> None:
    several[1] = dataclasses.replace(several[1], method="another")
    ax = new_axes()
    picture(several, ax=ax)
    assert legend_of(ax)[:3] == labels_of(several, None)


def test_names_say_what_differs(report: rl.Trajectory) -> None:
    faster = dataclasses.replace(report, scene=dataclasses.replace(report.scene, omega=3.2))
    other = dataclasses.replace(report, method="rk4")
    for motions, names in (
        ([report, other], ["exact", "rk4"]),
        ([report, faster], ["omega = 0 rad/s", "omega = 3.2 rad/s"]),
        ([report, report, report], ["1", "2", "3"]),
    ):
        ax = new_axes()
        rl.plot_phase(motions, ax=ax)
        assert legend_of(ax)[:-1] == names


def test_one_motion_needs_no_name(picture: Callable[..., Any], report: rl.Trajectory) -> None:
    ax = new_axes()
    picture(report, ax=ax, labels=["mine"])
    assert "mine" not in legend_of(ax)


def test_many_motions_are_named_now_and_then(
    picture: Callable[..., Any], report: rl.Trajectory
) -> None:
    ax = new_axes()
    picture([report] * 20, ax=ax, labels=[f"motion {i}" for i in range(20)])
    named = [text for text in legend_of(ax) if text.startswith("motion")]
    assert len(named) == 8 and named[0] == "motion 0" and named[-1] == "motion 19"


def test_a_picture_of_its_own(picture: Callable[..., Any], report: rl.Trajectory) -> None:
    shown = picture(report)
    ax = shown.ax if hasattr(shown, "ax") else shown.axes[0]
    assert plt.get_fignums() == [ax.figure.number]
    assert len(ax.figure.axes) == (2 if picture in TWO_PANELS else 1)
    plt.close(ax.figure)


@pytest.mark.parametrize("span", [0.0, 1e-6, 1e4])
def test_any_span_and_a_single_sample(picture: Callable[..., Any], span: float) -> None:
    trajectory = rl.simulate(rl.scenes.rolling, span)
    ax = new_axes()
    picture([trajectory, trajectory], ax=ax)
    ax.figure.draw_without_rendering()


@pytest.mark.parametrize("scene", [rl.Scene(2.0, 1.0), rl.Scene(1.0, 1.0)])
def test_a_body_at_rest(picture: Callable[..., Any], scene: rl.Scene) -> None:
    ax = new_axes()
    picture(rl.simulate(scene, 1.0), ax=ax)
    ax.figure.draw_without_rendering()


@pytest.fixture(params=["one", "several", "thin"])
def crowd(
    request: pytest.FixtureRequest, report: rl.Trajectory, several: list[rl.Trajectory]
) -> list[rl.Trajectory]:
    thin = rl.simulate(rl.scenes.thin, np.linspace(0.0, 4.0, 4001))
    return {"one": [rough(report, 0.5)], "several": several, "thin": [thin]}[request.param]


@pytest.mark.parametrize("panels", [1, 2])
def test_nothing_overlaps_at_320_by_240(
    picture: Callable[..., Any], crowd: list[rl.Trajectory], panels: int
) -> None:
    if panels == 2 and picture not in TWO_PANELS:
        panels = 1
    axes = two_axes(3.2, 2.4) if panels == 2 else [new_axes(3.2, 2.4)]
    names = ["rolling, exact", "multipliers, dop853", "multipliers, rk4"][: len(crowd)]
    picture(crowd, ax=axes if panels == 2 else axes[0], labels=names)
    axes[0].figure.draw(FigureCanvasAgg(axes[0].figure).get_renderer())
    boxes = []
    for ax in axes:
        window = ax.get_window_extent()
        # versions of matplotlib differ by a pixel in the height of letters, and so of what is left
        assert window.width > 160 and window.height > 85 / panels**2
        parts = [ax.xaxis.label, ax.yaxis.label, ax.get_legend(), *tick_labels(ax)]
        boxes += [window, *(part.get_window_extent() for part in parts if part is not None)]
    for box in boxes:  # within half a pixel, to which the layout rounds
        assert min(box.x0, box.y0) > -0.5 and box.x1 < 320.5 and box.y1 < 240.5
    full = [box.padded(-0.5) for box in boxes if min(box.width, box.height) > 1]
    assert not any(one.overlaps(other) for one, other in itertools.combinations(full, 2))


def tick_labels(ax: Axes) -> list[Text]:
    """Those that are drawn: matplotlib keeps some beyond the limits as well."""
    labels: list[Text] = []
    for axis in (ax.xaxis, ax.yaxis):
        low, high = sorted(axis.get_view_interval())
        ticks = [tick for tick in axis.get_major_ticks() if low <= tick.get_loc() <= high]
        labels += [tick.label1 for tick in ticks if tick.label1.get_visible()]
    return labels


def test_motions_differ_in_lightness_and_dashes(report: rl.Trajectory) -> None:
    for count in range(2, 6):
        styles = styles_of([report] * count, None)
        for one, other in itertools.combinations(styles, 2):
            # two greys 10 apart in L* of 100 are told apart at a glance
            assert abs(lightness(one.colour) - lightness(other.colour)) > 10
            assert one.dash != other.dash and one.marker != other.marker
    shades = [lightness(style.colour) for style in styles_of([report] * 12, None)]
    assert np.all(np.diff(shades) < -2)


def lightness(colour: str) -> float:
    """CIE L* of a colour (IEC 61966-2-1 for sRGB)."""
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in to_rgb(colour)]
    return float(116 * np.cbrt(np.dot(linear, (0.2126, 0.7152, 0.0722))) - 16)


# ------------------------------------------------------------------------------ time axes


@pytest.mark.parametrize("picture", OVER_TIME)
def test_events_are_dotted_lines(picture: Callable[..., Any], report: rl.Trajectory) -> None:
    events = tuple(SimpleNamespace(t=t, kind="slip") for t in (1.5, 4.0))
    shown = picture(dataclasses.replace(report, kept_events=events), ax=new_axes())
    (mark,) = shown.marks
    assert [segment[0, 0] for segment in mark.get_segments()] == [1.5, 4.0]


@pytest.mark.parametrize("picture", OVER_TIME)
def test_time_that_is_not_valid_has_grey_ground(
    picture: Callable[..., Any], report: rl.Trajectory
) -> None:
    assert picture(report, ax=new_axes()).marks == ()
    half = dataclasses.replace(report, valid_until=2.5)
    (ground,) = picture(half, ax=new_axes()).marks
    assert (ground.get_x(), ground.get_x() + ground.get_width()) == (2.5, 6.0)
    ground, start = picture([report, half], ax=new_axes()).marks
    assert ground.get_x() == 2.5 and list(start.get_xdata()) == [2.5, 2.5]


@pytest.mark.parametrize("picture", [rl.plot_phase, rl.plot_paths])
def test_paths_that_are_not_valid_have_grey_ground(
    picture: Callable[..., Any], report: rl.Trajectory
) -> None:
    assert picture(report, ax=new_axes()).marks == ()
    half = dataclasses.replace(report, valid_until=2.5)
    (ground,) = picture(half, ax=new_axes()).marks
    assert np.array_equal(np.isfinite(data(ground)[1]), report.t >= 2.5)


# --------------------------------------------------------------------------------- plot_phase


def test_phase_is_the_trajectory(trajectory: rl.Trajectory) -> None:
    shown = rl.plot_phase(trajectory, ax=new_axes(), fold=False)
    theta, omega = data(shown.motions[0])
    assert np.array_equal(theta, trajectory.theta) and np.array_equal(omega, trajectory.omega)
    assert data(shown.starts[0]) == (trajectory.theta[:1], trajectory.omega[:1])


@pytest.mark.parametrize(("a", "b"), [(2.0, 1.0), (0.7, 1.9), (2.0, 0.02)])
def test_separatrix_is_between_rocking_and_rolling_over(a: float, b: float) -> None:
    shown = rl.plot_phase(rl.simulate(rl.Scene(a, b, omega=1.0), 3.0), ax=new_axes())
    theta, omega = data(shown.separatrices[0])
    flat = 0.0 if a > b else math.pi / 2
    # nearer to a tip, rounding of max(a, b) - h is no longer small against that difference
    ours = (np.abs(theta - flat) < 1.5) & (omega != 0)
    assert np.count_nonzero(ours) > 800
    theta, omega = theta[ours], omega[ours]
    # from a millionth beside it the way to the tip takes some ln(1e6)/lambda = 8 s at most
    for factor, over in ((1 + 1e-6, True), (1 - 1e-6, False)):
        later, _, _ = rl.flow(30.0, a=a, b=b, theta=theta, omega=factor * omega)
        assert np.all((np.abs(later - flat) > math.pi / 2) == over)


def test_separatrix_goes_through_the_tips(report: rl.Trajectory) -> None:
    shown = rl.plot_phase(report, ax=new_axes())
    theta, omega = data(shown.separatrices[0])
    centres, saddles = shown.equilibria
    for tip in data(saddles)[0]:
        assert np.any((np.abs(theta - tip) < 1e-12) & (np.abs(omega) < 1e-7))
    flats = data(centres)[0]
    assert flats == pytest.approx(np.pi * np.arange(-1, 5), abs=1e-12)
    assert omega.max() == pytest.approx(rl.thresholds(2.0, 1.0).roll_over_speed, rel=1e-12)


def test_separatrix_keeps_the_spike_of_a_thin_body() -> None:
    shown = rl.plot_phase(rl.simulate(rl.Scene(1.0, 1e-3, theta=0.3), 1.0), ax=new_axes())
    _, omega = data(shown.separatrices[0])
    peak = rl.thresholds(1.0, 1e-3).roll_over_speed
    assert omega.max() == pytest.approx(peak, rel=1e-12)
    # |d omega| <= peak per point of the curve: a tenth is no visible corner
    assert np.max(np.abs(np.diff(omega))) < 0.1 * peak


def test_no_separatrix_for_a_circle_or_on_a_slope(report: rl.Trajectory) -> None:
    circle = rl.simulate(rl.scenes.circle, 2.0)
    downhill = dataclasses.replace(report, scene=dataclasses.replace(report.scene, slope=0.1))
    for motion in (circle, downhill):
        shown = rl.plot_phase(motion, ax=new_axes())
        assert shown.separatrices == () and shown.equilibria == ()
        assert legend_of(shown.ax) == []


def test_one_separatrix_for_each_body(report: rl.Trajectory) -> None:
    same = rl.simulate(rl.scenes.rocking, 1.0)
    other = rl.simulate(rl.Scene(1.5, 1.0, omega=1.0), 1.0)
    assert len(rl.plot_phase([report, same], ax=new_axes()).separatrices) == 1
    assert len(rl.plot_phase([report, same, other], ax=new_axes()).separatrices) == 2


def test_a_small_swing_fills_the_picture() -> None:
    ax = rl.plot_phase(rl.simulate(rl.Scene(2.0, 1.0, theta=0.01), 3.0), ax=new_axes()).ax
    assert 0.01 < ax.get_xlim()[1] < 0.012
    assert legend_of(ax) == []  # the separatrix is far outside


@pytest.mark.parametrize("scene", [rl.scenes.rolling, ORDINARY_SCENES["standing"]])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_long_rotation_is_folded_into_half_a_turn(scene: rl.Scene, sign: float) -> None:
    start = dataclasses.replace(scene, theta=0.1, omega=sign * scene.omega)
    motion = rl.simulate(start, 40.0)
    theta, omega = data(rl.plot_phase(motion, ax=new_axes()).motions[0])
    flat = 0.0 if scene.a > scene.b else math.pi / 2
    breaks = np.flatnonzero(np.isnan(theta))
    half_turns = np.floor((motion.theta - flat) / math.pi + 0.5)
    assert breaks.size == np.count_nonzero(np.diff(half_turns)) > 10
    assert np.array_equal(np.isnan(omega), np.isnan(theta))
    # the line leaves at one side and comes back at the other, with the same speed
    assert theta[breaks - 1] == pytest.approx(np.full(breaks.size, flat + sign * math.pi / 2))
    assert theta[breaks + 1] == pytest.approx(np.full(breaks.size, flat - sign * math.pi / 2))
    assert omega[breaks - 1] == pytest.approx(omega[breaks + 1], rel=1e-12)
    # all else are the samples
    ours = np.setdiff1d(np.arange(theta.size), np.concatenate([breaks + i for i in (-1, 0, 1)]))
    assert np.array_equal(omega[ours], motion.omega)
    turned = (motion.theta - theta[ours]) / math.pi
    assert turned == pytest.approx(np.round(turned), abs=1e-12)


def test_folding_is_a_choice(report: rl.Trajectory) -> None:
    folded = data(rl.plot_phase(report, ax=new_axes(), fold=True).motions[0])[0]
    assert np.nanmax(np.abs(folded)) <= math.pi / 2 < report.theta.max()


def test_ticks_of_the_phase_plane_are_quarter_turns(report: rl.Trajectory) -> None:
    ax = rl.plot_phase(report, ax=new_axes(9.0, 4.0)).ax
    ax.figure.draw_without_rendering()
    texts = [label.get_text() for label in ax.get_xticklabels()]
    assert texts == ["−π/2", "0", "π/2", "π", "3π/2", "2π", "5π/2", "3π", "7π/2"]


# -------------------------------------------------------------------------------- plot_forces


def test_forces_are_the_trajectory(trajectory: rl.Trajectory) -> None:
    limited = rough(trajectory, 0.7)
    shown = rl.plot_forces([trajectory, limited], ax=two_axes())
    for motion, normal, friction, needed in zip(
        (trajectory, limited), shown.normal, shown.friction, shown.needed, strict=True
    ):
        for line, values in (
            (normal, motion.normal_force),
            (friction, motion.friction_force),
            (needed, motion.friction_needed),
        ):
            assert np.array_equal(data(line)[0], motion.t)
            assert np.array_equal(data(line)[1], values)
    assert shown.limits[0] is None and shown.available[0] is None
    corners = shown.limits[1].get_paths()[0].vertices[:, 1]
    bound = 0.7 * trajectory.normal_force.max()
    assert (corners.min(), corners.max()) == (-bound, bound)
    assert list(shown.available[1].get_ydata()) == [0.7, 0.7]
    shown.axes[0].figure.draw_without_rendering()


def test_one_axes_for_the_forces_alone(report: rl.Trajectory) -> None:
    shown = rl.plot_forces(report, ax=new_axes())
    assert len(shown.axes) == 1 and shown.needed == () and shown.available == ()
    assert legend_of(shown.axes[0]) == ["normal", "friction"]


def test_needed_friction_is_shown_up_to_a_bound_where_n_vanishes() -> None:
    with pytest.warns(rl.ValidityWarning):
        jump = rl.simulate(rl.scenes.jump, 2.0, model="rolling")
    assert np.isinf(jump.friction_needed).any()
    upper, lower = rl.plot_forces(jump, ax=two_axes()).axes
    assert lower.get_ylim() == pytest.approx((0.0, 3.45))
    assert upper.get_ylim()[0] < jump.normal_force.min() < 0
    assert legend_of(lower) == ["μ"]


def test_needed_friction_fills_its_panel(report: rl.Trajectory) -> None:
    _, lower = rl.plot_forces(report, ax=two_axes()).axes
    assert lower.get_ylim()[1] == pytest.approx(1.15 * report.friction_needed.max())
    _, lower = rl.plot_forces(rough(report, 0.9), ax=two_axes()).axes
    assert lower.get_ylim()[1] == pytest.approx(1.15 * 0.9)


def test_spikes_leave_room_for_ordinary_forces(report: rl.Trajectory) -> None:
    thin = rl.simulate(rl.scenes.thin, np.linspace(0.0, 2.0, 8001))
    weight = 9.81
    assert thin.normal_force.max() > 100 * weight
    ax = rl.plot_forces(thin, ax=new_axes()).axes[0]
    bottom, ordinary, top = ax.transData.transform([(0, 0), (0, weight), (0, 100 * weight)])[:, 1]
    assert ordinary - bottom > 0.3 * (top - bottom)
    assert rl.plot_forces(report, ax=new_axes()).axes[0].get_yscale() == "linear"


@pytest.mark.parametrize("picture", TWO_PANELS)
def test_axes_are_one_or_two(picture: Callable[..., Any], report: rl.Trajectory) -> None:
    three = list(Figure().subplots(3))
    for wrong in (three, [], "here", [three[0], None]):
        with pytest.raises(ValueError, match="ax must be one matplotlib Axes or two, got"):
            picture(report, ax=wrong)


# -------------------------------------------------------------------------------- plot_energy


def test_energies_are_the_trajectory(trajectory: rl.Trajectory) -> None:
    shown = rl.plot_energy(trajectory, ax=new_axes())
    assert shown.error == () and legend_of(shown.ax) == ["total", "kinetic", "potential"]
    for (line,), values in (
        (shown.total, trajectory.energy),
        (shown.kinetic, trajectory.kinetic_energy),
        (shown.potential, trajectory.potential_energy),
    ):
        assert np.array_equal(data(line)[0], trajectory.t)
        assert np.array_equal(data(line)[1], values)


def test_several_motions_show_the_error_of_their_energies(several: list[rl.Trajectory]) -> None:
    shown = rl.plot_energy(several, ax=new_axes())
    assert shown.total == shown.kinetic == shown.potential == ()
    assert shown.ax.get_yscale() == "log"
    for line, motion in zip(shown.error, several, strict=True):
        # both energies are >= 0 on level ground from z = 0: the energy itself is the scale
        expected = np.abs(motion.energy - motion.energy[0]) / motion.energy.max()
        assert data(line)[1] == pytest.approx(expected, rel=1e-12, abs=1e-15)
    largest = [data(line)[1].max() for line in shown.error]
    assert largest[0] < 1e-14 and largest[1] > 1e-4 and largest[2] > 1e-3
    assert shown.ax.get_ylim()[0] < 1e-16 and shown.ax.get_ylim()[1] > max(largest)


def test_the_kind_of_energy_picture_is_a_choice(several: list[rl.Trajectory]) -> None:
    energies = rl.plot_energy(several, ax=new_axes(), kind="energies")
    assert len(energies.total) == len(energies.potential) == 3 and energies.error == ()
    assert legend_of(energies.ax)[3:] == ["total", "kinetic", "potential"]
    assert len(rl.plot_energy(several[0], ax=new_axes(), kind="error").error) == 1
    with pytest.raises(ValueError, match="kind must be one of 'energies', 'error', got 'total'"):
        rl.plot_energy(several, ax=new_axes(), kind="total")


def test_an_energy_without_any_error_is_said_to_be_0() -> None:
    still = rl.simulate(rl.Scene(2.0, 1.0), 1.0)
    ax = rl.plot_energy([still, still], ax=new_axes(), labels=["one", "two"]).ax
    assert legend_of(ax) == ["one = 0", "two = 0"]


# --------------------------------------------------------------------------- plot_constraints


def missing(motion: rl.Trajectory, **errors: float) -> rl.Trajectory:
    """The motion with residuals of the given size: f1 ... f4, df2 ... df4, gap, slip."""
    found = motion.constraint_residuals()
    position, velocity = found.position.copy(), found.velocity.copy()
    gap, slip = found.gap.copy(), found.slip.copy()
    columns = {"gap": gap, "slip": slip, "f1": velocity[:, 0]}
    for i in (2, 3, 4):
        columns |= {f"f{i}": position[:, i - 2], f"df{i}": velocity[:, i - 1]}
    for name, error in errors.items():
        columns[name][:] = error
    residuals = rl.ConstraintResiduals(position, velocity, gap, slip)
    other = dataclasses.replace(motion)
    object.__setattr__(other, "constraint_residuals", lambda: residuals)
    return other


def test_constraints_have_a_line_each(trajectory: rl.Trajectory) -> None:
    shown = rl.plot_constraints(trajectory, ax=two_axes())
    names = [[text.removesuffix(" = 0") for text in legend_of(ax)] for ax in shown.axes]
    assert names == [
        ["f2", "f3", "f4", "gap"],
        ["f1", "df2/dt", "df3/dt", "df4/dt", "slip"],
    ]
    for line in itertools.chain(*shown.lines):
        assert np.array_equal(data(line)[0], trajectory.t)
        # the motion is exact: a few hundred roundings, and 2/0.02 times as many for the thin body
        assert np.all(data(line)[1] < 1e-13)


def test_errors_of_constraints_have_no_unit(report: rl.Trajectory) -> None:
    position = {"f2": -1e-3, "f3": 2e-5, "f4": -1e-7, "gap": -4e-3}
    velocity = {"f1": 3e-3, "df2": 1e-4, "df3": -1e-6, "df4": 1e-5, "slip": -7e-3}
    shown = rl.plot_constraints(missing(report, **position, **velocity), ax=two_axes())
    rate = np.abs(report.omega).max()
    lengths = [2.0, 2.0, 1.0, 2.0], [2 * rate, 2 * rate, 2 * rate, rate, 2 * rate]
    for lines, errors, units in zip(shown.lines, (position, velocity), lengths, strict=True):
        for line, error, unit in zip(lines, errors.values(), units, strict=True):
            assert data(line)[1] == pytest.approx(abs(error) / unit, rel=1e-12)


def test_several_motions_show_the_worst_of_their_constraints(report: rl.Trajectory) -> None:
    motions = [report, missing(report, f2=1e-6, f3=1e-3), missing(report, f1=1e-2, f4=1e-5)]
    positions, velocities = rl.plot_constraints(motions, ax=two_axes()).lines
    largest = [[data(line)[1].max() for line in panel] for panel in (positions, velocities)]
    speed = 2 * np.abs(report.omega).max()
    assert largest[0][1:] == pytest.approx([5e-4, 1e-5], rel=1e-12)
    assert largest[1][2] == pytest.approx(1e-2 / speed, rel=1e-12)
    assert max(largest[0][0], largest[1][0], largest[1][1]) < 1e-14
    (all_of_it,) = rl.plot_constraints(motions, ax=new_axes()).lines
    worst = [data(line)[1].max() for line in all_of_it]
    assert worst[1:] == pytest.approx([5e-4, 1e-2 / speed], rel=1e-12)


def test_one_motion_in_one_axes_shows_the_worst_of_each_kind(report: rl.Trajectory) -> None:
    shown = rl.plot_constraints(missing(report, f1=1e-2, f3=1e-3), ax=new_axes())
    assert legend_of(shown.axes[0]) == ["positions", "velocities"]
    position, velocity = (data(line)[1] for line in shown.lines[0])
    speed = 2 * np.abs(report.omega).max()
    assert position.max() == pytest.approx(5e-4) and velocity.max() == pytest.approx(1e-2 / speed)


# --------------------------------------------------------------------------------- plot_paths


def test_paths_are_the_trajectory(trajectory: rl.Trajectory) -> None:
    shown = rl.plot_paths(trajectory, ax=new_axes())
    assert np.array_equal(shown.centres[0].get_xydata(), np.column_stack(data_of(trajectory)))
    assert np.array_equal(data(shown.contacts[0])[0], trajectory.contact_x)
    assert np.all(data(shown.contacts[0])[1] == 0)
    tips = shown.tips[0].get_xydata()
    for i in range(0, trajectory.t.size, 100):
        end = drawing.body_patch(trajectory, i).get_patch_transform().transform((1.0, 0.0))
        assert tips[i] == pytest.approx(end, rel=1e-13, abs=1e-12)  # theta passed through degrees


def data_of(motion: rl.Trajectory) -> tuple[Array, Array]:
    return motion.x, motion.z


def test_paths_of_several_motions_share_one_view(report: rl.Trajectory) -> None:
    small = rl.simulate(rl.Scene(0.5, 0.5, omega=-4.0, x=-3.0), 6.0)
    shown = rl.plot_paths([report, small], ax=new_axes(), labels=["large", "small"])
    assert legend_of(shown.ax) == ["large", "small", "centre", "end of axis a"]
    shown.ax.figure.draw_without_rendering()
    (left, right), (bottom, top) = shown.ax.get_xlim(), shown.ax.get_ylim()
    for line in (*shown.centres, *shown.tips, *shown.contacts):
        x, z = data(line)
        assert left < x.min() and x.max() < right and bottom < z.min() and z.max() < top
    window = shown.ax.get_window_extent()
    # matplotlib leaves limits alone that are equal within 0.5 %
    assert window.width / (right - left) == pytest.approx(window.height / (top - bottom), rel=5e-3)
    earth = shown.ground.get_xy()
    assert earth[:, 0].min() < left and earth[:, 0].max() > right


@pytest.mark.parametrize("span", [20, 1000])
def test_a_long_way_is_shown_over_three_turns(report: rl.Trajectory, span: int) -> None:
    rolling = rl.simulate(rl.scenes.rolling, np.linspace(0.0, span, 20_001))
    ax = rl.plot_paths(rolling, ax=new_axes()).ax
    assert ax.get_title(loc="left") == f"the first 13.1 s of {span} s"
    assert ax.get_xlim()[1] < 4 * 9.69  # turns of the perimeter
    assert rl.plot_paths(report, ax=new_axes()).ax.get_title(loc="left") == ""


def test_paths_on_a_slope_are_tilted(report: rl.Trajectory) -> None:
    downhill = dataclasses.replace(report, scene=dataclasses.replace(report.scene, slope=0.1))
    shown = rl.plot_paths(downhill, ax=new_axes())
    ax = shown.ax
    for line in (shown.centres[0], shown.tips[0], shown.contacts[0]):
        seen = ax.transData.inverted().transform(line.get_transform().transform((1.0, 0.0)))
        assert seen == pytest.approx([math.cos(0.1), -math.sin(0.1)], rel=1e-9)
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("horizontal [m]", "vertical [m]")
    with pytest.raises(ValueError, match=r"trajectories must be on one slope, got \[0.0, 0.1\]"):
        rl.plot_paths([report, downhill], ax=new_axes())
