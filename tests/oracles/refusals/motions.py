"""Refusals of a trajectory: what it is made of, what it is asked, the files it comes from."""

import io
import json
import math
import zipfile
from collections.abc import Callable
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np
import rolling_ellipse as rl
from rolling_ellipse import Scene, scenes

from oracles.refusals import Refusal

MOTION = rl.simulate(Scene(2.0, 1.0, omega=1.0), np.linspace(0.0, 0.5, 6))
TURNING = rl.simulate(Scene(2.0, 1.0, omega=3.2), [0.0, 1e9])
CONTACT = rl.simulate(scenes.jump, np.linspace(0.0, 2.0, 6))
STEPPED = rl.simulate(Scene(2.0, 1.0, omega=1.0), [0.5], model="multipliers")
N = MOTION.t.size
assert CONTACT.contact is not None


def contact(**changes: Any) -> Any:
    assert CONTACT.contact is not None
    return replace(CONTACT, contact=CONTACT.contact._replace(**changes))


def changed(**parts: Any) -> Any:
    return replace(MOTION, **parts)


PARTS: list[Refusal] = [
    (r"^t must be a 1-D array, got shape", lambda _: replace(MOTION, t=np.zeros((2, 2)))),
    (r"^x must have the length of t, 6, got 2", lambda _: replace(MOTION, x=np.zeros(2))),
    (r"^coordinates must be q and q_dot, .* got 1", lambda _: replace(STEPPED, coordinates=1)),  # type: ignore[arg-type]
    (
        r"^coordinates must be .*, got shapes",
        lambda _: replace(STEPPED, coordinates=(np.zeros(2), np.zeros(2))),
    ),
    (r"^contact must be ContactSamples or None", lambda _: replace(CONTACT, contact=1)),  # type: ignore[arg-type]
    (r"^mode must hold codes of Mode, got 9", lambda _: contact(mode=np.full(N, 9))),
    (r"^settings must be of the class Settings, got 1", lambda _: changed(settings=1)),
    (r"^kept_events must be a tuple of Event or None", lambda _: changed(kept_events=(1,))),
    (r"^t must be a time or a 1-D array", lambda _: MOTION.sol([[0.1]])),
    (r"^t must lie in \[0, 0\.5\], got 1\.0", lambda _: MOTION.sol(1.0)),
    (r"^t must be within \[0, 0\.5\] \[s\]", lambda _: MOTION._solution.sample_rolling(np.ones(1))),
    (r"^direction must be 1, -1 or 0", lambda _: MOTION.when(theta=0.1, direction=2)),
    (r"^exactly one of theta, .* must be given, got none", lambda _: MOTION.when()),
    (r"^function must be a function of a Traj", lambda _: MOTION.when(function=1)),  # type: ignore[call-overload]
    (r"^theta must be a number or a 1-D", lambda _: MOTION.when(theta=np.ones((1, 1)))),
    (r"^theta must be finite, got nan", lambda _: MOTION.when(theta=math.nan)),
    (r"^function must return one number a", lambda _: MOTION.when(function=lambda at: [1.0])),
    (
        r"^function must return numbers, got nan",
        lambda _: MOTION.when(function=lambda at: np.full(at.t.shape, math.nan)),
    ),
    (r"^z must pass its value no more than 1000000 times", lambda _: TURNING.when(z=1.5)),
    (r"^function must not be looked at over", lambda _: TURNING.when(function=lambda at: at.x)),
    (r"module 'rolling_ellipse' has no attribute 'nothing'", lambda _: rl.nothing),
    (r"^to_xarray needs xarray: pip install", lambda _: without("xarray", MOTION.to_xarray)),
]  # fmt: skip


def without(package: str, call: Callable[[], Any]) -> Any:
    with mock.patch.dict("sys.modules", {package: None}):
        return call()


# -------------------------------------------------------------------------------------- files


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


FILES: list[Refusal] = [
    (
        r"^path must name a file written by save, got .*it must hold the array 'about'",
        members(t=npy(np.zeros(9))),
    ),
    (r"it must hold known arrays, once each, got 'z1\.npy'", members(z1=npy(1.0))),
    (r"t must not be compressed", members(zipfile.ZIP_DEFLATED, t=npy(np.zeros(9)))),
    (r"t must be of version \(1, 0\), got \(2, 0\)", members(t=npy(np.zeros(9), (2, 0)))),
    (r"t must hold numbers or text row by row, got complex", members(t=npy(np.array([1j])))),
    (r"t must have 72 bytes, got 71", members(t=npy(np.zeros(9))[:-1])),
    (r"t must be of type float64, got int64", arrays(t=np.zeros(6, int))),
    (r"theta must be finite, got nan", arrays(theta=np.full(6, math.nan))),
    (r"about must hold numbers, got NaN", text('{"schema": NaN}')),
    (r"about must have each name once", text('{"schema": 1, "schema": 1}')),
    (r"^path .* must hold names and values, got \[\]", text("[]")),
    (r"must have 'status'", lambda folder: rewritten(MOTION, folder, without_fact)),
    (r"must not have 'more'", about(more=1)),
    (r"schema must be 4, got 3", about(schema=3)),
    (r"message must be a sentence, got 1", about(message=1)),
    (r"stats must have no names but", about(stats={"more": 1})),
    (r"segments must be a count, got -1", about(stats={"segments": -1})),
    (r"it begins with b'PK\\x05\\x06', or it is cut short", members()),
    (r"method must be that of the settings", about(STEPPED, method="dopri5", settings=as_set())),
    (r"t_end must lie in \[0\.0, 0\.5\], got 9", about(t_end=9.0)),
    (r"span must be what save writes", about(span=1)),
    (r"events must hold finite numbers, got 'x'", event(0, "x")),
    (r"events must hold states of \d+ numbers", event(2, [1.0, 0])),
    (r"times of events must not fall", lambda folder: rewritten(CONTACT, folder, backwards)),
    (r"^path must name a file, got", lambda _: MOTION.save("")),
    (r"Is a directory", lambda folder: MOTION.save(f"{folder}/")),
    (r"No such file or directory: '.*no/a\.npz'", lambda folder: MOTION.save(folder / "no/a.npz")),
]  # fmt: skip

REFUSALS: list[Refusal] = [*PARTS, *FILES]
