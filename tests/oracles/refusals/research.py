"""Refusals of batches, of comparisons of work and precision, and of the report's equations."""

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
from rolling_ellipse._verbs.batches.folders import _chunks, _digest_of_all, _name

from oracles.refusals import Refusal

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


BATCHES: list[Refusal] = [
    (r"^scenes must be Scenes, as an iterable, or a mapping", many(1)),
    (r"^scenes\[0\] must be a Scene, got 1", many([1])),
    (r"^scenes must have names of a, b", many({"c": 1.0})),
    (r"^scenes must have 'b'", many({"a": 1.0})),
    (r"^scenes\['impulse'\] must be an Impulse", many({"a": 2.0, "b": 1.0, "impulse": 1})),
    (r"^scenes\['z'\]\[1\] must be a number", many({**MANY, "z": [2.0, math.nan]})),
    (r"^scenes\['a'\]\[1\] must be a positive", many({"a": [2.0, -1.0], "b": 1.0})),
    (r"^scenes\[1\]: a/b must be between", many({"a": [2.0, 1e5], "b": 1.0})),
    (r"^progress must be True, False or a function", many([SCENE], progress=1)),
    (r"^out must be a new or empty folder, or one of", lambda folder: other_folder(folder)),
    (r"^out must be .*, got .* with the settings", lambda folder: again(folder, rtol=1e-3)),
    (r"^out must be .* with other times", lambda folder: again(folder, t=[0.0, 1.0])),
    (r"^out must be .*whose scenes 0 to 1", lambda folder: again(folder, omega=9.0)),
    (r"^out must be .*which has 16", lambda folder: more(folder)),
    (r"^out must be .* with '00000007-0+-0+.npz' of another", lambda folder: mixed(folder)),
    (r"^out must be .*which has more than", lambda folder: fewer(folder)),
    (r"chunks are missing: the same call goes on", lambda folder: broken(folder)),
    (r"a positive", lambda _: rl.flow([1.0, 1.0], a=[2.0, -1.0], **FLOW, workers=Pool())),
]  # fmt: skip
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


# ------------------------------------------------------------------------- folders of batches


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


FOLDERS: list[Refusal] = [
    (r"^path must be a folder written by simulate_many", lambda folder: rl.load_many(folder)),
    (r"^path must be a folder of schema .* of 99", of_request(schema=99)),
    (r"^path must be a complete folder", spoilt(lambda path: (path / "end.json").unlink())),
    (r"^path must have the file 0+-", spoilt(lambda path: next(path.glob("0*.npz")).unlink())),
    (r"t must hold times that do not fall", table(chunk=False, t=np.array([1.0, 0.0]))),
    (r"scenes must be a count, got -1", spoilt(negative_count)),
    (r"^path must have just the files that its end\.json tells", spoilt(another_digest)),
    (r"it must hold the array 'mode'", table(mode=None)),
    (r"codes must be of type int64 and shape", table(codes=np.zeros(3))),
    (r"codes of models must be of \[", with_entry("codes", (0, 1), 99)),
    (r"codes must hold counts, of samples at most 2", with_entry("codes", (0, 3), -1)),
    (r"rolling must hold finite numbers", with_entry("rolling", 0, math.nan)),
    (r"numbers must be none but numbers", with_entry("numbers", 0, math.nan)),
    (r"request and scenes must be those of the", with_entry("scenes", (0, 0), 3.0)),
    (r"scenes must be valid, got row 0: a must", lambda folder: renamed(folder)),
]  # fmt: skip


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


# ---------------------------------------------------------------------------- work, precision


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


RACES: list[Refusal] = [
    (r"^methods must be a sequence of names", race(methods=1)),
    (r"^methods must be names, or mappings", race(methods=[1])),
    (r"^name of a method must be a string", race(methods=[{"model": "rolling", "name": 1}])),
    (r"^methods must be among 'flow'", race(methods=["x"])),
    (r"^methods must be among 'flow'", race(methods=["multipliers/rk4/glue"])),
    (r"^arguments of methods must be one of", race(methods=[{"speed": 1}])),
    (r"^steps must be positive and finite", race(steps=[-1.0])),
    (r"^samples must be at least 1, got 0", race(samples=0)),
    (r"^rounds must be at least 1, got 0", race(rounds=0)),
    (r"^max_seconds must be positive", race(max_seconds=0)),
    (r"^methods and peers must name at least one", race(methods=[])),
    (r"^methods and peers must have names of", race(methods=["exact", "exact"])),
    (r"^peers must have a name and a function", race(peers=[1])),
    (r"^peers must be a sequence, got 1", race(peers=1)),
    (r"^reference must be a function of times", race(reference=1)),
    (r"^reference must return theta, omega", race(reference=lambda times: (1.0, 2.0))),
    (r"^tolerances must be a sequence of positive", race(tolerances=[])),
    (r"^tolerances must be positive and finite", race(tolerances=[-1.0])),
    (r"^t_end must be a time or increasing times", race(t_end=[1.0, 0.5])),
    (r"^t_end must be a time that the motion reaches.*it ends at", race(jammed(), 5.0)),
    (r"^margin must be at least 1", result(lambda found: found.unbeaten(0.5))),
    (r"^x must be an error, one of", result(lambda found: found.best(1.0, x="time"))),
    (r"^y must be one of", result(lambda found: found.best(1.0, y="x"))),
    (r"^t_end must be one of 0\.5, got 9", result(lambda found: found.best(1.0, t_end=9.0))),
    (r"^at must be positive, got -1", result(lambda found: found.best(-1.0))),
    (r"^tags must be among", result(lambda found: found.plot(tags="x"))),
    (r"'x'", result(lambda found: found.runs[0].errors["x"])),
]


def of_run(**facts: Any) -> Callable[[Path], Any]:
    return raced(lambda known: known["runs"][0].update(facts))


RACE_FILES: list[Refusal] = [
    (r"schema must be \d+, got 99", raced(lambda known: known.update(schema=99))),
    (r"runs must be a list that is not empty", raced(lambda known: known.update(runs=[]))),
    (r"runs must end where the references do", of_run(t_end=9.0)),
    (r"it must hold what save writes", raced(lambda known: known["scene"].update(a=2))),
    (r"time must be a number of at least 0, got 'x'", of_run(time="x")),
    (r"steps must be a count", of_run(steps=-1)),
    (r"status must be a text", of_run(status=1)),
]  # fmt: skip

# ----------------------------------------------------------------------------------- report


def printed(**options: Any) -> Callable[[Path], Any]:
    how = {**BODY, "equations": "printed", "consistent": "project", **options}
    return lambda _: report.simulate(Q, Q_DOT, 0.1, **how)


REPORT: list[Refusal] = [
    (
        r"^multipliers must have 4 entries last",
        lambda _: report.eqs_33_to_37(Q, Q_DOT, [1.0], **BODY),
    ),
    (r"^impulse must be finite, got nan", lambda _: report.eq_48(math.nan, 1.0, **AXES, mass=1.0)),
    (r"^printed must hold names out of", printed(printed="x")),
    (r"^step must be at least .* would not change by it", printed(step=1e-30)),
    (r"^stabilization must be None for the printed", printed(stabilization="none")),
    (r"^step must be a positive time for the method 'rk4'", printed(method="rk4")),
    (r"^q must have 5 entries .*, got", lambda _: report.simulate([1.0], Q_DOT, 1.0, **AXES)),
    (r"^q and q_dot must meet the", lambda _: report.simulate(2 * Q, Q_DOT, 0.1, **AXES)),
]  # fmt: skip

REFUSALS: list[Refusal] = [*BATCHES, *FOLDERS, *RACES, *RACE_FILES, *REPORT]
