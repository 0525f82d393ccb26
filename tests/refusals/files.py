"""Refusals of files that are damaged, or not ours."""

import io
import json
import math
import zipfile
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
import rolling_ellipse as rl
from rolling_ellipse import Scene, scenes

from refusals import Row

MOTION = rl.simulate(Scene(2.0, 1.0, omega=1.0), np.linspace(0.0, 0.5, 6))

CONTACT = rl.simulate(scenes.jump, np.linspace(0.0, 2.0, 6))

STEPPED = rl.simulate(Scene(2.0, 1.0, omega=1.0), [0.5], model="multipliers")


def rewritten(motion: rl.Trajectory, folder: Path, change: Callable[[Any, Any], Any]) -> Any:
    """A file in which something was changed: in its arrays, or in what it holds as JSON."""
    path = folder / "motion.npz"
    motion.save(path)
    with np.load(path) as data:
        arrays = dict(data)
    about = json.loads(str(arrays["about"]))
    change(arrays, about)
    if "about" in arrays and arrays["about"].dtype.kind == "U" and "raw" not in about:
        arrays["about"] = np.array(json.dumps(about))
    with path.open("wb") as file:
        np.savez(file, **arrays)
    return rl.load(path)


def about(motion: rl.Trajectory = MOTION, **facts: Any) -> Callable[[Path], Any]:
    return lambda folder: rewritten(motion, folder, lambda _, known: known.update(facts))


def arrays(motion: rl.Trajectory = MOTION, **values: Any) -> Callable[[Path], Any]:
    return lambda folder: rewritten(motion, folder, lambda known, _: known.update(values))


def text(content: str) -> Callable[[Path], Any]:
    def change(known: Any, facts: Any) -> None:
        known["about"] = np.array(content)
        facts["raw"] = True

    return lambda folder: rewritten(MOTION, folder, change)


def members(compression: int = zipfile.ZIP_STORED, **contents: bytes) -> Callable[[Path], Any]:
    def call(folder: Path) -> Any:
        path = folder / "motion.npz"
        with zipfile.ZipFile(path, "w", compression) as archive:
            for name, content in contents.items():
                archive.writestr(f"{name}.npy", content)
        return rl.load(path)

    return call


def npy(values: Any, version: tuple[int, int] = (1, 0)) -> bytes:
    file = io.BytesIO()
    np.lib.format.write_array(file, np.asarray(values), version=version)
    return file.getvalue()


def event(place: int, value: Any) -> Callable[[Path], Any]:
    """The first event of a contact motion with another entry."""

    def change(_: Any, known: Any) -> None:
        known["events"][0][place] = value

    return lambda folder: rewritten(CONTACT, folder, change)


def as_set() -> dict[str, Any]:
    """The settings of a motion by "dop853", which was asked for."""
    found = asdict(STEPPED.settings)
    return found | {"method": "dop853"}


def without_fact(_: Any, known: Any) -> None:
    del known["status"]


def backwards(_: Any, known: Any) -> None:
    known["events"] = known["events"][::-1]


REFUSALS: list[Row] = [
    ("path", members(t=npy(np.zeros(9)))),
    ("path", members(z1=npy(1.0))),
    ("path", members(zipfile.ZIP_DEFLATED, t=npy(np.zeros(9)))),
    ("path", members(t=npy(np.zeros(9), (2, 0)))),
    ("path", members(t=npy(np.array([1j])))),
    ("path", members(t=npy(np.zeros(9))[:-1])),
    ("path", arrays(t=np.zeros(6, int))),
    ("path", arrays(theta=np.full(6, math.nan))),
    ("path", text('{"schema": NaN}')),
    ("path", text('{"schema": 1, "schema": 1}')),
    ("path", text("[]")),
    ("path", lambda folder: rewritten(MOTION, folder, without_fact)),
    ("path", about(more=1)),
    ("path", about(schema=3)),
    ("path", about(message=1)),
    ("path", about(stats={"more": 1})),
    ("path", about(stats={"segments": -1})),
    ("path", members()),
    ("path", about(STEPPED, method="dopri5", settings=as_set())),
    ("path", about(t_end=9.0)),
    ("path", about(span=1)),
    ("path", event(0, "x")),
    ("path", event(2, [1.0, 0])),
    ("path", lambda folder: rewritten(CONTACT, folder, backwards)),
    ("path", lambda _: MOTION.save("")),
    (IsADirectoryError, lambda folder: MOTION.save(f"{folder}/")),
    (FileNotFoundError, lambda folder: MOTION.save(folder / "no/a.npz")),
]  # fmt: skip
