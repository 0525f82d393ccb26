"""Angles where the report's formulas divide by zero although the motion is regular.

The report's lambda3 (eq 39) divides by sin(2 psi) (a^2 - b^2): it is infinite in the flat position,
at the tip, and everywhere for a circle. The report's fourth row has tan theta, which is infinite at
the tip. The linear system of the multipliers, the rows with cos^2 theta and the support function
are regular there.
"""

import math
from typing import Any

import numpy as np
from oracles.margins import told
from oracles.report import SHAPE, start
from rolling_ellipse import report
from stability_laws import exponent, third

TIP = math.pi / 2
CLOSE = range(1, 9)  # exponents k of the distances 10^-k of theta from the tip, or of a/b from 1


def slope(values: list[float], first: int = 3) -> float:
    """Slope of ln |value| against ln of the distance, from k = first on."""
    return exponent([10.0**-k for k in CLOSE if k >= first], values[first - CLOSE[0] :])


def test_the_printed_lambda3_diverges_at_the_tip_and_for_a_circle() -> None:
    """Near the tip the printed value, from which terms are lost, grows like distance^-3: 1/sin(2
    psi) times tan^2 theta. Near a circle it grows like 1/(a - b), with a numerator that changes its
    sign near a/b = 1.003. The relative errors of these laws are the distance, 1e-3 where the fits
    begin, and 30 times the distance for the circle. With all terms the value is 0/0 in the limit.
    Its rounding error grows like 1/distance: an ulp of psi = pi/2 is 2.2e-16/10^-k of the distance,
    and tan^2 theta contains this error twice."""
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


def test_the_motion_with_the_printed_tangent_stops_at_the_tip() -> None:
    """The printed tangent is singular at a quarter turn, where the motion stops with a message."""
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
