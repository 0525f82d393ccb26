"""a/b from 1 to 1000: the radius of curvature varies by (a/b)^3 in a turn, and with it the rates.

The body swings over its flat side in some b/a of a swing. Steps of one size must be as small as
that everywhere; controlled steps need only find it, at a price that grows with the logarithm; the
exact motion takes no steps.
"""

import math
from typing import Any

import make_rolling_reference as reference
import mpmath as mp
import pytest
from oracles.margins import told
from oracles.separatrix import GRAVITY, rule
from oracles.stability import exponent
from rolling_ellipse import Scene, flow, period, simulate

RATIOS = [1.5, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0]
ACCURATE = 1e-6  # the angle after one swing, with steps of one size [rad]


def swing(ratio: float) -> Scene:
    """A swing with half the energy of the barrier, which ground and friction can hold."""
    gyration2 = (ratio * ratio + 1) / 4
    return Scene(ratio, 1.0, omega=math.sqrt(GRAVITY * (ratio - 1) / (gyration2 + 1)))


def steps_of(scene: Scene, **how: Any) -> int:
    """All that were tried in one swing, and what it missed is told."""
    once = period(scene)
    found = simulate(scene, [once], model="rolling", **how)
    assert abs(found.theta[0]) <= 1e-7  # rtol 1e-9 a step, a hundred of them
    return found.stats["steps"] + found.stats["rejected_steps"]


@pytest.mark.parametrize("method", ["dop853", "dopri5"])
def test_controlled_steps_grow_with_the_logarithm_only(method: str) -> None:
    """Each decade of a/b adds as many steps or fewer: towards the flat the motion is its own
    image, so that a factor in a/b adds a number of steps. As a power, a/b to less than 0.2."""
    counts = [steps_of(swing(ratio), method=method, rtol=1e-9, atol=1e-11) for ratio in RATIOS]
    told(f"{method}: " + ", ".join(f"{r:g}: {n}" for r, n in zip(RATIOS, counts, strict=True)))
    ten, hundred, thousand = (counts[RATIOS.index(ratio)] for ratio in (10, 100, 1000))
    power = exponent(RATIOS[2:], counts[2:])
    told(f"decades: +{hundred - ten}, +{thousand - hundred}; as a power {power:.3f}")
    assert 0 < thousand - hundred <= hundred - ten
    assert power < 0.2
    assert thousand > 2 * counts[0]


def needed(scene: Scene, method: Any) -> float:
    """Fewest steps of one size in a swing, by factors of 2^(1/4), that are accurate, as twice as
    many are."""
    once = period(scene)

    def accurate(count: float) -> bool:
        step = once / count
        found = simulate(
            scene, [once], model="rolling", method=method, step=step, raise_on_failure=False
        )
        return bool(found.success and abs(found.theta[0]) < ACCURATE)

    count = 32.0
    while not (accurate(count) and accurate(2 * count)):
        count *= 2**0.25
    return count


@pytest.mark.filterwarnings("ignore::rolling_ellipse.StabilityWarning")
@pytest.mark.parametrize("method", ["rk4", "gauss"])
def test_steps_of_one_size_grow_like_a_over_b(method: str) -> None:
    """The passage is b/a of the swing, and the step a part of it: slope 1, but for terms of the
    next order, 1/10 at a/b = 10, and the factors of 2^(1/4), which at both ends of a fit over a
    factor of 30 are 0.05 each."""
    ratios = RATIOS[2:6]
    counts = [needed(swing(ratio), method) for ratio in ratios]
    slope = exponent(ratios, counts)
    told(f"{method}: " + ", ".join(f"{r:g}: {n:.0f}" for r, n in zip(ratios, counts, strict=True)))
    told(f"slope {slope:.3f} (1)")
    assert abs(slope - 1) <= 0.1


@pytest.mark.parametrize("ratio", [1.5, 30.0, 1000.0])
def test_the_exact_motion_takes_no_steps_and_loses_nothing(ratio: float) -> None:
    """At times all over a swing and a thousand swings on, against 40 digits; the unit is what one
    rounding of every input does to the answer: within one."""
    with mp.workdps(40):
        scene = swing(ratio)
        once = period(scene)
        body = reference.Scene(ratio, 1.0, scene.gyration2, GRAVITY, 0.0, scene.omega)
        moving, sensitive = reference.motion(body, rule()), reference.sensitivities(body, rule())
        worst = 0.0
        for share in (1e-3, 0.1, 0.2499, 0.4, 0.4999, 0.77, 1000.3):
            t = share * once
            state = moving.state(mp.mpf(t))
            units = reference.units(sensitive(mp.mpf(t)), state)
            found = flow(t, a=ratio, b=1.0, theta=0.0, omega=scene.omega)
            off = [abs(float(v - w)) / u for v, w, u in zip(found, state, units, strict=True)]
            worst = max(worst, *off)
    told(f"a/b = {ratio:g}: {worst:.2g} units")
    assert worst <= 1
    stats = simulate(scene, [once], model="rolling", method="exact").stats
    assert stats["steps"] == stats["evaluations"] == 0
