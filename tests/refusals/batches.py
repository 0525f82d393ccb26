"""Wrong calls of the functions for many motions, and folders of motions that are refused."""

import json
import math
import shutil
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import rolling_ellipse as rl
from oracles.files import put_together, taken_apart
from rolling_ellipse import Impulse, Scene, scenes
from rolling_ellipse._verbs.batches.folders import _chunks, _digest_of_all, _name

from refusals import ANYTHING, Row, wrong
from refusals.functions import WORKERS

SCENE = Scene(2.0, 1.0, omega=1.0)
TIMES = [0.0, 1.5]
MANY: Any = {"a": 2.0, "b": 1.0, "omega": [1.0, 2.0]}
MIXED = [scenes.jump, scenes.report, scenes.slip]
FLOW: dict[str, Any] = {"b": 1.0, "theta": 0.0, "omega": 1.0}


def many(scenes: Any, run: Any = rl.simulate_many, **options: Any) -> Callable[[Path], Any]:
    return lambda _: run(scenes, TIMES, **options)


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
    """Add a scene after a full chunk."""
    path = made(folder, [SCENE] * 16)
    rl.simulate_many([SCENE] * 17, TIMES, out=path)


def mixed(folder: Path) -> None:
    """Add a chunk of another request."""
    path = made(folder)
    shutil.copy(next(path.glob("0*.npz")), path / f"{7:08d}-{'0' * 16}-{'0' * 16}.npz")
    rl.simulate_many(MANY, TIMES, out=path)


def fewer(folder: Path) -> None:
    path = made(folder)
    (path / "end.json").unlink()
    chunk = next(path.glob("0*.npz"))
    shutil.copy(chunk, path / f"{7:08d}-{chunk.name[9:]}")
    rl.simulate_many(MANY, TIMES, out=path)


def outdated(folder: Path) -> None:
    """Continue a folder of an older schema."""
    file = made(folder) / "request.npz"
    about, arrays = taken_apart(file.read_bytes())
    file.write_bytes(put_together(about | {"schema": 1}, arrays))
    rl.simulate_many(MANY, TIMES, out=file.parent)


def broken(folder: Path) -> None:
    with Broken(1) as pool:
        made(folder, workers=pool)


def spoilt(change: Callable[[Path], Any], scenes: Any = MANY) -> Callable[[Path], Any]:
    def call(folder: Path) -> Any:
        path = made(folder, scenes)
        change(path)
        return list(rl.load_many(path))

    return call


def forged(name: str = "0*.npz", **changes: Callable[[Any], Any]) -> Row:
    """Change arrays in the only chunk, or in another file. A change that returns None removes the
    array."""

    def change(path: Path) -> None:
        file = next(path.glob(name))
        with np.load(file) as data:
            arrays = dict(data)
        new = {key: change(arrays.pop(key)) for key, change in changes.items()}
        arrays |= {key: value for key, value in new.items() if value is not None}
        with file.open("wb") as whole:
            np.savez(whole, **arrays)

    return "path", spoilt(change, MIXED)


def put(place: Any, value: float) -> Callable[[Any], Any]:
    """Replace the number at an index of an array."""

    def change(values: Any) -> Any:
        values[place] = value
        return values

    return change


def of_schema(number: int) -> Callable[[Any], Any]:
    return lambda about: np.array(json.dumps(json.loads(str(about)) | {"schema": number}))


def ended(text: str) -> Callable[[Path], Any]:
    return lambda path: (path / "end.json").write_text(text)


def renamed(folder: Path) -> Any:
    """Store an impossible scene in a chunk whose name matches its content."""
    path = made(folder)
    file = next(path.glob("0*.npz"))
    with np.load(file) as data:
        arrays = dict(data)
    arrays["scenes"][0, 0] = -1.0
    request = str(arrays["request"])
    file.unlink()
    with (path / _name(0, request, arrays["scenes"])).open("wb") as new:
        np.savez(new, **arrays)
    digest = _digest_of_all(request, 2, _chunks(path), {})
    (path / "end.json").write_text(json.dumps({"scenes": 2, "digest": digest}))
    return list(rl.load_many(path))


REFUSALS: list[Row] = [
    # requests
    *(("scenes", many(asked)) for asked in (
        1, scenes.rocking, np.array("1"), {}, {"a": 1.0}, {"a": 1, "b": 1, "omga": 2})),
    *(("scenes" + place, many({"a": 1.0, "b": 1.0, **asked})) for place, asked in (
        ("['a']", {"a": "1"}), ("['a']", {"a": None}), ("['a']", {"a": 0}),
        ("['a'][3]", {"a": [1, 2, 3, -1.0]}),
        ("['b'][1, 0]", {"b": [[1], [math.nan]], "theta": [0, 1, 2]}),
        ("['z'][1]", {"z": [2.0, math.nan]}), ("['z'][1]", {"z": [2, 0.5]}),
        ("['inertia']", {"inertia": math.nan}), ("['impulse']", {"impulse": 1}),
        ("[1]", {"a": [2.0, 1e5]}), ("[1]", {"impulse": rl.Impulse(jx=0, jz=-1, dx=[0, 4])}))),
    *((f"scenes['{name}'", many({**MANY, "omega": np.empty((0, 1)), name: value}, run))
      for run in (rl.simulate_many, rl.ends) for name, value in (
        ("a", -1.0), ("b", [1.0, math.nan]), ("mass", 0.0), ("gravity", -9.81), ("inertia", -1.0),
        ("inertia", 1e9), ("slope", 2.0), ("friction", -0.1), ("restitution", 1.1),
        ("theta", math.inf), ("z", [math.nan]))),
    ("scenes['inertia']", many({"a": [], "b": 1.0, "inertia": -1.0})),
    ("scenes[0]", many([1])), ("scenes[3]", many([SCENE] * 3 + ["rocking"])),
    ("arguments", many({"a": [1, 2], "b": [1, 2, 3]})),
    *wrong(rl.simulate_many, {"scenes": [], "t": 1.0},
           t=[-1.0], rtol=[-1.0], model=["roling"], raise_on_failure=[1], progress=[1, "yes"],
           out=[3], returns=[3, ["x", "vx"], ["reason"], ["events", "x"]], workers=WORKERS),
    ("out", many([], out="here", returns="x")),
    ("step", many([], method="rk4")),
    ("out", other_folder),
    ("out", lambda folder: again(folder, rtol=1e-3)),
    ("out", lambda folder: again(folder, t=[0.0, 1.0])),
    ("out", lambda folder: again(folder, omega=9.0)),
    ("out", more),
    ("out", mixed),
    ("out", fewer),
    ("out", outdated),
    (rl.WorkerError, broken),
    ("a[1]", lambda _: rl.flow([1.0, 1.0], a=[2.0, -1.0], **FLOW, workers=ThreadPoolExecutor(1))),
    *wrong(rl.ends, {"scenes": MIXED, "t": 1.0},
           t=[-1.0, [1.0, 2.0], [[1.0]], math.nan, math.inf, "x"], scenes=[1], progress=[1],
           max_events=[-1, 0.5, "x"], rest_speed=[-1.0, "x"], workers=WORKERS,
           blows=[3, [(2.0, Impulse())]], stop=["x", 42, object()], count=[0, 2, "x"]),
    *wrong(rl.ends(MIXED, 1.0).go_on, {"t": 2.0, "stop": "slip"},
           t=[0.5, [1.0, 2.0], math.nan, "x"], stop=["x", ("slip", "decided")], count=[0, 10_001],
           workers=[0, "x", None]),
    ("t", lambda _: rl.ends(MIXED, 1.0).go_on(math.inf)),
    ("blows", lambda _: rl.ends(MIXED, 1.0, blows=[(0.9, Impulse())], stop="slip").go_on(2.0)),
    ("stop", many([], stop="impact")),
    ("blows", many([], blows=[(-1.0, Impulse())])),
    *wrong(rl.ends(MIXED, 1.0).plot, {}, quantity=[*ANYTHING, "energy"], path=["", "theta"]),
    ("ends", lambda _: rl.ends({"a": 2.0, "b": 1.0}, 1.0).plot()),
    ("ends", lambda _: rl.ends([], 1.0).plot()),
    ("arguments", lambda _: rl.ends(MANY, [1.0, 2.0, 3.0])),
    ("t", lambda _: rl.ends(iter(MIXED), [1.0, 2.0, 3.0])),
    (rl.WorkerError, lambda _: rl.ends(MANY, 1.0, workers=Broken(1))),
    # folders
    ("path", lambda folder: rl.load_many(folder)), *wrong(rl.load_many, {}, path=[3]),
    ("path", spoilt(lambda path: (path / "end.json").unlink())),
    ("path", spoilt(lambda path: next(path.glob("0*.npz")).unlink())),
    ("path", spoilt(ended('{"scenes": -1, "digest": ""}'))),
    ("path", spoilt(ended('{"scenes": 2, "digest": ""}'))),
    ("path", renamed),
    forged("request.npz", about=of_schema(99)),
    forged("request.npz", t=lambda _: np.array([1.0, 0.0])),
    forged(mode=lambda _: None), forged(mode=lambda v: v + 9),
    forged(codes=lambda v: v[:1]), forged(codes=lambda v: v.astype(float)),
    *(forged(codes=put(place, value)) for place, value in (
        ((0, 0), 77), ((0, 1), 99), ((0, 3), -1), ((0, 3), 1), ((0, 9), 2**62))),
    forged(rolling=put(0, math.nan)), forged(numbers=put(0, math.nan)),
    forged(contact=lambda v: v * math.nan),
    forged(events=put((0, 1), 0.5)), forged(events=put((0, 8), 9.0)),
    forged(text=lambda v: np.append(v, np.int8(1))),
    forged(scenes=put((0, 0), 3.0)), forged(scenes=lambda v: v[:, :17]),
]  # fmt: skip
