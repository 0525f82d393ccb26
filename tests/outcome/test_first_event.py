"""`classify` on random scenes agrees with a search along the angles.

The search evaluates Newton's law (oracles/rolling.py) in long double at thousands of angles: from
the start, through the flat position if the body falls first, to the tip or the turning point.
"""

from collections import Counter
from typing import NamedTuple

import numpy as np
import oracles.geometry
import oracles.rolling
import pytest
from numpy.typing import NDArray
from oracles.crowd import Sample, random_sample
from oracles.numbers import PI, Long
from oracles.rolling import Motion
from rolling_ellipse import Outcome, classify

STEPS, CHUNK = 4000, 100
Codes = NDArray[np.int8]
CLEAR = 1e-6  # relative to forces, energy or gravity; scenes with a smaller margin are left out


class Start(NamedTuple):
    """Direction in which a motion starts, and its reduced angle measured in that direction, from 0
    when flat to pi/2 on the tip. A start exactly on the tip has the angle -pi/2, because half a
    turn lies ahead in either direction."""

    direction: Long
    angle: Long


def start_of(sample: Sample) -> Start:
    offset = sample.theta - np.where(sample.a < sample.b, PI / 2, np.longdouble(0))
    angle = offset - np.round(offset / PI) * PI
    direction = np.where(sample.omega != 0, np.sign(sample.omega), -np.sign(angle))
    ahead = np.where(np.abs(angle) == PI / 2, -PI / 2, direction * angle)
    return Start(direction, ahead)


def slack(moving: Motion, friction: Long, tangent: Long) -> Long:
    """Margin of rolling relative to the forces, at a given tangent of the reduced angle. The oracle
    returns margins in units of its errors, which are 1e-12 of the forces, and more where the energy
    or a - b is itself little more than rounding."""
    cosine = 1 / np.sqrt(1 + tangent**2)
    found = oracles.rolling.forces(moving, np.abs(tangent) * cosine, cosine)
    return 1e-12 * np.minimum(*found.margins(friction))


def least_slack(sample: Sample) -> Long:
    """Smallest margin between the start and the tip or the turning point. The samples are evenly
    spaced in v, where tan = waist sinh v, and therefore denser near the flat position and the tip.
    A golden-section search refines minima close to zero."""
    moving, angle = sample.motion(), start_of(sample).angle
    on = oracles.rolling.chart(moving)
    highest = on.waist * np.sinh(on.top)
    tangent = np.where(angle == -PI / 2, -np.longdouble(1e9), np.tan(angle))  # not 1/rounding
    tangent = np.clip(tangent, -np.longdouble(1e9), highest)
    begin = np.arcsinh(tangent / on.waist)
    share = np.linspace(np.longdouble(0), 1, STEPS + 1)
    v = begin[:, None] + (on.top - begin)[:, None] * share
    friction = sample.friction.astype(np.longdouble)
    values = slack(
        moving.at((slice(None), None)), friction[:, None], on.waist[:, None] * np.sinh(v)
    )
    least: Long = values.min(1)
    # The samples are at most 0.016 apart in v, so a minimum lies below the lowest of them by at
    # most 3e-5 times the second derivative. The forces have no feature narrower than about 0.1.
    rows, columns = oracles.rolling.local_minima(values, np.where(least < -0.01, -np.inf, 0.01))
    if rows.size:
        part, held, waist = moving.at(rows), friction[rows], on.waist[rows]
        dip = oracles.rolling.golden_minimum(
            lambda v: slack(part, held, waist * np.sinh(v)),
            v[rows, np.maximum(columns - 1, 0)],
            v[rows, np.minimum(columns + 1, STEPS)],
        )
        np.minimum.at(least, rows, slack(part, held, waist * np.sinh(dip)))
    return least


class Walk(NamedTuple):
    outcome: Codes
    clear: NDArray[np.bool_]  # no margin is within CLEAR of zero


def walk(sample: Sample) -> Walk:
    moving = sample.motion()
    sine, cosine = oracles.geometry.reduced(sample.theta, sample.a, sample.b)
    curvature = oracles.geometry.outline(moving.a, moving.b, sine, cosine).curvature
    spin = curvature * np.asarray(sample.omega, np.longdouble) ** 2
    pressed = (moving.gravity + spin) / (moving.gravity + np.abs(spin))
    barrier = moving.gravity * np.abs(moving.a - moving.b)
    over = (moving.lift - barrier) / (moving.lift + barrier)
    rolls = least_slack(sample)
    # a scene at rest is either on an axis or farther from it than roundings
    rests = (sample.omega == 0) & (2 * sample.theta / PI % 1 == 0)
    slips = (rolls < 0) | (sample.friction == 0)
    outcome = np.select(
        [rests, pressed < 0, slips, over < 0],
        [Outcome.RESTS, Outcome.LOSES_CONTACT, Outcome.SLIPS, Outcome.ROCKS],
        Outcome.ROLLS_OVER,
    ).astype(np.int8)
    nearest = np.minimum(np.abs(pressed), np.minimum(np.abs(rolls), np.abs(over)))
    return Walk(outcome, rests | (nearest > CLEAR))


class Walked(NamedTuple):
    sample: Sample
    truth: Codes


@pytest.fixture(scope="module")
def walked() -> list[Walked]:
    """800 scenes and their answers in chunks of 100, without those too close to a threshold (about
    a fifth). An array of 100 scenes x 4001 angles in long double takes 6.4 MB."""
    chunks = []
    for seed in range(8):
        sample, _ = random_sample(CHUNK, seed)
        found = walk(sample)
        chunks.append(Walked(sample.only(found.clear), found.outcome[found.clear]))
    assert sum(chunk.truth.size for chunk in chunks) > 0.75 * 8 * CHUNK
    return chunks


def test_the_random_scenes_cover_every_case(walked: list[Walked]) -> None:
    """The scenes include rising and falling starts, all outcomes except jams, and rising bodies
    that would slip only at angles below their start."""
    counts: Counter[int] = Counter()
    beyond = up = down = 0
    for sample, truth in walked:
        counts.update(truth.tolist())
        on_the_way = start_of(sample).angle
        up += int((on_the_way > 0).sum())
        down += int((on_the_way < 0).sum())
        needed = oracles.rolling.extremes(sample.motion()).needed
        unbroken = (truth == Outcome.ROLLS_OVER) | (truth == Outcome.ROCKS)
        beyond += int((unbroken & (needed > sample.friction) & (on_the_way > 0)).sum())
    for outcome, least in (
        (Outcome.RESTS, 10),
        (Outcome.ROCKS, 50),
        (Outcome.ROLLS_OVER, 30),
        (Outcome.SLIPS, 100),
        (Outcome.LOSES_CONTACT, 40),
    ):
        assert counts[outcome] >= least, counts
    assert min(up, down) > 100
    assert beyond >= 5


def test_classify_gives_the_first_event_as_the_angle_advances(walked: list[Walked]) -> None:
    for sample, truth in walked:
        wrong = np.flatnonzero(np.asarray(classify(**sample.arguments())) != truth)
        assert wrong.size == 0, [
            (sample.scene(int(row)), Outcome(int(truth[row])).name) for row in wrong[:3]
        ]


def test_a_wrong_direction_is_detected(walked: list[Walked]) -> None:
    """The opposite direction changes the first event of some scenes, so the test above can fail."""
    differ = 0
    for sample, truth in walked:
        back = sample._replace(omega=-sample.omega)
        differ += int((np.asarray(classify(**back.arguments())) != truth).sum())
    assert differ >= 5


def test_random_scenes_never_jam_and_are_rarely_undecided() -> None:
    """Rounding changes the margins by only about 1e-12 of their largest value, so that far fewer
    than one in a thousand of the 1e5 scenes are undecided."""
    rng = np.random.default_rng(31)
    count = 100_000
    a = 10 ** rng.uniform(-2, 2, count)
    top = np.sqrt(9.81 / np.maximum(a, 1.0))
    found = classify(
        a=a,
        b=1.0,
        omega=top * rng.normal(size=count) * 10 ** rng.uniform(-1, 1, count),
        theta=rng.uniform(-4, 4, count),
        friction=np.where(rng.random(count) < 0.2, np.inf, rng.uniform(0, 2, count)),
        gyration2=np.maximum(a, 1.0) ** 2 * 10 ** rng.uniform(-2, 0, count),
        workers=2,
    )
    assert isinstance(found, np.ndarray)
    counts = np.bincount(found, minlength=7)
    assert counts[Outcome.JAMS] == 0
    assert counts[Outcome.EDGE] < 1e-3 * count
    for outcome in (Outcome.ROCKS, Outcome.ROLLS_OVER, Outcome.SLIPS, Outcome.LOSES_CONTACT):
        assert counts[outcome] > 1000
