"""`ends` gives the last samples and the events of `simulate`, for any shape and any workers."""

import math
import pickle
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
import pytest
import rolling_ellipse as rl
from oracles.batches import NAMED
from oracles.contact import random_scenes
from oracles.pickles import require_same

STATE = ("theta", "omega", "x", "z", "x_dot", "z_dot")
JAMS = rl.Scene(2.0, 1.0, theta=0.9, x_dot=5.0, friction=3.0)
SCENES = [*NAMED, JAMS, rl.Scene(2.0, 1.0), *random_scenes(60, 8), *random_scenes(60, 9, slope=0.2)]
TIMES = np.linspace(0.0, 6.0, len(SCENES))


@pytest.mark.parametrize("most", [10_000, 2])
def test_ends_equal_simulate_bit_for_bit(most: int) -> None:
    """A motion with too many events ends with the last one that it may have."""
    ends = rl.ends(SCENES, TIMES, max_events=most)
    for k, (scene, t) in enumerate(zip(SCENES, TIMES.tolist(), strict=True)):
        motion = rl.simulate(scene, [t], max_events=most, raise_on_failure=False)
        assert ends.status[k] == motion.status.name and ends.events[k] == len(motion.events)
        assert ends.first[k] == (motion.events[0].kind.value if motion.events else -1)
        there = motion.t.size == 1
        if motion.status is rl.Status.MAX_EVENTS:
            last = motion.events[-1]
            assert ends.t[k] == last.t and ends.mode[k] == last.state_after.mode
            assert [getattr(ends, n)[k] for n in STATE] == [
                getattr(last.state_after, n) for n in STATE
            ]
            continue
        assert ends.mode[k] == (motion.mode[0] if there else -1) and ends.t[k] == motion.t_end
        for name in STATE:
            value = getattr(ends, name)[k]
            assert value == getattr(motion, name)[0] if there else np.isnan(value), (k, name)
    assert set(ends.mode) == {-1, 0, 1, 2, 3} and {"COMPLETED", "JAMMED"} <= set(ends.status)
    over = np.flatnonzero(ends.status == "MAX_EVENTS").tolist()
    assert (len(over) > 5) == (most == 2) and all(ends.events[over] == most)
    for k in over:
        error = ends.errors[k,]
        assert isinstance(error, rl.IntegrationError) and len(error.trajectory.events) == most


@pytest.mark.parametrize("workers", [2, -1, ThreadPoolExecutor(2)])
def test_the_number_of_workers_changes_no_bit_of_the_results(workers: Any) -> None:
    require_same(rl.ends(SCENES, TIMES, workers=workers), rl.ends(SCENES, TIMES))


def test_times_broadcast_with_the_arguments_of_a_mapping() -> None:
    """The end of a single motion has the shape ()."""
    body: dict[str, Any] = {"a": 2.0, "b": 1.0, "z": 3.0, "restitution": 0.3}
    ends = rl.ends(body | {"omega": [[1.0], [2.0]]}, [0.5, 1.0, 2.0])
    each = [rl.ends([rl.Scene(**body, omega=w)] * 3, [0.5, 1.0, 2.0]) for w in (1.0, 2.0)]
    for name in STATE:
        assert np.array_equal(getattr(ends, name), [getattr(one, name) for one in each])
    assert rl.ends(body, 1.0).theta.shape == () and rl.ends([], 1.0).theta.shape == (0,)
    assert "6 COMPLETED" in repr(ends)


def test_a_motion_that_stops_early_has_an_exception_in_place_of_its_end() -> None:
    endless = rl.Scene(1.0, 1.0, z=1.5, friction=0.0, restitution=1.0)
    seen: list[Any] = []
    found = rl.ends(
        [NAMED[0], endless], 1e5, rest_speed=0.01, progress=lambda *done: seen.append(done)
    )
    assert found.status.tolist() == ["COMPLETED", "MAX_EVENTS"] and list(found.errors) == [(1,)]
    error = found.errors[1,]
    assert isinstance(error, rl.IntegrationError) and found.events[1] == 10_000
    assert error.trajectory.settings.rest_speed == 0.01
    assert seen == [(2, 2)]


def test_the_exceptions_of_a_batch_hold_no_arcs() -> None:
    """An arc takes kilobytes, and a motion has up to max_events of them: they are solved again."""
    slips = rl.Scene(2.0, 1.0, friction=0.3, restitution=0.8, z=2.1, theta=0.2)
    cases: list[tuple[Any, Any]] = [([1e6], None), (math.inf, "decided")]
    for t, stop in cases:
        kept = rl.ends([slips], t, max_events=50, stop=stop).errors[0,]
        assert isinstance(kept, rl.IntegrationError) and "_solution" not in vars(kept.trajectory)
        with pytest.raises(rl.IntegrationError) as raised:
            rl.simulate(slips, t, max_events=50, stop=stop)
        assert str(kept) == str(raised.value)
        assert kept.trajectory.events == raised.value.trajectory.events


@pytest.mark.parametrize("share", [1e-6, 1e-5, 1e-3, 1e-2])
def test_bounces_are_counted_down_to_the_rest_speed(share: float) -> None:
    """The nth rebound of a dropped disc has e^n of its speed; the first one below the rest speed
    and all later ones count as one event."""
    e, speed, g = 0.6, 3.0, 9.81
    disc = rl.Scene(1.0, 1.0, z=1.0 + speed**2 / (2 * g), friction=0.0, restitution=e, gravity=g)
    rest_speed = share * np.sqrt(g)
    impacts = 1 + np.flatnonzero(speed * e ** np.arange(1, 60) < rest_speed)[0]
    found = rl.ends([disc], 10.0, rest_speed=rest_speed)
    assert found.events[0] == impacts + 1
    kinds = [event.kind.name for event in rl.simulate(disc, 10.0, rest_speed=rest_speed).events]
    assert kinds == ["IMPACT"] * impacts + ["REST"]


def test_a_table_of_ends_lists_the_scenes_and_times() -> None:
    grid = {"a": 2.0, "b": 1.0, "omega": [[1.0], [3.2]]}
    ends = rl.ends(grid, [0.5, 1.0, 1.5])
    table, rows = ends.to_xarray(), ends.to_dataframe()
    assert ends.axes == ("omega0", "t") == table.x.dims and table.attrs["a"] == 2.0
    assert np.array_equal(table.x, ends.x) and table.t.values.tolist() == [0.5, 1.0, 1.5]
    assert len(rows) == 6 and rows.theta[3.2, 1.0] == ends.theta[1, 1]
    listed = rl.ends([rl.scenes.jump, rl.scenes.report], [0.5, 1.0])
    assert listed.axes == ("scene",) and listed.to_xarray().mass.values.tolist() == [1.0, 10.0]
    assert pickle.loads(pickle.dumps(ends)).to_xarray().equals(table)
    assert len(rl.ends({"a": 2.0, "b": 1.0}, 1.0).to_dataframe()) == 1
    assert len(rl.ends([], 1.0).to_dataframe()) == 0
