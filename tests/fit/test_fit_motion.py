"""Fits to synthetic films recover the parameters of the films, with realistic errors."""

import math
import sys
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from judge_films import SIGMA, noisy
from matplotlib import pyplot
from rolling_ellipse import Fit, Impulse, Mode, Scene, Trajectory, fit_motion, geometry, simulate
from rolling_ellipse._verbs.films.errors import standard_errors

DISC = (0.035**2 + 0.025**2) / 4
BODY: dict[str, Any] = {"a": 0.035, "b": 0.025, "inertia": DISC}
DROP = Scene(z=0.1, theta=0.5, omega=12.0, x_dot=0.2, friction=0.18, restitution=0.52, **BODY)
SLIDE = Scene(x_dot=1.2, theta=0.3, friction=0.25, **BODY)
ROLL = Scene(theta=0.3, omega=8.0, friction=2.0, **BODY)
FREE = ("omega", "friction", "restitution")


def filmed(scene: Scene, t: Any, seed: int = 1) -> dict[str, Any]:
    """Times and tracks of a scene with normal noise of SIGMA."""
    return noisy(scene, t, SIGMA, np.random.default_rng(seed))


def value_of(scene: Scene, name: str) -> float:
    """Value of a parameter of a scene; an omitted velocity in the air is 0."""
    of: Any = scene.impulse if name in ("dx", "dz") else scene
    return float(getattr(of, name) or 0.0)


def off(fit: Fit, scene: Scene, names: Any) -> np.ndarray:
    """Fitted minus true parameters, divided by their errors, none of which may be NaN or 0."""
    errors = np.array([fit.errors[name] for name in names])
    assert list(fit.errors) == list(names) and np.all(errors > 0)
    return np.array([value_of(fit.scene, n) - value_of(scene, n) for n in names]) / errors


TIMES = np.arange(1, 110) / 240
FILM = filmed(DROP, TIMES)
GUESS = DROP.replace(omega=10.0, friction=0.4, restitution=0.3)
HOLES = {name: track.copy() for name, track in FILM.items()}
HOLES["x"][20:60] = HOLES["theta"][50:] = np.nan
OUTLIERS = {name: track.copy() for name, track in FILM.items()}
OUTLIERS["x"][::20] += 0.05
OUTLIERS["z"][5::20] -= 0.05
UNEVEN = np.sort(np.random.default_rng(2).uniform(0, 0.45, 90))


def test_fits_of_twelve_films_recover_their_parameters_with_realistic_errors() -> None:
    """chi2 has the mean n, its degrees of freedom, and the variance 2n. The bound is 5 standard
    deviations. Of m normal deviates, 0.68 m are below 1 in magnitude, with a standard deviation of
    sqrt(0.22 m). The bound is 4 times this deviation. For m = 48, more than one exceeds 3 with a
    probability of 0.8 %."""
    chi2, count, pulls = 0.0, 0, []
    for seed in range(12):
        rng = np.random.default_rng(seed)
        scene, free = (
            (DROP, ("x", "z_dot", *FREE)), (SLIDE, ("x_dot", "theta", "friction", "inertia")),
            (ROLL, ("theta", "omega", "inertia")),
        )[seed % 3]  # fmt: skip
        scene = scene.replace(theta=rng.uniform(-1, 1), inertia=DISC * rng.uniform(0.7, 1.2))
        t = np.arange(1, 27 if seed % 2 else 105) / (60 if seed % 2 else 240)
        guess = {n: value_of(scene, n) * 1.2 + (0.01 if n in ("x", "z_dot") else 0) for n in free}
        film = filmed(scene, t, seed)
        fit = fit_motion(**film, scene=scene.replace(**guess), free=free, sigma=SIGMA)
        chi2, count = chi2 + fit.chi2, count + 3 * t.size - len(free)
        pulls += off(fit, scene, free).tolist()
    assert abs(chi2 - count) < 5 * math.sqrt(2 * count)
    size, within = len(pulls), np.abs(pulls) < 1
    assert size == 48 and abs(within.sum() - 0.683 * size) < 4 * math.sqrt(0.2165 * size)
    assert np.sum(np.abs(pulls) > 3) <= 1


@pytest.mark.parametrize(
    ("film", "how"),
    [
        (HOLES, {}), (FILM | {"theta": FILM["theta"] % math.pi}, {}), (FILM | {"theta": None}, {}),
        ({"t": TIMES, "theta": FILM["theta"]}, {"sigma": 0.01}), (filmed(DROP, UNEVEN), {}),
        (FILM, {"sigma": None}), (OUTLIERS, {"loss": "soft_l1"}),
        (OUTLIERS, {"loss": "soft_l1", "sigma": None}),
    ],
    ids=["holes", "half turns", "no angle", "angle", "uneven", "no sigma", "outliers", "both"],
)  # fmt: skip
def test_fits_of_realistic_films_recover_their_parameters(
    film: dict[str, Any], how: dict[str, Any]
) -> None:
    """A normal deviate exceeds 4 in one of 16 000 cases."""
    fit = fit_motion(**film, scene=GUESS, free=FREE, **({"sigma": SIGMA} | how))
    assert np.all(np.abs(off(fit, DROP, FREE)) < 4) and fit.errors["restitution"] < 0.02
    assert "not fit" not in fit.message


def test_outliers_and_a_wrong_scene_are_reported_as_not_fitting() -> None:
    fit = fit_motion(**OUTLIERS, scene=GUESS, free=FREE, sigma=SIGMA)
    wrong = fit_motion(**FILM, scene=GUESS.replace(z=0.12), free=FREE, sigma=SIGMA)
    for each in (fit, wrong):
        assert f"chi2 / {3 * TIMES.size - len(FREE)} = " in each.message
        assert "the scene does not fit the film" in each.message


@pytest.mark.parametrize(
    "changes",
    [
        {"restitution": 0.0},
        {"restitution": 0.0, "theta": 0.1, "omega": 0.0, "friction": 0.3},
        {"restitution": 1.0},
        {"friction": 0.0},
    ],
)
def test_parameters_at_their_bounds_are_fitted(changes: dict[str, float]) -> None:
    """The error of the restitution is below 0.2: after an impact at 1 m/s, a restitution of 0.2
    would lead to a hop of 4 sigma_z, which is detected."""
    scene = DROP.replace(**changes)
    guess = GUESS.replace(theta=scene.theta)
    fit = fit_motion(**filmed(scene, TIMES), scene=guess, free=FREE, sigma=SIGMA)
    assert np.all(np.abs(off(fit, scene, FREE)) < 4)
    assert fit.errors["restitution"] < 0.2


def test_an_undetermined_parameter_keeps_its_guess() -> None:
    """A film without an impact does not determine restitution, a film of a body at rest does not
    determine friction, and no film determines the mass. All points on the line of a blow are
    equivalent. The fitted theta keeps the half turns of the guess."""
    blow = Scene(friction=0.5, impulse=Impulse(jx=0.3, jz=-0.1, dx=-0.01, dz=0.02), **BODY)
    for scene, free, lost in (
        (ROLL, ("theta", "restitution"), ["restitution"]),
        (DROP.replace(mass=3.0, inertia=None), ("omega", "mass"), ["mass"]),
        (Scene(friction=0.3, **BODY), ("x", "friction"), ["friction"]),
        (blow, ("dx", "dz"), ["dx", "dz"]),
    ):
        fit = fit_motion(**filmed(scene, TIMES), scene=scene, free=free, sigma=SIGMA)
        assert [name for name, error in fit.errors.items() if math.isinf(error)] == lost
        assert f"cannot determine {', '.join(lost)}" in fit.message
        assert not np.isnan(fit.covariance).any()
        if len(lost) == 1:  # the film determines only a sum of dx and dz
            kept = value_of(scene, lost[0])
            assert value_of(fit.scene, lost[0]) == pytest.approx(kept, abs=1e-8)
    light = ROLL.replace(mass=1e-7, inertia=None)
    fit = fit_motion(**filmed(ROLL, TIMES), scene=light, free=("theta", "mass"), sigma=SIGMA)
    assert "mass   1e-07" in repr(fit) and "± inf" in repr(fit)
    turned = DROP.replace(theta=0.5 + 3 * math.pi)
    fit = fit_motion(**FILM, scene=turned, free=("theta",), sigma=SIGMA)
    assert abs(fit.scene.theta - turned.theta) < 0.05


def test_the_picture_shows_the_film() -> None:
    fit = fit_motion(TIMES, HOLES["x"], theta=HOLES["theta"], scene=GUESS, free=FREE, sigma=SIGMA)
    chart = fit.plot()
    assert list(chart.residuals) == ["x", "theta"] and len(chart.axes) == 3
    assert chart.axes[0].get_shared_x_axes().joined(chart.axes[0], chart.axes[2])
    for name, line in chart.measured.items():
        assert np.allclose(np.asarray(line.get_ydata()), HOLES[name], equal_nan=True, atol=1e-12)
    seen = np.asarray(chart.residuals["x"].get_ydata()) * SIGMA["x"]
    assert np.allclose(seen, HOLES["x"] - fit.trajectory.x, equal_nan=True, atol=1e-12)
    assert "±" in repr(fit) and "±" in fit._repr_html_()
    pyplot.close("all")


def test_a_fit_without_scipy_says_how_to_install_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "scipy.optimize", None)
    with pytest.raises(ImportError, match=r"pip install 'rolling_ellipse\[fit\]'"):
        fit_motion(**FILM, scene=DROP, free=FREE)


@pytest.mark.parametrize("start", [0.0, 0.4])
def test_angles_alone_determine_a_rolling_motion(start: float) -> None:
    t = np.linspace(start, 1.0, 4000)
    motion = simulate(ROLL.replace(theta=start, x=7.0), t, model="rolling")
    mine = Trajectory.from_arrays(motion.t, theta=motion.theta, scene=motion.scene)
    for name in ("x", "z"):
        assert getattr(mine, name) == pytest.approx(getattr(motion, name), rel=1e-14, abs=1e-14)
    assert (mine.mode == Mode.ROLLING).all()


def test_rates_from_sampled_arrays_converge_at_fourth_order(tmp_path: Any) -> None:
    """Halving the steps leaves 1/16 of the error of the rates, to within a quarter."""
    errors = []
    for count in (101, 201):
        motion = simulate(ROLL, np.linspace(0, 0.5, count))
        mine = Trajectory.from_arrays(motion.t, motion.x, motion.z, motion.theta, scene=ROLL)
        errors.append(np.max(np.abs(mine.omega - motion.omega)))
    assert 12 < errors[0] / errors[1] < 20
    assert np.array_equal(mine.mode, motion.mode) and np.allclose(mine.sol(motion.t).x, motion.x)
    assert np.allclose(mine.normal_force, motion.normal_force, rtol=1e-3)
    mine.save(tmp_path / "mine.npz")
    again = Trajectory.load(tmp_path / "mine.npz")
    assert again == mine and again.sol(0.123) == mine.sol(0.123)
    one, row = mine.at(0.123), mine.sol(0.123)
    assert all(value == getattr(row, name)[0] for name, value in vars(one).items())
    assert np.max(np.asarray(mine.plot_error().errors[0].get_ydata())) < 1e-6
    for show in (mine.plot_forces, mine.plot_phase, mine.plot, mine.animate):
        show()
    pyplot.close("all")
    flying = simulate(DROP, TIMES)
    seen = Trajectory.from_arrays(TIMES, flying.x, flying.z, flying.theta, scene=DROP)
    gap = flying.z - geometry.support(flying.theta, a=0.035, b=0.025)
    assert np.array_equal(seen.mode == Mode.FLIGHT, gap > 0.01 * 0.035)


def test_many_samples_from_arrays_do_not_depend_on_each_other() -> None:
    """Samples are computed in pieces of a few thousand."""
    t = np.linspace(0.0, 1.0, 10_000)
    mine = Trajectory.from_arrays(t, np.sin(t), 1 + t * t, np.cos(t), scene=ROLL)
    assert np.abs(mine.x_dot - np.cos(t)).max() < 1e-6
    force = mine.sol(t).normal_force
    for part in (slice(3000, 5000), slice(9990, None), slice(0)):
        assert np.array_equal(mine.sol(t[part]).normal_force, force[part])


@pytest.mark.parametrize(("rise", "away", "error"), [
    (26.0, 5.0, 0.1), (16.0, 5.0, 1.25), (16.0, 200.0, 0.1), (4.0, 5.0, 2.5), (4.0, 90.0, math.inf),
])  # fmt: skip
def test_a_rival_minimum_widens_the_errors(rise: float, away: float, error: float) -> None:
    """A rival is another minimum of chi2. It is dropped if chi2 rises by more than 25. If it widens
    the error beyond 30, it is dropped if chi2 rises by more than 9, and otherwise the error is inf.

    In place of a film, the search has a parabola of chi2 with the error 0.1 and a chosen rival.
    """
    best = SimpleNamespace(x=np.zeros(1), cost=50.0, jac=np.array([[10.0]]))

    def solve(u: Any, **_: Any) -> Any:
        return SimpleNamespace(x=u, cost=best.cost + (10 * u[0]) ** 2 / 2)

    wide = np.array([1e9])
    unknowns = SimpleNamespace(low=-wide, high=wide, turned=lambda change: change)
    search: Any = SimpleNamespace(unknowns=unknowns, solve=solve)
    rival = SimpleNamespace(x=np.array([away]), cost=best.cost + rise / 2)
    (found,), _, _ = standard_errors(search, best, [rival])
    assert found == pytest.approx(error)
