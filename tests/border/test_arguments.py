"""Pictures, films and the report's functions name the argument that they cannot use, and a picture
that fails leaves nothing behind."""

import inspect
import itertools
import math
import re
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
import pytest
import rolling_ellipse as rl
from matplotlib.animation import FFMpegWriter, PillowWriter
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from oracles.pictures import frames_of
from PIL import Image
from rolling_ellipse import _core, report
from rolling_ellipse import _settings as settings
from rolling_ellipse._fields import cached_property
from rolling_ellipse._pictures.animation import movies as movies

MOTION = rl.simulate(rl.scenes.report, np.linspace(0.0, 1.0, 26))
Q, Q_DOT = rl.kinematics(0.3, 1.0, a=2.0, b=1.0)
BODY: dict[str, Any] = {"a": 2.0, "b": 1.0, "mass": 1.0, "gravity": 9.81}
CURVES = [
    rl.plot_paths, rl.plot_phase, rl.plot_forces, rl.plot_energy, rl.plot_constraints,
    rl.plot_error,
]  # fmt: skip
SMALL: dict[str, Any] = {"t_end": 0.2, "width": 160, "dpi": 50}

FRAMES = (".gif", ".mp4")  # written frame by frame; an .html is one string

ANYTHING: list[Any] = [
    "a", "", b"a", 42, 1.5, -1, math.nan, math.inf, 10**400, 2j, [], [1, 2], {}, object(), len,
    np.array([]), np.array([1.0, 2.0]), np.array("x"), np.array([None, 1.0]), np.ma.masked, Figure,
    rl.scenes.report, plt,
]  # fmt: skip


@pytest.fixture(autouse=True)
def no_figure_stays() -> Iterator[None]:
    yield
    opened = plt.get_fignums()
    plt.close("all")
    assert opened == []


def refused(name: str, call: Callable[..., Any], value: Any) -> None:
    with pytest.raises((TypeError, ValueError)) as caught:
        call(**{name: value})
    said = str(caught.value)
    assert said.startswith(f"{name} must ") and "got " in said, said


# --------------------------------------------------------------------------------- pictures


@pytest.mark.parametrize("value", [None, *ANYTHING], ids=lambda value: repr(value)[:20])
def test_what_is_no_trajectory(value: Any) -> None:
    refused("trajectory", rl.plot, value)
    refused("trajectory", rl.plot_strobe, value)
    for draw in (*CURVES, rl.animate):
        refused("trajectories", draw, value)  # type: ignore[arg-type]


@pytest.mark.parametrize("value", ANYTHING, ids=lambda value: repr(value)[:20])
def test_where_nothing_can_be_drawn(value: Any) -> None:
    refused("figure", lambda figure: rl.plot(MOTION, figure=figure), value)
    refused("figure", lambda figure: rl.animate(MOTION, figure=figure), value)
    refused("ax", lambda ax: rl.plot_strobe(MOTION, ax=ax), value)
    refused("ax", lambda ax: rl.plot_phase_map(resolution=2, ax=ax), value)
    for draw in CURVES:
        refused("ax", lambda ax, draw=draw: draw(MOTION, ax=ax), value)


def test_one_place_is_wanted_or_one_motion() -> None:
    """What lies near: a figure for its axes, an array of axes for one, motions where one is drawn,
    a scene where its motion is."""
    figure = Figure()
    draw: Any
    several: Any = figure.subplots(3)
    drawn = [len(panel.get_children()) for panel in several]
    one: list[Any] = [rl.plot_strobe, *CURVES]
    two: list[Any] = [rl.plot_forces, rl.plot_constraints]
    single: list[Any] = [rl.plot, rl.plot_strobe]
    for draw in one:
        with pytest.raises(TypeError, match=r"^ax must be .*Axes.*, got <Figure size"):
            draw(MOTION, ax=figure)
    for draw in (draw for draw in one if draw not in two):
        for given in (several, several.tolist()):
            with pytest.raises(TypeError, match=r"^ax must be a matplotlib Axes .*, got .*<Axes"):
                draw(MOTION, ax=given)
    for draw in two:
        with pytest.raises(ValueError, match=r"^ax must be one .* or two, got 3 of them$"):
            draw(MOTION, ax=several)
    for draw, given in itertools.product(single, (rl.scenes.report, [MOTION, MOTION])):
        said = re.escape(repr(given)[:12])
        with pytest.raises(TypeError, match=rf"^trajectory must be a Trajectory, got {said}"):
            draw(given)
    for draw in CURVES:
        with pytest.raises(TypeError, match=r"^trajectories must be .*, got Scene\(a=2.0"):
            draw(rl.scenes.report)
    assert [len(panel.get_children()) for panel in several] == drawn


class Lying:
    """It says that it is an array, and is none."""

    def __array__(self, *_: Any, **__: Any) -> Any:
        return "no array"


@pytest.mark.parametrize(
    "value",
    [[[1], [2, 3]], [[[1]], 2], Lying(), [Lying()]],
    ids=["ragged", "deep", "lying", "lies"],
)
def test_places_that_are_no_array(value: Any) -> None:
    for draw in CURVES:
        refused("ax", lambda ax, draw=draw: draw(MOTION, ax=ax), value)


def test_places_in_rows() -> None:
    figure = Figure()
    two: Any = figure.subplots(1, 2, squeeze=False)
    for given in (two, two.tolist(), list(two), (two[0, 0], two[0, 1])):
        assert len(rl.plot_forces(MOTION, ax=given).axes) == 2


SPANS = [((0, 6), "6"), ((0.0, 2.5), "2.5"), ((-0.0, 1e9), "1000000000.0")]
TIMES = [[0.0, 6.0], np.array([0.0, 6.0]), (1.0, 6.0), (0.0, 3.0, 6.0), (6.0,)]


@pytest.mark.parametrize(("t", "end"), SPANS)
def test_a_span_is_no_array_of_times(t: tuple[float, float], end: str) -> None:
    said = rf"^t must be an end time, {end}, or .* a list; got \("
    with pytest.raises(ValueError, match=said):
        rl.simulate(rl.scenes.report, t)
    with pytest.raises(ValueError, match=said):
        report.simulate(Q, Q_DOT, t, a=2.0, b=1.0)


@pytest.mark.parametrize("t", TIMES)
def test_times_of_other_kinds_are(t: Any) -> None:
    assert rl.simulate(rl.scenes.report, t).t.tolist() == list(t)


def test_choices_are_those_of_the_core() -> None:
    for name in ("MODELS", "METHODS", "STABILIZATIONS"):
        assert getattr(settings, name) == getattr(_core, name)


def test_only_what_is_public_is_offered() -> None:
    assert dir(rl) == sorted(rl.__all__)
    for module in (rl.scenes, rl.geometry):
        assert dir(module) == sorted(module.__all__)


WITHOUT_UNITS = ("events", "success", "reason", "stats")


def test_help_tells_units() -> None:
    properties = {
        name: inspect.getdoc(each)
        for name, each in vars(rl.Trajectory).items()
        if not name.startswith("_") and isinstance(each, (property, cached_property))
    }
    assert len(properties) > 25
    for name, text in properties.items():
        assert text, name
        assert re.search(r"\[.+\]", text) or name in WITHOUT_UNITS, (name, text)
    assert properties["normal_force"] == (
        "Contact force on the body away from the ground [N], shape (n,)."
    )
    for name in rl.scenes.__all__:
        assert f"``{name}``" in (rl.scenes.__doc__ or ""), name


@pytest.mark.parametrize("value", ANYTHING, ids=lambda value: repr(value)[:20])
def test_choices_and_switches(value: Any) -> None:
    refused("kind", lambda kind: rl.plot_energy(MOTION, kind=kind), value)
    refused("quantity", lambda quantity: rl.plot_error(MOTION, quantity), value)
    refused("reference", lambda reference: rl.plot_error(MOTION, reference=reference), value)
    refused("colors", lambda colors: rl.plot_phase(MOTION, colors=colors), value)
    refused("fold", lambda fold: rl.plot_phase(MOTION, fold=fold), value)
    refused("labels", lambda labels: rl.plot_forces(MOTION, labels=labels), value)
    refused("progress", lambda progress: rl.animate(MOTION, progress=progress), value)
    refused("x", lambda x: rl.plot_phase_map(x), value)
    if repr(value) not in ("[1, 2]", "array([1., 2.])"):
        refused("x_range", lambda x_range: rl.plot_phase_map(resolution=2, x_range=x_range), value)


@pytest.mark.parametrize("value", ANYTHING, ids=lambda value: repr(value)[:20])
def test_numbers_of_pictures(value: Any) -> None:
    refused("t_end", lambda t_end: rl.plot(MOTION, t_end=t_end), value)
    refused("t_end", lambda t_end: rl.animate(MOTION, t_end=t_end), value)
    if repr(value) != "42":
        refused("count", lambda count: rl.plot(MOTION, count=count), value)
        refused("max_frames", lambda max_frames: rl.animate(MOTION, max_frames=max_frames), value)
    if repr(value) not in ("42", "1.5"):
        for name in ("fps", "speed", "width", "dpi"):
            refused(name, lambda name=name, **given: rl.animate(MOTION, **given), value)


def test_a_given_figure_stays_as_it_is() -> None:
    figure = Figure()
    with pytest.raises(ValueError, match="count must be at least 1"):
        rl.plot(MOTION, figure=figure, count=0)
    assert figure.axes == []


@pytest.mark.parametrize("draw", [rl.plot, rl.plot_strobe, *CURVES])
def test_a_drawing_that_fails_closes_its_figure(draw: Any, monkeypatch: Any) -> None:
    mine = plt.figure()
    monkeypatch.setattr(Axes, "plot", lambda *args, **options: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        draw(MOTION)
    assert plt.get_fignums() == [mine.number]
    plt.close(mine)


def test_what_cannot_be_made() -> None:
    """Sizes and numbers that no machine has room for, and no eye could see."""
    with pytest.raises(ValueError, match="count must be at most 10000, got 1000000000000"):
        rl.plot_strobe(MOTION, count=10**12)
    frames = "t_end must be shown in at most 1000000 frames, got 1.0, which is .* frames at fps = "
    slow: list[dict[str, Any]] = [{"speed": 1e-12}, {"speed": 1e-6, "fps": 1000}]
    for options in slow:
        with pytest.raises(ValueError, match=frames):
            rl.animate(MOTION, t_end=1.0, **options)
    wrong: dict[str, tuple[Any, ...]] = {
        "speed": (1e-320, 1e-13, 1e300), "fps": (1e-320, 1e-4, 1e4, 1e308),
        "width": (1, 1e-9, 10**9), "dpi": (1e-300, 1, 1e5), "max_frames": (10**9,),
    }  # fmt: skip
    for name, values in wrong.items():
        for value in values:
            refused(name, lambda name=name, **given: rl.animate(MOTION, **given), value)


@pytest.mark.parametrize("units", [1, 512, 749])
def test_a_motion_of_next_to_no_time(units: int) -> None:
    """No even time is after its end, whose share in it is rounded up to a unit or two."""
    end = units * 5e-324
    assert rl.simulate(rl.scenes.rocking, end).t[-1] == end
    motion = rl.simulate(rl.scenes.rocking, [0.0, end])
    draw: Any
    for draw in (rl.plot, rl.plot_strobe, *CURVES):
        draw(motion)
        plt.close()
    assert rl.animate(motion)._repr_html_() and motion._repr_html_()


# ------------------------------------------------------------------------------------ films


@pytest.mark.parametrize("value", [42, 1.5, b"roll.gif", object(), ["roll.gif"], np.array("x.gif")])
def test_what_is_no_path(value: Any) -> None:
    with pytest.raises(TypeError, match=r"^path must be a path, a string or a PathLike, got "):
        rl.animate(MOTION, value)
    with pytest.raises(TypeError, match=r"^filename must be a path, .*, got "):
        rl.animate(MOTION, **SMALL).save(value)


def test_paths_that_cannot_be_written(tmp_path: Path, monkeypatch: Any) -> None:
    (tmp_path / "folder.gif").mkdir()
    monkeypatch.setattr(rl.Trajectory, "sol", None)  # before any work
    for name in ("", "roll\0.gif"):
        with pytest.raises(ValueError, match=r"^path must name a file, got"):
            rl.animate(MOTION, name)
    with pytest.raises(IsADirectoryError, match=r"folder\.gif"):
        rl.animate(MOTION, tmp_path / "folder.gif")
    with pytest.raises(FileNotFoundError, match=r"no such folder.*no/roll\.gif"):
        rl.animate(MOTION, tmp_path / "no" / "roll.gif")


@pytest.mark.parametrize("name", ["12:30.mp4", "-x.mp4", "%03d.mp4", "concat:a|b.gif", "ä.html"])
def test_names_that_ffmpeg_would_understand(tmp_path: Path, name: str, monkeypatch: Any) -> None:
    monkeypatch.chdir(tmp_path)
    rl.animate(MOTION, name, **SMALL)
    assert [path.name for path in tmp_path.iterdir()] == [name]
    if name.endswith(".mp4"):
        assert (tmp_path / name).read_bytes()[4:8] == b"ftyp"


@pytest.mark.parametrize("suffix", FRAMES)
@pytest.mark.parametrize("error", [KeyboardInterrupt, MemoryError, OSError])
def test_an_old_film_stays_until_the_new_one_is_whole(
    tmp_path: Path, monkeypatch: Any, suffix: str, error: type[BaseException]
) -> None:
    path = tmp_path / f"roll{suffix}"
    path.write_bytes(b"old")
    film = rl.animate(MOTION, **SMALL)
    drawn: list[Any] = []
    draw = film._func  # type: ignore[attr-defined]

    def stops(i: int, *args: Any) -> Any:
        drawn.append(i)
        if len(drawn) > 3:
            raise error
        return draw(i, *args)

    monkeypatch.setattr(film, "_func", stops)
    with pytest.raises(error):
        film.save(path)
    assert path.read_bytes() == b"old" and list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("suffix", FRAMES)
def test_a_killed_film_leaves_the_old_one(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"roll{suffix}"
    path.write_bytes(b"old")
    program = (
        "import os, signal, sys, rolling_ellipse as rl\n"
        "film = rl.animate(rl.simulate(rl.scenes.report, 1.0), width=160, dpi=50)\n"
        "kill = lambda i, n: i > 5 and os.kill(os.getpid(), signal.SIGKILL)\n"
        "film.save(sys.argv[1], progress_callback=kill)\n"
    )
    subprocess.run([sys.executable, "-c", program, path], timeout=120, check=False)
    assert path.read_bytes() == b"old"


def test_an_ffmpeg_that_fails(tmp_path: Path, monkeypatch: Any) -> None:
    path = tmp_path / "roll.mp4"
    path.write_bytes(b"old")
    program = tmp_path / "ffmpeg"
    program.write_text(
        "#!/bin/sh\ncat > /dev/null\necho first >&2\necho disk is full >&2\nexit 1\n"
    )
    program.chmod(0o755)
    monkeypatch.setattr(movies, "ffmpeg", lambda: str(program))
    with pytest.raises(OSError, match=r"^ffmpeg could not write '.*roll\.mp4': disk is full$"):
        rl.animate(MOTION, path, **SMALL)
    assert path.read_bytes() == b"old" and len(list(tmp_path.iterdir())) == 2


def test_an_extra_without_a_program(monkeypatch: Any) -> None:
    """imageio_ffmpeg has none for this machine, and says so by a RuntimeError."""
    imageio = pytest.importorskip("imageio_ffmpeg")

    def missing() -> str:
        raise RuntimeError("No ffmpeg exe could be found")

    monkeypatch.setattr(imageio, "get_ffmpeg_exe", missing)
    monkeypatch.setattr(FFMpegWriter, "isAvailable", lambda: False)
    with pytest.raises(FileNotFoundError, match=r"rolling_ellipse\[video\]"):
        rl.animate(MOTION, "roll.mp4")


def test_a_gif_slower_than_its_clock_can_tell(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="fps must be 100 over a whole number"):
        rl.animate(MOTION, tmp_path / "roll.gif", fps=1e-3)


def test_writers_of_ones_own(tmp_path: Path) -> None:
    film = rl.animate(MOTION, **SMALL)
    film.save(tmp_path / "roll.gif", PillowWriter(fps=5))
    with Image.open(tmp_path / "roll.gif") as picture:
        assert frames_of(picture) == film.t.size
    values: list[Any] = [42, [], np.array(["pillow"]), "no_such"]
    for value in values:
        refused("writer", lambda writer: film.save(tmp_path / "roll.gif", writer), value)


# -------------------------------------------------------------------------------- the report


@pytest.mark.parametrize("value", ANYTHING, ids=lambda value: repr(value)[:20])
def test_arguments_of_the_report(value: Any) -> None:
    refused("case", lambda case: report.f1(Q, Q_DOT, case=case), value)
    refused("complete", lambda complete: report.eq_41(Q, Q_DOT, **BODY, complete=complete), value)
    for equations in ("corrected", "printed"):

        def run(q: Any = Q, q_dot: Any = Q_DOT, equations: Any = equations, **given: Any) -> Any:
            return report.simulate(q, q_dot, 0.1, **BODY, equations=equations, **given)

        for name in ("q", "q_dot", "equations", "consistent", "method", "stabilization"):
            refused(name, run, value)
        if repr(value) not in ("[]", "42"):  # no row as printed, many steps
            refused("max_steps", run, value)
            refused("printed", run, value)


def test_as_many_states_everywhere() -> None:
    """Leading axes broadcast, or are refused with all shapes."""
    two, three, one = (np.stack([Q] * n) for n in (2, 3, 1))
    four = np.zeros((3, 4))
    said = r"^arguments must broadcast together, got shapes q \(2, 5\), "
    axes: dict[str, Any] = {"a": 2.0, "b": 1.0}
    for call in (
        lambda q, other: report.f1(q, other),
        lambda q, other: report.eq_38(q, other, **axes),
        lambda q, other: report.constraint_rates(q, other, **axes),
        lambda q, other: rl.constraints(q, other, **axes).gap,
        lambda q, other: report.consistent_rates(q, other[:, 0], **axes),
        lambda q, other: report.eqs_33_to_37(q, other, four[: len(other)], **BODY),
        lambda q, other: report.equations_of_motion(q, other, four[: len(other)], **BODY),
        *(
            lambda q, other, name=name: getattr(report, name)(q, other, **BODY)
            for name in (
                "eq_39", "eq_40", "eq_41", "eq_42", "lambda4_numerator", "multipliers", "complete_f"
            )
        ),
    ):  # fmt: skip
        with pytest.raises(ValueError, match=said):
            call(two, three)
        assert len(call(two, one)) == len(call(one, two)) == 2


@pytest.mark.parametrize("method", ["dopri5", "rk4"])
def test_a_step_that_cannot_change_the_time(method: Any) -> None:
    for step, t in ((1e-300, 1.0), (2e-15, 1.0), (1e-10, 1e6)):
        with pytest.raises(ValueError, match=rf"^step must be at least .* s, .*, got {step!r}"):
            report.simulate(
                Q, Q_DOT, t, **BODY, equations="printed", consistent="project", method=method,
                step=step,
            )  # fmt: skip
    motion = report.simulate(
        Q, Q_DOT, 1e-12, **BODY, equations="printed", consistent="project", step=1e-14
    )
    assert motion.message == "" and motion.t[-1] == 1e-12


@pytest.mark.parametrize("draw", [rl.plot_strobe, rl.plot_paths, rl.plot, rl.animate])
def test_a_body_too_far_away_to_be_seen_is_refused(draw: Any) -> None:
    """At 7.8e23 m doubles are 1.3e8 m apart; at 1e12 m a tenth of a millimetre, enough to draw."""
    with pytest.raises(ValueError, match=r"^trajectory must stay where .*, got a centre 7\.8"):
        draw(rl.simulate(rl.Scene(2.0, 1.0, theta=0.3, x=7.847959263208443e23), 1.0))
    assert not plt.get_fignums()
    draw(rl.simulate(rl.Scene(2.0, 1.0, theta=0.3, x=1e12), 1.0))
    plt.close("all")


class Dial:
    """A number that may be turned."""

    def __init__(self, value: float) -> None:
        self.value = value

    def __float__(self) -> float:
        return self.value


def test_settings_that_were_seen_before_are_checked_as_at_first() -> None:
    """Equal numbers of another type are not the same, nor is an object whose value has changed."""
    scene, dial = rl.scenes.rolling, Dial(1e-4)
    how: dict[str, Any] = {"model": "rolling", "method": "dopri5"}
    assert rl.simulate(scene, [1.0], max_steps=500, **how).settings.max_steps == 500
    with pytest.raises(TypeError, match=r"max_steps must be a whole number, got 500\.0"):
        rl.simulate(scene, [1.0], max_steps=500.0, **how)  # type: ignore[arg-type]
    for dial.value in (1e-4, 1e-6):
        changing: Any = dial
        assert rl.simulate(scene, [1.0], rtol=changing, **how).settings.rtol == dial.value
