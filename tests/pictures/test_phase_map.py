"""The phase map, read back from its artists: colours, lines, names and axes."""

import itertools
import math
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pytest
import rolling_ellipse as rl
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_hex, to_rgb
from numpy.typing import NDArray
from oracles.curves import Array, legend_of, new_axes
from oracles.numbers import known
from oracles.pictures import figure_of, legend_in
from rolling_ellipse._pictures.phase_map import PhaseMap, plot_phase_map

PAIRS = [
    pair
    for pair in itertools.permutations(("aspect", "energy", "speed", "friction"), 2)
    if set(pair) != {"energy", "speed"}
]
SHOWN = {"aspect": (1, 20), "energy": (0, 4), "speed": (0, 2 * math.sqrt(9.81)), "friction": (0, 2)}
LEVEL_MARKS = {"separatrix", "contact loss", "lift-off"}
COARSE = 24
pairs = pytest.mark.parametrize(("x", "y"), PAIRS, ids=[f"{x}-{y}" for x, y in PAIRS])


def phase_map(*axes: str, resolution: int = COARSE, **options: Any) -> PhaseMap:
    return plot_phase_map(*axes, ax=new_axes(), resolution=resolution, **options)


def colour_of(shown: PhaseMap, outcome: rl.Outcome) -> Any:
    return shown.cells.to_rgba(np.array([int(outcome)]))[0]


def codes_of(shown: PhaseMap) -> NDArray[np.int8]:
    return np.asarray(shown.cells.get_array())


def edges_of(shown: PhaseMap) -> tuple[Array, Array]:
    corners = np.asarray(shown.cells.get_coordinates())
    assert np.all(corners[0, :, 0] == corners[:, :, 0])
    assert np.all(corners[:, :1, 1] == corners[:, :, 1])
    return corners[0, :, 0], corners[:, 0, 1]


def middles_of(name: str, edges: Array) -> Array:
    if name == "aspect":
        return np.exp((np.log(edges[:-1]) + np.log(edges[1:])) / 2)
    return (edges[:-1] + edges[1:]) / 2


def at(shown: PhaseMap, key: str) -> tuple[Array, Array]:
    x, y = shown.marks[key].get_data()
    return np.asarray(x), np.asarray(y)


def constant(values: Array) -> float:
    assert np.ptp(values) <= 1e-12 * abs(values[0])
    return float(values[0])


@pairs
@pytest.mark.parametrize("swapped", [False, True], ids=["long axis a", "long axis b"])
def test_cells_agree_with_classify_at_their_centres(x: str, y: str, swapped: bool) -> None:
    """`classify` is called for one body at a time, also with its axes swapped."""
    shown = phase_map(x, y, b=0.7, gravity=3.7)
    columns, rows = (middles_of(n, e) for n, e in zip((x, y), edges_of(shown), strict=True))
    codes = codes_of(shown)
    assert codes.shape == (COARSE, COARSE)
    rng = np.random.default_rng(len(x) + 10 * len(y))
    for i, j in rng.integers(COARSE, size=(60, 2)):
        values = {"aspect": 2.0, "energy": 1.5, "friction": math.inf, x: columns[j], y: rows[i]}
        a = 0.7 * values["aspect"]
        roll_over = math.sqrt(2 * 3.7 * (a - 0.7) / ((a**2 + 0.49) / 4 + 0.49))
        omega = values.get("speed", math.sqrt(values["energy"]) * roll_over)
        axes = {"a": 0.7, "b": a, "theta": math.pi / 2} if swapped else {"a": a, "b": 0.7}
        expected = rl.classify(omega=omega, friction=values["friction"], gravity=3.7, **axes)
        assert codes[i, j] == expected, (values, omega)


@pytest.mark.parametrize(
    ("options", "expected"),
    [
        ({}, ["rocks", "rolls over", "slips"]),
        ({"friction": 0.5}, ["rocks", "rolls over", "slips"]),
        ({"friction": 5.0, "x_range": (1.2, 1.5), "y_range": (0.2, 0.9)}, ["rocks"]),
        ({"y": "friction", "energy": 0.0}, ["rests"]),
        ({"y": "friction", "energy": 1.0, "x_range": (1.1, 1.3), "y_range": (1, 2)}, ["edge"]),
    ],
)
def test_the_legend_names_only_outcomes_on_the_map(
    options: dict[str, Any], expected: list[str]
) -> None:
    shown = phase_map(**options)
    assert legend_of(shown.ax) == expected
    present = [rl.Outcome(code) for code in np.unique(codes_of(shown))]
    assert [outcome.name.lower().replace("_", " ") for outcome in present] == expected
    for outcome, entry in zip(present, legend_in(shown.ax).get_patches(), strict=True):
        assert to_hex(colour_of(shown, outcome)) == to_hex(entry.get_facecolor())


def test_regions_can_be_told_apart_in_greyscale() -> None:
    shown = phase_map()
    regions = [o for o in rl.Outcome if o not in (rl.Outcome.RESTS, rl.Outcome.EDGE)]
    colours = [to_rgb(colour_of(shown, outcome)) for outcome in regions]
    greys = sorted(0.299 * r + 0.587 * g + 0.114 * b for r, g, b in colours)
    reached = [grey for grey in greys if grey > 0.3]  # without JAMS, which no cell has
    assert len(reached) == 4 and np.min(np.diff(reached)) > 1 / 6


@pairs
def test_each_pair_of_axes_marks_exactly_the_thresholds_it_can_show(x: str, y: str) -> None:
    shown = phase_map(x, y)
    expected = LEVEL_MARKS if {x, y} & {"energy", "speed"} else set()
    expected = expected | ({"Painlevé"} if "friction" in (x, y) else set())
    expected = expected | ({"tip", "last to roll over"} if "aspect" in (x, y) else set())
    assert set(shown.marks) == expected and set(shown.names) <= expected
    assert set(shown.ax.lines) == set(shown.marks.values())
    assert set(shown.ax.texts) == set(shown.names.values())
    swapped = phase_map(y, x)
    for key, line in shown.marks.items():
        assert line.get_data()[0] == pytest.approx(swapped.marks[key].get_data()[1], nan_ok=True)


def test_the_critical_aspect_ratios_are_marked() -> None:
    for friction in (math.inf, 0.4):
        shown = phase_map(friction=friction)
        assert constant(at(shown, "tip")[0]) == pytest.approx(math.sqrt(3), rel=1e-15)
        last = constant(at(shown, "last to roll over")[0])
        assert last == pytest.approx(9.7532168, abs=5e-8)
        assert list(at(shown, "tip")[1]) == [0, 4]
    assert shown.names["last to roll over"].get_text() == "beyond 9.753 none rolls over"


def test_painleves_critical_friction_is_marked() -> None:
    straight = constant(at(phase_map("friction", "energy"), "Painlevé")[0])
    assert straight == pytest.approx(1.352698667647026, rel=1e-14)
    aspects, frictions = at(phase_map("aspect", "friction", x_range=(2, 8)), "Painlevé")
    assert frictions[0] == pytest.approx(1.352698667647026, rel=1e-14)
    for aspect, friction in zip(aspects[::12], frictions[::12], strict=True):
        assert friction == rl.thresholds(aspect, 1.0).painleve_friction


def test_curves_over_the_aspect_ratio_agree_with_thresholds() -> None:
    shown = phase_map(friction=0.5)
    assert constant(at(shown, "separatrix")[1]) == 1
    contact, flight = at(shown, "contact loss"), at(shown, "lift-off")
    for i in range(3, contact[0].size, 9):
        found = rl.thresholds(3 * contact[0][i], 3.0, gravity=1.6, friction=0.5)  # another size
        for marked, speed in ((contact, found.contact_loss_speed), (flight, found.lift_off_speed)):
            energy = (known(speed) / found.roll_over_speed) ** 2
            assert marked[1][i] == pytest.approx(energy, rel=1e-9)


def test_speeds_plotted_against_friction_agree_with_thresholds() -> None:
    shown = phase_map("friction", "speed", b=2.0, gravity=3.0, aspect=3.0)
    for key, name in {"separatrix": "roll_over_speed", "contact loss": "contact_loss_speed",
                      "lift-off": "lift_off_speed"}.items():  # fmt: skip
        frictions, speeds = at(shown, key)
        for i in range(1, frictions.size, 12):
            found = rl.thresholds(6.0, 2.0, gravity=3.0, friction=frictions[i])
            assert speeds[i] == getattr(found, name)
    assert shown.ax.get_xlabel().endswith("(at a/b = 3, b = 2 m)")


def test_colours_change_at_the_marked_lines() -> None:
    """Rolling ends where N = 0; the separatrix divides rocking from rolling over."""
    shown = phase_map(resolution=400)
    codes = codes_of(shown)
    aspects, energies = (
        middles_of(n, e) for n, e in zip(("aspect", "energy"), edges_of(shown), strict=True)
    )
    ends = at(shown, "contact loss")
    limit = np.interp(np.log(aspects), np.log(ends[0]), ends[1])
    near = np.abs(energies[:, None] - limit) < 0.02 * (1 + limit)
    lost = energies[:, None] > limit
    rolls = np.where(energies[:, None] > 1, rl.Outcome.ROLLS_OVER, rl.Outcome.ROCKS)
    expected = np.where(lost, rl.Outcome.SLIPS, rolls)
    assert np.mean(near) < 0.05 and np.array_equal(codes[~near], expected[~near])


def test_only_thresholds_in_view_are_marked() -> None:
    assert set(phase_map(x_range=(2, 9)).marks) == LEVEL_MARKS
    assert set(phase_map(x_range=(9.1, 9.2), y_range=(0, 0.9)).marks) == set()
    assert "last to roll over" not in phase_map(x_range=(9.76, 20)).marks
    assert "last to roll over" in phase_map(x_range=(9.75, 9.76)).marks
    assert "Painlevé" not in phase_map("friction", "energy", x_range=(0, 1.35)).marks


@pairs
@pytest.mark.parametrize("size", [(6.4, 4.4), (3.2, 2.6)], ids=["640 px", "320 px"])
def test_names_fit_in_the_axes_without_overlap(x: str, y: str, size: tuple[float, float]) -> None:
    shown = plot_phase_map(x, y, ax=new_axes(*size), resolution=COARSE)
    FigureCanvasAgg(figure_of(shown.ax)).draw()
    window = shown.ax.get_window_extent()
    boxes = [text.get_window_extent() for text in shown.names.values()]
    assert len(boxes) >= len(shown.marks) - 2
    for box in boxes:
        assert window.x0 - 1 <= box.x0 and box.x1 <= window.x1 + 1
        assert window.y0 - 1 <= box.y0 and box.y1 <= window.y1 + 1
    straight = [text for text in shown.names.values() if abs(text.get_rotation() % 90) < 1e-6]
    upright = [text.get_window_extent() for text in straight]
    for one, other in itertools.combinations(upright, 2):
        assert not one.overlaps(other)
    legend = legend_in(shown.ax).get_window_extent()
    assert legend.x0 >= 0 and legend.x1 <= shown.ax.figure.bbox.x1 + 1


def test_a_tiny_map_omits_the_names_that_do_not_fit() -> None:
    tiny = plot_phase_map(ax=new_axes(0.9, 0.8), resolution=COARSE)
    assert len(tiny.marks) == 5 and len(tiny.names) <= 2


@pairs
def test_axes_show_the_whole_map(x: str, y: str) -> None:
    shown = phase_map(x, y)
    assert shown.ax.get_xlim() == pytest.approx(SHOWN[x])
    assert shown.ax.get_ylim() == pytest.approx(SHOWN[y])
    for name, scale in ((x, shown.ax.get_xscale()), (y, shown.ax.get_yscale())):
        assert scale == ("log" if name == "aspect" else "linear")
    for edges, limits in zip(edges_of(shown), (SHOWN[x], SHOWN[y]), strict=True):
        assert (edges[0], edges[-1]) == pytest.approx(limits) and edges.size == COARSE + 1


@pytest.mark.parametrize("wide", [(1.5, 3.0), (1.0, 1000.0)])
def test_ranges_set_the_limits_of_the_axes(wide: tuple[float, float]) -> None:
    shown = phase_map(x_range=wide, y_range=(0.5, 2.5), friction=0.5)
    assert shown.ax.get_xlim() == wide and shown.ax.get_ylim() == (0.5, 2.5)
    FigureCanvasAgg(figure_of(shown.ax)).draw()
    ticks = [tick.get_text() for tick in shown.ax.get_xticklabels() if tick.get_text()]
    assert len(ticks) >= 3 and ("1000" in ticks) == (wide[1] == 1000)


def test_limits_set_before_drawing_are_kept() -> None:
    ax = new_axes()
    ax.set_xlim(2, 4)
    plot_phase_map(ax=ax, resolution=COARSE)
    assert ax.get_xlim() == (2, 4) and ax.get_ylim() == (0, 4)


@pytest.mark.parametrize("resolution", [1, 2, np.int64(7)])
def test_a_map_may_have_any_resolution(resolution: int) -> None:
    shown = phase_map("friction", "energy", resolution=resolution)
    assert codes_of(shown).shape == (resolution, resolution)
    if resolution == 1:
        middle = rl.thresholds(2.0, 1.0).roll_over_speed * math.sqrt(2)
        assert codes_of(shown)[0, 0] == rl.classify(a=2.0, b=1.0, omega=middle, friction=1.0)


def test_a_map_without_given_axes_opens_a_figure_with_rasterized_cells() -> None:
    shown = rl.plot_phase_map(resolution=4)
    assert shown.cells.get_rasterized() and shown.ax.figure is plt.gcf()
    assert shown.ax.get_xlabel() == "a/b   (at μ = ∞)"
    plt.close(figure_of(shown.ax))
