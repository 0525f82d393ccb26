"""Films, pictures, pages and races do not change state shared by all threads, not even briefly."""

import platform
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import matplotlib
import matplotlib.pyplot as plt
import pytest
import rolling_ellipse as rl
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from oracles.threads import at_once
from rolling_ellipse import scenes, simulate

ROLLED, DROPPED = simulate(scenes.rolling, 1.0), simulate(scenes.drop, 1.0)
COARSE = simulate(scenes.rolling, 1.0, model="rolling", method="rk4", step=0.02)
SLIPPING = scenes.rolling.replace(omega=6.0, friction=0.1)
HOPPING: dict[str, Any] = {"methods": ["exact", "multipliers/rk4/none"], "steps": [0.4, 0.2]}
WARNED = 100


@pytest.fixture(autouse=True)
def style_of_a_user() -> Iterator[None]:
    """Two settings of a user that films must ignore."""
    with matplotlib.rc_context({"savefig.bbox": "tight", "animation.ffmpeg_path": "elsewhere"}):
        yield
    plt.close("all")


def film(path: Path) -> None:
    ROLLED.animate(path, width=64, fps=10)


def pictures() -> list[Any]:
    return [
        rl.plot_strobe(ROLLED).ax.figure,
        rl.plot_forces(DROPPED).axes[0].figure,
        rl.plot_energy(ROLLED).ax.figure,
        rl.plot_error(COARSE).ax.figure,
        ROLLED.plot().figure,
    ]


def race() -> rl.WorkPrecision:
    return rl.work_precision(scenes.rolling, 1.0, rounds=2, max_seconds=60, **HOPPING)


def explorer(path: Path) -> None:
    rl.explore(scenes.report, t_end=1.0).to_html(path)


def refused_picture() -> None:
    """Make a picture fail while its figure is open."""
    with pytest.raises(ValueError):
        rl.plot_energy(ROLLED, color="no such colour")


def warned() -> None:
    for _ in range(WARNED):
        simulate(SLIPPING, [0.0, 2.0], model="rolling")


def test_threads_leave_shared_state_unchanged(tmp_path: Path) -> None:
    """Thirteen threads work at once; each warning is shown, and each figure has its own number."""
    films = [lambda i=i: film(tmp_path / f"film{i}.{'gif' if i else 'mp4'}") for i in range(3)]
    work: list[Callable[[], Any]] = [
        *films, pictures, pictures, race, lambda: explorer(tmp_path / "explorer.html"), warned,
        *5 * [refused_picture],
    ]  # fmt: skip
    with warnings.catch_warnings(record=True) as shown:
        warnings.simplefilter("always")
        before = list(warnings.filters), dict(matplotlib.rcParams)
        results = at_once(work)
        assert (list(warnings.filters), dict(matplotlib.rcParams)) == before
    assert [each.category for each in shown] == [rl.ValidityWarning] * WARNED
    figures = [figure for drawn in results if isinstance(drawn, list) for figure in drawn]
    assert len(figures) == 10
    assert sorted(figure.number for figure in figures) == plt.get_fignums()
    assert all(plt.figure(figure.number) is figure for figure in figures)


@pytest.mark.parametrize(
    "action",
    [lambda path: explorer(path / "page.html"), lambda _: rl.plot_error(COARSE), lambda _: race()],
    ids=["explorer", "error", "race"],
)
def test_the_package_does_not_catch_warnings(action: Any, tmp_path: Path, monkeypatch: Any) -> None:
    """`warnings.catch_warnings` would silence all threads."""

    def caught(*_: Any, **__: Any) -> None:
        raise AssertionError("warnings are caught")

    platform.processor()  # its first call starts a subprocess, which catches warnings
    with monkeypatch.context() as patched:
        patched.setattr(warnings, "catch_warnings", caught)
        action(tmp_path)


@pytest.mark.parametrize("suffix", ["gif", "mp4"])
def test_shared_settings_stay_unchanged_while_a_film_is_written(
    suffix: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The settings are compared while each frame is drawn, when other threads may run."""
    before, seen, usual = dict(matplotlib.rcParams), [], Patch.draw

    def compared(self: Patch, *args: Any, **options: Any) -> None:
        seen.append(dict(matplotlib.rcParams) == before)
        usual(self, *args, **options)

    monkeypatch.setattr(Patch, "draw", compared)
    film(tmp_path / f"film.{suffix}")
    assert len(seen) >= 11  # at least 11 frames: 1 s at 10 frames a second
    assert all(seen)


def test_a_failing_picture_closes_only_its_own_figure(monkeypatch: pytest.MonkeyPatch) -> None:
    """A figure that is opened while the failing picture is drawn stays open."""
    mine, usual = [], plt.figure

    def beside(**options: Any) -> Figure:
        figure = usual(**options)
        mine.append(usual())
        return figure

    monkeypatch.setattr(plt, "figure", beside)
    refused_picture()
    assert plt.get_fignums() == [each.number for each in mine]
