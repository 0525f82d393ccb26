"""Failed pictures and films leave no files or figures behind; any valid file name works."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pytest
import rolling_ellipse as rl
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from oracles.curves import PICTURES

MOTION = rl.simulate(rl.scenes.report, np.linspace(0.0, 1.0, 26))
SMALL: dict[str, Any] = {"t_end": 0.2, "width": 160, "dpi": 50}

FRAMES = (".gif", ".mp4")  # formats written frame by frame; an .html file is one string


def test_axes_may_be_given_as_arrays_lists_or_tuples() -> None:
    figure = Figure()
    two: Any = figure.subplots(1, 2, squeeze=False)
    for given in (two, two.tolist(), list(two), (two[0, 0], two[0, 1])):
        assert len(rl.plot_forces(MOTION, ax=given).axes) == 2


def test_a_rejected_call_leaves_a_given_figure_empty() -> None:
    figure = Figure()
    with pytest.raises(ValueError, match="count must be from 1 to"):
        rl.plot(MOTION, figure=figure, count=0)
    assert figure.axes == []


@pytest.mark.parametrize("draw", [rl.plot, rl.plot_strobe, *PICTURES.values()])
def test_a_failed_drawing_closes_its_figure(draw: Any, monkeypatch: Any) -> None:
    mine = plt.figure()
    monkeypatch.setattr(Axes, "plot", lambda *args, **options: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        draw(MOTION)
    assert plt.get_fignums() == [mine.number]
    plt.close(mine)


@pytest.mark.parametrize("units", [1, 512, 749])
def test_an_extremely_short_motion_is_drawn_and_animated(units: int) -> None:
    """The number of frames is rounded up, but a frame after the end would raise a ValueError."""
    end = units * 5e-324
    assert rl.simulate(rl.scenes.rocking, end).t[-1] == end
    motion = rl.simulate(rl.scenes.rocking, [0.0, end])
    draw: Any
    for draw in (rl.plot, rl.plot_strobe, *PICTURES.values()):
        draw(motion)
        plt.close()
    assert rl.animate(motion)._repr_html_() and motion._repr_html_()


@pytest.mark.parametrize(
    "name", ["12:30.mp4", "-x.mp4", "%03d.mp4", "concat:a|b.gif", "file:ß.gif", "ä.html"]
)
def test_file_names_are_taken_literally(tmp_path: Path, name: str, monkeypatch: Any) -> None:
    monkeypatch.chdir(tmp_path)
    rl.animate(MOTION, name, **SMALL)
    assert [path.name for path in tmp_path.iterdir()] == [name]
    if name.endswith(".mp4"):
        assert (tmp_path / name).read_bytes()[4:8] == b"ftyp"


@pytest.mark.parametrize("suffix", FRAMES)
@pytest.mark.parametrize("error", [KeyboardInterrupt, MemoryError, OSError])
def test_an_old_film_stays_until_the_new_one_is_complete(
    tmp_path: Path, monkeypatch: Any, suffix: str, error: type[BaseException]
) -> None:
    path = tmp_path / f"roll{suffix}"
    path.write_bytes(b"old")
    film = rl.animate(MOTION, **SMALL)
    drawn: list[Any] = []
    draw = film.draw

    def stops(i: int) -> Any:
        drawn.append(i)
        if len(drawn) > 7:  # background and three frames for the palette come first
            raise error
        return draw(i)

    monkeypatch.setattr(film, "draw", stops)
    with pytest.raises(error):
        film.save(path)
    assert path.read_bytes() == b"old" and list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("draw", [rl.plot_strobe, rl.plot_paths, rl.plot, rl.animate])
def test_a_body_too_far_away_to_be_drawn_is_rejected(draw: Any) -> None:
    """Adjacent doubles at 7.8e23 m are 1.3e8 m apart. At 1e12 m, where the body can be drawn, they
    are 0.1 mm apart."""
    with pytest.raises(ValueError, match=r"^trajectory must stay where .*, got a centre 7\.8"):
        draw(rl.simulate(rl.Scene(2.0, 1.0, theta=0.3, x=7.847959263208443e23), 1.0))
    assert not plt.get_fignums()
    draw(rl.simulate(rl.Scene(2.0, 1.0, theta=0.3, x=1e12), 1.0))
    plt.close("all")


class Place:
    """An os.PathLike that is not a pathlib.Path."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def __fspath__(self) -> str:
        return str(self.path)


def test_all_file_writers_accept_strings_and_path_likes(tmp_path: Path) -> None:
    motion = rl.simulate(rl.scenes.report, np.linspace(0.1, 1.0, 12))
    scores = rl.benchmark.run(lambda p, t, s: p.exact(t), problems="roll.rock", ladder=[1.0])
    fit = rl.fit_motion(motion.t, motion.x, scene=motion.scene, free=("theta",), sigma=1e-3)
    race = rl.work_precision(motion.scene, 0.5, methods=["flow"], rounds=1, max_seconds=0.1)
    film = rl.animate(motion, width=160, dpi=50.0, t_end=0.1)
    page = rl.explore(motion.scene)
    writers: dict[str, Callable[[Any], object]] = {
        "plot.png": motion.plot, "strobe.svg": motion.plot_strobe().savefig,
        "ends.png": lambda path: rl.ends([motion.scene], 1.0).plot("x", path),
        "scores.png": scores.plot, "fit.png": fit.plot, "race.png": race.plot().savefig,
        "roll.gif": lambda path: motion.animate(path, width=160, dpi=50.0, t_end=0.1),
        "film.gif": film.save, "frame.png": lambda path: film.frame(0.0, path),
        "a.html": page.to_html, "b.html": page.save, "folder": rl.benchmark.export,
        "notebooks": rl.examples, "race.json": race.save, "motion.npz": motion.save,
    }  # fmt: skip
    for name, write in writers.items():
        for kind in (str, Place):
            path = tmp_path / f"{kind.__name__}_{name}"
            write(kind(path))
            assert path.exists(), name
    plt.close("all")
