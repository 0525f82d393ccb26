"""From one half turn to 1e9: what is left of the phase.

An error of the energy that grows like t costs the phase t^2; one that is kept costs it t; drifting
constraints cost t^3. Whatever the law, a stepped motion takes as many steps as there is motion, and
where that is more than it may take, the status says where it ended. The exact motion has no span:
what it loses is what its inputs do not know.
"""

import math
from typing import Any

import make_rolling_reference as reference
import mpmath as mp
import numpy as np
import pytest
from oracles.margins import told
from oracles.numbers import DIGITS
from oracles.separatrix import GRAVITY, GYRATION2, A, B, rule
from oracles.stability import exponent
from rolling_ellipse import IntegrationError, Scene, Status, flow, period, simulate

SCENE = Scene(A, B, theta=0.2, omega=3.2)
HALF_TURN = period(SCENE) / 2
FAR = 1e9

LAWS: dict[str, tuple[float, dict[str, Any]]] = {  # power of t in the phase, and how
    "dop853, rtol 1e-10": (2, {"method": "dop853", "rtol": 1e-10, "atol": 1e-12}),
    "dop853, rtol 1e-13": (2, {"method": "dop853", "rtol": 1e-13, "atol": 1e-15}),
    "dopri5, rtol 1e-10": (2, {"method": "dopri5", "rtol": 1e-10, "atol": 1e-12}),
    "rk4, 0.005 s": (2, {"method": "rk4", "step": 0.005}),
    "gauss, 0.03 s": (1, {"method": "gauss", "step": 0.03}),
    "radau, 0.01 s": (2, {"method": "radau", "step": 0.01}),
    "multipliers, none": (3, {"model": "multipliers", "stabilization": "none"}),
    "multipliers, baumgarte": (2, {"model": "multipliers", "stabilization": "baumgarte"}),
    "multipliers, projection": (2, {"model": "multipliers", "stabilization": "projection"}),
    "multipliers, projection+energy": (
        1, {"model": "multipliers", "stabilization": "projection+energy"},
    ),
}  # fmt: skip


def test_the_exact_motion_loses_what_its_inputs_do_not_know() -> None:
    """1 to 1e9 half turns, flow and simulate, against 40 digits. The unit is what one rounding of
    every input does to the answer by then: 5e-6 rad after 1e9 half turns. Within one."""
    with mp.workdps(DIGITS):
        body = reference.Scene(A, B, GYRATION2, GRAVITY, SCENE.theta, SCENE.omega)
        moving, sensitive = reference.motion(body, rule()), reference.sensitivities(body, rule())
        for half_turns in 10.0 ** np.arange(10):
            t = float(half_turns * HALF_TURN + 0.3)
            state = moving.state(mp.mpf(t))
            units = reference.units(sensitive(mp.mpf(t)), state)
            sampled = simulate(SCENE, [t])
            answers = (
                flow(t, a=A, b=B, theta=SCENE.theta, omega=SCENE.omega),
                (sampled.theta[0], sampled.omega[0], sampled.x[0]),
            )
            off = [
                max(abs(float(v - w)) / u for v, w, u in zip(found, state, units, strict=True))
                for found in answers
            ]
            missed = abs(float(answers[0][0] - state.theta))
            told(f"{half_turns:.0e} half turns: theta {missed:.1e} rad, {max(off):.2g} units")
            assert max(off) <= 1
            assert sampled.status is Status.COMPLETED and sampled.stats["steps"] == 0
    assert units[0] < 1e-5


@pytest.mark.parametrize(("power", "how"), LAWS.values(), ids=LAWS)
def test_the_phase_is_lost_by_a_power_of_time(power: float, how: dict[str, Any]) -> None:
    """Slopes from 20 to 500 half turns; the next power is down by 1/20 where the fit begins, which
    is 0.1 or so of a slope at that end and half of it in the fit. When a radian is lost is told by
    the law, and that 1e9 half turns take more steps than `max_steps` can allow is asserted."""
    spans = np.unique(np.geomspace(20, 500, 8).round())
    times = spans * HALF_TURN
    found = simulate(SCENE, times, **({"model": "rolling"} | how))
    missed = np.abs(found.theta - simulate(SCENE, times).theta)
    slope = exponent(spans, missed)
    lost = spans[-1] * (1 / missed[-1]) ** (1 / power)
    per_turn = found.stats["steps"] / spans[-1]
    told(
        f"{missed[-1]:.1e} rad after {spans[-1]:.0f} half turns, slope {slope:.3f} ({power:g}); "
        f"a radian after {lost:.1e}; {per_turn * FAR:.1e} steps to 1e9"
    )
    assert abs(slope - power) <= 0.15
    assert per_turn * FAR > 2**31  # more than max_steps can be


HOW_FAR: dict[str, dict[str, Any]] = {
    name: how for name, (_, how) in LAWS.items() if "none" not in name
} | {"ggl": {"model": "multipliers", "method": "radau", "stabilization": "ggl", "step": 0.02}}


@pytest.mark.parametrize("how", HOW_FAR.values(), ids=HOW_FAR)
def test_a_span_beyond_max_steps_ends_with_that_answer(how: dict[str, Any]) -> None:
    """Asked for 1e9 half turns with 2000 steps: all samples up to where they ended, right; the
    others are not there, and the sentence says so. 6 to 53 half turns, on which the worst of the
    methods, ggl, loses 2e-6 times their square: 1e-2 rad."""
    settings: dict[str, Any] = {"model": "rolling", "max_steps": 2000} | how
    times = np.append(np.arange(1.0, 100.0) * HALF_TURN, FAR * HALF_TURN)
    with pytest.raises(IntegrationError, match="max_steps = 2000 steps ended at t = ") as raised:
        simulate(SCENE, times, **settings)
    found = raised.value.trajectory
    assert found.status is Status.MAX_STEPS and not found.success
    assert found.stats["steps"] <= 2000
    assert 0 < found.t.size < 100 and found.t[-1] <= found.t_end < times[found.t.size]
    missed = np.abs(found.theta - simulate(SCENE, found.t).theta)
    told(f"ended after {found.t_end / HALF_TURN:.1f} half turns, theta {missed[-1]:.1e}")
    assert np.max(missed) <= 1e-2
    assert found.t_end < 1e-6 * FAR * HALF_TURN


def test_ggl_loses_the_phase_by_the_square() -> None:
    """Radau IIA loses energy at every step; 10 to 100 half turns, for it is slow."""
    spans = np.array([10.0, 20.0, 40.0, 80.0])
    how: dict[str, Any] = {"model": "multipliers", "method": "radau", "stabilization": "ggl"}
    found = simulate(SCENE, spans * HALF_TURN, step=0.02, **how)
    missed = np.abs(found.theta - simulate(SCENE, found.t).theta)
    slope = exponent(spans, missed)
    told(f"{missed[-1]:.1e} rad after {spans[-1]:.0f} half turns, slope {slope:.3f} (2)")
    assert abs(slope - 2) <= 0.15
    assert math.isfinite(found.omega[-1])
