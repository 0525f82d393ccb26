"""Infinitely many bounces in a finite time (Zeno): a body dropped flat, e = 0.5.

Bounce n takes 2 v e^n/g; with the fall, v/g (1 + e)/(1 - e). A loop over events never passes that
time, and with equal steps the body sinks into the ground. The package sums the rest of the series.
"""

import math
from typing import Any

import mpmath as mp
import numpy as np
import pytest
from oracles.geometry import support
from oracles.margins import told
from oracles.numbers import DIGITS, EPS
from rolling_ellipse import EventKind, Scene, simulate
from stability_laws import GRAVITY, B, event_loop, exponent, sinking

SPEED, E = 1.7, 0.5
UNIT = math.sqrt(GRAVITY * B)  # unit of rest_speed [m/s]


def dropped(theta: float = 0.0, **given: Any) -> Scene:
    """A body at rest that hits the ground with SPEED (if flat; if tilted, with about SPEED)."""
    height = float(support(theta, 2.0, B).h) + SPEED**2 / (2 * GRAVITY)
    return Scene(2.0, B, theta=theta, z=height, friction=0.3, restitution=E, **given)


def test_a_loop_over_events_never_gets_past_the_last_bounce() -> None:
    """In a loop over parabolas and collisions, time stops at the first bounce that takes less than
    half an ulp of the clock, n = log2(4 v/(g ulp)) = 53, however many bounces follow. The
    bounces end at v/g (1 + e)/(1 - e), where v is the speed of impact for the start height z as it
    is stored in a double."""
    with mp.workdps(DIGITS):
        v = mp.sqrt(2 * mp.mpf(GRAVITY) * (mp.mpf(dropped().z) - B))
        end = float(v / GRAVITY * (1 + mp.mpf(E)) / (1 - mp.mpf(E)))
    stood, t = event_loop(SPEED, E, 2000)
    told(f"after 2000 events t = {t!r} of {end!r} s; stands still from event {stood} on")
    assert t <= end * (1 + 4 * EPS)
    assert stood == math.ceil(math.log2(4 * SPEED / (GRAVITY * math.ulp(end))))


@pytest.mark.parametrize("step", [1e-2, 1e-3, 1e-4])
def test_equal_steps_let_the_body_sink_into_the_ground(step: float) -> None:
    """Symplectic Euler steps multiply the speed by -e where the body is below the ground and falls.
    The speed tends to e g h/(1 + e), and the body sinks by g h/(1 + e) per second."""
    t, z = sinking(SPEED, E, step, 6.0)
    half = t.size // 2
    rate = (z[half] - z[-1]) / (t[-1] - t[half])
    told(f"step {step}: sinks by {rate:.4g} m/s, {rate / (GRAVITY * step):.6f} g h")
    assert rate == pytest.approx(GRAVITY * step / (1 + E), rel=1e-9)


@pytest.mark.parametrize("theta", [0.1, 0.3])
def test_errors_of_a_tilted_body_scale_with_the_square_of_the_rest_speed(theta: float) -> None:
    """A tilted body turns as it bounces, which the sum neglects. The duration of the summed bounces
    and the turn during this time are both proportional to the rest speed; hence the slope is 2. The
    number of bounces is whole, which scatters the errors by a factor of at most e^-2. With six
    speeds per decade over four decades, this changes the slope by 0.1. `simulate` states that the
    errors are of the order of the square of rest_speed/sqrt(g b). They may be 10 times as large
    here, since they grow during the next three seconds, ten natural times."""
    speeds = np.geomspace(1e-2, 1e-6, 25)
    scene = dropped(theta)
    exact = simulate(scene, [3.0], rest_speed=1e-10 * UNIT)
    errors = []
    for speed in speeds:
        found = simulate(scene, [3.0], rest_speed=float(speed) * UNIT)
        assert [e.kind for e in found.events if e.kind is not EventKind.IMPACT] == [
            e.kind for e in exact.events if e.kind is not EventKind.IMPACT
        ]
        errors.append(max(abs(found.theta[0] - exact.theta[0]), abs(found.x[0] - exact.x[0])))
    slope = exponent(speeds, errors)
    shares = np.array(errors) / speeds**2
    told(f"{errors[0]:.1e} to {errors[-1]:.1e}: slope {slope:.3f} (2), at most {shares.max():.2g}")
    assert abs(slope - 2) <= 0.1
    assert np.all(shares <= 10)
