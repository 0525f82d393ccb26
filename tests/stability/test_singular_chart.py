"""Where the report's formulas divide by zero and the motion has nothing to be afraid of.

Its lambda3 (eq 39) divides by sin(2 psi) (a^2 - b^2), its fourth row has tan theta: infinite at
every quarter turn, and for a circle everywhere. The linear system of the multipliers, the rows with
cos^2 theta and the support function are regular there.
"""

import math
from typing import Any

import mpmath as mp
import numpy as np
import pytest
import rolling_ellipse as rl
from oracles.constraints import lead
from oracles.geometry import support
from oracles.margins import told
from oracles.numbers import DIGITS, EPS
from oracles.report import BODY, SHAPE, start
from oracles.rolling import forces_by_differentiation
from rolling_ellipse import Scene, report, simulate
from stability_laws import exponent, third

TIP = math.pi / 2
MASS, GRAVITY = BODY["mass"], BODY["gravity"]
CLOSE = range(1, 9)  # k: 10^-k rad, or parts, beside the singular place


def slope(values: list[float], first: int = 3) -> float:
    """Of ln |value| against ln of the distance, from k = first on."""
    return exponent([10.0**-k for k in CLOSE if k >= first], values[first - CLOSE[0] :])


# ------------------------------------------------------------------------- as printed


def test_the_printed_lambda3_is_infinite_at_the_tip_and_for_a_circle() -> None:
    """1/sin(2 psi) and tan^2 theta: the distance to the power -3, lost terms and all. For a circle
    1/(a - b), and a numerator that happens to change its sign near a/b = 1.003. The next order is
    the distance itself: 1e-3 where the fits begin, and some 30 times the distance of the circle.
    With all terms it is zero over zero: the value exists, its rounding grows like 1/distance (an
    ulp of psi = pi/2 is of the distance 2.2e-16/10^-k, and tan^2 theta has it twice)."""
    at_tip = [third(TIP + 10.0**-k, 2.0, 1.0).printed for k in CLOSE]
    of_circle = [third(0.7, 1 + 10.0**-k, 1.0).printed for k in CLOSE]
    limit = third(TIP + 1e-5, 2.0, 1.0).complete
    distances = 10.0 ** -np.arange(8, 13)
    lost = [third(TIP + distance, 2.0, 1.0).complete / limit - 1 for distance in distances]
    told(f"at the tip slope {slope(at_tip):.4f} (-3), up to {max(map(abs, at_tip)):.1e} N")
    told(f"for a circle {slope(of_circle, 5):.4f} (-1), up to {max(map(abs, of_circle)):.1e} N")
    told(f"complete: {lost[-1]:.1e} lost, slope {exponent(distances, lost):.3f} (-1)")
    assert abs(slope(at_tip) + 3) <= 1e-3
    assert abs(slope(of_circle, 5) + 1) <= 1e-2
    for place in ((0.0, 2.0, 1.0), (0.7, 1.0, 1.0)):
        assert not math.isfinite(third(*place).printed) and math.isfinite(third(*place).solved)
    assert abs(exponent(distances, lost) + 1) <= 0.05
    assert abs(lost[-1]) > 1e-5


def test_the_tangent_of_the_fourth_row_is_infinite_at_the_tip() -> None:
    """sec^2 theta: slope -2; cos^2 theta times that row is (a^2, b^2 at most) and no more."""
    places = [start(TIP + 10.0**-k, 1.0)[0] for k in CLOSE]

    def largest(printed: tuple[str, ...]) -> list[float]:
        rows = [report.constraint_matrix(q, printed=printed, **SHAPE) for q in places]
        return [float(np.abs(row).max()) for row in rows]

    printed, right = largest(report.CODE), largest(())
    told(f"slope {slope(printed):.4f} (-2), up to {max(printed):.1e}; right {max(right):.3g}")
    assert abs(slope(printed) + 2) <= 1e-3
    assert max(right) <= 16.0 * (1 + 8 * EPS)


def test_the_tangent_does_not_get_over_the_tip() -> None:
    """With tan as printed the system is singular at a quarter turn: it stops, and says when."""
    q, q_dot = start(0.0, 3.2)
    how: dict[str, Any] = SHAPE | {"equations": "printed", "method": "rk4", "step": 0.02}
    times = np.linspace(0, 12, 121)
    motion = report.simulate(q, q_dot, times, printed=("tan",), **how)
    assert isinstance(motion, report.PrintedMotion)
    assert 0 < motion.t.size < 121 and "at 1.98 s" in motion.message
    assert np.all(np.isfinite(motion.q))
    over = report.simulate(q, q_dot, times, printed=(), **how)
    assert isinstance(over, report.PrintedMotion)
    assert over.message == "" and over.q[-1, 2] > 2 * math.pi


# ------------------------------------------------------------------------- as it is solved

BESIDE = [TIP + side * 10.0**-k for k in (3, 8, 12) for side in (1, -1)]
PLACES = [0.0, TIP, -TIP, math.pi, 3 * TIP, *BESIDE]
BODIES = [(2.0, 1.0), (1.0, 1.0), (1 + 1e-8, 1.0), (1.0, 1 + 1e-13), (1.0, 2.0)]


@pytest.mark.parametrize(("a", "b"), BODIES)
def test_the_multipliers_of_the_linear_system_are_right_in_every_place(a: float, b: float) -> None:
    """F and N by differentiating h and the energy alone; lambda3 = N h/r, as the equation of r has
    it, whose mass is 0, and lambda4 = 0. 16 ulp of m (g + rho omega^2), the largest of the terms,
    and the long axis: nine unknowns, each a sum of a few products.
    """
    worst = 0.0
    for theta in [*PLACES, 0.7]:
        with mp.workdps(DIGITS):
            at = support(mp.mpf(theta), mp.mpf(a), mp.mpf(b))
            gyration2 = (mp.mpf(a) ** 2 + mp.mpf(b) ** 2) / 4
            inertia = gyration2 + at.h**2 + at.slope**2
            energy = inertia * mp.mpf(3.2) ** 2 / 2 + mp.mpf(GRAVITY) * at.h
            normal, friction = forces_by_differentiation(theta, a, b, gyration2, GRAVITY, energy)
            squeeze = normal * at.h / mp.hypot(at.h, at.slope)
            truth = [float(MASS * value) for value in (friction, normal, squeeze, mp.mpf(0))]
        scene = Scene(a, b, mass=MASS, gravity=GRAVITY, theta=theta, omega=3.2)
        for model in ("multipliers", "rolling"):
            found = simulate(scene, [0.0], model=model).multipliers[0]
            scale = MASS * (GRAVITY + (max(a, b) ** 2 / min(a, b)) * 3.2**2)
            worst = max(worst, float(np.max(np.abs(found - truth))) / (EPS * scale))
    told(f"{a:g}:{b:g}: {worst:.2g} ulp")
    assert worst <= 16


@pytest.mark.parametrize(("a", "b"), BODIES)
def test_the_coordinates_pass_every_quarter_turn_smoothly(a: float, b: float) -> None:
    """psi and r and their rates at a quarter turn and 1e-3 ... 1e-12 rad beside it, against the
    continuous formula in 40 digits: 16 ulp of their sizes, and no branch."""
    aspect = max(a / b, b / a)
    for theta in PLACES:
        q, q_dot = rl.kinematics(theta, 3.2, a=a, b=b)
        held = rl.constraints(q, q_dot, a=a, b=b)
        with mp.workdps(DIGITS):
            turned, long_a, long_b = mp.mpf(theta), mp.mpf(a), mp.mpf(b)
            psi = turned + lead(turned, long_a, long_b)
            rate = 3.2 * (1 + mp.diff(lambda y: lead(y, long_a, long_b), turned))  # noqa: B023
            at = support(turned, long_a, long_b)
            r = mp.hypot(at.h, at.slope)
            off = [float(abs(q[3] - psi)), float(abs(q[4] - r)), float(abs(q_dot[3] - rate))]
        assert off[0] <= 16 * EPS * max(1.0, abs(theta)), theta
        assert off[1] <= 16 * EPS * max(a, b), theta
        assert off[2] <= 16 * EPS * 3.2 * aspect**2, theta
        assert np.max(np.abs(held.position)) <= 16 * EPS * max(a, b) * max(1.0, abs(theta)), theta


@pytest.mark.parametrize("stabilization", ["none", "projection", "projection+energy"])
def test_a_motion_of_the_multipliers_passes_ten_quarter_turns(stabilization: Any) -> None:
    """Its multipliers along the way are those of the exact motion, whichever place it is in: rtol
    is 1e-12, forces vary as fast as theta (some 40 N a rad), and e^5 is what is made of it."""
    scene = Scene(2.0, 1.0, mass=MASS, gravity=GRAVITY, omega=3.2)
    times = np.linspace(0, 2.5 * rl.period(scene), 2001)
    found = simulate(
        scene, times, model="multipliers", stabilization=stabilization, rtol=1e-12, atol=1e-14
    )
    exact = simulate(scene, times)
    off = float(np.max(np.abs(found.multipliers - exact.multipliers)))
    told(f"{stabilization}: {off:.1e} N")
    assert exact.theta[-1] > 10 * TIP - 1e-6
    assert off <= 1e-6
