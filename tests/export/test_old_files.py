"""Files written before bodies had rolling resistance stay readable.

They have schema 4 or one of its time: a folder, a race, answers to a problem, and pickles. The
tests of the player read an old link.
"""

import json
import pickle
from pathlib import Path

import numpy as np
import pytest
import rolling_ellipse as rl
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


def test_an_old_race_is_read() -> None:
    race = rl.WorkPrecision.load(OLD / "race.json")
    assert race.scene == rl.Scene(2.0, 1.0, omega=1.0)


def test_old_pickles_are_read_as_scenes_without_rolling_resistance() -> None:
    scene = pickle.loads((OLD / "scene.pickle").read_bytes())
    assert scene == rl.Scene(2.0, 1.0, theta=0.3, impulse=rl.Impulse.press(48.0, 1.5))
    motion = pickle.loads((OLD / "motion.pickle").read_bytes())
    assert motion.scene == rl.scenes.report
    assert motion.sol(0.3).theta == rl.simulate(rl.scenes.report, [0.3]).theta


def test_old_answers_are_scored_and_an_old_problem_is_described_as_it_was() -> None:
    """The answers come from this package, so that they are right to a few roundings."""
    told, folder = "hit.drop_slip_e", OLD / "answers"
    (score,) = (each for each in rl.benchmark.score(folder) if each.answer != "not supported")
    assert score.problem == told and score.passed and score.over_condition < 1e-15
    new = json.loads((PROBLEMS / f"{told}.json").read_text(encoding="utf-8"))
    old = json.loads((folder / f"{told}.json").read_text(encoding="utf-8"))
    assert new.items() >= old.items()
