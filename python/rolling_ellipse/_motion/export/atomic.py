"""Files that are written completely or not at all."""

from __future__ import annotations

import errno
import os
import re
import secrets
import stat
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

if sys.platform != "win32":
    import fcntl

UNFINISHED = ".rolling_ellipse_"  # prefix of the names of unfinished files


@contextmanager
def replacing(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Yield the path of a new empty file in the same folder, which replaces `path` on success.

    Until then the old file stays in place, and `path` never names an unfinished file, even if the
    process is killed. Any exception removes the new file. The new name has the suffix of `path`,
    from which writers choose a format, and contains only plain characters, so that other programs
    accept it. A link stays a link, and a replaced file keeps its permissions. Devices and pipes
    cannot be replaced; for them `path` itself is yielded. An OSError names `path`, like an error
    from `open`.
    """
    name = os.fspath(path)
    try:
        target, old = _target(name)
        new = _beside(target) if old is None or stat.S_ISREG(old.st_mode) else None
    except OSError as error:  # the error may name a file other than `path`
        raise OSError(error.errno, error.strerror, name) from None
    if new is None:
        yield Path(name)
        return
    try:
        with _locked(new):
            yield new
            with open(new, "r+b") as written:  # flush to disk before replacing the old file
                os.fsync(written.fileno())
            if old is not None:
                with suppress(PermissionError):  # only root can change the owner of a file
                    os.chown(new, old.st_uid, old.st_gid)
                new.chmod(stat.S_IMODE(old.st_mode))
            os.replace(new, target)
    except BaseException:
        new.unlink(missing_ok=True)
        raise


def remove_unfinished(folder: Path) -> None:
    """Remove the unfinished files of killed processes; those still being written are locked."""
    for path in folder.glob(f"{UNFINISHED}*"):
        with suppress(OSError), _locked(path) as is_free:
            if is_free:
                path.unlink()


def write(path: str | os.PathLike[str], content: bytes) -> None:
    """Write a file completely or not at all, with `replacing`."""
    with replacing(path) as new:
        new.write_bytes(content)


@contextmanager
def _locked(path: Path) -> Iterator[bool]:
    """Lock a file, and yield whether it was free. The lock ends with the process, if not before.

    Windows needs no lock, because it does not remove open files.
    """
    if sys.platform == "win32":
        yield True
        return
    descriptor = os.open(path, os.O_RDWR | os.O_NOFOLLOW)
    try:
        is_free = True
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:  # another process holds the lock, or the file system has no locks
            is_free = False
        yield is_free
    finally:
        os.close(descriptor)


def _target(name: str) -> tuple[Path, os.stat_result | None]:
    """Return the path with all links resolved, and the file's status (None if it does not exist).

    An OSError is raised if the file cannot be opened for writing; this check does not truncate it.
    """
    folder, last = os.path.split(name)
    if last in ("", os.curdir, os.pardir):
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
    target = Path(os.path.realpath(os.path.join(os.path.realpath(folder, strict=True), last)))
    try:
        old = os.stat(name)
    except FileNotFoundError:
        return target, None
    if stat.S_ISREG(old.st_mode) or stat.S_ISDIR(old.st_mode):
        os.close(os.open(name, os.O_WRONLY))
    return target, old


def _beside(target: Path) -> Path:
    """Create an empty file next to `target`, because renaming works only within a file system."""
    plain = re.fullmatch(r"\.[A-Za-z0-9_]{1,16}", target.suffix)
    new = target.with_name(f"{UNFINISHED}{secrets.token_hex(8)}{plain[0] if plain else ''}")
    os.close(os.open(new, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666))
    return new
