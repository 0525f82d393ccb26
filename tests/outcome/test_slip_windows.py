"""`slip_windows` contain exactly the speeds at which rolling needs more than the given friction.

The oracle samples |F|/N over the angle in long double. At each angle F and N are linear in omega^2.
The package finds the ends of windows by scanning the angle, and proves them with polynomials.
"""

import math
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
import oracles.rolling
import pytest
from rolling_ellipse import Outcome, Scene, Validity, certify, outcome, simulate, thresholds

GRAVITY = 3.7
Windows = tuple[tuple[float, float], ...]


class Body(NamedTuple):
    a: float
    b: float
    gyration2: float
    friction: float

    def windows(self) -> Windows:
        a, b, gyration2, friction = self
        found = thresholds(a, b, gyration2=gyration2, friction=friction, gravity=GRAVITY)
        windows = found.slip_windows
        assert found.slip_speed == windows[0][0] and windows[-1][1] == math.inf
        edges = [end for window in windows for end in window]
        assert len(windows) <= 2 and edges == sorted({*edges})
        # only a body that slips when released from rest has two windows
        assert len(windows) < 2 or friction < friction_at_rest(a, b, gyration2) * (1 + 1e-5)
        return windows

    def scene(self, omega: float) -> Scene:
        a, b, gyration2, friction = self
        flat = 0.0 if a >= b else math.pi / 2
        return Scene(
            a, b, inertia=gyration2, gravity=GRAVITY, friction=friction, theta=flat, omega=omega
        )


def friction_at_rest(a: float, b: float, gyration2: float) -> float:
    """The least friction that prevents slip from rest at any angle: max h |h'| / (k^2 + h^2)."""
    theta = np.linspace(0, math.pi / 2, 4001)
    h2 = (a * np.sin(theta)) ** 2 + (b * np.cos(theta)) ** 2
    lead = abs(a * a - b * b) * np.sin(theta) * np.cos(theta)  # h |h'|
    return float(np.max(lead / (gyration2 + h2)))


def bodies(count: int, seed: int, decades: float) -> Iterator[Body]:
    """Random bodies; every second one slips if it is released from rest at some angle."""
    rng = np.random.default_rng(seed)
    for i in range(count):
        size, aspect = 10 ** rng.uniform(-1, 1), 10 ** rng.uniform(-decades, decades)
        a, b = size, size * aspect
        gyration2 = max(a, b) ** 2 * 10 ** rng.uniform(-4, 1)
        friction = 10 ** rng.uniform(-3, 2)
        if i % 2:
            friction = friction_at_rest(a, b, gyration2) * (1 - 10 ** rng.uniform(-6, -0.3))
        yield Body(a, b, gyration2, float(friction))


def ends(windows: Windows) -> list[float]:
    return [end for window in windows for end in window if 0 < end < math.inf]


def is_inside(windows: Windows, omega: Any) -> Any:
    return np.any([(low < omega) & (omega < high) for low, high in windows], axis=0)


def test_windows_agree_with_samples_of_the_needed_friction() -> None:
    """At 150 speeds, including those a relative 1e-8 from each end, rolling needs more than the
    given friction exactly if the speed is inside a window."""
    two = 0
    for body in bodies(60, 11, decades=1.5):
        windows = body.windows()
        two += len(windows) == 2
        beside = [end * (1 + by) for end in ends(windows) for by in (-1e-8, 1e-8)]
        around = np.geomspace(ends(windows)[0] / 5, ends(windows)[-1] * 5, 150 - len(beside))
        speeds = np.concatenate([beside, around])
        a, b, gyration2, friction = body
        motions = oracles.rolling.passing_flat(a, b, gyration2, GRAVITY, speeds)
        needs_more = oracles.rolling.extremes(motions).needed > friction
        assert np.array_equal(needs_more, is_inside(windows, speeds)), body
    assert two >= 15


def test_windows_agree_with_certify_and_outcome() -> None:
    """Rolling is invalid inside windows and valid outside. It is undecided only near an end."""
    rng = np.random.default_rng(12)
    two = 0
    for body in bodies(500, 13, decades=3):
        windows = body.windows()
        two += len(windows) == 2
        edges = ends(windows)
        speeds = [end * (1 + by) for end in edges for by in (-1e-3, -1e-9, 1e-9, 1e-3)]
        speeds += [*np.geomspace(edges[0] / 10, edges[-1] * 10, 4), *rng.uniform(0, edges[-1], 2)]
        for omega in map(float, speeds):
            inside = bool(is_inside(windows, omega))
            scene = body.scene(omega)
            validity, first = certify(scene).validity, outcome(scene)
            if validity is Validity.EDGE:
                assert min(abs(omega / end - 1) for end in edges) < 1e-8, (body, omega)
                continue
            assert validity is (Validity.INVALID if inside else Validity.VALID), (body, omega)
            rolls = first in (Outcome.ROCKS, Outcome.ROLLS_OVER)
            assert rolls != inside or first is Outcome.EDGE, (body, omega, first)
    assert two >= 100


def test_a_body_between_its_slip_windows_rolls_forever() -> None:
    """A 2:1 disc with friction 0.4 slips at 1.8 and at 4.6 rad/s, but neither at 2.5 rad/s, where
    it rocks, nor at 3.5 rad/s, where it rolls over and over. The contact model confirms this."""
    (low, high), (again, _) = thresholds(2.0, 1.0, friction=0.4).slip_windows
    assert low < 1.8 < high < 2.5 < 3.5 < again < 4.6
    for omega, slips in ((1.0, False), (1.8, True), (2.5, False), (3.5, False), (4.6, True)):
        scene = Scene(2.0, 1.0, friction=0.4, omega=omega)
        motion = simulate(scene, 10.0, model="contact")
        assert bool(motion.events) == slips, omega


def test_windows_are_right_at_the_limits_of_friction() -> None:
    """Without friction any moving body slips, even a circle; any friction suffices for a circle."""
    for a, b in ((2.0, 1.0), (1.0, 2.0), (1.3, 1.3)):
        found = thresholds(a, b, friction=0.0)
        assert found.slip_windows == ((0.0, math.inf),)
        assert (found.slip_speed, found.slip_angle) == (0.0, 0.0 if a >= b else math.pi / 2)
        assert certify(Scene(a, b, omega=1e-6, friction=0.0)).validity is Validity.INVALID
        found = thresholds(a, b)
        loss = found.contact_loss_speed
        assert found.slip_windows == (((loss, math.inf),) if a != b else ())
    assert thresholds(1.3, 1.3, friction=1e-300).slip_windows == ()
    assert thresholds(1.3, 1.3, friction=1e-300).slip_speed == math.inf
    for friction in (1e-300, 1e-150, 1e-12, 1e6):
        ((low, _),) = thresholds(2.0, 1.0, friction=friction).slip_windows
        assert 0 <= low <= thresholds(2.0, 1.0).contact_loss_speed
    assert low == pytest.approx(thresholds(2.0, 1.0).contact_loss_speed, rel=1e-5)
