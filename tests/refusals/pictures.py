"""Refusals of pictures, films and the explorer."""

from functools import partial
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np
import rolling_ellipse as rl
from matplotlib.animation import FFMpegWriter
from matplotlib.figure import Figure
from oracles.report import lifted
from rolling_ellipse import Scene, scenes
from rolling_ellipse._pictures.animation import movies

from refusals import ANYTHING, INF, NAN, Row, but, wrong

MOTION = rl.simulate(Scene(2.0, 1.0, omega=1.0), np.linspace(0.0, 0.5, 6))
SLOPED = rl.simulate(scenes.slope, [0.0, 0.5])
LATER = rl.simulate(Scene(2.0, 1.0, omega=1.0), np.linspace(0.0, 1.0, 6))
TOO_LONG = rl.simulate(
    rl.Scene(2.0, 2.0, omega=1e6), 1e10, model="rolling", method="radau", step=5e9,
    raise_on_failure=False,
)  # fmt: skip
EMPTY = MOTION.sol([])
ANGLES_UNKNOWN = rl.simulate(Scene(2.0, 1.0, theta=1e16, omega=1.0), 0.5, model="rolling")
FAR = rl.simulate(Scene(2.0, 1.0, x=1e24), [0.0, 1.0])
OWN_START = lifted([0.0, 0.1])
WRONG: Any = 1
WORDS = rl.explore(scenes.report).words
FILM: dict[str, Any] = {"width": 160, "dpi": 50}


CURVES: list[Any] = [
    rl.plot_paths, rl.plot_phase, rl.plot_curves, rl.plot_forces, rl.plot_energy,
    rl.plot_constraints, rl.plot_error,
]  # fmt: skip
PAIRS = (rl.plot_forces, rl.plot_constraints)  # pictures with two axes


class Lying:
    """An object that claims to be an array but is not one."""

    def __array__(self, *_: Any, **__: Any) -> Any:
        return "no array"


NO_PLACES: list[Any] = [*ANYTHING, [[1], [2, 3]], [[[1]], 2], Lying(), [Lying()], Figure()]


def axes(count: int) -> Any:
    return Figure().subplots(count)


def film_that_fails(folder: Path) -> None:
    program = folder / "ffmpeg"
    program.write_text("#!/bin/sh\ncat > /dev/null\necho the disk is full >&2\nexit 1\n")
    program.chmod(0o755)
    with mock.patch.object(movies, "ffmpeg", lambda: str(program)):
        rl.animate(MOTION, folder / "roll.mp4", **FILM)


def film_that_is_stopped(folder: Path) -> None:
    """Raise an exception while a frame is drawn; the writer's own failure must not hide it."""
    program = folder / "ffmpeg"
    program.write_text("#!/bin/sh\ncat > /dev/null\nexit 1\n")
    program.chmod(0o755)
    film = rl.animate(MOTION, **FILM)
    draw = mock.Mock(side_effect=[film.draw(0)] * 6 + [ArithmeticError("stopped")])
    with (
        mock.patch.object(movies, "ffmpeg", lambda: str(program)),
        mock.patch.object(film, "draw", draw),
    ):
        film.save(folder / "roll.mp4")


def film_without_ffmpeg(folder: Path) -> None:
    """imageio_ffmpeg raises a RuntimeError if it has no program for this machine."""
    with (
        mock.patch("imageio_ffmpeg.get_ffmpeg_exe", side_effect=RuntimeError),
        mock.patch.object(FFMpegWriter, "isAvailable", return_value=False),
    ):
        rl.animate(MOTION, folder / "roll.mp4", **FILM)


def webm_without_encoder(folder: Path) -> None:
    with mock.patch.object(movies, "ffmpeg", lambda: "true"):
        rl.animate(MOTION, folder / "roll.webm", **FILM)


def folder_called_gif(folder: Path) -> None:
    (folder / "roll.gif").mkdir()
    rl.animate(MOTION, folder / "roll.gif", **FILM)


def long_film(folder: Path) -> None:
    """Request a film for which a player would need too many samples."""
    turning = rl.simulate(Scene(2.0, 1.0, omega=3.2), [0.0, 20_000.0])
    rl.animate(turning, folder / "roll.html", speed=20.0, fps=50.0, **FILM)


def page(folder: Path, **options: Any) -> None:
    rl.animate(MOTION, **FILM).save(folder / "roll.html", **options)


REFUSALS: list[Row] = [
    # curves
    *wrong(rl.plot, {}, trajectory=[None, *ANYTHING, EMPTY, [MOTION, MOTION]]),
    *wrong(rl.plot, {"trajectory": MOTION}, figure=ANYTHING, t_end=ANYTHING, count=[*but(42), 0],
           path=[3, "", b"a.png"], figsize=[*but([1, 2], np.array([1.0, 2.0])), (0, 1), (1, 2, 3)]),
    ("figsize", lambda _: rl.plot_phase(MOTION, ax=axes(1), figsize=(3, 4))),
    *wrong(rl.plot_strobe, {}, trajectory=[None, *ANYTHING, [MOTION, MOTION], FAR]),
    *wrong(rl.plot_strobe, {"trajectory": MOTION}, t_end=[9.0], count=["x", 0, 10**6, 10**12],
           ax=[*ANYTHING, Figure(), axes(3), axes(3).tolist()]),
    *(row for draw in CURVES for row in wrong(
        draw, {}, trajectories=[None, *ANYTHING, [MOTION, WRONG]])),
    *(row for draw in CURVES for row in wrong(
        draw, {"trajectories": MOTION},
        ax=[*NO_PLACES, axes(3), *([] if draw in PAIRS else [axes(3).tolist()])])),
    *(("every trajectory", lambda _, draw=draw, motions=motions: draw(motions))
      for draw in CURVES for motions in (EMPTY, [MOTION, EMPTY])),
    ("trajectory", lambda _: rl.plot_strobe(EMPTY)),
    ("every trajectory", lambda _: rl.animate(EMPTY)),
    ("trajectories", lambda _: rl.plot_paths([MOTION, SLOPED])),
    ("trajectories", lambda _: rl.plot_phase(ANGLES_UNKNOWN)),
    *wrong(rl.plot_phase, {"trajectories": MOTION}, colors=ANYTHING, fold=[*ANYTHING, 1]),
    *wrong(rl.plot_forces, {"trajectories": MOTION}, labels=[*ANYTHING, ["a", "b"], "ab"],
           ax=[[], "here", [axes(1), None]]),
    *wrong(rl.plot_paths, {"trajectories": [MOTION, LATER]},
           labels=[["a"], ["a", "b", "c"], "ab", [1, 2], 3],
           colors=["red", ["red"], ["red", "no colour"], 3, [1, 2]]),
    *(("quantities", lambda _, name=name: rl.plot_curves(MOTION, name)) for name in ANYTHING),
    *wrong(partial(rl.plot_curves, MOTION, "x", "z"), {}, ax=[axes(1), axes(3)]),
    *wrong(rl.plot_energy, {"trajectories": MOTION}, kind=ANYTHING),
    *wrong(rl.plot_error, {"trajectories": MOTION}, quantity=ANYTHING, reference=ANYTHING),
    ("reference", lambda _: rl.plot_error(LATER, reference=MOTION)),
    ("reference", lambda _: rl.plot_error(OWN_START)),
    ("reference", lambda _: rl.plot_error(TOO_LONG)),
    # maps
    *wrong(rl.plot_phase_map, {"resolution": 2}, x=ANYTHING, ax=ANYTHING, b=[-1.0], aspect=[2.0],
           friction=[-1.0], x_range=[*but([1, 2], np.array([1.0, 2.0])), (2.0, 1.0)]),
    *wrong(rl.plot_phase_map, {}, resolution=[0, 2.5, True, np.timedelta64(3, "s")],
           gravity=[INF, "one"], b=[0, "one", 1.4e166], y=[None], speed=[3], workers=[0],
           friction=[NAN, "one"], x_range=[(0.9, 2), (2, 2)], y_range=[(0, INF), (0, 1, 2), 4]),
    *wrong(rl.plot_phase_map, {"x": "friction", "resolution": 2}, aspect=[1, 1001]),
    *wrong(rl.plot_phase_map, {"y": "friction", "resolution": 2}, energy=[INF], speed=[-1]),
    *(("x and y", lambda _, x=x, y=y: rl.plot_phase_map(x, y, resolution=2))
      for x, y in (("energy", "speed"), ("aspect", "aspect"))),
    ("energy", lambda _: rl.plot_phase_map(y="friction", energy=1.0, speed=1.0)),
    # films
    *wrong(rl.animate, {}, trajectories=[None, *ANYTHING]),
    *wrong(rl.animate, {"trajectories": MOTION},
           figure=ANYTHING, progress=ANYTHING, layout=ANYTHING, panel=ANYTHING,
           forces=[*ANYTHING, None], blow=[*ANYTHING, 1],
           t_end=[*ANYTHING, 9.0], max_frames=[*but(42), 2],
           fps=[*but(42, 1.5), 1e-320, 1e-4, 1e4, 1e308], speed=[*but(42, 1.5), 1e-320, 1e300],
           width=[*but(42, 1.5), 1, 1e-9, 10**9], dpi=[*but(42, 1.5), 1e-300, 1, 1e5],
           path=[42, 1.5, b"a.gif", object(), ["a.gif"], np.array("x.gif"), "", "roll\0.gif"]),
    ("ax", lambda _: rl.animate(MOTION, ax=axes(1), figure=Figure())),
    ("ax", lambda _: rl.animate([MOTION, LATER], ax=axes(1))),
    ("ax", lambda _: rl.animate(MOTION, ax=axes(1), panel="phase")),
    ("panel", lambda folder: rl.animate(MOTION, folder / "roll.html", panel="phase")),
    ("speed", lambda _: rl.animate(LATER, speed=100.0)),  # 2 rad a frame
    *wrong(rl.animate(MOTION, **FILM).frame, {"path": "a.png"}, t=[*but(), 0.51]),
    ("path", webm_without_encoder),
    *(("max_frames", lambda _, how=how: rl.animate(LATER, **how))
      for how in ({"speed": 1e-6, "fps": 1e3}, {"speed": 1e-12})),
    (IsADirectoryError, folder_called_gif),
    (FileNotFoundError, lambda folder: rl.animate(MOTION, folder / "no" / "roll.gif")),
    *(("fps", lambda folder, fps=fps: rl.animate(MOTION, folder / "a.gif", fps=fps))
      for fps in (30, 24, 60, 100, 25.001, 1e-3)),
    ("path", lambda folder: rl.animate(MOTION, folder / "roll.txt")),
    (FileNotFoundError, film_without_ffmpeg),
    (OSError, film_that_fails),
    (ArithmeticError, film_that_is_stopped),
    ("i", lambda _: rl.animate(MOTION, **FILM).draw(10**6)),
    *wrong(rl.animate(MOTION, **FILM).save, {}, filename=[42, 1.5, object(), ["roll.gif"]]),
    *wrong(rl.animate(MOTION, **FILM).save, {"filename": "roll.gif"},
           writer=[WRONG, 42, [], np.array(["pillow"]), "no_such"]),
    ("options", lambda folder: page(folder, codec="x")),
    (TypeError, lambda _: MOTION.plot_strobe(title="x")),
    *(("path", lambda _, name=name: MOTION.plot(name)) for name in ("theta", "normal_force")),
    # players
    ("t_end", long_film),
    *wrong(rl.explore, {}, scene=[None, 42, "report", scenes, MOTION]),
    *wrong(rl.explore, {"scene": scenes.report},  # at most 40 sqrt(2 m / 9.81 m/s^2) = 18.06 s
           t_end=[0.0, -1.0, NAN, INF, 18.1, 1e9, "1", [1.0], object()]),
    *wrong(rl.explore, {"scene": scenes.report},
           language=["xx", 1, {"title": "x"}, WORDS | {"x": "x"}, WORDS | {"lang": 1},
                     WORDS | {"title": "\ud800"},
                     WORDS | {"place": "{F}"}],
           live=[1, "yes"]),
    ("scene", lambda _: rl.explore(scenes.report.replace(x=1e30))),
    ("path", lambda folder: rl.explore(scenes.report).to_html(folder / "a.gif")),
]  # fmt: skip
