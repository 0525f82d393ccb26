"""Motions are equal if their requests and results are equal bit for bit."""

import copy
import dataclasses
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rolling_ellipse as rl
from oracles.trajectory import MOTIONS, TIMES
from rolling_ellipse import Trajectory, simulate

each = pytest.mark.parametrize("make", MOTIONS.values(), ids=MOTIONS)


@each
def test_a_repeated_motion_is_equal(make: Callable[[], Trajectory], tmp_path: Path) -> None:
    motion = make()
    motion.save(tmp_path / "motion.npz")
    again = [make(), rl.load(tmp_path / "motion.npz"), pickle.loads(pickle.dumps(motion))]
    again += [copy.copy(motion), copy.deepcopy(motion), motion]
    if motion.t.size:
        _ = motion.energy, motion.q  # values that a motion caches do not matter
        again.append(motion.sol(motion.t))
    times = np.random.default_rng(1).uniform(0, motion.t_end, 200)
    for other in again:
        assert motion == other and other == motion and hash(motion) == hash(other)
        assert motion.sol(times) == other.sol(times) and repr(motion) == repr(other)
        assert (motion.stats, motion.events) == (other.stats, other.events)
    assert len({motion, *again}) == 1


@each
def test_a_motion_with_one_changed_bit_is_unequal(make: Callable[[], Trajectory]) -> None:
    motion = make()
    for name in ("t", "theta", "omega", "x") if motion.t.size else ():
        values = np.array(getattr(motion, name))
        values[-1] = np.nextafter(values[-1], np.inf)
        part: dict[str, Any] = {name: values}
        assert dataclasses.replace(motion, **part) != motion, name
    changes: dict[str, Any] = {
        "scene": motion.scene.replace(friction=17.0),
        "settings": dataclasses.replace(motion.settings, rtol=1e-9),
        "span": motion.span + 1.0,
        "status": rl.Status.STEP_TOO_LARGE,
        "t_end": 0.5 * motion.t_end,
        "kept_events": (*motion.events, rl.simulate(rl.scenes.drop, 1.0).events[0]),
    }
    for name, value in changes.items():
        assert dataclasses.replace(motion, **{name: value}) != motion, name
    if motion.coordinates is not None:
        q = motion.coordinates[0].copy()
        q[3, 4] = np.nextafter(q[3, 4], 0.0)
        changed = dataclasses.replace(motion, coordinates=(q, motion.coordinates[1]))
        assert changed != motion
        assert dataclasses.replace(motion, start=(q[0], q[1])) != motion
    if motion.contact is not None and motion.t.size:
        z = motion.contact.z.copy()
        z[0] = np.nextafter(z[0], 0.0)
        assert dataclasses.replace(motion, contact=motion.contact._replace(z=z)) != motion


def test_motions_that_differ_in_the_sign_of_a_zero_are_unequal() -> None:
    motion = MOTIONS["rolling"]()
    assert motion.x[0] == 0
    other = dataclasses.replace(motion, x=np.where(motion.x == 0, -0.0, motion.x))
    assert other != motion and not np.any(other.x != motion.x)


@pytest.mark.parametrize("thing", [None, 1.0, "motion", rl.scenes.report, np.zeros(3)[0]])
def test_a_motion_equals_nothing_but_a_motion(thing: Any) -> None:
    assert MOTIONS["rolling"]() != thing
    assert thing not in [MOTIONS["rolling"]()]


def test_equal_results_of_different_requests_are_unequal() -> None:
    """A part of a motion is not equal to the whole either."""
    exact = MOTIONS["rolling"]()
    assert exact != simulate(rl.scenes.report, TIMES, method="exact")
    assert exact != simulate(rl.scenes.report, TIMES[:-1])
