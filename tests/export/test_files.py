"""Damaged trajectory files raise errors that name them. A failed save leaves the old file."""

import copy
import dataclasses
import math
import os
import re
import tracemalloc
import zipfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rolling_ellipse as rl
from oracles.files import put_together, taken_apart
from oracles.pickles import require_same
from oracles.report import lifted
from rolling_ellipse import Trajectory, simulate

TIMES = np.linspace(0.0, 1.5, 12)
SAVED: dict[str, Callable[[], Any]] = {
    "rolling": lambda: simulate(rl.scenes.report, TIMES),
    "contact": lambda: simulate(rl.scenes.bounce, 2 * TIMES, max_events=3, raise_on_failure=False),
    "multipliers": lambda: lifted(TIMES, method="rk4", step=0.1),
}
REFUSED = r"^path must name a file written by save, got '[^']*motion\.npz': "
Motions = dict[str, Trajectory]
Contents = dict[str, bytes]
each_model = pytest.mark.parametrize("name", SAVED)


@pytest.fixture(scope="module")
def motions() -> Motions:
    return {name: make() for name, make in SAVED.items()}


@pytest.fixture(scope="module")
def contents(motions: Motions, tmp_path_factory: pytest.TempPathFactory) -> Contents:
    folder = tmp_path_factory.mktemp("saved")
    for name, motion in motions.items():
        motion.save(folder / f"{name}.npz")
    return {name: (folder / f"{name}.npz").read_bytes() for name in motions}


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "motion.npz"


def require_refused(content: bytes, path: Path, reason: str = "") -> None:
    path.write_bytes(content)
    with pytest.raises(ValueError, match=REFUSED + reason):
        rl.load(path)


DAMAGES: dict[str, Callable[[bytes], bytes]] = {
    "lost": lambda part: b"",
    "wiped": lambda part: bytes(len(part)),
    "turned round": lambda part: part[::-1],
    "flipped": lambda part: bytes([part[0] ^ 16]) + part[1:],
}


def damaged(content: bytes, rng: np.random.Generator, damage: str) -> bytes:
    """The content with a damaged part, half of the time in the directory at its end."""
    start = len(content) - int(rng.integers(1, 900 if rng.random() < 0.5 else len(content)))
    end = start + int(rng.choice([1, 300, len(content)]))
    return content[:start] + DAMAGES[damage](content[start:end]) + content[end:]


def test_damage_is_rejected_or_harmless(motions: Motions, contents: Contents, path: Path) -> None:
    rng, harmless = np.random.default_rng(71), 0
    for i in range(2500):
        name = list(SAVED)[i % len(SAVED)]
        damage = str(rng.choice(list(DAMAGES)))
        path.write_bytes(damaged(contents[name], rng, damage))
        try:
            motion = rl.load(path)
        except ValueError as error:
            assert re.match(REFUSED, str(error)), (i, damage)
        else:  # the damage is in a date, or in a header of a member that the directory repeats
            harmless += 1
            require_same(motion, dataclasses.replace(motions[name], kept_events=motion.events))
    assert 100 < harmless < 800


@each_model
def test_an_undamaged_file_is_read_back_unchanged(
    name: str, motions: Motions, contents: Contents, path: Path
) -> None:
    path.write_bytes(put_together(*taken_apart(contents[name])))
    expected = dataclasses.replace(motions[name], kept_events=motions[name].events)
    require_same(rl.load(path), expected)
    rl.load(path).save(path)
    assert taken_apart(path.read_bytes())[0] == taken_apart(contents[name])[0]


def places(part: Any, road: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Paths of keys and indices to every value, and to every dictionary or list."""
    yield road
    if isinstance(part, (dict, list)):
        for key in part if isinstance(part, dict) else range(len(part)):
            yield from places(part[key], (*road, key))


def changed(about: Any, road: tuple[Any, ...], change: Callable[[Any, Any], None]) -> Any:
    about = copy.deepcopy(about)
    part = about
    for key in road[:-1]:
        part = part[key]
    change(part, road[-1])
    return about


def nested(depth: int) -> list[Any]:
    return [nested(depth - 1)] if depth else []


WRONG_VALUES: dict[str, Any] = {
    "null": None, "true": True, "false": False, "text": "wrong", "number as text": "1.0",
    "empty": "", "list": [1.0], "none": [], "part": {"a": 1.0}, "nan": math.nan, "inf": math.inf,
    "-inf": -math.inf, "negative": -1.0, "negative whole": -1, "huge": 1e300, "half": 0.5,
    "enormous": 10**400, "whole": 7, "deep": nested(300),
}  # fmt: skip


@each_model
def test_wrong_values_are_rejected_or_saved_unchanged(
    name: str, contents: Contents, path: Path
) -> None:
    """Each value in the JSON is replaced by each wrong value. If accepted, it is saved
    unchanged."""
    about, arrays = taken_apart(contents[name])
    taken = set()
    about["events"] = about["events"][:1]  # the other events have the same form
    roads = [road for road in places(about) if road]
    for road in roads:
        for label, value in WRONG_VALUES.items():
            wrong = changed(about, road, lambda part, key, new=value: part.__setitem__(key, new))  # type: ignore[misc]
            path.write_bytes(put_together(wrong, arrays))
            try:
                motion = rl.load(path)
            except ValueError as error:
                assert re.match(REFUSED, str(error)), (road, label)
                continue
            taken.add(label)
            motion.save(path)
            assert taken_apart(path.read_bytes())[0] == wrong, (road, label)
    assert taken <= {
        "null", "text", "number as text", "empty", "negative", "whole", "half", "inf", "-inf",
        "huge", "none", "part",
    }  # fmt: skip


@pytest.mark.parametrize(("schema", "cure"), [(3, ""), (7, ": a newer .* pip install .*")])
def test_an_unknown_schema_of_a_file_is_reported(
    schema: int, cure: str, contents: Contents, path: Path
) -> None:
    """The message names the schema even if the file contains unknown names."""
    about, arrays = taken_apart(contents["rolling"])
    del about["reason"]
    other = put_together(about | {"schema": schema, "colour": 1}, arrays | {"psi": arrays["x"]})
    require_refused(other, path, f"it has schema {schema}; this version reads 4 to 6{cure}$")


@each_model
def test_missing_and_unknown_names_are_rejected(name: str, contents: Contents, path: Path) -> None:
    about, arrays = taken_apart(contents[name])
    for road in places(about):
        part = about
        for key in road:
            part = part[key]
        if not isinstance(part, dict):
            continue
        new = changed(about, (*road, "colour"), lambda part, key: part.__setitem__(key, 1))
        require_refused(put_together(new, arrays), path, ".*colour")
        for key in part if road != ("stats",) else ():
            new = changed(about, (*road, key), lambda part, key: part.__delitem__(key))
            require_refused(put_together(new, arrays), path, f".* must have '{key}'$")


RETYPED: dict[str, Callable[[Any], Any]] = {
    "complex": lambda v: v + 1j,
    "float32": lambda v: v.astype(np.float32),
    "whole": lambda v: v.astype(np.int64),
    "truth": lambda v: v.astype(bool),
    "text": lambda v: v.astype(str),
    "times": lambda v: v.astype("m8[s]"),
    "fields": lambda v: np.zeros(v.shape, [("a", float), ("b", float)]),
    "a column": lambda v: v[..., None],
    "one more": lambda v: np.concatenate([v, v[-1:]]),
    "one less": lambda v: v[:-1],
    "a number": lambda v: v.ravel()[0],
    "none": lambda v: v[:0],
    "columns first": lambda v: np.asfortranarray(np.stack([v, v])),
    "nan": lambda v: np.where(np.arange(v.size).reshape(v.shape) == 3, math.nan, v),
    "inf": lambda v: np.where(np.arange(v.size).reshape(v.shape) == 3, -math.inf, v),
}


@pytest.mark.parametrize("change", RETYPED.values(), ids=RETYPED)
@each_model
def test_invalid_arrays_are_rejected(
    name: str, change: Any, contents: Contents, path: Path
) -> None:
    about, arrays = taken_apart(contents[name])
    for array, values in arrays.items():
        require_refused(put_together(about, arrays | {array: change(values)}), path)


@each_model
def test_arrays_from_another_model_are_rejected(name: str, contents: Contents, path: Path) -> None:
    about, arrays = taken_apart(contents[name])
    for array in set(arrays) - {"start"}:
        rest = {key: values for key, values in arrays.items() if key != array}
        require_refused(put_together(about, rest), path, f"model '{name}' must have '{array}'")
        other = put_together(about, rest | {"colour": arrays[array]})
        require_refused(other, path, ".*'colour.npy'")
    for array in ("z", "mode", "coordinates"):
        if array not in arrays:
            more = put_together(about, arrays | {array: arrays["x"]})
            require_refused(more, path, f"model '{name}' must not have '{array}'")


def test_samples_in_any_order_or_byte_order_are_read(motions: Motions, path: Path) -> None:
    for times in ([1.0, 0.0, 0.5, 0.5], []):
        motions["multipliers"].sol(times).save(path)
        assert rl.load(path).t.tolist() == times
    about, arrays = taken_apart(path.read_bytes())
    swapped = {name: values.astype(">f8") for name, values in arrays.items()}
    path.write_bytes(put_together(about, swapped))
    assert rl.load(path).theta.dtype == np.float64


class Harmful:
    def __reduce__(self) -> tuple[Any, ...]:
        return os.mkdir, ("harmed",)


def test_nothing_is_unpickled(contents: Contents, path: Path, monkeypatch: Any) -> None:
    monkeypatch.chdir(path.parent)
    about, arrays = taken_apart(contents["rolling"])
    wrong = np.full(12, None)
    wrong[3] = Harmful()
    for name in arrays:
        require_refused(put_together(about, arrays | {name: wrong}), path)
    assert not Path("harmed").exists()


def test_an_archive_with_a_repeated_member_is_rejected(contents: Contents, path: Path) -> None:
    """An archive that lists the same bytes a million times would take a week to read."""
    path.write_bytes(contents["rolling"])
    with zipfile.ZipFile(path, "a") as archive, pytest.warns(UserWarning, match="Duplicate"):
        archive.writestr("x.npy", archive.read("x.npy"))
    require_refused(path.read_bytes(), path, "it must contain known arrays once, got 'x.npy'")


@pytest.mark.parametrize("start", [b"", b"PK\x03\x04"])
def test_a_huge_file_is_rejected_without_being_read(
    start: bytes, path: Path, tmp_path: Path
) -> None:
    """Files of 6 GiB, starting with zeros or like an archive, and an endless file are rejected."""
    (tmp_path / "many").mkdir()
    (tmp_path / "many" / "request.npz").symlink_to(path)
    with open(path, "wb") as file:
        file.write(start)
        file.truncate(6 * 2**30)
    reads: list[tuple[Callable[[Any], Any], Any]] = [
        (rl.load, path), (rl.load, "/dev/zero"), (rl.WorkPrecision.load, path),
        (rl.load_many, tmp_path / "many"),
    ]  # fmt: skip
    tracemalloc.start()
    for read, place in reads:
        with pytest.raises(ValueError, match=r"^path must name a file.*: it starts|a device$"):
            read(place)
    assert tracemalloc.get_traced_memory()[1] < 2**24
    tracemalloc.stop()


@pytest.mark.parametrize("name", ["folder", "folder/motion.npz", "text/motion.npz"])
def test_an_unreadable_file_raises_the_error_of_the_operating_system(
    name: str, tmp_path: Path
) -> None:
    (tmp_path / "folder").mkdir()
    (tmp_path / "text").write_text("text")
    with pytest.raises(OSError) as caught:
        rl.load(tmp_path / name)
    assert caught.value.filename == os.fspath(tmp_path / name)


def test_a_motion_that_load_would_reject_is_not_saved(motions: Motions, path: Path) -> None:
    motion = motions["contact"]
    motion.save(path)
    before, contact = path.read_bytes(), motion.contact
    assert contact is not None
    for change, reason in (
        ({"x": np.full(motion.t.size, math.nan)}, "x must be finite, got nan"),
        ({"contact": contact._replace(z=contact.z * math.inf)}, "z must be finite, got inf"),
        ({"method": "another"}, "method must be one of"),
        ({"model": "rolling"}, "model 'rolling' must not have"),
        ({"contact": None}, "model 'contact' must have 'friction_force'"),
        ({"t_end": 0.0}, r"t must be within \[0\.0, 0\.0\]"),
        ({"stats": {"beats": 2}}, "stats must have names among"),
    ):
        with pytest.raises(ValueError, match=f"^{reason}"):
            dataclasses.replace(motion, **change).save(path)
        assert path.read_bytes() == before
    dataclasses.replace(motion, valid_until=1, stats={}).save(path)
    assert rl.load(path).valid_until == 1.0
