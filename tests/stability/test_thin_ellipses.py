"""Ellipses with a/b from 1 to 1000: the curvature radius varies by a factor of (a/b)^3.

The body passes its flat side in about b/a of a swing. Equal steps must be that small everywhere;
controlled steps adapt, and their number grows only logarithmically.
"""

import pytest
from oracles.margins import told
from stability_laws import RATIOS, STABILIZATIONS, exponent, kept_by, steps_needed, steps_taken


@pytest.mark.parametrize("method", ["dop853", "dopri5"])
def test_the_number_of_controlled_steps_grows_only_logarithmically(method: str) -> None:
    """No decade of a/b adds more steps than the one before: near the flat position the motion is
    self-similar, so that each factor in a/b adds a fixed number of steps."""
    counts = [steps_taken(ratio, method=method) for ratio in RATIOS]
    told(", ".join(f"{r:g}: {n}" for r, n in zip(RATIOS, counts, strict=True)))
    ten, hundred, thousand = (counts[RATIOS.index(ratio)] for ratio in (10, 100, 1000))
    power = exponent(RATIOS[2:], counts[2:])
    told(f"decades: +{hundred - ten}, +{thousand - hundred}; as a power {power:.3f}")
    assert 0 < thousand - hundred <= hundred - ten
    assert power < 0.2
    assert thousand > 2 * counts[0]


@pytest.mark.parametrize("name", STABILIZATIONS)
def test_the_cost_of_five_coordinates_grows_slower_than_the_root_of_a_over_b(name: str) -> None:
    """r and psi change fast over the flat side, and the error control includes them."""
    power = exponent(RATIOS[2:], [steps_taken(ratio, **kept_by(name)) for ratio in RATIOS[2:]])
    told(f"{name}: as a power {power:.3f}")
    assert power < 0.5


@pytest.mark.parametrize(("method", "last"), [("rk4", 6), ("gauss", 6), ("radau", 5)])
def test_the_number_of_equal_steps_grows_like_a_over_b(method: str, last: int) -> None:
    """Passing over the flat side takes b/a of the swing, and the step is a fraction of this time;
    hence the slope is 1. It may differ by terms of the next order, 1/10 at a/b = 10, and by factors
    of 2^(1/4), which contribute 0.05 at each end of a fit over a factor of 30."""
    counts = [steps_needed(ratio, method) for ratio in RATIOS[2:last]]
    slope = exponent(RATIOS[2:last], counts)
    told(f"{method}: {', '.join(f'{count:.0f}' for count in counts)}: slope {slope:.3f} (1)")
    assert abs(slope - 1) <= 0.1
