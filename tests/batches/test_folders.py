"""Motions in a folder equal those in memory bit for bit; an interrupted run can be resumed."""

import errno
import json
import os
import shutil
import signal
import subprocess
import sys
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rolling_ellipse as rl
from oracles.batches import ENDLESS, NAMED, TIMES, chunks, singly, states
from oracles.files import put_together, taken_apart
from oracles.limits import ctrl_c_after, files_of_at_most
from oracles.pickles import require_same
from rolling_ellipse import Impulse, Scene, load_many, scenes, simulate_many
from rolling_ellipse._verbs.batches import folders  # a test replaces its `version`

GRID: dict[str, Any] = {"a": 2.0, "b": 1.0, "theta": 0.3, "omega": np.linspace(0.1, 1.4, 70)}
UNUSUAL = [  # negative zeros, infinite friction, omitted arguments, numbers with 16 or 17 digits
    Scene(2.0, 1.0, x=-0.0, omega=-0.0, theta=0.1, friction=np.inf),
    Scene(2.0, 1.0, z=2.0, x_dot=-0.0, impulse=Impulse(jx=0.1, jz=-0.0, dx=1 / 3)),
    Scene(2.0, 1.0, inertia=0.1 + 0.2, friction=0.0),
]


@pytest.fixture
def out(tmp_path: Path) -> Path:
    return tmp_path / "motions"


def require_equal(loaded: Any, expected: Any) -> None:
    """Require equal motions and errors; the events in the folder must equal the computed ones."""
    for one, other in zip(loaded, expected, strict=True):
        assert type(one) is type(other) and str(one) == str(other)
        ours, theirs = (getattr(each, "trajectory", each) for each in (one, other))
        if isinstance(ours, rl.Trajectory):
            assert ours == theirs and ours.stats == theirs.stats
            assert repr(ours.scene) == repr(theirs.scene)
            assert ours.kept_events == theirs.events
            require_same(ours._bytes(), theirs._bytes())


@pytest.mark.parametrize(
    "way",
    [
        {}, {"model": "contact", "max_events": 1}, {"model": "multipliers", "rtol": 1e-6},
        {"model": "contact", "max_events": 1, "raise_on_failure": False},
        {"model": "rolling", "baumgarte": (1, 2), "rest_speed": 1e-3},
    ],
    ids=str,
)  # fmt: skip
def test_motions_and_errors_are_read_back_unchanged(way: dict[str, Any], out: Path) -> None:
    many = [*UNUSUAL, *NAMED * 3]
    assert simulate_many(many, TIMES, out=out, **way) == str(out)
    assert len(chunks(out)) == 3
    require_equal(load_many(out), singly(many, TIMES, **way))


@pytest.mark.parametrize("end", [5e-324, 512 * 5e-324])  # 512 * 5e-324 / 1000 rounds to 5e-324
def test_a_motion_with_coinciding_samples_survives_saving_to_a_folder(
    out: Path, end: float
) -> None:
    simulate_many([scenes.rocking], end, out=out)
    require_equal(load_many(out), singly([scenes.rocking], end))


def test_finished_chunks_are_not_computed_again(out: Path) -> None:
    simulate_many(GRID, TIMES, out=out)
    everything = states(out)
    first, *_, last = chunks(out)
    first.unlink()
    (out / "end.json").unlink()
    reports: list[int] = []
    simulate_many(GRID, TIMES, out=out, workers=2, progress=lambda n, of: reports.append(n))
    now = states(out)
    assert set(now) == set(everything) and len(reports) == 1
    assert {name for name in now if now[name] != everything[name]} == {first.name}
    require_equal(load_many(out), simulate_many(GRID, TIMES))
    last.unlink()  # a missing chunk of a complete folder is also rebuilt
    simulate_many(GRID, TIMES, out=out)
    require_equal(load_many(out), simulate_many(GRID, TIMES))


def test_scenes_given_singly_or_as_arrays_are_the_same_request(out: Path) -> None:
    simulate_many(GRID, TIMES, out=out)
    before = states(out)
    each = (Scene(2.0, 1.0, theta=0.3, omega=float(omega)) for omega in GRID["omega"])
    simulate_many(each, TIMES, out=out)
    assert states(out) == before


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"t": [1.0]}, "with other times, 60 from 0.0 to 2.0 s"),
        ({"t": TIMES * (1 + 2**-52)}, "with other times"),
        ({"rtol": 1e-9}, "with the settings .*'rtol': 1e-10.*'rtol': 1e-09"),
        ({"raise_on_failure": False}, "with the raise_on_failure True, not False"),
        ({"scenes": GRID | {"b": 1.1}}, "whose scenes 0 to 15 are different"),
        ({"scenes": GRID | {"omega": np.r_[GRID["omega"][:69], 1.0]}}, "scenes 66 to 69"),
        ({"scenes": GRID | {"omega": GRID["omega"][:49]}}, "which has more than 49"),
        ({"scenes": GRID | {"omega": np.r_[GRID["omega"], 1.0]}}, "scenes 66 to 70"),
        ({"scenes": [*(Scene(2.0, 1.0, theta=0.3, omega=float(w)) for w in GRID["omega"][:49]),
                     scenes.report]}, "scenes 49 to 49"),
    ],
)  # fmt: skip
def test_a_folder_from_another_request_is_rejected(
    changes: dict[str, Any], reason: str, out: Path
) -> None:
    request: dict[str, Any] = {"scenes": GRID, "t": TIMES}
    simulate_many(**request, out=out)
    before = states(out)
    with pytest.raises(ValueError, match=f"^out must be a folder of the same .*motions'.*{reason}"):
        simulate_many(**(request | changes), out=out)
    assert states(out) == before
    simulate_many(**request, out=out)


def test_a_folder_from_another_version_is_rejected(
    out: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    simulate_many(GRID, TIMES, out=out)
    monkeypatch.setattr(folders, "version", lambda name: "0.0.9")
    with pytest.raises(ValueError, match=r"^out must be .* version '\d.*', not '0.0.9'"):
        simulate_many(GRID, TIMES, out=out)
    list(load_many(out))  # motions computed by another version can be read


@pytest.mark.parametrize(("schema", "cure"), [(1, ""), (5, ": a newer .* pip install .*")])
def test_an_unknown_schema_of_a_folder_is_reported(schema: int, cure: str, out: Path) -> None:
    """The message states the schema even if the request contains unknown names."""
    simulate_many(GRID, TIMES, out=out)
    about, arrays = taken_apart((out / "request.npz").read_bytes())
    about = about | {"schema": schema, "colour": 1}
    (out / "request.npz").write_bytes(put_together(about, arrays | {"psi": TIMES}))
    said = f"must be a folder .*: it has schema {schema}; this version reads 2 to 4{cure}$"
    with pytest.raises(ValueError, match=f"^path {said}"):
        load_many(out)
    with pytest.raises(ValueError, match=f"^out {said}"):
        simulate_many(GRID, TIMES, out=out)


def test_a_folder_with_foreign_files_is_rejected_and_left_alone(tmp_path: Path) -> None:
    (tmp_path / "mine.txt").write_text("kept")
    (tmp_path / "lost+found").mkdir()
    (tmp_path / ".DS_Store").write_text("kept")
    with pytest.raises(ValueError, match=r"^out must be a new or empty .* with 'mine.txt' in it$"):
        simulate_many(GRID, TIMES, out=tmp_path)
    with pytest.raises(ValueError, match=r"^path must be a folder written by simulate_many"):
        load_many(tmp_path)
    for out in ("mine.txt", "no/folder"):
        with pytest.raises(OSError):
            simulate_many(GRID, TIMES, out=tmp_path / out)
    with pytest.raises(FileNotFoundError):
        load_many(tmp_path / "none")
    assert sorted(os.listdir(tmp_path)) == [".DS_Store", "lost+found", "mine.txt"]
    (tmp_path / "mine.txt").unlink()
    simulate_many(GRID, TIMES, out=tmp_path)  # hidden files and lost+found are accepted
    require_equal(load_many(tmp_path), simulate_many(GRID, TIMES))


@pytest.fixture
def small(out: Path) -> Path:
    remake(out)
    return out


def remake(folder: Path) -> None:
    simulate_many([scenes.jump, scenes.report, scenes.slip], [0.5, 1.5], out=folder)


@pytest.mark.parametrize(("name", "stride"), [("chunk", 17), ("request.npz", 17), ("end.json", 1)])
def test_a_damaged_byte_is_detected_or_harmless(name: str, stride: int, small: Path) -> None:
    """Reading a file with a changed byte raises an error that names the file, unless the byte is
    insignificant, like the dates in a zip archive. Calling simulate_many again repairs chunks and
    end.json, but rejects a damaged request.npz until that file is removed."""
    path = chunks(small)[0] if name == "chunk" else small / name
    whole, expected = path.read_bytes(), list(load_many(small))
    refused = 0
    for place in range(0, len(whole), stride):
        path.write_bytes(whole[:place] + bytes([whole[place] ^ 0x11]) + whole[place + 1 :])
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # warnings about the headers of NumPy's files
            try:
                loaded = list(load_many(small))
            except ValueError as error:
                assert path.name in str(error) and "simulate_many with the same" in str(error)
                refused += 1
                if name == "request.npz":
                    with pytest.raises(ValueError, match=rf"{path.name}.*: delete it, and call"):
                        remake(small)
                    path.unlink()
            else:
                require_equal(loaded, expected)
            remake(small)
        require_equal(load_many(small), expected)
    assert refused > len(whole) / stride / 2


@pytest.mark.parametrize("name", ["request.npz", "end.json", "chunk"])
@pytest.mark.parametrize("content", [b"", b"PK\x05\x06" + bytes(18), b"{}", b"\xff\xfe"])
def test_a_file_with_foreign_content_is_rejected(name: str, content: bytes, small: Path) -> None:
    path = chunks(small)[0] if name == "chunk" else small / name
    path.write_bytes(content)
    with pytest.raises(ValueError, match=rf"^path must name a file written by sim.*{path.name}"):
        list(load_many(small))


@pytest.mark.parametrize("count", [-1, 0, 2, 4, 49, 10**6, 10**18, "3", 3.0, True, None])
def test_an_end_file_with_a_wrong_scene_count_is_rejected(count: Any, small: Path) -> None:
    """The right count is the int 3."""
    end = json.loads((small / "end.json").read_text())
    (small / "end.json").write_text(json.dumps(end | {"scenes": count}))
    with pytest.raises(ValueError, match=r"end\.json|the file 00000001-"):
        load_many(small)
    remake(small)
    assert len(list(load_many(small))) == 3


@pytest.mark.parametrize(
    "changes",
    [
        {"t": np.array([1.0, 5.0])}, {"model": "rolling", "method": "rk4", "step": 0.1},
        {"scenes": GRID | {"b": 1.1}},
    ],
    ids=["times", "settings", "scenes"],
)  # fmt: skip
def test_a_folder_merged_from_two_requests_is_rejected(
    changes: Any, out: Path, tmp_path: Path
) -> None:
    request: dict[str, Any] = {"scenes": GRID, "t": np.array([2.0, 6.0])}
    simulate_many(**request, out=out)
    simulate_many(**(request | changes), out=tmp_path / "other")
    theirs = {path.name for path in chunks(tmp_path / "other")} - {p.name for p in chunks(out)}
    shutil.copytree(tmp_path / "other", out, dirs_exist_ok=True)
    with pytest.raises(ValueError, match=r"^path must have exactly the files of its end\.json"):
        load_many(out)
    for call in (request, request | changes):
        with pytest.raises(ValueError, match=r"^out must be a folder of the same"):
            simulate_many(**call, out=out)
    for name in (*theirs, "request.npz", "end.json"):  # remove the files of the other request
        (out / name).unlink()
    simulate_many(**request, out=out)
    require_equal(load_many(out), simulate_many(**request))


def test_parts_of_the_same_folder_can_be_merged(out: Path, tmp_path: Path) -> None:
    simulate_many(GRID, TIMES, out=out)
    shutil.copytree(out, tmp_path / "other")
    for place, path in enumerate(chunks(out)):
        ((out if place % 2 else tmp_path / "other") / path.name).unlink()
    shutil.copytree(tmp_path / "other", out, dirs_exist_ok=True)
    require_equal(load_many(out), simulate_many(GRID, TIMES))
    simulate_many(GRID | {"omega": GRID["omega"][:49]}, TIMES, out=tmp_path / "first")
    shutil.copytree(tmp_path / "first", out, dirs_exist_ok=True)
    # the end.json of `first` has another number of scenes
    with pytest.raises(ValueError, match=r"^path must have exactly the files of its end\.json"):
        load_many(out)
    simulate_many(GRID, TIMES, out=out)
    require_equal(load_many(out), simulate_many(GRID, TIMES))


def test_a_chunk_under_the_name_of_another_request_is_rejected(out: Path, tmp_path: Path) -> None:
    """The chunk of the other request has states at other times."""
    simulate_many(GRID, [2.0, 6.0], out=out)
    simulate_many(GRID, [1.0, 5.0], out=tmp_path / "other")
    for mine, other in zip(chunks(out), chunks(tmp_path / "other"), strict=True):
        shutil.copy(other, mine)
    with pytest.raises(ValueError, match="request and scenes must match the digests"):
        list(load_many(out))
    simulate_many(GRID, [2.0, 6.0], out=out)
    require_equal(load_many(out), simulate_many(GRID, [2.0, 6.0]))


def test_no_file_is_written_through_a_link_out_of_the_folder(out: Path, tmp_path: Path) -> None:
    out.mkdir()
    for name in ("end.json", "request.npz"):
        (out / name).symlink_to(tmp_path / "outside" / name)
    (tmp_path / "outside").mkdir()
    simulate_many(GRID, TIMES, out=out)
    assert list((tmp_path / "outside").iterdir()) == []
    require_equal(load_many(out), simulate_many(GRID, TIMES))


LIVES = """
import sys
from rolling_ellipse._motion.export.atomic import replacing
with replacing(sys.argv[1]) as new:
    print(new.name, flush=True)
    input()
    new.write_text("whole")
"""


def test_leftovers_of_killed_runs_are_removed_but_not_files_being_written(out: Path) -> None:
    out.mkdir()
    with subprocess.Popen(
        [sys.executable, "-c", LIVES, os.fspath(out / "note.txt")],
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
    ) as living:  # fmt: skip
        assert living.stdin and living.stdout
        name = living.stdout.readline().strip()
        (out / ".rolling_ellipse_0123.npz").write_bytes(b"of a process that was killed")
        simulate_many(GRID, TIMES, out=out)
        assert [path.name for path in out.glob(".rolling_ellipse_*")] == [name]
        living.communicate("go on")
    assert (out / "note.txt").read_text() == "whole"


def test_a_full_disk_leaves_the_request_intact(out: Path) -> None:
    """Files are limited to 15 kB here; the first chunk, of 1600 samples, needs 40 kB."""
    small = [Scene(2.0, 1.0, theta=0.3, omega=0.1)] * 40
    with files_of_at_most(15_000), pytest.raises(OSError) as caught:
        simulate_many(small, np.linspace(0, 1, 100), out=out)
    assert caught.value.errno == errno.EFBIG
    assert [path.name for path in out.iterdir()] == ["request.npz"]
    simulate_many(small, np.linspace(0, 1, 100), out=out)
    require_equal(load_many(out), simulate_many(small, np.linspace(0, 1, 100)))


def test_an_interrupt_loses_no_finished_chunk(out: Path) -> None:
    """Sixteen scenes at rest finish at once; the next one, which takes minutes, is interrupted."""
    quick = [Scene(2.0, 1.0)] * 16

    def last() -> Iterator[Scene]:
        yield from quick
        signal.setitimer(signal.ITIMER_REAL, 0.2)
        yield scenes.rocking

    with ctrl_c_after(-1.0):
        simulate_many(last(), 1e5, out=out, workers=2, **ENDLESS)
    assert len(chunks(out)) == 1 and not (out / "end.json").exists()
    before = states(out)
    simulate_many(quick, 1e5, out=out, **ENDLESS)
    assert states(out) == before and len(list(load_many(out))) == 16
