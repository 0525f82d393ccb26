"""Refusals of files that are damaged or foreign."""

import io
import math
import os
import pickle
import zipfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rolling_ellipse as rl
from oracles.files import put_together, taken_apart
from rolling_ellipse import Scene, scenes

from refusals import Row

MOTION = rl.simulate(Scene(2.0, 1.0, omega=1.0), np.linspace(0.0, 0.5, 12))
CONTACT = rl.simulate(scenes.bounce, np.linspace(0.0, 3.0, 12))
STEPPED = rl.simulate(
    Scene(2.0, 1.0, omega=1.0), [0.5], model="multipliers", method="rk4", step=0.1
)
HERE, NOWHERE, NOTHING = [0.0] * 6 + [0], [0.0] * 6 + [9], [0.0] * 4
BLOW = {"jx": 1.0, "jz": 0.0, "dx": 0.0, "dz": 0.0}

Change = Callable[[Any, Any], Any]


def reads(content: bytes) -> Callable[[Path], Any]:
    def call(folder: Path) -> Any:
        path = folder / "motion.npz"
        path.write_bytes(content)
        return rl.load(path)

    return call


def pipe(load: Callable[[Path], Any]) -> Callable[[Path], Any]:
    """Load a pipe without a writer, for which a reader would wait forever."""

    def call(folder: Path) -> Any:
        os.mkfifo(folder / "pipe")
        return load(folder / "pipe")

    return call


def changed(motion: rl.Trajectory, change: Change) -> Callable[[Path], Any]:
    """Load a file whose JSON or arrays were changed."""

    def call(folder: Path) -> Any:
        motion.save(folder / "saved.npz")
        about, arrays = taken_apart((folder / "saved.npz").read_bytes())
        text = change(about, arrays)
        return reads(put_together(text if isinstance(text, str) else about, arrays))(folder)

    return call


def facts(motion: rl.Trajectory = CONTACT, **given: Any) -> Iterator[Row]:
    """Rows that each replace one value in the JSON. In a name, double underscores separate the keys
    that lead to the value."""

    def put(name: str, value: Any) -> Change:
        *road, last = (int(key) if key.isdigit() else key for key in name.split("__"))

        def change(about: Any, _: Any) -> None:
            for key in road:
                about = about[key]
            about[last] = value

        return change

    for name, values in given.items():
        for value in values:
            yield "path", changed(motion, put(name, value))


def arrays(motion: rl.Trajectory = MOTION, **values: Any) -> Row:
    return "path", changed(motion, lambda _, known: known.update(values))


def entry(name: str, value: float) -> Row:
    return "path", changed(CONTACT, lambda _, known: known[name].__setitem__(1, value))


def text(content: str) -> Row:
    return "path", changed(MOTION, lambda *_: content)


def members(
    compression: int = zipfile.ZIP_STORED, *, text: str | None = '{"schema": 4}', **contents: bytes
) -> Row:
    """A row for an archive that contains the text, unless it is None, and these members."""
    file = io.BytesIO()
    if text is not None:
        contents = {"about": npy(text), **contents}
    with zipfile.ZipFile(file, "w", compression) as archive:
        for name, content in contents.items():
            archive.writestr(f"{name}.npy", content)
    return "path", reads(file.getvalue())


def npy(values: Any, version: tuple[int, int] = (1, 0)) -> bytes:
    file = io.BytesIO()
    np.lib.format.write_array(file, np.asarray(values), version=version)
    return file.getvalue()


def header(shape: str, dtype: str = "<f8", version: bytes = b"\x01\x00") -> bytes:
    said = f"{{'descr': {dtype!r}, 'fortran_order': False, 'shape': {shape}, }}".encode()
    said += b" " * (-(len(said) + 11) % 64) + b"\n"
    return b"\x93NUMPY" + version + len(said).to_bytes(2, "little") + said


#: Headers of arrays that are too large, too small, nested too deeply, of objects or of another
#: version, and a pickle.
HEADERS = [
    *map(header, ("(1000000000000,)", "(13,)", "(-12, -1)", f"({'1, ' * 70}12)", "'all'",
                  "(" * 500 + "12" + ",)" * 500, "-" * 7000 + "1")),
    header("(12,)", "|O"), header("(12,)", "|V0"), header("(12,)", version=b"\x09\x00"), b"",
    pickle.dumps(Path("x")),
]  # fmt: skip


def broken(_: Path) -> Any:
    """Look up a name of the package whose module cannot be loaded."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(rl, "_import_module", lambda *_: np.no_such_name)  # type: ignore[attr-defined]
        return rl.__getattr__("plot")


REFUSALS: list[Row] = [
    (ImportError, broken),
    ("path", lambda folder: MOTION.save(folder / "a.csv")),
    # members
    members(text=None), members(text=None, t=npy(np.zeros(9))), members(),
    members(t=npy(np.zeros(9))), members(z1=npy(1.0)),
    members(zipfile.ZIP_DEFLATED, t=npy(np.zeros(9))), members(t=npy(np.zeros(9), (2, 0))),
    members(t=npy(np.array([1j]))), members(t=npy(np.zeros(9))[:-1]),
    *(members(x=head + np.arange(12.0).tobytes()) for head in HEADERS),
    # arrays
    arrays(t=np.zeros(12, int)), arrays(theta=np.full(12, math.nan)),
    entry("t", -1e-9), entry("t", 9.0), entry("z", math.nan), entry("mode", 4), entry("mode", -1),
    # text
    *map(text, (
        "t = 1", "[]", "", "[" * 100_000, '{"schema":' * 50_000 + "4" + "}" * 50_000,
        '{"schema": ' + "4" * 5000 + "}", '{"schema": "\ud800"}', '{"schema": NaN}',
        '{"schema": 1, "schema": 1}',
    )),
    ("path", changed(MOTION, lambda about, _: about.__delitem__("status"))),
    ("path", changed(CONTACT, lambda about, _: about["events"].reverse())),
    *facts(
        more=[1], schema=[3, 4, 5, 7], message=[1], reason=[1], status=["FINISHED"],
        method=["auto", "x"], model=["falling", "multipliers"], span=[1, 0.01], t_end=[-1.0, 9.0],
        valid_until=[-1.0],
        stats=[{"more": 1}, {"segments": -1}, {"steps": 1.5}],
        events=[3, [[0.1, "SLIP"]], *([each] for each in (
            [0.1, "FALL", HERE, HERE, NOTHING], [9.0, "SLIP", HERE, HERE, NOTHING],
            [0.1, "SLIP", [0.0] * 6, [0.0] * 8, NOTHING], [0.1, "SLIP", HERE, NOWHERE, NOTHING],
            [0.1, "SLIP", ["a"] * 7, [0.0] * 7, NOTHING], [0.1, "SLIP", HERE, HERE, [0.0]],
            [0.1, "SLIP", HERE, HERE, ["a"] * 4]))],
        events__0__0=["x"], events__0__2=[[1.0, 0]],
        scene__mass=[-1.0], scene__theta=["flat"], scene__z=[0.1], scene__impulse=[{"jx": 1.0}],
        scene__a=[2], settings__rtol=[-1.0], settings__model=["rolling"], settings__method=["rk4"],
        settings__max_events=[0], settings__baumgarte=[[1.0]],
        settings__blows=[3, [[0.1, {"jx": 1.0}]], [[9.0, BLOW]], [[0.1, BLOW]]],
    ),
    *facts(STEPPED, span=[1e308], method=["dopri5"]),
    # files and folders
    ("path", pipe(rl.load)), ("path", pipe(rl.WorkPrecision.load)), ("path", pipe(rl.read_track)),
    ("folder", lambda folder: [(folder / "02_physics.ipynb").write_text(""), rl.examples(folder)]),
    ("path", lambda _: MOTION.save("")),
    (IsADirectoryError, lambda folder: MOTION.save(f"{folder}/")),
    (FileNotFoundError, lambda folder: MOTION.save(folder / "no/a.npz")),
]  # fmt: skip
