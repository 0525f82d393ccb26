"""`classify` gives known answers near thresholds, for arrays and with default arguments."""

import math
from typing import Any

import mpmath as mp
import numpy as np
import oracles.geometry
import oracles.rolling
import pytest
from oracles.crowd import Sample, random_sample
from oracles.numbers import DIGITS
from rolling_ellipse import Outcome, Scene, certify, classify, thresholds


@pytest.mark.parametrize("friction", [0.0, 1e-9, 0.5, math.inf])
@pytest.mark.parametrize("omega", [-1e6, -1e-5, 1.0, 1e6])
def test_a_circle_rolls_forever_unless_friction_is_zero(omega: float, friction: float) -> None:
    """Without friction the circle moves in the same way, but its outcome is SLIPS."""
    for theta in (0.0, 0.7, 500.0):
        found = classify(a=0.7, b=0.7, omega=omega, theta=theta, friction=friction)
        assert found is (Outcome.ROLLS_OVER if friction else Outcome.SLIPS)


@pytest.mark.parametrize("gravity", [9.81, 1.62])
@pytest.mark.parametrize(("a", "b"), [(2.0, 1.0), (1.5, 1.0), (0.3, 0.9), (9.5, 1.0), (1.0, 9.5)])
def test_starts_near_the_separatrix_are_edge_or_correct(a: float, b: float, gravity: float) -> None:
    """Friction is infinite, and at ratios of axes below 9.75 N stays positive even slightly above
    the separatrix. At the double nearest to the separatrix the answer is EDGE; up to 64 ulp away it
    is EDGE or correct. Every start is flat: the double nearest to pi/2 is off by 6e-17, which
    matters only through its square."""
    mp.mp.dps = DIGITS
    longer, shorter = mp.mpf(max(a, b)), mp.mpf(min(a, b))
    gyration2 = mp.mpf((a * a + b * b) / 4)  # as the package rounds it
    exact = mp.sqrt(2 * mp.mpf(gravity) * (longer - shorter) / (gyration2 + shorter**2))
    theta = 0.0 if a > b else math.pi / 2

    def found(omega: float) -> Any:
        return classify(a=a, b=b, omega=omega, theta=theta, gravity=gravity)

    nearest = float(exact)
    assert found(nearest) is Outcome.EDGE
    assert found(-nearest) is Outcome.EDGE
    for steps in range(-64, 65):
        omega = nearest + steps * math.ulp(nearest)
        truth = Outcome.ROCKS if omega < exact else Outcome.ROLLS_OVER
        assert found(omega) in (truth, Outcome.EDGE)
    for share in (1e-12, 1e-9, 1e-4):
        assert found(float(exact * (1 - share))) is Outcome.ROCKS
        assert found(-float(exact * (1 + share))) is Outcome.ROLLS_OVER


@pytest.mark.parametrize(
    ("a", "b", "omega"),
    [(2.0, 1.0, 2.5), (2.0, 1.0, 3.2), (2.0, 1.0, 4.5), (0.7, 1.9, 1.0), (20.0, 1.0, 1.0)],
)
def test_the_outcome_changes_at_the_certified_friction(a: float, b: float, omega: float) -> None:
    """A motion that starts flat passes every height it can reach, so it needs the largest |F|/N of
    the certificate. This ratio is known to about 1e-13, because the forces are rounded to about
    1e-14 of the weight and N is at least a tenth of the weight."""
    theta = 0.0 if a > b else math.pi / 2
    needed = certify(Scene(a, b, omega=omega, theta=theta)).largest_friction_needed
    assert needed is not None
    unlimited = classify(a=a, b=b, omega=omega, theta=theta)
    assert unlimited in (Outcome.ROCKS, Outcome.ROLLS_OVER)
    for side in (1, -1):
        at: dict[str, Any] = {"a": a, "b": b, "omega": side * omega, "theta": theta}
        assert classify(**at, friction=needed * (1 + 1e-11)) is unlimited
        assert classify(**at, friction=needed * (1 - 1e-11)) is Outcome.SLIPS


def test_a_body_that_rises_from_beyond_the_slip_angle_rolls_over() -> None:
    """The 2:1 disc that turns at 4.5 rad/s when flat needs a friction of 0.647 at 48.6 degrees, and
    hardly any near the tip. If the same motion starts near the tip, it passes the tip when rising
    and slips when falling."""
    friction = 0.5
    moving = oracles.rolling.motion([2.0], [1.0], [1.25], [9.81], [0.0], [4.5])
    for angle, up, down in (
        (0.0, Outcome.SLIPS, Outcome.SLIPS),
        (0.5, Outcome.SLIPS, Outcome.SLIPS),
        (1.45, Outcome.ROLLS_OVER, Outcome.SLIPS),
    ):
        sides = oracles.geometry.reduced([angle], [2.0], [1.0])
        omega = float(oracles.rolling.speed(moving, *sides)[0])
        at: dict[str, Any] = {"a": 2.0, "b": 1.0, "friction": friction}
        assert classify(**at, theta=angle, omega=omega) is up
        assert classify(**at, theta=angle, omega=-omega) is down
        assert classify(**at, theta=-angle, omega=-omega) is up
        assert classify(**at, theta=math.pi - angle, omega=omega) is down


@pytest.mark.parametrize("friction", [0.0, 0.5, 10.0, math.inf])
def test_a_body_turning_too_fast_to_stay_on_the_ground_loses_contact(friction: float) -> None:
    """A body on its tip leaves the ground if omega^2 exceeds g L/(L^2 - S^2), where L and S are the
    longer and the shorter semi-axis. For axes of 1:1.5, a ratio below root three, this is also the
    least speed at which N of rolling vanishes, so a slower body rolls over if friction is infinite.
    A change of 1e-11 in speed changes g + h'' omega^2 by 2e-11 g, far above rounding."""
    limit = math.sqrt(9.81 * 1.5 / (1.5**2 - 1))
    at: dict[str, Any] = {"a": 1.0, "b": 1.5, "friction": friction}
    below = Outcome.ROLLS_OVER if math.isinf(friction) else Outcome.SLIPS
    for side in (1, -1):
        fast, slow = side * limit * (1 + 1e-11), side * limit * (1 - 1e-11)
        assert classify(**at, omega=fast) is Outcome.LOSES_CONTACT
        assert classify(**at, omega=slow) is below
        assert classify(**at, omega=side * 1e6) is Outcome.LOSES_CONTACT
        assert classify(**at, omega=side * limit) in (Outcome.EDGE, below, Outcome.LOSES_CONTACT)


@pytest.mark.parametrize(("a", "b"), [(1e3, 1.0), (1.0, 1e3), (1.0, 1e-3), (1e-3, 1.0)])
def test_the_thinnest_body_rocks_if_slow_and_slips_if_fast(a: float, b: float) -> None:
    """g + h'' omega^2 is positive in the flat position, where h'' = L^2/S - S > 0, at any speed; at
    1e4 rad/s the ground would have to pull as soon as the body rises."""
    flat = 0.0 if a > b else math.pi / 2
    tip = math.pi / 2 - flat
    slow = 1e-3 * thresholds(a, b).contact_loss_speed
    at: dict[str, Any] = {"a": a, "b": b}
    assert classify(**at, theta=flat, omega=slow) is Outcome.ROCKS
    assert classify(**at, theta=flat, omega=1e4) is Outcome.SLIPS
    assert classify(**at, theta=flat, omega=1e4, friction=2.0) is Outcome.SLIPS
    assert classify(**at, theta=tip, omega=1e4, friction=2.0) is Outcome.LOSES_CONTACT
    assert classify(**at, theta=tip, omega=0.0) is Outcome.RESTS


def test_the_defaults_are_a_disc_on_earth_at_theta_0_with_unlimited_friction() -> None:
    a, b = np.array([2.0, 0.5, 5.0])[:, None], 1.0
    omega = np.linspace(-8, 8, 101)
    usual: dict[str, Any] = {"theta": 0.0, "friction": math.inf, "gravity": 9.81, "workers": 1}
    explicit = classify(a=a, b=b, omega=omega, gyration2=(a * a + b * b) / 4, **usual)
    assert np.array_equal(classify(a=a, b=b, omega=omega), explicit)
    assert len(np.unique(explicit)) >= 3


def test_the_number_of_workers_does_not_change_the_answers() -> None:
    sample, _ = random_sample(400, 21)
    big = Sample(*(np.tile(field, 50) for field in sample))
    big = big._replace(omega=big.omega * np.linspace(0.5, 1.5, big.omega.size))
    one, two, every = (classify(**big.arguments(), workers=n) for n in (1, 2, -1))
    assert isinstance(one, np.ndarray) and one.shape == (20_000,)
    assert np.array_equal(one, two) and np.array_equal(one, every)
