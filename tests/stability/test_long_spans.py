"""Phase errors of methods, extrapolated to 1e9 half turns.

An energy error that grows like t gives a phase error like t^2. A constant energy error gives one
like t, and drifting constraints one like t^3. The number of steps grows with the span in any case.
"""

from typing import Any

import numpy as np
import pytest
from oracles.margins import told
from stability_laws import LAWS, SPANS, exponent, kept_by, phase_missed

FAR = 1e9
ALL: dict[str, tuple[int, dict[str, Any]]] = LAWS | {
    "dop853, rtol 1e-13": (2, {"method": "dop853", "rtol": 1e-13, "atol": 1e-15}),
    "dopri5, rtol 1e-10": (2, {"method": "dopri5", "rtol": 1e-10, "atol": 1e-12}),
    "radau, 0.01 s": (2, {"method": "radau", "step": 0.01}),
    "multipliers, baumgarte": (2, kept_by("baumgarte")),
    "ggl, 0.02 s": (2, kept_by("ggl", method="radau", step=0.02)),
}


@pytest.mark.parametrize("name", ALL)
def test_the_phase_error_grows_as_a_power_of_time(name: str) -> None:
    """Slopes are fitted from 20 to 500 half turns (10 to 80 for ggl, which is slow). At the first
    span the next power of time is 1/20 as large, which changes the slope by about 0.1 there and by
    half of this in the fit. The law predicts when a radian is lost; 1e9 half turns take more steps
    than `max_steps` allows."""
    power, how = ALL[name]
    spans = np.array([10.0, 20.0, 40.0, 80.0]) if "ggl" in name else SPANS
    missed, steps = phase_missed(spans, **how)
    slope = exponent(spans, missed)
    lost = spans[-1] * (1 / missed[-1]) ** (1 / power)
    told(
        f"{missed[-1]:.1e} rad after {spans[-1]:.0f} half turns, slope {slope:.3f} ({power:g}); "
        f"a radian after {lost:.1e}; {steps * FAR:.1e} steps to 1e9"
    )
    assert abs(slope - power) <= 0.15
    assert steps * FAR > 2**31
