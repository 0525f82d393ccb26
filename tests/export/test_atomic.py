"""`replacing` leaves either the old file or the complete new file, whatever interrupts it."""

import os
import re
import signal
import stat
import tempfile
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import pytest
import rolling_ellipse as rl
from oracles.limits import files_of_at_most
from oracles.programs import run
from rolling_ellipse._motion.export.atomic import replacing  # everything that writes files uses it

OLD, NEW = b"what was there", b"what comes"


@pytest.fixture
def old(tmp_path: Path) -> Path:
    path = tmp_path / "motion.npz"
    path.write_bytes(OLD)
    return path


def names(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


def test_a_new_file_takes_the_place_and_permissions_of_the_old_one(old: Path) -> None:
    old.chmod(0o640)
    with replacing(old) as new:
        new.write_bytes(NEW)
        assert old.read_bytes() == OLD
    assert old.read_bytes() == NEW and names(old.parent) == [old.name]
    assert permissions(old) == 0o640


USUAL = ["roll.mp4", "ROLL.GIF", "motion", "größe -i.npz", "a.tar.gz", "-x.html", "x" * 240]
ODD = ["a.ß", "a.b c", "a." + "b" * 240, ".npz"]  # suffixes that temporary names leave out


@pytest.mark.parametrize("name", USUAL + ODD)
def test_temporary_names_are_safe_for_other_programs(name: str, tmp_path: Path) -> None:
    with replacing(tmp_path / name) as new:
        assert new.is_absolute() and new.parent == tmp_path
        assert new.suffix == ("" if name in ODD else Path(name).suffix)
        assert re.fullmatch(r"[A-Za-z0-9_.]{1,64}", new.name)
        new.write_bytes(NEW)
    assert names(tmp_path) == [name]


def test_a_relative_path_keeps_its_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    with replacing("motion.npz") as new:
        new.write_bytes(NEW)
        monkeypatch.chdir("/")
    assert names(tmp_path) == ["motion.npz"]


@pytest.mark.parametrize("kind", [ValueError, KeyboardInterrupt, SystemExit, MemoryError])
def test_an_exception_leaves_the_old_file(kind: type[BaseException], old: Path) -> None:
    for path in (old, old.with_name("another.npz")):
        with pytest.raises(kind), replacing(path) as new:
            new.write_bytes(NEW)
            raise kind
    assert old.read_bytes() == OLD and names(old.parent) == [old.name]


def test_a_vanished_temporary_file_is_an_error(old: Path) -> None:
    with pytest.raises(FileNotFoundError), replacing(old) as new:
        new.unlink()
    assert old.read_bytes() == OLD


def test_a_killed_process_leaves_the_old_file(old: Path) -> None:
    program = """
        import os, signal, sys
        from rolling_ellipse._motion.export.atomic import replacing
        with replacing(sys.argv[1]) as new, open(new, 'wb') as file:
            file.write(b'half')
            file.flush()
            os.kill(os.getpid(), signal.SIGKILL)
    """
    assert run(program, old).returncode == -signal.SIGKILL
    assert old.read_bytes() == OLD


MOTION = rl.simulate(rl.scenes.rolling, [0.0, 0.1])
FILM: dict[str, Any] = {"fps": 10, "width": 320}
WRITERS: dict[str, tuple[str, Callable[[Path], Any]]] = {
    "motion": ("npz", MOTION.save),
    "picture": ("png", lambda path: rl.plot(MOTION, path)),
    "savefig": ("pdf", lambda path: rl.plot_phase(MOTION).savefig(path)),
    "frame": ("svg", lambda path: rl.animate(MOTION, **FILM).frame(0.0, path)),
    "film": ("gif", lambda path: rl.animate(MOTION, path, **FILM)),
    "other writer": ("gif", lambda path: rl.animate(MOTION, **FILM).save(path, writer="pillow")),
    "player": ("html", lambda path: rl.animate(MOTION, path, **FILM)),
    "page": ("html", rl.explore(rl.scenes.report).save),
}


@pytest.mark.parametrize("name", WRITERS)
def test_every_writer_leaves_the_old_file_if_the_disk_is_full(name: str, tmp_path: Path) -> None:
    suffix, write = WRITERS[name]
    path = tmp_path / f"old.{suffix}"
    path.write_bytes(OLD)
    with files_of_at_most(500), pytest.raises(OSError, match="large"):
        write(path)
    plt.close("all")
    assert path.read_bytes() == OLD and names(tmp_path) == [path.name]


def test_a_picture_without_a_suffix_gets_the_usual_one(tmp_path: Path) -> None:
    """Without a format, matplotlib's default suffix is added. Otherwise the name is unchanged."""
    shown = rl.plot_phase(MOTION)
    shown.savefig(tmp_path / "one")
    shown.savefig(tmp_path / "two", format="svg")
    rl.animate(MOTION, **FILM).frame(0.0, tmp_path / "three")
    plt.close("all")
    assert names(tmp_path) == ["one.png", "three.png", "two"]
    assert b"<svg" in (tmp_path / "two").read_bytes()


def permissions(path: Path) -> int:
    return stat.S_IMODE(path.stat().st_mode)


@pytest.mark.parametrize("mask", [0o022, 0o077, 0o002])
def test_a_new_file_gets_the_usual_permissions(mask: int, tmp_path: Path) -> None:
    before = os.umask(mask)
    try:
        with replacing(tmp_path / "motion.npz") as new:
            new.write_bytes(NEW)
    finally:
        os.umask(before)
    assert permissions(tmp_path / "motion.npz") == 0o666 & ~mask


@pytest.mark.skipif(os.geteuid() != 0, reason="only root can give files away")
def test_a_new_file_keeps_the_owner(old: Path) -> None:
    os.chown(old, 1234, 2345)
    with replacing(old) as new:
        new.write_bytes(NEW)
    assert (old.stat().st_uid, old.stat().st_gid) == (1234, 2345)


def test_a_read_only_file_is_not_overwritten() -> None:
    """Root may write to any file, so root runs the test as `nobody`, in a folder open to all."""
    nobody, user = 65534, os.geteuid()
    with tempfile.TemporaryDirectory() as folder:
        os.chmod(folder, 0o777)
        old = Path(folder, "motion.npz")
        old.write_bytes(OLD)
        old.chmod(0o444)
        if user == 0:
            os.seteuid(nobody)
        try:
            with pytest.raises(PermissionError, match=r"motion\.npz"), replacing(old):
                pass
        finally:
            os.seteuid(user)
        assert old.read_bytes() == OLD and names(old.parent) == [old.name]


@pytest.mark.parametrize("there", [True, False])
def test_a_link_stays_a_link(there: bool, tmp_path: Path) -> None:
    (tmp_path / "far").mkdir()
    file, link = tmp_path / "far" / "motion.npz", tmp_path / "link.npz"
    if there:
        file.write_bytes(OLD)
    link.symlink_to(Path("far", "motion.npz"))
    with replacing(link) as new:
        new.write_bytes(NEW)
    assert link.is_symlink() and file.read_bytes() == NEW and names(file.parent) == [file.name]


def test_devices_and_pipes_are_written_not_replaced(tmp_path: Path) -> None:
    with replacing("/dev/null") as new:
        new.write_bytes(NEW)
    assert stat.S_ISCHR(os.stat("/dev/null").st_mode)
    pipe, contents = tmp_path / "pipe", []
    os.mkfifo(pipe)
    reader = threading.Thread(target=lambda: contents.append(pipe.read_bytes()), daemon=True)
    reader.start()
    with replacing(pipe) as new:
        new.write_bytes(NEW)
    reader.join(10)
    assert contents == [NEW] and stat.S_ISFIFO(pipe.stat().st_mode)


@pytest.mark.parametrize(
    ("name", "kind"),
    [
        ("no/such/folder/motion.npz", FileNotFoundError),
        ("no/../motion.npz", FileNotFoundError),
        ("motion.npz/inside.npz", NotADirectoryError),
        ("folder", IsADirectoryError),
        ("folder/", IsADirectoryError),
        ("folder/..", IsADirectoryError),
        ("new/", OSError),
        ("", OSError),
        ("loop", OSError),
        ("x" * 300, OSError),
    ],
)
def test_unwritable_paths_are_named_in_the_error(
    name: str, kind: type[OSError], old: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The error of `open` is raised before any work, and names the given path."""
    monkeypatch.chdir(old.parent)
    Path("folder").mkdir()
    Path("loop").symlink_to("loop")
    with pytest.raises(OSError), open(name, "wb"):
        pass
    before = names(old.parent)
    with pytest.raises(kind) as caught, replacing(name):
        pytest.fail("nothing can be written there")
    assert caught.value.filename == name
    assert names(old.parent) == before and not names(old.parent / "folder")
    assert old.read_bytes() == OLD
