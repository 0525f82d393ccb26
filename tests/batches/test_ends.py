"""`ends` returns the final states and the event counts that `simulate` gives, for arguments of any
shape and any number of workers."""

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
SCENES = [
    *NAMED, JAMS, rl.Scene(2.0, 1.0), *random_scenes(60, 8), *random_scenes(60, 9, slope=0.2),
    *random_scenes(20, 5, struck=1.0),
]  # fmt: skip
TIMES = np.linspace(0.0, 6.0, len(SCENES))
SETTINGS: list[dict[str, Any]] = [
    {}, {"max_events": 2}, {"max_events": 100, "stop": "impact", "count": 2},
    {"max_events": 100, "stop": "decided"},
]  # fmt: skip


@pytest.mark.parametrize("how", SETTINGS, ids=str)
def test_ends_equal_simulate_bit_for_bit(how: dict[str, Any]) -> None:
    """A motion that exceeds `max_events` ends at event number `max_events`."""
    most = how.get("max_events", 10_000)
    times = [math.inf] * len(SCENES) if "stop" in how else TIMES.tolist()
    ends = rl.ends(SCENES, times, **how)
    for k, (scene, t) in enumerate(zip(SCENES, times, strict=True)):
        given = t if "stop" in how else [t]
        motion = rl.simulate(scene, given, raise_on_failure=False, **how)
        assert ends.status[k] == motion.status.name and ends.events[k] == len(motion.events)
        assert ends.first[k] == (motion.events[0].kind.value if motion.events else -1)
        hits = [e.state_after.reaction_z for e in motion.events if e.kind is rl.EventKind.IMPACT]
        assert ends.impacts[k] == len(hits) and ends.largest_impulse[k] == max(hits, default=0.0)
        if motion.status in (rl.Status.JAMMED, rl.Status.STEP_TOO_SMALL):
            assert ends.mode[k] == -1 and ends.t[k] == motion.t_end
            assert all(np.isnan(getattr(ends, name)[k]) for name in STATE)
            continue
        full = motion.status is rl.Status.MAX_EVENTS
        last: Any = motion.events[-1].state_after if full else motion.at(motion.t_end)
        assert ends.t[k] == (motion.events[-1].t if full else motion.t_end)
        assert ends.mode[k] == last.mode
        assert [getattr(ends, name)[k] for name in STATE] == [getattr(last, n) for n in STATE]
    assert {*ends.mode} == {-1, 0, 1, 2, 3} and "JAMMED" in ends.status
    over = np.flatnonzero(ends.status == "MAX_EVENTS").tolist()
    assert bool(over) == (most < 10_000) and all(ends.events[over] == most)
    for k in over:
        error = ends.errors[k,]
        assert isinstance(error, rl.IntegrationError) and len(error.trajectory.events) == most


@pytest.mark.parametrize("workers", [2, -1, ThreadPoolExecutor(2)])
def test_the_number_of_workers_changes_no_bit_of_the_results(workers: Any) -> None:
    require_same(rl.ends(SCENES, TIMES, workers=workers), rl.ends(SCENES, TIMES))


def test_times_broadcast_with_the_arguments_of_a_mapping() -> None:
    """For a single motion, the arrays have the shape ()."""
    body: dict[str, Any] = {"a": 2.0, "b": 1.0, "z": 3.0, "restitution": 0.3}
    ends = rl.ends(body | {"omega": [[1.0], [2.0]]}, [0.5, 1.0, 2.0])
    each = [rl.ends([rl.Scene(**body, omega=w)] * 3, [0.5, 1.0, 2.0]) for w in (1.0, 2.0)]
    for name in STATE:
        assert np.array_equal(getattr(ends, name), [getattr(one, name) for one in each])
    assert rl.ends(body, 1.0).theta.shape == () and rl.ends([], 1.0).theta.shape == (0,)
    assert "6 COMPLETED" in repr(ends)


def test_errors_of_ends_are_the_exceptions_that_simulate_raises() -> None:
    """The exception does not store the arcs of its motion, which take kilobytes each. They are
    computed again on demand."""
    slips = rl.Scene(2.0, 1.0, friction=0.3, restitution=0.8, z=2.1, theta=0.2)
    reports: list[Any] = []
    cases: list[tuple[float, Any]] = [(1e6, None), (math.inf, "decided")]
    for t, stop in cases:
        how: dict[str, Any] = {"stop": stop, "max_events": 20, "rest_speed": 1e-4}
        ends = rl.ends([NAMED[0], slips], t, progress=lambda *done: reports.append(done), **how)
        assert list(ends.errors) == [(1,)]
        error = ends.errors[1,]
        assert isinstance(error, rl.IntegrationError) and "_solution" not in vars(error.trajectory)
        with pytest.raises(rl.IntegrationError) as raised:
            rl.simulate(slips, t, **how)
        assert str(error) == str(raised.value)
        assert error.trajectory.events == raised.value.trajectory.events
        assert error.trajectory.settings == raised.value.trajectory.settings
    assert reports == [(2, 2)] * 2


@pytest.mark.parametrize("share", [1e-6, 1e-5, 1e-3, 1e-2])
def test_bounces_below_the_rest_speed_are_a_single_event(share: float) -> None:
    """The nth rebound of a dropped disc has e^n times the speed of its first impact. The first
    rebound below the rest speed, and all later ones, are replaced by a single event, REST."""
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
