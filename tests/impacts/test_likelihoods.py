"""Likelihoods, covariances and evidences of measured impacts agree with sums and closed forms."""

import math
from typing import Any

import numpy as np
import pytest
from impacts.test_laws_and_fit import BODY, K2, after, approaching, series, speed
from rolling_ellipse import course, impacts
from scipy.integrate import quad
from scipy.special import logsumexp

RIGHT = math.pi / 2


def noisy(law: Any, count: int, noise: float, seed: int) -> tuple[Any, Any]:
    rng = np.random.default_rng(seed)
    before = approaching(count, seed)
    blur = rng.normal(0, noise, (3, count)) / np.array([[1.0], [1.0], [math.sqrt(K2)]])
    return before, after(before, law, 0.3, 0.6) + blur


def squares(law: Any, before: Any, seen: Any, e: Any, angle: Any) -> Any:
    """Sums of squared errors for arrays of coefficients."""
    e, mu = np.asarray(e)[..., None], np.tan(angle)[..., None]
    moved = impacts.collide(*before, **BODY, friction=mu, restitution=e, law=law)
    return (speed(np.stack(moved) - seen[:, None, None]) ** 2).sum(axis=-1)


def density(total: Any, count: int, sigma: float | None) -> Any:
    """The logarithm of the likelihood. Without sigma it is, by definition, an integral over sigma
    with the weight 1/sigma, evaluated with sigma = sqrt(total) s."""
    if sigma is not None:
        return -total / (2 * sigma**2) - count * math.log(math.sqrt(2 * math.pi) * sigma)
    peak = 1 / math.sqrt(count)

    def integrand(s: float) -> float:
        ratio = peak / s
        return ratio**count / s * math.exp((1 - ratio**2) * count / 2)

    whole = quad(integrand, 0.2 * peak, 8 * peak, epsabs=0, epsrel=1e-12, points=[peak])[0]
    scaled = math.log(whole) - count / 2 - count * math.log(peak * math.sqrt(2 * math.pi))
    return scaled - count / 2 * np.log(total)


@pytest.mark.parametrize("law", impacts.LAWS)
@pytest.mark.parametrize("sigma", [None, 0.15])
def test_evidence_and_covariance_agree_with_sums_over_the_whole_range(
    law: Any, sigma: float | None
) -> None:
    """The reference is a plain sum over 400 by 400 cells, about twenty per standard deviation. A
    kink of the likelihood changes the coarser sum of the package by less than a hundredth, and the
    largest likelihood exceeds that of the nearest cell by less than a hundredth."""
    before, seen = noisy(law, 30, 0.15, 5)
    fitted = impacts.fit(before, seen, **BODY, law=law, sigma=sigma)
    e, angle = np.meshgrid((np.arange(400) + 0.5) / 400, (np.arange(400) + 0.5) / 400 * RIGHT)
    logs = density(squares(law, before, seen, e, angle), 90, sigma)
    assert fitted.log_evidence == pytest.approx(logsumexp(logs) - 2 * math.log(400), abs=0.01)
    assert 0 <= fitted.log_likelihood - logs.max() < 0.01
    points = np.stack([e.ravel(), angle.ravel()])
    true = np.cov(points, aweights=np.exp(logs - logs.max()).ravel(), ddof=0)
    stretch = np.array([1, 1 + fitted.friction**2])
    assert fitted.covariance == pytest.approx(true * np.outer(stretch, stretch), rel=0.02)


def test_the_evidence_is_largest_for_the_law_that_generated_the_impacts() -> None:
    """Laws are compared with and without sigma. Fitting one law gives the same as fitting all."""
    sigmas: Any = (None, 0.05, None)
    for law, sigma in zip(impacts.LAWS, sigmas, strict=True):
        before, seen = series(law, 0.05, 60)
        by: Any = impacts.fit(before, seen, **BODY, law="all", sigma=sigma)
        assert tuple(by) == impacts.LAWS and all(by[each].law == each for each in by)
        assert max(by, key=lambda each: by[each].log_evidence) == law
    assert by[law] == impacts.fit(before, seen, **BODY, law=law)


def test_the_likelihood_depends_neither_on_the_measure_nor_on_the_grids() -> None:
    """The grids also find the maximum for tiny noise and for infinite friction. For exact impacts
    the sum of squares is 0, and only the factor with sigma remains."""
    before, seen = series("stronge", 1e-6, 40)
    median, rms = (impacts.fit(before, seen, **BODY, sigma=1e-6, minimise=by) for by in
                   ("median", "rms"))  # fmt: skip
    assert (median.log_likelihood, median.log_evidence) == (rms.log_likelihood, rms.log_evidence)
    nothing = density(0.0, 120, 1e-6)
    chi2 = 2 * (nothing - rms.log_likelihood)  # of 118 degrees of freedom
    assert abs(chi2 - 118) < 4 * math.sqrt(2 * 118)
    assert np.sqrt(np.diag(rms.covariance)).max() < 1e-5
    state = approaching(50, 9)
    stuck = after(state, "stronge", math.inf, 0.5)
    found = impacts.fit(list(state), list(stuck), **BODY, sigma=0.01)
    assert found.log_likelihood == pytest.approx(density(0.0, 150, 0.01), abs=1e-3)


@pytest.mark.parametrize("unit", [2.0**-1000, 2.0**100])
def test_the_unit_of_speed_scales_the_fit(unit: float) -> None:
    """A power of two changes no digit of a speed, and no coefficient. A density of N speeds is
    divided by unit^N: its logarithm is up to 72 times 693, of which doubles resolve 1e-11."""
    before, seen = course.measured_impacts()
    other = [before[0], *(unit * np.array(before[1:]))]
    for sigma, scaled in ((None, None), (0.1, 0.1 * unit)):
        how: dict[str, Any] = {"a": 0.035, "b": 0.025}
        one = impacts.fit(list(before), list(seen), **how, sigma=sigma)
        two = impacts.fit(other, list(unit * np.array(seen)), **how, sigma=scaled)
        for name in ("restitution", "friction", "restitution_error", "friction_error"):
            assert getattr(two, name) == getattr(one, name)
        for name in ("median_error", "rms_error"):
            assert getattr(two, name) == unit * getattr(one, name)
        for name in ("log_likelihood", "log_evidence"):
            shift = 3 * one.errors.size * math.log(unit)
            assert getattr(two, name) + shift == pytest.approx(getattr(one, name), abs=1e-9)
        assert np.array_equal(two.covariance, one.covariance)
