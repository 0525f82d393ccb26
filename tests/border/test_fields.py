"""Each field of the core's tables passes unchanged through every interface of the package.

A contact motion has the same bits in any units scaled by powers of two. This shows that each field
has the right dimension.
"""

import dataclasses
import json
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rolling_ellipse as rl
from oracles.units import STATE, UNITS, assert_same_in_other_units, scaled, scene_in_other_units
from rolling_ellipse import Impulse, Scene, _core
from rolling_ellipse._ask.settings import DEFAULTS, Settings
from rolling_ellipse._command_line import SCENE_OPTIONS, chosen_scene, motion_parser
from rolling_ellipse._motion.export.strict import scene_of

FIELDS = list(UNITS["Scene"])
BLOW = Impulse(jx=3.0, jz=-5.0, dx=0.3, dz=-0.2)
# A start in the air over a slope, so that x_dot, z and z_dot matter; fields not listed get 2^-6.
GIVEN = {
    "a": 2.0, "b": 1.0, "mass": 10.0, "gravity": 9.0, "inertia": 11.0, "slope": 0.2,
    "friction": 0.3, "restitution": 0.6, "theta": 0.5, "omega": 1.5, "x": 0.7, "z": 2.5,
    "x_dot": 0.4, "z_dot": -0.3,
}  # fmt: skip
# Fields of a Scene that have no command-line option, with the reasons.
NOT_TYPED = {
    "x": "a motion is the same from every place",
    "z": "the body starts on the ground, where a blow can press it down",
    "x_dot": "as z: it starts rolling",
    "z_dot": "as z: it starts rolling",
    "impulse": "--press",
}
START = Scene(**{name: GIVEN.get(name, 2**-6) for name in FIELDS}, impulse=BLOW)
TIMES = np.linspace(0.0, 2.0, 21)


def names(kind: Any) -> list[str]:
    return [field.name for field in dataclasses.fields(kind)]


def changed(name: str) -> Scene:
    """START with one number increased by a relative 2^-6."""
    return START.replace(**{name: getattr(START, name) * (1 + 2**-6)})


def by_file(scene: Scene, folder: Path) -> Scene:
    rl.simulate(scene, [0.0], model="contact").save(folder / "motion.npz")
    return rl.load(folder / "motion.npz").scene


def by_folder(scene: Scene, folder: Path) -> Scene:
    rl.simulate_many([scene], [0.0], out=folder / "many")
    (found,) = rl.load_many(folder / "many")
    return found.scene  # type: ignore[union-attr]


def by_arrays(scene: Scene, folder: Path) -> Scene:
    numbers = {name: np.array([getattr(scene, name)]) for name in FIELDS}
    (found,) = rl.simulate_many({**numbers, "impulse": scene.impulse}, [0.0])
    return found.scene  # type: ignore[union-attr]


INTERFACES: dict[str, Callable[[Scene, Path], Scene]] = {
    "repr": lambda scene, folder: eval(repr(scene)),
    "replace": lambda scene, folder: dataclasses.replace(scene),
    "pickle": lambda scene, folder: pickle.loads(pickle.dumps(scene)),
    "JSON": lambda scene, folder: scene_of(json.loads(json.dumps(dataclasses.asdict(scene)))),
    "npz": by_file,
    "folder": by_folder,
    "arrays": by_arrays,
}


def test_scenes_have_the_fields_of_the_core() -> None:
    assert sorted(names(Scene)) == sorted([*FIELDS, "impulse"])
    assert names(Impulse) == list(UNITS["Impulse"])
    assert _core.COLUMNS["scenes"] == (*UNITS["Scene"], *UNITS["Impulse"])


@pytest.mark.parametrize("interface", INTERFACES)
@pytest.mark.parametrize("name", FIELDS)
def test_a_scene_keeps_its_values_through_every_interface(
    interface: str, name: str, tmp_path: Path
) -> None:
    assert INTERFACES[interface](changed(name), tmp_path) == changed(name) != START


@pytest.mark.parametrize("name", FIELDS)
def test_every_value_of_a_scene_affects_the_motion(name: str) -> None:
    one, other = (rl.simulate(scene, TIMES, model="contact") for scene in (START, changed(name)))
    assert any(getattr(one, each).tobytes() != getattr(other, each).tobytes() for each in STATE)


OF_UNIT_SIZE = Scene(1.2, 0.8, gravity=1.0, theta=0.3, omega=2.0, friction=0.2, x_dot=1.0)


@pytest.mark.parametrize(
    ("scene", "units"),
    [*((START, units) for units in ((3, 0, 0), (0, -2, 0), (0, 0, 5), (-7, 4, 2))),
     (OF_UNIT_SIZE, (0, 0, 3))],
)  # fmt: skip
def test_a_motion_is_the_same_in_other_units(scene: Scene, units: Any) -> None:
    """In the last scene, the core's own units of length and time are a metre and a second, so that
    only the mass is scaled."""
    one = rl.simulate(scene, TIMES, model="contact")
    other = scene_in_other_units(scene, units)
    again = rl.simulate(other, scaled(TIMES, "s", units), model="contact")
    assert_same_in_other_units(one, again, units)
    assert len(one.events) > (3 if scene is START else 0) and np.any(one.normal_force > 0)


def test_each_field_is_a_command_line_option_or_has_a_reason() -> None:
    assert {*SCENE_OPTIONS, *NOT_TYPED} == set(names(Scene))
    assert not set(SCENE_OPTIONS) & set(NOT_TYPED)
    for name in SCENE_OPTIONS:
        option = f"--{name.replace('_', '-')}=0.25"
        scene = chosen_scene(motion_parser().parse_args([option, "--press", "0", "0"]))
        assert getattr(scene, name) == 0.25


def test_settings_have_the_fields_of_the_core() -> None:
    """The core raises an error if any field is missing."""
    given = DEFAULTS.__getstate__()
    for name in names(Settings):
        with pytest.raises(KeyError, match=name):
            _core.Settings({key: value for key, value in given.items() if key != name})


def test_initial_states_have_the_fields_of_the_core() -> None:
    assert set(names(type(START.initial_state))) == {*UNITS["InitialState"], "mode", "reason"}
    assert set(UNITS["State"]) < set(UNITS["InitialState"])


def test_statistics_and_columns_have_the_names_of_the_core() -> None:
    assert set(rl.simulate(START, TIMES).stats) == set(_core.STATS) <= set(_core.COLUMNS["codes"])
    no_scenes = np.empty((0, len(_core.COLUMNS["scenes"])))
    tables = _core.simulate_table(no_scenes, DEFAULTS.core, TIMES, 1)
    for name, columns in _core.COLUMNS.items():
        if name != "scenes":
            assert len(columns) in tables[name].shape, name
