"""With friction just above or below what rolling needs, the grip holds or is lost for an instant.

The friction needed has a smooth maximum during the rise. If friction falls short of it by 10^-k,
more is needed over 10^(-k/2) of the path. Beyond some k neither samples nor ends of steps show
this; the certificate decides signs of polynomials and misses no such place.
"""

import math
from functools import cache
from typing import Any

import mpmath as mp
import numpy as np
import pytest
from oracles.geometry import support
from oracles.margins import told
from oracles.numbers import DIGITS
from rolling_ellipse import EventKind, Outcome, Scene, Validity, certify, classify, period, simulate
from stability_laws import GRAVITY, GYRATION2, A, B, exponent, rms, shortfall
from stability_laws import GRAZING as SCENE

OMEGA = SCENE.omega
DISTANCES = range(1, 16)  # exponents k of the distances 10^-k
# Exponents with a sure verdict: the polynomial of degree 10 is known to 1e-12 of its terms.
DECIDED = range(1, 12)


def ratio(theta: Any) -> Any:
    """|F|/N of rolling with the energy of SCENE, from Newton's law, in the arithmetic of theta."""
    at = support(theta, *((mp.mpf(A), mp.mpf(B)) if isinstance(theta, mp.mpf) else (A, B)))
    inertia = GYRATION2 + at.h**2 + at.slope**2
    omega2 = ((GYRATION2 + B * B) * OMEGA**2 + 2 * GRAVITY * (B - at.h)) / inertia
    bend = (A * B) ** 2 / at.h**3
    turning = -at.slope * (GRAVITY + bend * omega2) / inertia
    return abs(at.h * turning + at.slope * omega2) / (
        GRAVITY + at.slope * turning + at.curvature * omega2
    )


@cache
def need() -> tuple[Any, Any]:
    """The largest |F|/N and its angle, from the zero of the derivative, in 40 digits."""
    with mp.workdps(DIGITS):
        where = mp.findroot(lambda y: mp.diff(ratio, y), mp.mpf("0.85"))
        return ratio(where), where


def friction(k: int, side: int) -> float:
    """The friction needed, times 1 + side 10^-k."""
    with mp.workdps(DIGITS):
        return float(need()[0] * (1 + side * mp.mpf(10) ** -k))


def test_samples_miss_shortfalls_of_friction_up_to_the_square_of_their_spacing() -> None:
    """A maximum is flat; hence the slope is -2. It scatters by 0.05, since the rms of 64 draws
    scatters by a tenth over two decades. A grid therefore misses a lack of friction below this
    shortfall."""
    counts = [30, 100, 300, 1000, 3000]
    places = np.random.default_rng(0).uniform(0, 1, 64)
    short = [rms(shortfall(count, places)) for count in counts]
    slope = exponent(counts, short)
    for count, missed in zip(counts, short, strict=True):
        told(f"{count} samples: short by {missed:.1e}, blind from k = {-math.log10(missed):.1f} on")
    told(f"slope {slope:.3f} (-2)")
    assert abs(slope + 2) <= 0.05


@pytest.mark.parametrize("side", [1, -1])
def test_the_certificate_misses_nothing_down_to_1e_minus_11(side: int) -> None:
    """On both sides of the friction needed, verdicts are right down to the distance that doubles
    resolve; closer to it they are right or EDGE. `classify` agrees, since it uses the same
    polynomial."""
    verdicts = []
    for k in DISTANCES:
        mu = friction(k, side)
        rolls = mu > need()[0]
        assert rolls == (side > 0)
        verdict = certify(Scene(A, B, omega=OMEGA, friction=mu)).validity
        outcome = classify(a=A, b=B, omega=OMEGA, friction=mu)
        verdicts.append(verdict.name)
        proved = Validity.VALID if rolls else Validity.INVALID
        becomes = Outcome.ROLLS_OVER if rolls else Outcome.SLIPS
        edge = k not in DECIDED
        assert verdict is proved or (edge and verdict is Validity.EDGE), k
        assert outcome is becomes or (edge and outcome is Outcome.EDGE), k
    told(", ".join(f"{side:+d}e-{k} {v}" for k, v in zip(DISTANCES, verdicts, strict=True)))
    assert verdicts[-1] == "EDGE"


@pytest.mark.parametrize("slope", [0.0, 1e-300], ids=["by the certificate", "by the event finder"])
def test_the_motion_slips_only_where_friction_is_insufficient(slope: float) -> None:
    """On level ground the certificate gives the angle. On the slightest slope an event of the
    stepped motion gives it, because minima of mu N - |F| are searched for, not changes of sign.
    |F|/N first exceeds mu at an angle of 10^(-k/2) before its maximum, which is known to some ulps
    of |F|/N over its slope, 1e-15 10^(k/2), and on a slope to the error of the steps."""
    maximum = need()[1]
    for k in DECIDED:
        for side in (1, -1):
            mu = friction(k, side)
            scene = Scene(A, B, omega=OMEGA, friction=mu, slope=slope)
            motion = simulate(scene, period(SCENE) / 4, model="contact")
            slips = [event for event in motion.events if event.kind is EventKind.SLIP]
            assert bool(slips) == (side < 0), (k, side)
            if not slips:
                assert motion.events == ()
                continue
            with mp.workdps(DIGITS):
                low, high = mp.mpf("0.5"), maximum
                for _ in range(100):
                    middle = (low + high) / 2
                    low, high = (middle, high) if ratio(middle) < mu else (low, middle)
            off = abs(slips[0].state_before.theta - float(low))
            told(f"k = {k}: slips at {slips[0].state_before.theta:.9f} rad, off by {off:.1e}")
            assert off <= (1e-14 if slope == 0 else 1e-13) * 10 ** (k / 2)
