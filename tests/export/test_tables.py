"""Tables of a trajectory contain its numbers in the stated units, and survive saving to files."""

import dataclasses
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rolling_ellipse as rl
import xarray
from oracles.trajectory import VECTORS
from oracles.units import UNITS, scaled, scene_in_other_units

COLUMNS = [*VECTORS[1:], "lambda1", "lambda2", "lambda3", "lambda4", "mode"]
BLOW = rl.Impulse(jx=1.0, jz=-4.0, dx=0.5)
BLOWN = rl.Scene(2.0, 1.0, mass=3.0, inertia=2.0, friction=5.0, impulse=BLOW)
SCENES = {"report": rl.scenes.report, "rocking": rl.scenes.rocking, "blown": BLOWN}


@pytest.fixture(scope="module", params=list(SCENES.values()), ids=list(SCENES))
def motion(request: pytest.FixtureRequest) -> rl.Trajectory:
    return rl.simulate(request.param, np.linspace(0.5, 2.0, 31))


def scene_in(facts: Mapping[str, Any]) -> rl.Scene:
    """The scene that the attributes of a table describe."""
    names = {field.name for field in dataclasses.fields(rl.Scene)}
    blow = {k.removeprefix("impulse_"): v for k, v in facts.items() if k.startswith("impulse_")}
    given = {name: facts[name] for name in names & set(facts)}
    return rl.Scene(**given, impulse=rl.Impulse(**blow) if blow else None)


def test_the_dataframe_contains_the_arrays(motion: rl.Trajectory) -> None:
    frame = motion.to_dataframe()
    assert frame.index.name == "t" and np.array_equal(frame.index, motion.t)
    for name in VECTORS[1:]:
        assert np.array_equal(frame[name], getattr(motion, name)), name
    for i in range(4):
        assert np.array_equal(frame[f"lambda{i + 1}"], motion.multipliers[:, i])
    assert list(frame.columns) == COLUMNS
    assert set(frame.attrs["units"]) == {"t", *frame.columns}


def test_the_dataset_contains_the_arrays(motion: rl.Trajectory) -> None:
    dataset = motion.to_xarray()
    assert np.array_equal(dataset["t"], motion.t)
    for name in (*VECTORS[1:], "mode"):
        assert dataset[name].dims == ("t",)
        assert np.array_equal(dataset[name], getattr(motion, name)), name
    assert dataset["multipliers"].dims == ("t", "constraint")
    assert np.array_equal(dataset["multipliers"], motion.multipliers)
    assert np.array_equal(dataset["multipliers"].sel(constraint="f2"), motion.normal_force)
    for variable in dataset.data_vars.values():
        assert set(variable.attrs) >= {"units", "long_name"}
    assert dataset["t"].attrs == {"units": "s", "long_name": "time"}


def test_no_array_of_a_trajectory_is_missing_from_the_tables(motion: rl.Trajectory) -> None:
    public = [name for name in dir(motion) if not name.startswith("_")]
    arrays = {name for name in public if isinstance(getattr(motion, name), np.ndarray)}
    assert {*VECTORS, "mode", "multipliers", "q", "q_dot"} == arrays  # q repeats x, ..., r


def test_the_stated_units_match_the_values() -> None:
    """In units scaled by powers of two, each quantity changes by the factor of its unit."""
    factors = (2, 1, 3)  # exponents of two, so that scaling rounds nothing
    small = rl.Scene(0.7, 1.9, mass=3.0, gravity=3.7, theta=0.4, omega=1.0, x=-5.0)
    large = scene_in_other_units(small, factors)
    times = np.linspace(0.0, 2.0, 21)
    one = rl.simulate(small, times).to_dataframe()
    other = rl.simulate(large, scaled(times, "s", factors)).to_dataframe()
    units = one.attrs["units"]
    assert np.array_equal(other.index, scaled(one.index, units["t"], factors))
    for name in one.columns.drop("mode"):
        expected = scaled(one[name].to_numpy(), units[name], factors)
        largest = np.max(np.abs(expected))
        assert largest > 0 or name == "lambda4"  # lambda4 is zero while the body rolls
        # apart from rounding; a wrong unit would change a value by a factor of 2 or more
        assert other[name].to_numpy() == pytest.approx(expected, rel=0, abs=1e-12 * largest), name
    shared = {"x", "z", "theta", "omega", "x_dot", "z_dot"}
    assert all(units[name] == UNITS["Scene"][name] for name in shared)


def test_the_attributes_describe_the_whole_scene(motion: rl.Trajectory) -> None:
    for facts in (motion.to_dataframe().attrs, motion.to_xarray().attrs):
        assert scene_in(facts) == motion.scene
        known = {"model": "rolling", "method": "exact", "status": "COMPLETED"}
        assert known.items() | {("reason", motion.reason)} <= facts.items()
    assert all(isinstance(value, float | str) for value in motion.to_xarray().attrs.values())


def test_the_attributes_state_when_validity_was_lost() -> None:
    with pytest.warns(rl.ValidityWarning):
        jump = rl.simulate(rl.scenes.jump, 1.0, model="rolling")
    facts = jump.to_xarray().attrs
    assert facts["status"] == "VALIDITY_LOST"
    assert facts["valid_until"] == jump.valid_until < 1.0


def test_a_dataset_survives_netcdf(motion: rl.Trajectory, tmp_path: Path) -> None:
    written = motion.to_xarray()
    written.to_netcdf(tmp_path / "motion.nc")
    read = xarray.load_dataset(tmp_path / "motion.nc")
    assert read.identical(written)
    again = rl.simulate(scene_in(read.attrs), read["t"].to_numpy())
    assert np.array_equal(again.theta, motion.theta)


def test_modes_appear_by_name_in_tables() -> None:
    motion = dataclasses.replace(rl.simulate(rl.scenes.rocking, [0.0, 1.0, 2.0, 3.0]))
    codes = [rl.Mode.FLIGHT, rl.Mode.SLIDING, rl.Mode.REST, rl.Mode.ROLLING]
    motion.__dict__["mode"] = np.array(codes, np.int8)
    column = motion.to_dataframe()["mode"]
    assert list(column) == ["FLIGHT", "SLIDING", "REST", "ROLLING"]
    assert (column == "SLIDING").sum() == 1
    variable = motion.to_xarray()["mode"]
    assert variable.dtype == np.int8
    meanings = variable.attrs["flag_meanings"].split()
    names = dict(zip(variable.attrs["flag_values"], meanings, strict=True))
    assert [names[code] for code in variable.to_numpy()] == list(column)


def test_changing_a_table_leaves_the_trajectory_unchanged(motion: rl.Trajectory) -> None:
    frame, dataset = motion.to_dataframe(), motion.to_xarray()
    before = motion.x[0]
    frame.loc[frame.index[0], "x"] = 99.0
    dataset["x"][0] = 99.0
    dataset["multipliers"][0] = 99.0
    assert frame["x"].iloc[0] == dataset["x"][0] == 99.0
    assert motion.x[0] == before
    assert 99.0 not in motion.multipliers


def test_a_trajectory_without_samples_makes_empty_tables() -> None:
    jams = rl.Scene(2.0, 1.0, theta=0.9, omega=0.0, x_dot=5.0, friction=3.0)
    motion = rl.simulate(jams, [0.5, 1.0])
    frame, dataset = motion.to_dataframe(), motion.to_xarray()
    assert len(frame) == dataset.sizes["t"] == 0
    assert list(frame.columns) == COLUMNS
    assert scene_in(dataset.attrs) == jams
