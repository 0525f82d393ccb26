"""Tables of events equal the Event objects bit for bit, for one motion and for many."""

import copy
import pickle
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rolling_ellipse as rl
from oracles.contact import random_scenes
from oracles.pickles import require_same
from rolling_ellipse import EventKind, Mode
from rolling_ellipse._motion.events import Events

T_END = 6.0
SETTLES = rl.Scene(2.0, 1.0, z=1.5, theta=0.3, restitution=0.5, friction=0.2)
JAMS = rl.Scene(2.0, 1.0, theta=0.9, x_dot=5.0, friction=3.0)
TURNS = rl.Scene(2.0, 1.0, theta=0.9, friction=0.6, rolling_resistance=0.02)
SCENES = [
    SETTLES, JAMS, TURNS, rl.scenes.bounce, rl.scenes.jump, rl.scenes.report,
    *random_scenes(150, 1), *random_scenes(60, 2, slope=0.2),
    *random_scenes(60, 3, rolling_resistance=0.05),
]  # fmt: skip


@cache
def motions() -> list[rl.Trajectory]:
    return [rl.simulate(scene, [T_END], raise_on_failure=False, max_events=60) for scene in SCENES]


def many(scenes: Any = SCENES, **given: Any) -> rl.EventArrays:
    how = {"raise_on_failure": False, "max_events": 60} | given
    return rl.simulate_many(scenes, T_END, returns="events", **how)


def size(table: rl.EventTable) -> int:
    return table["t"].size


def require_bits(one: rl.EventTable, other: rl.EventTable) -> None:
    """Require equal bits in all columns that both have, including the signs of zeros."""
    assert size(one) == size(other)
    for name in other.keys() & one.keys():
        mine, its = one[name], other[name]
        assert mine.dtype == its.dtype, name
        if name == "reason":
            assert mine.tolist() == its.tolist()
        else:
            assert mine.tobytes() == its.tobytes(), name


def test_a_table_equals_the_objects_bit_for_bit() -> None:
    """Objects compute their values one by one, in the core and in plain floats."""
    for motion in motions():
        objects = Events(tuple(motion.events))  # their table is read from the objects
        assert not vars(objects)
        require_bits(motion.events.table, objects.table)


def test_the_motions_have_events_of_all_kinds_except_blows() -> None:
    tables = [motion.events.table for motion in motions()]
    kinds = set(chain.from_iterable(each["kind"].tolist() for each in tables))
    assert kinds == {*EventKind} - {EventKind.BLOW}  # in tests/contact/test_blows_in_motion.py
    assert max(map(size, tables)) > 20 and {*map(size, tables)} > {0, 1, 2}
    assert tables[0]["mode_after"][-1] != Mode.FLIGHT  # bounces that are summed
    hidden = [motion._solution.turns.size for motion in motions()]
    assert hidden[2] > 0 and not set(motions()[2]._solution.turns) & set(tables[2]["t"])
    reasons = [*chain.from_iterable(each["reason"] for each in tables)]
    assert len({*reasons}) == len(kinds) + 1  # a second one for slips at infinite friction
    lost = np.concatenate([each["energy_lost"] for each in tables])
    assert (lost > 0).any() and (lost == 0).any() and not (lost < 0).any()


def test_an_impact_changes_the_motion_by_its_impulse() -> None:
    """The impulse equals the change of momentum; other events have no impulse."""
    for motion in motions():
        table, mass = motion.events.table, motion.scene.mass
        hit = table["kind"] == EventKind.IMPACT
        for impulse, name in ((table["reaction_x"], "x_dot"), (table["reaction_z"], "z_dot")):
            gained = table[f"{name}_after"] - table[f"{name}_before"]
            assert np.array_equal(impulse[hit], (mass * gained)[hit]) and not impulse[~hit].any()
        taken = table["energy_before"] - table["energy_after"]
        fall = mass * 9.81 * (np.abs(table["z_before"]) + np.abs(table["x_before"]))
        largest = np.abs(table["energy_before"]) + 2 * fall  # at least kinetic + |potential| energy
        # both energies and their loss have at most 8 roundings each, of numbers up to this size
        assert np.all(np.abs(taken - table["energy_lost"])[hit] <= 24 * 1.2e-16 * largest[hit])


@pytest.mark.parametrize("workers", [1, 2, ThreadPoolExecutor(2)])
def test_the_table_of_many_motions_joins_the_tables_of_each(workers: Any) -> None:
    found, each = many(workers=workers), [motion.events.table for motion in motions()]
    assert np.array_equal(found["scene"], np.repeat(np.arange(len(each)), [*map(size, each)]))
    for place in range(len(each)):
        here = found["scene"] == place
        part = {name: values[here] for name, values in found.items()}
        require_bits(rl.EventTable(part), each[place])
    assert [*found.status] == [motion.status.name for motion in motions()]
    assert "JAMMED" in found.status and "MAX_EVENTS" in found.status and not found.errors


def test_a_failed_scene_has_its_exception_and_no_event() -> None:
    grid = {"a": 2.0, "b": 1.0, "z": [[2.0, 1.0, 3.0]], "omega": [[0.0], [3.2]]}
    grid["restitution"] = 0.5
    found = many(grid, raise_on_failure=True, max_events=1)
    arrays = rl.simulate_many(grid, [T_END], returns="x", max_events=1)
    assert found.axes == arrays.axes and found.status.shape == (2, 3)
    assert np.array_equal(found.status, arrays.status)
    assert found.errors.keys() == arrays.errors.keys()
    assert 0 < len(found.errors) < 6 and found["scene"].tolist() == [0, 2, 3, 5]
    refused = many([rl.scenes.jump, rl.scenes.drop, JAMS], model="rolling")
    assert "REFUSED" in refused.status and size(refused) == 0
    assert {*map(type, refused.errors.values())} == {ValueError}
    assert size(many([])) == 0 and many([]).status.shape == (0,)
    assert many({"a": 2.0, "b": 1.0, "z": 3.0}).status.shape == ()


def test_the_table_of_a_folder_equals_that_of_its_motions(tmp_path: Path) -> None:
    folder = rl.simulate_many(SCENES, [1.0, T_END], out=tmp_path / "many", max_events=60)
    stored = rl.load_many(folder)
    require_bits(stored.arrays("events"), many())
    assert np.array_equal(stored.arrays(["events"]).status, many().status)
    for motion, alone in zip(stored, motions(), strict=True):
        if isinstance(motion, rl.Trajectory):
            require_bits(motion.events.table, alone.events.table)


def test_copies_and_files_keep_the_table_read_only(tmp_path: Path) -> None:
    motion = motions()[0]
    table = motion.events.table
    motion.save(tmp_path / "motion.npz")
    loaded = rl.load(tmp_path / "motion.npz")
    for again in (
        pickle.loads(pickle.dumps(table)), copy.deepcopy(table), copy.copy(table),
        pickle.loads(pickle.dumps(motion.events)).table, motion.events[:].table,
        loaded.events.table, loaded.events[:].table,
    ):  # fmt: skip
        require_bits(again, table)
        for values in (*again.values(), *table.values()):
            assert not values.flags.writeable
    together = many(SCENES[:9])
    for both in (pickle.loads(pickle.dumps(together)), copy.deepcopy(together)):
        require_same(both, together)
        assert not both["scene"].flags.writeable
        assert both.status.tolist() == together.status.tolist()


def test_frames_and_datasets_have_names_units_and_scenes() -> None:
    fall = {"a": 2.0, "b": 1.0, "z": [2.0, 3.0], "restitution": [[0.0], [0.5]]}
    found = many(fall)
    frame, data = found.to_dataframe(), found.to_xarray()
    assert [*frame.columns] == [*found] and frame.columns[0] == "scene"
    assert [*frame["kind"]] == [EventKind(code).name for code in found["kind"].tolist()]
    assert [*frame["mode_after"]] == [Mode(code).name for code in found["mode_after"].tolist()]
    assert frame.attrs["units"]["reaction_z"] == data.reaction_z.units == "N s"
    assert data.kind.flag_meanings.split() == [kind.name for kind in EventKind]
    assert data.t.dims == ("event",) and data.status.dims == ("restitution", "z0")
    assert data.attrs["a"] == 2.0 and data.restitution.values.tolist() == [0.0, 0.5]
    for name, values in found.items():
        assert np.array_equal(data[name], values), name
    frame.loc[0, "t"] = data["t"][0] = 99.0
    assert found["t"][0] < 99.0
    alone = rl.simulate(rl.scenes.bounce, 3.0).events
    assert alone.to_dataframe().equals(alone.table.to_dataframe())
    assert "scene" not in alone.table.to_dataframe() and alone.table.to_xarray().sizes["event"] == 5


def test_tables_state_how_many_events_of_each_kind_they_have() -> None:
    bounces = rl.simulate(rl.scenes.bounce, 3.0).events.table
    assert repr(bounces) == "<EventTable of 5 events: 5 IMPACT>"
    assert repr(rl.simulate(rl.scenes.report, 1.0).events.table) == "<EventTable of 0 events: none>"
    both = many([rl.scenes.bounce, rl.scenes.report])
    assert repr(both).startswith("<EventArrays of ") and repr(both).endswith("; 2 COMPLETED>")
