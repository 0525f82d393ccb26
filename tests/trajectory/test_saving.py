"""`save` and `load`: every bit comes back, and a wrong file is refused by name."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rolling_ellipse as rl
from oracles.trajectory import MATRICES, SCENES, VECTORS
from rolling_ellipse import Scene, Trajectory, simulate

SAVED = {**SCENES, "jump": rl.scenes.jump, "drop": rl.scenes.drop, "rest": Scene(2.0, 1.0)}


@pytest.mark.parametrize("scene", SAVED.values(), ids=SAVED)
def test_save_and_load(scene: Scene, tmp_path: Path) -> None:
    before = simulate(scene, np.linspace(0.1, 7.0, 77))
    path = tmp_path / "motion.npz"
    before.save(path)
    for after in (Trajectory.load(path), rl.load(str(path))):
        for name in (*VECTORS, *MATRICES, "mode"):
            one, other = getattr(before, name), getattr(after, name)
            assert one.dtype == other.dtype and np.array_equal(one, other), name
        for name in ("scene", "model", "method", "status", "message", "reason", "valid_until"):
            assert getattr(before, name) == getattr(after, name), name
        assert (after.stats, after.events, after.t_end) == (
            before.stats,
            before.events,
            before.t_end,
        )
        assert repr(after) == repr(before)
        times = np.random.default_rng(1).uniform(0, 7, 200)
        for name in (*VECTORS, "mode"):
            assert np.array_equal(getattr(before.sol(times), name), getattr(after.sol(times), name))


def test_files_hold_no_pickle(report: Trajectory, tmp_path: Path) -> None:
    path = tmp_path / "motion"  # the name is the one given, whatever its suffix
    report.save(path)
    assert [file.name for file in tmp_path.iterdir()] == ["motion"]
    with np.load(path, allow_pickle=False) as data:
        assert {"t", "theta", "omega", "x", "about"} <= set(data.files)
        about = json.loads(str(data["about"]))
    assert about["schema"] == 4


def rewritten(path: Path, **changes: Any) -> None:
    with np.load(path) as data:
        arrays = {name: data[name] for name in data.files}
    about = json.loads(str(arrays.pop("about"))) | changes
    with path.open("wb") as file:
        np.savez(file, about=np.array(json.dumps(about)), **arrays)


@pytest.mark.parametrize("kind", ["schema", "other npz", "npy", "text", "cut", "empty"])
def test_a_wrong_file_is_refused_by_name(report: Trajectory, tmp_path: Path, kind: str) -> None:
    path = tmp_path / "wrong.npz"
    report.save(path)
    if kind == "schema":
        rewritten(path, schema=999)
    elif kind == "other npz":
        np.savez(path, x=np.arange(3))
    elif kind == "npy":
        with path.open("wb") as file:
            np.save(file, np.arange(3))
    elif kind == "text":
        path.write_text("t,theta\n0,1\n")
    elif kind == "cut":
        path.write_bytes(path.read_bytes()[:2000])
    else:
        path.write_bytes(b"")
    with pytest.raises(ValueError, match=r"^path .*wrong\.npz") as caught:
        rl.load(path)
    assert "pickle" not in str(caught.value)


def test_a_missing_file_is_not_found(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        rl.load(tmp_path / "nothing.npz")
