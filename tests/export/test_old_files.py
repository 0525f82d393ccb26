"""Files written before bodies had rolling resistance, or motions had blows, can still be read.

Files without rolling resistance have schema 4 or are as old: a folder, a race, answers to a
problem, and pickles. Files without blows have schema 5 and `before_blows` in their names. The tests
of the player read an old link.
"""

import json
import pickle
from pathlib import Path

import numpy as np
import pytest
import rolling_ellipse as rl
from rolling_ellipse import _core
from rolling_ellipse.benchmark._problem import FOLDER as PROBLEMS

OLD = Path(__file__).with_name("old_files")
SCENES = {
    "rolling": rl.scenes.report,
    "contact": rl.Scene(2.0, 1.0, theta=0.5, z=2.5, friction=0.3, restitution=0.5, omega=-1.0),
    "multipliers": rl.Scene(2.0, 1.0, theta=0.3, friction=2.0),
}


@pytest.mark.parametrize("name", SCENES)
def test_an_old_motion_is_read_as_one_without_rolling_resistance(name: str, tmp_path: Path) -> None:
    motion = rl.load(OLD / f"{name}.npz")
    assert motion.scene == SCENES[name]
    assert motion.scene.rolling_resistance == 0
    with np.load(OLD / f"{name}.npz") as stored:
        assert np.array_equal(motion.theta, stored["theta"])
    motion.save(tmp_path / "new.npz")
    assert rl.load(tmp_path / "new.npz") == motion


def test_an_old_folder_is_read_as_scenes_without_rolling_resistance() -> None:
    first, second = rl.load_many(OLD / "folder")
    assert isinstance(first, rl.Trajectory)
    assert isinstance(second, rl.Trajectory)
    assert first.scene == rl.Scene(2.0, 1.0, theta=0.2, friction=0.5, z=2.5)
    assert second.scene.theta == 0.4
    assert first.t.tolist() == [0.0, 0.5, 1.0]


CODES = {  # of schema 4
    _core.MODELS: "auto rolling multipliers contact",
    _core.METHODS: "auto exact dop853 dopri5 rk4 gauss radau",
    tuple(each.name for each in _core.Ending): "COMPLETED MAX_STEPS STEP_TOO_SMALL STEP_TOO_LARGE"
    " MAX_EVENTS JAMMED UNDETERMINED VALIDITY_LOST NEVER",
    tuple(each.name for each in rl.EventKind): "SLIP STICK REVERSE LIFT_OFF IMPACT REST JAM BLOW",
    tuple(each.name for each in rl.Mode): "ROLLING SLIDING FLIGHT REST",
}  # fmt: skip


def test_codes_in_folders_keep_their_names() -> None:
    """Folders store the place of a name in its list, so new names must follow the old ones."""
    for names, old in CODES.items():
        assert list(names[: len(old.split())]) == old.split()


def test_motions_from_before_blows_are_read_with_the_effects_of_impacts(
    tmp_path: Path,
) -> None:
    scene = rl.Scene(2.0, 1.0, theta=0.5, z=2.5, friction=0.3, restitution=0.5, omega=-1.0, mass=3)
    alone = rl.load(OLD / "before_blows.npz")
    stored = rl.load_many(OLD / "folder_before_blows")
    scenes = [scene, scene, scene.replace(theta=0.4, mass=0.7)]
    impulses = []
    for old, its in zip([alone, *stored], scenes, strict=True):
        assert isinstance(old, rl.Trajectory)
        assert old.scene == its and old.blows == () and len(old.events) > 0
        for event in old.events:
            was, becomes = event.state_before, event.state_after
            impulses.append(its.mass * (becomes.z_dot - was.z_dot))
            assert becomes.reaction_z == impulses[-1] > 0 and becomes.free_omega == was.omega
            lost = event.energy_before - event.energy_after
            assert becomes.energy_lost == pytest.approx(lost, abs=1e-12)  # energies are about 100 J
    first = len(alone.events)
    assert stored.arrays("events")["reaction_z"].tolist() == impulses[first:]
    alone.save(tmp_path / "new.npz")
    assert rl.load(tmp_path / "new.npz") == alone


def test_an_old_race_is_read() -> None:
    race = rl.WorkPrecision.load(OLD / "race.json")
    assert race.scene == rl.Scene(2.0, 1.0, omega=1.0)


def test_old_pickles_are_read_as_scenes_without_rolling_resistance() -> None:
    scene = pickle.loads((OLD / "scene.pickle").read_bytes())
    assert scene == rl.Scene(2.0, 1.0, theta=0.3, impulse=rl.Impulse.press(48.0, 1.5))
    motion = pickle.loads((OLD / "motion.pickle").read_bytes())
    assert motion.scene == rl.scenes.report
    assert motion.sol(0.3).theta == rl.simulate(rl.scenes.report, [0.3]).theta


def test_old_answers_are_scored_and_their_problem_is_unchanged() -> None:
    """The answers come from this package, and are right to within a few rounding errors."""
    name, folder = "hit.drop_slip_e", OLD / "answers"
    (score,) = (each for each in rl.benchmark.score(folder) if each.answer != "not supported")
    assert score.problem == name and score.passed and score.over_condition < 1e-15
    new = json.loads((PROBLEMS / f"{name}.json").read_text(encoding="utf-8"))
    old = json.loads((folder / f"{name}.json").read_text(encoding="utf-8"))
    assert new.items() >= old.items()
