"""Refusals of many motions, and of the folders that hold them."""

import json
import math
import shutil
import tempfile
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import rolling_ellipse as rl
from rolling_ellipse import Scene, WorkPrecision, report, scenes
from rolling_ellipse._batches.folders import _chunks, _digest_of_all, _name

from refusals import Row

SCENE = Scene(2.0, 1.0, omega=1.0)

TIMES = [0.0, 0.5]

WRONG: Any = 1

Q, Q_DOT = rl.kinematics(0.3, 1.0, a=2.0, b=1.0)

AXES: dict[str, Any] = {"a": 2.0, "b": 1.0}

BODY: dict[str, Any] = {**AXES, "mass": 1.0, "gravity": 9.81}

QUICK: dict[str, Any] = {"tolerances": [1e-3], "steps": [0.1], "samples": 2, "rounds": 1}

MANY: Any = {"a": 2.0, "b": 1.0, "omega": [1.0, 2.0]}


def many(scenes: Any, **options: Any) -> Callable[[Path], Any]:
    return lambda _: rl.simulate_many(scenes, TIMES, **options)


FLOW: dict[str, Any] = {"b": 1.0, "theta": 0.0, "omega": 1.0}


class Pool(ThreadPoolExecutor):
    """Workers of another process are not needed to be refused by one."""


class Broken(ThreadPoolExecutor):
    def submit(self, function: Any, /, *arguments: Any, **options: Any) -> Any:
        return super().submit(lambda: 1 // 0)


def made(folder: Path, scenes: Any = MANY, **options: Any) -> Path:
    return Path(rl.simulate_many(scenes, TIMES, out=folder / "many", **options))


def other_folder(folder: Path) -> None:
    (folder / "many").mkdir()
    (folder / "many" / "notes.txt").write_text("mine")
    made(folder)


def again(folder: Path, t: Any = TIMES, omega: float = 1.0, **options: Any) -> None:
    path = made(folder)
    rl.simulate_many({"a": 2.0, "b": 1.0, "omega": [omega, 2.0]}, t, out=path, **options)


def more(folder: Path) -> None:
    """A scene behind a chunk that was full."""
    path = made(folder, [SCENE] * 16)
    rl.simulate_many([SCENE] * 17, TIMES, out=path)


def mixed(folder: Path) -> None:
    """A chunk of another request."""
    path = made(folder)
    shutil.copy(next(path.glob("0*.npz")), path / f"{7:08d}-{'0' * 16}-{'0' * 16}.npz")
    rl.simulate_many(MANY, TIMES, out=path)


def fewer(folder: Path) -> None:
    path = made(folder)
    (path / "end.json").unlink()
    chunk = next(path.glob("0*.npz"))
    shutil.copy(chunk, path / f"{7:08d}-{chunk.name[9:]}")
    rl.simulate_many(MANY, TIMES, out=path)


def broken(folder: Path) -> None:
    with Broken(1) as pool:
        made(folder, workers=pool)


def spoilt(change: Callable[[Path], Any]) -> Callable[[Path], Any]:
    def call(folder: Path) -> Any:
        path = made(folder)
        change(path)
        return list(rl.load_many(path))

    return call


def table(chunk: bool = True, **values: Any) -> Callable[[Path], Any]:
    """Other arrays in the one chunk, or in the request; None takes one away."""

    def change(path: Path) -> None:
        file = next(path.glob("0*.npz")) if chunk else path / "request.npz"
        with np.load(file) as data:
            arrays = dict(data) | values
        with file.open("wb") as new:
            np.savez(new, **{k: v for k, v in arrays.items() if v is not None})

    return spoilt(change)


def of_request(**facts: Any) -> Callable[[Path], Any]:
    def change(path: Path) -> None:
        with np.load(path / "request.npz") as data:
            arrays = dict(data)
        about = json.loads(str(arrays["about"])) | facts
        with (path / "request.npz").open("wb") as new:
            np.savez(new, about=np.array(json.dumps(about)), t=arrays["t"])

    return spoilt(change)


def kept(name: str) -> np.ndarray:
    """An array of the chunk, to be changed."""
    with tempfile.TemporaryDirectory() as folder:
        with np.load(next(made(Path(folder)).glob("0*.npz"))) as data:
            found: np.ndarray = data[name]
        return found


def with_entry(name: str, place: Any, value: float) -> Callable[[Path], Any]:
    def call(folder: Path) -> Any:
        values = kept(name)
        values[place] = value
        changed: Any = {name: values}
        return table(**changed)(folder)

    return call


def negative_count(path: Path) -> None:
    (path / "end.json").write_text('{"scenes": -1, "digest": ""}')


def another_digest(path: Path) -> None:
    (path / "end.json").write_text('{"scenes": 2, "digest": ""}')


def renamed(folder: Path) -> Any:
    """Scenes that nobody could have had, under their right name."""
    path = made(folder)
    file = next(path.glob("0*.npz"))
    with np.load(file) as data:
        arrays = dict(data)
    arrays["scenes"][0, 0] = -1.0
    request = str(arrays["request"])
    file.unlink()
    with (path / _name(0, request, arrays["scenes"])).open("wb") as new:
        np.savez(new, **arrays)
    digest = _digest_of_all(request, 2, _chunks(path))
    (path / "end.json").write_text(json.dumps({"scenes": 2, "digest": digest}))
    return list(rl.load_many(path))


def race(scene: Scene = SCENE, t_end: Any = 0.5, **options: Any) -> Callable[[Path], Any]:
    return lambda _: rl.work_precision(scene, t_end, **{**QUICK, "methods": "exact", **options})


class Peer:
    name = "peer"

    def __init__(self, run: Any = WRONG) -> None:
        self.run = run

    def prepare(self, scene: Any, t_end: float, setting: float) -> Any:
        return self.run


def result(ask: Callable[[WorkPrecision], Any]) -> Callable[[Path], Any]:
    return lambda _: ask(race()(Path()))


def raced(change: Callable[[Any], Any]) -> Callable[[Path], Any]:
    """A file of a race in which something was changed."""

    def call(folder: Path) -> Any:
        path = folder / "race.json"
        race()(folder).save(path)
        known = json.loads(path.read_text())
        change(known)
        path.write_text(json.dumps(known))
        return WorkPrecision.load(path)

    return call


def jammed() -> Scene:
    return scenes.slip.replace(friction=5.0, theta=1.0)


def of_run(**facts: Any) -> Callable[[Path], Any]:
    return raced(lambda known: known["runs"][0].update(facts))


def negative_floor(known: Any) -> None:
    known["references"][0]["floor"] = -1.0


def printed(**options: Any) -> Callable[[Path], Any]:
    how = {**BODY, "equations": "printed", "consistent": "project", **options}
    return lambda _: report.simulate(Q, Q_DOT, 0.1, **how)


REFUSALS: list[Row] = [
    # asked
    ("scenes", many(1)),
    ("scenes[0]", many([1])),
    ("scenes", many({"c": 1.0})),
    ("scenes", many({"a": 1.0})),
    ("scenes['impulse']", many({"a": 2.0, "b": 1.0, "impulse": 1})),
    ("scenes['z'][1]", many({**MANY, "z": [2.0, math.nan]})),
    ("scenes['a'][1]", many({"a": [2.0, -1.0], "b": 1.0})),
    ("scenes[1]", many({"a": [2.0, 1e5], "b": 1.0})),
    ("progress", many([SCENE], progress=1)),
    ("out", other_folder),
    ("out", lambda folder: again(folder, rtol=1e-3)),
    ("out", lambda folder: again(folder, t=[0.0, 1.0])),
    ("out", lambda folder: again(folder, omega=9.0)),
    ("out", more),
    ("out", mixed),
    ("out", fewer),
    (rl.WorkerError, broken),
    ("a[1]", lambda _: rl.flow([1.0, 1.0], a=[2.0, -1.0], **FLOW, workers=Pool())),
    # folders
    ("path", lambda folder: rl.load_many(folder)),
    ("path", of_request(schema=99)),
    ("path", spoilt(lambda path: (path / "end.json").unlink())),
    ("path", spoilt(lambda path: next(path.glob("0*.npz")).unlink())),
    ("path", table(chunk=False, t=np.array([1.0, 0.0]))),
    ("path", spoilt(negative_count)),
    ("path", spoilt(another_digest)),
    ("path", table(mode=None)),
    ("path", table(codes=np.zeros(3))),
    ("path", with_entry("codes", (0, 1), 99)),
    ("path", with_entry("codes", (0, 3), -1)),
    ("path", with_entry("rolling", 0, math.nan)),
    ("path", with_entry("numbers", 0, math.nan)),
    ("path", with_entry("scenes", (0, 0), 3.0)),
    ("path", renamed),
]  # fmt: skip
