"""Tables of common trackers become tracks in metres, radians and seconds."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from oracles.paths import ROOT, made_by
from rolling_ellipse import Scene, fit_motion, read_track, simulate

DATA = ROOT / "docs" / "data"
T = np.arange(6) / 60
ROWS = {"t": T, "x": np.linspace(0, 1, 6), "y": np.linspace(2, 3, 6), "q": np.linspace(0, 5, 6)}
TABLE: dict[str, Any] = ROWS


def written(path: Path, head: str, delimiter: str, decimal: str) -> Path:
    lines = [delimiter.join(f"{v:.6f}" for v in row) for row in zip(*ROWS.values(), strict=True)]
    text = "\n".join(line.replace(".", decimal) for line in lines)
    path.write_text(f"{head}\n{text}\n", encoding="utf-8-sig")
    return path


@pytest.mark.parametrize(
    ("head", "delimiter", "decimal"),
    [
        ("mass A\t\t\t\nt\tx\ty\tq", "\t", ","),  # Tracker
        ("mass A\t\t\t\nt\tx\ty\tq", "\t", "."),
        ('"t";"x";"y";"q"', ";", ","),
        ("#Kinovea 0.8\n#t x y q", " ", "."),
        ("t,x,y,q", ",", "."),
        ("# 60 frames a second\nt,x,y,q", ",", "."),
    ],
)
def test_tables_in_several_formats_give_the_same_track(
    head: str, delimiter: str, decimal: str, tmp_path: Path
) -> None:
    path = written(tmp_path / "track.txt", head, delimiter, decimal)
    hows: list[dict[str, Any]] = [{}, {"delimiter": delimiter, "decimal": decimal}]
    for how in hows:
        t, x, z, theta = read_track(path, t="t", x="x", z="y", theta="q", clockwise=True, **how)
        assert np.allclose([t, x, z, theta], [*ROWS.values()], atol=1e-6)


def test_a_data_frame_a_mapping_and_a_file_give_the_same_track(tmp_path: Path) -> None:
    pandas = pytest.importorskip("pandas")
    path = written(tmp_path / "t.csv", "t,x,y,q", ",", ".")
    for table in (TABLE, pandas.DataFrame(TABLE), pandas.read_csv(path), path, str(path)):
        t, x, _, theta = read_track(table, t="t", x="x")
        assert np.allclose([t, x], [ROWS["t"], ROWS["x"]], atol=1e-6) and np.isnan(theta).all()


def test_units_and_directions_are_converted_as_stated() -> None:
    """Times follow from frame numbers or row numbers, and heights from pixels counted downwards."""
    table = {"n": [3, 4, 6], "x": [0, 1, 2], "y": [5, 4, 3], "deg": [10.0, 20.0, 40.0]}
    t, x, z, theta = read_track(
        table, t="n", x="x", z="y", theta="deg", fps=50, y_up=False, degrees=True, scale=0.1
    )
    assert t == pytest.approx([0.06, 0.08, 0.12]) and x == pytest.approx([0.0, 0.1, 0.2])
    assert z == pytest.approx([-0.5, -0.4, -0.3])
    assert theta == pytest.approx(-np.radians([10, 20, 40]))
    t, x, z, theta = read_track(table, fps=50, theta="x", clockwise=True)
    assert t == pytest.approx([0.0, 0.02, 0.04]) and theta == pytest.approx([0, 1, 2])
    assert np.isnan(x).all() and np.isnan(z).all()


@pytest.mark.parametrize(("period", "rate"), [(math.pi, 30.0), (2 * math.pi, 40.0)])
def test_angles_are_unwrapped_at_the_ends_of_their_range(period: float, rate: float) -> None:
    """Angles of fitted ellipses cover half a turn, and those of points a whole turn."""
    true = rate * T - 1.0
    wrapped = np.mod(true, period)
    wrapped[2] = math.nan
    theta = read_track({"q": wrapped}, theta="q", fps=60, clockwise=True)[3]
    assert np.isnan(theta[2]) and np.nanmax(abs(np.diff(theta - true)[[0, 3, 4]])) < 1e-12


def test_two_points_of_a_body_give_its_middle_and_its_angle() -> None:
    """The angle is clockwise as seen in the film, whether the axis z points up or down."""
    angle, middle = np.linspace(0.3, 9.0, 30), np.array([[2.0], [3.0]])
    along = 0.4 * np.stack([np.cos(angle), -np.sin(angle)])
    tracks = np.concatenate([middle - along, middle + along])
    for sign in (1, -1):
        rows = tracks * np.array([[1], [sign], [1], [sign]])
        table = dict(zip(("x1", "y1", "x2", "y2"), rows, strict=True))
        _, x, z, theta = read_track(table, points=(*table,), fps=30, y_up=sign > 0)
        assert np.allclose([x - 2, z - 3, theta - angle], 0, atol=1e-12)


def test_empty_cells_become_nan_and_repeated_names_get_numbers(tmp_path: Path) -> None:
    path = tmp_path / "two.txt"
    path.write_text("A\t\t\tB\nt\tx\ty\tx\ty\n0\t1\t2\t3\t4\n1\t\t-\tnan\n", encoding="utf-8")
    assert np.array_equal(read_track(path, t="t", x="x")[1], [1.0, np.nan], equal_nan=True)
    again = read_track(path, t="t", x="x.1", z="y.1")[1:3]
    assert np.array_equal(again, [[3, np.nan], [4, np.nan]], equal_nan=True)
    path.write_text("0 1\n1 3\n", encoding="utf-8")
    assert read_track(path, t="0", x="1")[1].tolist() == [1.0, 3.0]


@pytest.mark.parametrize("mark", ["\t", ";", ",", "|"])
def test_rows_of_empty_cells_are_missing_frames(mark: str, tmp_path: Path) -> None:
    """Blank lines are no rows, and empty cells beyond the names are no fields."""
    path = tmp_path / "gap.txt"
    path.write_text("x z|1 1|2 1  |   | ||5 1|".replace("|", "\n").replace(" ", mark))
    t, x, z, _ = read_track(path, x="x", z="z", fps=10)
    assert t == pytest.approx([0.0, 0.1, 0.2, 0.3, 0.4])
    assert np.array_equal([x, z], [[1, 2, np.nan, np.nan, 5], [1, 1, np.nan, np.nan, 1]], True)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("theta\n0\n0,512\n0,498\n", "line 3 must have 1 fields, got 2; a decimal comma"),
        ("t,x\n\n0,1\n\n1,2,3\n", "line 5 must have 2 fields, got 3"),
        ("x y\n0 .1 .2\n", "line 2 must have 2 fields, got 3"),  # rows are numbered without a name
        ("1;2\n1;2;3\n", "line 2 must have 2 fields, got 3"),
        ('t,x\n0,1\n1,"2\n2,3\n3,4\n', "line 3 must have quotes in pairs .* end of data"),
        ("t,x\n0,1\n\nt,x\n5,1\n", "one line of names, above all numbers, got line 1 .* line 4"),
        ("a\n1,2\n\nt,x\n5,1\n", "got line 2 of .* above line 4"),
        ("t,x\n0,1\n1,2\nend\n", "got line 2 of .* above line 4"),
        ("t,x,mode\n0,1,ROLL\nt,x,mode\n1,2,ROLL\n", "got line 1 of .* above line 3"),
    ],
)
def test_lines_that_would_be_lost_are_refused_by_number(
    text: str, said: str, tmp_path: Path
) -> None:
    (tmp_path / "lost.txt").write_text(text)
    with pytest.raises(ValueError, match=f"^path must .*{said}"):
        read_track(tmp_path / "lost.txt", x="x")


def test_decimal_commas_in_a_table_with_commas_are_read_from_quotes(tmp_path: Path) -> None:
    (tmp_path / "quoted.csv").write_text('frame,x\n0,"12,5"\n1,"12,9"\n')
    _, x, _, _ = read_track(tmp_path / "quoted.csv", x="x", fps=60, decimal=",")
    assert x.tolist() == [12.5, 12.9]


@pytest.mark.parametrize(
    "above", ["#Kinovea 0.8", "# 60", "60 frames", "rate,60", "mass A", '"mass A', "a,b,c,d", "t,m"]
)
def test_other_lines_above_the_names_are_skipped(above: str, tmp_path: Path) -> None:
    (tmp_path / "named.csv").write_text(f"{above}\nt,x\n0,12\n1,13\n")
    assert read_track(tmp_path / "named.csv", t="t", x="x")[1].tolist() == [12, 13]


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "cp1252"])
def test_names_of_columns_may_have_accents(encoding: str, tmp_path: Path) -> None:
    (tmp_path / "high.csv").write_text("Höhe,x\n1,2\n3,4\n", encoding=encoding)
    with open(tmp_path / "high.csv", "rb") as file:
        for table in (tmp_path / "high.csv", file):
            assert read_track(table, z="Höhe", fps=1)[2].tolist() == [1, 3]


def test_digits_joined_by_an_underscore_are_text(tmp_path: Path) -> None:
    (tmp_path / "text.csv").write_text("t,x\n0,1_0\n1,2\n")
    with pytest.raises(TypeError, match=r"^x must be .*got \['1_0', 2.0\]"):
        read_track(tmp_path / "text.csv", t="t", x="x")


def test_a_scene_is_fitted_to_a_table_in_the_format_of_tracker() -> None:
    """The track begins 4 ms after the drop, and its origin is 12 mm below the ground."""
    track = read_track(DATA / "track_tracker.txt", t="t", x="x", z="y", theta="θ", degrees=True)
    guess = Scene(0.035, 0.025, z=0.1, theta=0.3, omega=10.0, x_dot=0.15, friction=0.3)
    free = ("theta", "omega", "x_dot", "restitution", "friction", "ground", "clock")
    fit = fit_motion(*track, scene=guess, free=free)
    true = {"omega": 12.0, "restitution": 0.52, "friction": 0.18, "ground": 0.012, "clock": -17.196}
    assert all(abs(fit.values[name] - v) < 4 * fit.errors[name] for name, v in true.items())
    assert fit.errors["ground"] < 2e-4 and "not fit" not in fit.message


def test_a_scene_is_fitted_to_two_tracked_points() -> None:
    """A pixel is 0.4 mm, but is assumed to be 1 mm. The ground is 500 pixels below the corner."""
    points = ("x1", "y1", "x2", "y2")
    track = read_track(
        DATA / "track_points.csv", t="frame", fps=60, points=points, y_up=False, scale=1e-3
    )
    guess = Scene(0.06, 0.04, theta=0.8, omega=0.0, friction=1.0)
    free = ("x", "theta", "inertia", "scale", "ground", "clock")
    fit = fit_motion(*track, scene=guess, free=free)
    true = {"theta": 0.9, "inertia": 0.0013, "scale": 2.5, "ground": -0.5, "clock": 0.0}
    assert all(abs(fit.values[name] - v) < 4 * fit.errors[name] for name, v in true.items())
    assert fit.errors["inertia"] < 1e-5 and "not fit" not in fit.message
    assert np.isnan(fit.residuals[30:32]).all() and simulate(fit.scene, 0.1).mode.size


def test_the_tracks_equal_those_written_by_their_script() -> None:
    maker = made_by("tracks")
    for name, make in (("track_tracker.txt", "tracker"), ("track_points.csv", "points")):
        assert (DATA / name).read_text(encoding="utf-8") == maker[make]()
