"""`flow` at many times of one motion uses a table; neither order nor number of times matters.

The bits depend only on whether there are enough times for a table (40). Hence the comparison of 151
times with 40 digits in test_flow_reference.py holds for any number of times.
"""

import math
import tracemalloc
from typing import Any

import numpy as np
import pytest
from oracles.flow import MOTIONS as flow_motions
from oracles.flow import ROLL_OVER, arguments
from oracles.margins import told
from oracles.spread import known_to, path_grain, state
from rolling_ellipse import flow

MOTIONS = flow_motions | {
    "on the way back": (2.0, 1.0, 1.25, 9.81, 0.2, -1.0),
    "from rest": (2.0, 1.0, 1.25, 9.81, 0.5, 0.0),
    "tiny": (2.0, 1.0, 1.25, 9.81, 1e-9, 0.0),
    "faster": (1.5, 1.0, 0.3, 3.7, 0.4, 1e6),
    "over the tip": (2.0, 1.0, 1.25, 9.81, 0.0, ROLL_OVER * (1 + 1e-12)),
    "not over the tip": (2.0, 1.0, 1.25, 9.81, 0.0, ROLL_OVER * (1 - 1e-12)),
    "a mountain": (1e20, 3e19, 1e39, 9.81, 0.3, 1e-12),
    "dust": (1e-20, 3e-21, 1e-41, 9.81, 0.3, 1e11),
}
each_motion = pytest.mark.parametrize("motion", MOTIONS.values(), ids=MOTIONS)


def swing(motion: tuple[float, ...]) -> float:
    """Approximate time of a half turn or swing, from the speed or from small rocking."""
    a, b, gyration2, gravity, _, omega = motion
    low, high = min(a, b), max(a, b)
    rocking = math.sqrt(gravity * (high**2 - low**2) / (low * (gyration2 + low**2)))
    return math.pi / max(abs(omega), rocking)


def times_of(motion: tuple[float, ...]) -> np.ndarray:
    """Times on both sides of the start, up to the longest that doubles resolve."""
    spans = swing(motion) * np.array([1e-6, 0.1, 1.0, 30.0, 1e9, 1e14])
    return np.concatenate([span * np.linspace(-0.3, 1.0, 411) for span in spans])


def same(one: Any, other: Any) -> bool:
    return all(np.array_equal(a, b) for a, b in zip(one, other, strict=True))


@each_motion
def test_results_depend_only_on_the_time_bit_for_bit(motion: tuple[float, ...]) -> None:
    """The bits do not depend on the order, the neighbours, the chunk or the worker."""
    times, start = times_of(motion), arguments(motion)
    found = flow(times, **start)
    generator = np.random.default_rng(5)
    for order in (np.arange(times.size)[::-1], generator.permutation(times.size)):
        assert same(flow(times[order], **start), [values[order] for values in found])
    for part in (slice(0, 43), slice(3, 1001), slice(700, 2000, 7)):
        assert same(flow(times[part], **start), [values[part] for values in found])
    for i in (0, 411, 1300, -1):
        again = flow(np.full(1031, times[i]), **start)
        assert same(again, [np.full(1031, values[i]) for values in found])
    assert same(flow(times, **start, workers=3), found)


@each_motion
def test_results_at_many_times_agree_with_those_at_single_times(motion: tuple[float, ...]) -> None:
    """Each answer may err by the bound; x may also err by the rounding of a length of the body's
    size."""
    start = arguments(motion)
    times = times_of(motion)
    found = np.array(flow(times, **start))[:, ::137]
    times = times[::137]
    assert np.all(np.isfinite(found))
    worst = 0.0
    for i, t in enumerate(times):
        bound = known_to(state, {"t": float(t)} | start) + path_grain(start)
        worst = max(worst, float((np.abs(found[:, i] - flow(float(t), **start)) / bound).max()))
    told(f"{worst:.3g} of a bound")
    assert worst <= 2


@pytest.mark.parametrize("count", [0, 1, 2, 39, 40, 41, 1023, 1025])
def test_any_number_of_times_gives_correct_results(count: int) -> None:
    """The counts are near 40, where a table starts, and near the 1024 times of a chunk."""
    start = arguments(MOTIONS["rotation"])
    times = np.linspace(0.0, 3.0, count)
    found = flow(times, **start)
    assert [values.shape for values in found] == [(count,)] * 3
    for values, several in zip(found, flow(np.append(times, np.ones(40)), **start), strict=True):
        # angles, speeds and positions of the motion are about 10 in SI units
        assert np.all(np.abs(values - several[:count]) <= 32 * math.ulp(10.0))


@pytest.mark.parametrize("place", [0, 5, 1500, 2002])
@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf, 1e300])
def test_an_invalid_time_is_reported_with_its_index(place: int, bad: float) -> None:
    times = np.linspace(0.0, 3.0, 2003)
    times[place] = bad
    times[place + 1 :: 700] = math.nan  # the message names the first wrong time
    with pytest.raises(ValueError, match=rf"^t\[{place}\] must be .* got {bad}".replace("+", ".")):
        flow(times, **arguments(MOTIONS["libration"]))


def test_flow_needs_little_more_memory_than_its_result() -> None:
    """The million times are not copied, and the table takes less than a tenth of the answer."""
    times, start = np.linspace(0.0, 100.0, 1_000_000), arguments(MOTIONS["rotation"])
    tracemalloc.start()
    try:
        found = flow(times, **start)
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    answer = sum(values.nbytes for values in found)
    told(f"{peak / answer:.3f} of the answer")
    assert answer <= peak <= 1.1 * answer
