"""Refusals of pictures, films, the explorer and the command line."""

from collections.abc import Callable
from pathlib import Path
from typing import Any
from unittest import mock

import matplotlib

matplotlib.use("Agg")

import numpy as np
import rolling_ellipse as rl
from matplotlib.animation import FFMpegWriter
from matplotlib.figure import Figure
from rolling_ellipse import Scene, report, scenes
from rolling_ellipse.__main__ import _motion
from rolling_ellipse._pictures.animation import movies
from rolling_ellipse._show.command.options import joined, motion_parser

from oracles.refusals import Refusal

MOTION = rl.simulate(Scene(2.0, 1.0, omega=1.0), np.linspace(0.0, 0.5, 6))
SLOPED = rl.simulate(scenes.slope, [0.0, 0.5])
LATER = rl.simulate(Scene(2.0, 1.0, omega=1.0), np.linspace(0.0, 1.0, 6))
TOO_LONG = rl.simulate(
    rl.Scene(2.0, 2.0, omega=1e6), 1e10, model="rolling", method="radau", step=5e9,
    raise_on_failure=False,
)  # fmt: skip
EMPTY = MOTION.sol([])
FAR = rl.simulate(Scene(2.0, 1.0, x=1e24), [0.0, 1.0])
Q, Q_DOT = rl.kinematics(0.3, 1.0, a=2.0, b=1.0)
OWN_START: Any = report.simulate(Q, Q_DOT, [0.0, 0.1], a=2.0, b=1.0)
ANY: Any = rl  # an object of a kind that nothing takes
WRONG: Any = 1
FILM: dict[str, Any] = {"width": 160, "dpi": 50}


def axes(count: int) -> Any:
    return Figure().subplots(count)


def told(*arguments: str) -> Callable[[Path], Any]:
    """What the command line says in one line before it ends."""
    return lambda _: _motion(motion_parser().parse_args(joined(list(arguments))))


def film_that_fails(folder: Path) -> None:
    program = folder / "ffmpeg"
    program.write_text("#!/bin/sh\ncat > /dev/null\necho the disk is full >&2\nexit 1\n")
    program.chmod(0o755)
    with mock.patch.object(movies, "ffmpeg", lambda: str(program)):
        rl.animate(MOTION, folder / "roll.mp4", **FILM)


def film_that_is_stopped(folder: Path) -> None:
    """An exception in a frame is not covered by the failure of the program that it leaves."""
    program = folder / "ffmpeg"
    program.write_text("#!/bin/sh\ncat > /dev/null\nexit 1\n")
    program.chmod(0o755)
    film = rl.animate(MOTION, **FILM)
    draw = mock.Mock(side_effect=[ArithmeticError("stopped")] * 9)
    with (
        mock.patch.object(movies, "ffmpeg", lambda: str(program)),
        mock.patch.object(film, "_func", draw),
    ):
        film.save(folder / "roll.mp4")


def film_without_ffmpeg(folder: Path) -> None:
    with (
        mock.patch("importlib.util.find_spec", return_value=None),
        mock.patch.object(FFMpegWriter, "isAvailable", return_value=False),
    ):
        rl.animate(MOTION, folder / "roll.mp4", **FILM)


def folder_called_gif(folder: Path) -> None:
    (folder / "roll.gif").mkdir()
    rl.animate(MOTION, folder / "roll.gif", **FILM)


def long_film(folder: Path) -> None:
    """Of more frames than a player has samples, and a motion that needs more."""
    turning = rl.simulate(Scene(2.0, 1.0, omega=3.2), [0.0, 20_000.0])
    rl.animate(turning, folder / "roll.html", speed=20.0, fps=50.0, **FILM)


def page(folder: Path, **options: Any) -> None:
    rl.animate(MOTION, **FILM).save(folder / "roll.html", **options)


CURVES: list[Refusal] = [
    (r"^figure must be a matplotlib Figure or None", lambda _: rl.plot(MOTION, figure=WRONG)),
    (r"^ax must be a matplotlib Axes or None", lambda _: rl.plot_strobe(MOTION, ax=WRONG)),
    (r"^ax must be one matplotlib Axes or two, got 1", lambda _: rl.plot_forces(MOTION, ax=WRONG)),
    (r"^ax must be .* two, got 3 of them", lambda _: rl.plot_forces(MOTION, ax=axes(3))),
    (r"^trajectory must be a Trajectory, got 1", lambda _: rl.plot(WRONG)),
    (r"^trajectory must have samples, got none", lambda _: rl.plot(EMPTY)),
    (r"^trajectories must be a Trajectory or a sequence", lambda _: rl.plot_paths(WRONG)),
    (r"^trajectories must be .*, got none", lambda _: rl.plot_paths([])),
    (r"^trajectories must be .*, got 1 among them", lambda _: rl.plot_paths([MOTION, WRONG])),
    (r"^every trajectory must have samples", lambda _: rl.plot_paths([MOTION, EMPTY])),
    (r"^colors must be a sequence of 1 matplotlib", lambda _: rl.plot_paths(MOTION, colors="x")),
    (r"^labels must be a sequence of strings", lambda _: rl.plot_paths(MOTION, labels=WRONG)),
    (r"^labels must be 1, one for each", lambda _: rl.plot_paths(MOTION, labels=["a", "b"])),
    (r"^trajectories must be on one slope", lambda _: rl.plot_paths([MOTION, SLOPED])),
    (r"^trajectory must stay where a double still knows", lambda _: rl.plot_strobe(FAR)),
    (r"^reference must be a Trajectory or None", lambda _: rl.plot_error(MOTION, reference=WRONG)),
    (r"^reference must reach the last", lambda _: rl.plot_error(LATER, reference=MOTION)),
    (r"^reference must be given for a trajectory that", lambda _: rl.plot_error(OWN_START)),
    (r"^reference must be given where no exact motion reaches", lambda _: rl.plot_error(TOO_LONG)),
    (r"^t_end must be within \[0, 0\.5\] s, got 9", lambda _: rl.plot_strobe(MOTION, t_end=9.0)),
    (r"^kind must be one of", lambda _: rl.plot_energy(MOTION, kind=ANY)),
]  # fmt: skip

MAPS: list[Refusal] = [
    (r"^resolution must be an int from 1", lambda _: rl.plot_phase_map(resolution=0)),
    (r"^x and y must be two of", lambda _: rl.plot_phase_map("energy", "speed", resolution=2)),
    (r"^energy and speed must not be given", lambda _: rl.plot_phase_map(energy=1.0, speed=1.0)),
    (r"^friction must be 0 or more, inf all", lambda _: rl.plot_phase_map(friction=-1.0)),
    (r"^aspect must not be given where x =", lambda _: rl.plot_phase_map(aspect=2.0)),
    (r"^x_range must be two ascending", lambda _: rl.plot_phase_map(x_range=(2.0, 1.0))),
    (r"^x_range must be two ascending .*got 1", lambda _: rl.plot_phase_map(x_range=WRONG)),
]  # fmt: skip

FILMS: list[Refusal] = [
    (r"^figure must be a matplotlib Figure", lambda _: rl.animate(MOTION, figure=WRONG)),
    (r"^t_end must be within \[0, 0\.5\] s, got 9", lambda _: rl.animate(MOTION, t_end=9.0)),
    (r"^ax must be None where a", lambda _: rl.animate(MOTION, ax=axes(1), figure=Figure())),
    (r"^ax must be None for 2 motions", lambda _: rl.animate([MOTION, LATER], ax=axes(1))),
    (r"^fps must be from", lambda _: rl.animate(MOTION, fps=1e9)),
    (r"^t_end must be shown in at most 1000000", lambda _: rl.animate(LATER, speed=1e-6, fps=1e3)),
    (r"^max_frames must hold the whole film", lambda _: rl.animate(MOTION, max_frames=2)),
    (r"Is a directory", folder_called_gif),
    (r"no such folder to write to", lambda folder: rl.animate(MOTION, folder / "no" / "roll.gif")),
    (r"^fps must be 100 over a", lambda folder: rl.animate(MOTION, folder / "a.gif", fps=30.0)),
    (r"^path must end in one of", lambda folder: rl.animate(MOTION, folder / "roll.txt")),
    (r"^an \.mp4 needs ffmpeg: pip install", film_without_ffmpeg),
    (r"^ffmpeg could not write .*: the disk is full", film_that_fails),
    (r"^stopped", film_that_is_stopped),
    (r"^i must be a frame, from 0 to", lambda _: rl.animate(MOTION, **FILM).draw(10**6)),
    (r"^options must be none for an \.html", lambda folder: page(folder, codec="x")),
    (r"^writer must be a matplotlib", lambda _: rl.animate(MOTION, **FILM).save("roll.gif", WRONG)),
]  # fmt: skip

PLAYERS: list[Refusal] = [
    (r"^t_end must be shown by a player in at most", long_film),
    (r"^t_end must be at most .* s for this body", lambda _: rl.explore(scenes.report, t_end=1e9)),
    (
        r"^scene must stay where a double still knows a thousandth of its body of 2 m, got a",
        lambda _: rl.explore(scenes.report.replace(x=1e30)),
    ),
    (
        r"^path must end in \.html",
        lambda folder: rl.explore(scenes.report).to_html(folder / "a.gif"),
    ),
]

COMMANDS: list[Refusal] = [
    (r"^--time must be a finite time >= 0", told("--time=nan")),
    (r"--plot must name a file in an existing folder", told("--plot=no/such/folder.png")),
    (r"--press must have F >= 0, got .*: it would pull", told("--press", "-1", "1")),
    (r"impulse must .*: give --press F D, or --omega", told("--a=1e-2", "--b=1e-2")),
]

REFUSALS: list[Refusal] = [*CURVES, *MAPS, *FILMS, *PLAYERS, *COMMANDS]
