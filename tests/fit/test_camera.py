"""Fits to films by a camera with unknown scale s, ground g and clock c.

A body at (x, z) at time t appears in the film at (s x, g + s z) at time t - c.
"""

import math
import pickle
from typing import Any

import judge_films
import numpy as np
import pytest
from judge_films import EXAMPLE, GUESS, SIGMA, noisy
from matplotlib import pyplot
from rolling_ellipse import Scene, fit_motion

CAMERA = ("scale", "ground", "clock")
ROLL = Scene(0.035, 0.025, theta=0.3, omega=8.0, friction=2.0)
FLY = Scene(0.035, 0.025, z=1.0, theta=0.2, omega=3.0, x_dot=0.3, z_dot=1.0)
TIMES = np.arange(80) / 240


def filmed(scene: Scene, scale: float = 1.0, ground: float = 0.0, late: float = 0.0) -> Any:
    film = noisy(scene, TIMES + late, SIGMA, np.random.default_rng(5))
    return film | {"t": TIMES, "x": scale * film["x"], "z": ground + scale * film["z"]}


def test_fits_of_twenty_films_by_unknown_cameras_have_realistic_errors() -> None:
    """The bounds on chi2 and on the pulls are those in test_fit_motion.py. chi2 counts only films
    with given sigma. More than two of 110 pulls exceed 3 in one of 300 cases."""
    rows = [judge_films.camera(seed) for seed in range(20)]
    assert not any(row["alarm"] for row in rows)
    given = [row for row in rows if row["given"]]
    chi2, dof = (sum(row[name] for row in given) for name in ("chi2", "dof"))
    assert abs(chi2 - dof) < 5 * math.sqrt(2 * dof)
    pulls = np.abs([off for row in rows for off in row["off"].values() if off != 0])
    size = pulls.size
    assert size > 80 and abs(np.sum(pulls < 1) - 0.683 * size) < 4 * math.sqrt(0.2165 * size)
    assert np.sum(pulls > 3) <= 2
    of_camera = np.abs([row["off"][name] for row in rows for name in CAMERA])
    assert np.all(of_camera < 5) and np.all(np.isfinite(of_camera))


@pytest.mark.parametrize("start", [17.0, -5.0, 1.7e9])
def test_a_clock_may_have_any_origin(start: float) -> None:
    """The spacing of doubles near 1.7e9 s is 2e-7 s."""
    film = filmed(EXAMPLE, late=0.02)
    here, there = (
        fit_motion(**film | {"t": t}, scene=GUESS, free=("theta", "omega", "clock"), sigma=SIGMA)
        for t in (TIMES, TIMES + start)
    )
    assert abs(here.values["clock"] - 0.02) < 4 * here.errors["clock"]
    assert abs(there.values["clock"] + start - here.values["clock"]) < 1e-6
    assert abs(there.values["omega"] - here.values["omega"]) < 1e-3 * there.errors["omega"]


def test_frames_before_the_first_datum_are_omitted_if_the_clock_is_unknown() -> None:
    film = filmed(EXAMPLE)
    t, none = np.append(np.arange(-9, 0) / 240, TIMES), np.full(9, np.nan)
    how: dict[str, Any] = {name: np.append(none, film[name]) for name in ("x", "z", "theta")}
    how |= {"scene": GUESS, "free": ("theta", "omega", "clock"), "sigma": SIGMA}
    fit = fit_motion(t + 3, **how)
    assert fit.residuals.shape == (80, 3) and fit.trajectory.t.shape == (80,)
    assert abs(fit.values["clock"] + 3) < 4 * fit.errors["clock"]


def test_a_film_in_millimetres_with_outliers_is_fitted() -> None:
    film = filmed(EXAMPLE, 1000.0, 30.0, 0.01)
    film["z"][5::9] -= 200
    film["theta"][3::11] += 1.5
    free = ("omega", "friction", "restitution", *CAMERA)
    fit = fit_motion(**film, scene=GUESS.replace(theta=0.5), free=free, loss="soft_l1")
    true = {"scale": 1000.0, "ground": 30.0, "clock": 0.01, "omega": 12.0, "friction": 0.18}
    off = {name: (fit.values[name] - value) / fit.errors[name] for name, value in true.items()}
    assert all(abs(each) < 4 for each in off.values()) and "not fit" not in fit.message
    assert "x 0." in fit.message and " mm" in fit.message  # lengths in the scene, not in the film


@pytest.mark.parametrize(
    ("scene", "free", "lost"),
    [
        (FLY, ("x", "z", "x_dot", "z_dot", "gravity", "scale"), "gravity, z, x_dot, z_dot, scale"),
        (FLY, ("z", "ground"), "z, ground"),
        (Scene(0.035, 0.025), ("x", "clock"), "clock"),
        (ROLL, ("mass", *CAMERA), "mass"),
    ],
)
def test_unknowns_that_a_film_cannot_determine_are_named(
    scene: Scene, free: tuple[str, ...], lost: str
) -> None:
    """A flight that does not touch the ground determines neither the height of the ground nor the
    scale, and a body at rest does not determine the clock."""
    fit = fit_motion(**filmed(scene), scene=scene, free=free, sigma=SIGMA)
    finite = [name for name in lost.split(", ") if not math.isinf(fit.errors[name])]
    assert finite == [] and "the film cannot determine" in fit.message


def test_a_wrong_scene_is_not_explained_by_its_camera() -> None:
    film, free = filmed(EXAMPLE, late=0.01), ("omega", "friction", "restitution", *CAMERA)
    for wrong in (film | {"theta": -film["theta"]}, film | {"z": 0.3 - film["z"]}):
        fit = fit_motion(**wrong, scene=GUESS.replace(theta=0.5), free=free, sigma=SIGMA)
        assert "the scene does not fit the film" in fit.message


def test_the_guess_decides_between_two_starts_at_one_height() -> None:
    """The body passes its starting height on the way up and on the way down. The film begins after
    both times, so that either may be the time 0 of the scene."""
    scene = FLY.replace(z=0.3, z_dot=0.5)
    film = filmed(scene, late=0.12)
    free = ("x", "theta", "z_dot", "clock")
    for speed, clock in ((0.6, 0.12), (-0.6, 0.12 - 2 * 0.5 / 9.81)):
        fit = fit_motion(**film, scene=scene.replace(z_dot=speed), free=free, sigma=SIGMA)
        assert abs(fit.values["clock"] - clock) < 4 * fit.errors["clock"] < 0.01
        assert abs(abs(fit.values["z_dot"]) - 0.5) < 4 * fit.errors["z_dot"]


def test_camera_and_scene_are_shown_together() -> None:
    """The picture has the coordinates of the scene. The printed fit and its pickle contain the
    values of the camera."""
    film = filmed(ROLL, 2.0, 0.1, 0.02)
    fit = fit_motion(**film, scene=ROLL, free=("omega", *CAMERA), sigma=SIGMA)
    assert list(fit.values) == list(fit.errors) == ["omega", *CAMERA]
    assert fit.values["omega"] == fit.scene.omega and fit.covariance.shape == (4, 4)
    for text in (repr(fit), fit._repr_html_()):
        assert all(name in text for name in CAMERA) and text.count("±") == 4
    copy = pickle.loads(pickle.dumps(fit))
    assert copy.values == fit.values and copy.message == fit.message
    chart = fit.plot()
    scale, ground = fit.values["scale"], fit.values["ground"]
    for name, values in (("x", film["x"] / scale), ("z", (film["z"] - ground) / scale)):
        assert np.allclose(np.asarray(chart.measured[name].get_ydata()), values, atol=1e-12)
    times = np.asarray(chart.measured["x"].get_xdata())
    assert np.allclose(times, TIMES + fit.values["clock"], atol=1e-12)
    pyplot.close("all")


def test_rolling_resistance_follows_from_the_decay_of_the_swings() -> None:
    """The guess and the second film have no resistance. The stated errors are below 0.01 mm."""
    for lever in (8e-4, 0.0):
        body: dict[str, Any] = {"theta": 0.9, "omega": 0.0, "friction": 0.6}
        scene = Scene(0.035, 0.025, **body | {"rolling_resistance": lever})
        film = noisy(scene, np.arange(1, 160) / 120, SIGMA, np.random.default_rng(1))
        free = ("theta", "rolling_resistance", *CAMERA)
        fit = fit_motion(**film, scene=Scene(0.035, 0.025, **body), free=free, sigma=SIGMA)
        assert abs(fit.values["rolling_resistance"] - lever) < 3 * 1e-5
        assert fit.errors["rolling_resistance"] < 1e-5
