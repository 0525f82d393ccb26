"""A fit estimates the noise, and reports whether a scene or a misreading explains the film."""

import math
from types import SimpleNamespace
from typing import Any

import judge_films
import numpy as np
import pytest
from judge_films import EXAMPLE, FREE, GUESS, KINDS, SIGMA, TIMES, WRONG, noisy
from rolling_ellipse import Fit, Scene, fit_motion, simulate
from rolling_ellipse._verbs.films import judgement  # its effect on fits is statistical
from rolling_ellipse._verbs.films.film import Film
from rolling_ellipse._verbs.films.judgement import judged, neighbours

TRACKS = ("x", "z", "theta")


def film(seed: int, t: Any = TIMES, sigma: Any = SIGMA) -> dict[str, Any]:
    return noisy(EXAMPLE, t, sigma, np.random.default_rng(seed))


def fitted(tracks: dict[str, Any], **how: Any) -> Fit:
    return fit_motion(**tracks, scene=GUESS, free=FREE, **{"sigma": SIGMA} | how)


@pytest.mark.parametrize("seed", [6, 7, 14, 23])
def test_the_fit_is_no_worse_than_one_started_at_the_true_values(seed: int) -> None:
    """From other starts, these films lead to minima whose chi2 is 9 to 30 higher."""
    row = judge_films.example(seed)
    assert row["over"] < 0.1 and "cannot determine" not in row["message"]


@pytest.mark.parametrize("seed", [8, 10, 24, 33])
def test_quarter_turn_outliers_do_not_lead_to_another_minimum(seed: int) -> None:
    row = judge_films.wild(seed)
    assert row["over"] < 0.1 and "4 of them beyond 5 sigma" in row["message"]


def test_sigma_is_estimated_for_each_track() -> None:
    """The estimated standard deviation of n numbers has a relative error of 1/sqrt(2n). The bound
    is five times this error."""
    true = {"x": 2e-4, "z": 1e-3, "theta": 0.02}
    fit = fitted(film(1, sigma=true), sigma=None)
    off = fit.sigma / list(true.values()) - 1
    assert np.all(np.abs(off) < 5 / math.sqrt(2 * TIMES.size))
    assert "sigma estimated: x 0." in fit.message and "chi2" not in fit.message
    given = fitted(film(1, sigma=true), sigma={"x": 2e-4, "z": 1e-3})
    assert given.sigma[:2].tolist() == [2e-4, 1e-3] and abs(given.sigma[2] / 0.02 - 1) < 0.4
    assert "sigma estimated: theta" in given.message


def test_unknowns_reduce_the_degrees_of_freedom_of_a_track() -> None:
    """A track of a flight has five numbers and two unknowns. The mean of sigma^2 over 80 tracks of
    3 degrees of freedom has an error of sqrt(2/240). Division by 5 would give a mean of 3/5."""
    scene, t = Scene(0.035, 0.025, z=2.0), np.arange(1, 6) / 60
    seen, shares = simulate(scene, t), []
    for seed in range(40):
        random = np.random.default_rng(seed)
        x, z = (track + random.normal(0, 1e-3, t.size) for track in (seen.x, seen.z))
        fit = fit_motion(t, x, z, scene=scene, free=("x", "x_dot", "z", "z_dot"))
        shares.append((fit.sigma[:2] / 1e-3) ** 2)
    assert abs(np.mean(shares) - 1) < 4 * math.sqrt(2 / 240)
    assert "too few neighbouring frames to judge the fit" in fit.message


def test_outliers_do_not_inflate_the_noise() -> None:
    """The median residual of n numbers gives sigma with a relative error of 1.17/sqrt(n)
    [Rousseeuw, Croux, JASA 88 (1993) 1273], and 5 % of outliers, of one sign, add a fifteenth. The
    bound is four standard deviations of the mean of three tracks. Without its factor of 1.48, the
    median is a third lower."""
    t = np.linspace(0.00125, 0.4, 320)
    tracks = film(3, t)
    for name in TRACKS:
        tracks[name][::20] += 40 * SIGMA[name]
    fit = fitted(tracks, sigma=None, loss="soft_l1")
    mean = np.mean(fit.sigma / list(SIGMA.values()))
    assert -4 * 1.17 / math.sqrt(960) < mean - 1 < 4 * 1.17 / math.sqrt(960) + 1 / 15
    assert "48 of them beyond 5 sigma" in fit.message and "not fit" not in fit.message


@pytest.mark.parametrize("seed", range(len(KINDS)))
def test_correct_films_raise_no_alarm(seed: int) -> None:
    """T, the measure of correlated residuals, exceeds 3.5 in at most one of 4000 tracks of correct
    films, and therefore in one of 300 runs of this test."""
    row = judge_films.right(seed)
    assert not row["alarm"] and row["T"] < 3.5
    assert all(abs(off) < 5 for off in row["off"].values())


@pytest.mark.parametrize("pairs", [1, 8, 13, 60])
@pytest.mark.parametrize("apart", [True, False])
def test_noise_of_any_length_raises_alarms_at_the_same_rate(
    monkeypatch: pytest.MonkeyPatch, pairs: int, apart: bool
) -> None:
    """The rate is raised to a tenth, so that 2000 tracks show it: within four standard deviations
    for separate pairs. In a row of frames the pairs overlap, and the rate is at least 0.7 of it."""
    monkeypatch.setattr(judgement, "_RARE", 0.1)
    monkeypatch.setattr(judgement, "_FEWEST", 1)
    t = np.arange(2.0 * pairs) if apart else np.arange(pairs + 1.0)
    t += 9 * (t // 2) * apart
    unknowns = SimpleNamespace(scene=EXAMPLE, lens=lambda _: (np.ones(3), np.zeros(3)))
    random, alarms = np.random.default_rng(0), 0
    for _ in range(2000):
        film = Film(t, np.column_stack([np.full(t.size, math.nan), random.normal(size=t.size), t]))
        film.data[:, 2] = math.nan
        search: Any = SimpleNamespace(
            film=film, unknowns=unknowns, sigma=np.ones(3), loss="linear", dof=t.size,
            residuals=lambda _, film=film: film.data[:, 1],
        )  # fmt: skip
        given = np.array([math.nan, math.nan, 1.0])
        alarms += not judged(search, SimpleNamespace(x=None), given).fits
    assert (0.1 if apart else 0.07) - 4 * math.sqrt(0.09 / 2000) < alarms / 2000
    assert alarms / 2000 < 0.1 + 4 * math.sqrt(0.09 / 2000)


@pytest.mark.parametrize("frames", [12, 13])
def test_a_wrong_short_film_is_rejected_or_said_to_be_too_short(frames: int) -> None:
    """A flight whose angles are off by 0.08 rad. Even 12 frames of one sign are rarer than the
    alarm of a right film, but 12 right ones are too few to say that the scene fits."""
    scene = Scene(0.035, 0.025, z=0.3, theta=0.5, omega=8.0, x_dot=0.5, z_dot=0.3)
    free, t = ("omega", "x_dot", "z_dot"), np.arange(1, frames + 1) / 60
    for seed in range(3):
        right = noisy(scene, t, SIGMA, np.random.default_rng(seed))
        few = fit_motion(**right, scene=scene, free=free).message
        assert ("too few neighbouring frames" in few) == (frames < 13) and "not fit" not in few
        wrong = right | {"theta": right["theta"] + 0.08}
        assert "the scene does not fit" in fit_motion(**wrong, scene=scene, free=free).message


def test_stated_errors_cover_the_other_minima() -> None:
    """More friction than the body needs fits nearly as well, with a restitution that is 4.4
    linearised errors away."""
    assert abs(judge_films.right(6)["off"]["restitution"]) < 3


@pytest.mark.parametrize(
    ("kind", "sigma"),
    [
        ("counter-clockwise", None), ("other axis", SIGMA), ("ground 3 mm", None),
        ("centimetres", None), ("y down", None), ("image", SIGMA), ("milliseconds", None),
        ("frames", SIGMA), ("slowed twice", None), ("smoothed", None),
    ],
)  # fmt: skip
def test_wrong_films_are_rejected_and_their_misreading_is_named(kind: str, sigma: Any) -> None:
    (change, reading), tracks = WRONG[kind], film(11)
    fit = fitted(tracks | change(tracks, np.random.default_rng(1)), sigma=sigma)
    assert "the scene does not fit the film" in fit.message
    assert ("it fits with" in fit.message) == bool(reading) and reading in fit.message
    if "not fitted" in fit.message:
        assert fit.scene == GUESS and all(map(math.isinf, fit.errors.values()))


@pytest.mark.parametrize("seed", [0, 3, 4])
def test_units_that_a_free_inertia_makes_equal_are_all_named(seed: int) -> None:
    """Milliseconds of a rocking body. A time that is 4 % too long fits as well as the true one,
    with another inertia. If the inertia is known, only the true unit fits."""
    egg, t = Scene(0.035, 0.025, theta=0.6), np.arange(100) / 60
    rocking = noisy(egg, t, SIGMA, np.random.default_rng(seed)) | {"t": 1000 * t}
    guess = egg.replace(inertia=4e-4)
    fit = fit_motion(**rocking, scene=guess, free=("inertia",))
    _, _, named = fit.message.partition("it fits with ")
    assert named.startswith("t = t / 1000 or ") and "t = t / 960" in named
    assert named.endswith(", which the free unknowns cannot tell apart.")
    fit = fit_motion(**rocking, scene=egg.replace(theta=0.5), free=("theta",))
    assert fit.message.endswith("it fits with t = t / 1000.")


@pytest.mark.parametrize("start", [100.0, 1.7e9])
def test_a_film_of_another_days_clock_is_read_from_its_first_frame(start: float) -> None:
    """No search is made at the late times, which would take ten times as long. A body that rolls
    for 100 s is fitted, although its motion from the first frame fits another start as well."""
    t = TIMES - TIMES[0]
    late = fitted(film(1, t) | {"t": t + start}, sigma=None)
    assert "not fitted; the film starts 1" in late.message and late.scene == GUESS
    assert late.message.endswith("it fits with t = t - t[0].")
    scene = Scene(0.035, 0.025, theta=0.3, omega=8.0, friction=2.0)
    rolling = noisy(scene, t + 100, SIGMA, np.random.default_rng(2))
    free = ("theta", "omega")
    fit = fit_motion(**rolling, scene=scene.replace(omega=8.001), free=free, sigma=SIGMA)
    assert "not fit" not in fit.message and abs(fit.values["omega"] - 8) < 5 * fit.errors["omega"]


def test_no_misreading_explains_the_film_of_a_body_in_thick_air() -> None:
    """T, the measure of correlated residuals, exceeds 3.5, the bound for correct films."""
    tracks = film(11)
    fit = fitted(tracks | WRONG["in air"][0](tracks, None), sigma=None)
    assert "does not fit" in fit.message and "it fits" not in fit.message
    assert judge_films.largest(fit) > 3.5


def test_a_frozen_or_jumping_track_is_reported_as_worse_than_any_tracker() -> None:
    tracks = film(2)
    still = fitted(tracks | {"theta": np.full(80, 0.5)}, sigma=None)
    assert "theta is off by" in still.message and "more than with any tracker" in still.message
    half = np.random.default_rng(2).random(80) < 0.5
    tracks["z"][half] += np.random.default_rng(3).uniform(-0.05, 0.05, half.sum())
    assert "z is off by" in fitted(tracks, sigma=None).message
    many = fitted(tracks, loss="soft_l1").message
    assert "of 80 values of z are beyond 5 sigma; the scene does not fit" in many


def test_frames_on_either_side_of_a_missing_one_are_not_neighbours() -> None:
    """Whole rows of the film may be missing, or single numbers."""
    off = np.arange(8.0)
    off[3] = np.nan
    one, other = neighbours(np.array([0.0, 1, 2, 3, 4, 7, 8, 9]), off)
    assert one.tolist() == [0, 1, 5, 6] and other.tolist() == [1, 2, 6, 7]
