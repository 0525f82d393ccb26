"""Files that appear whole or not at all."""

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

UNFINISHED = ".rolling_ellipse_"  # begins the names of files that are not whole


@contextmanager
def replacing(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Yield the absolute path of an empty file beside `path` that takes its place on success.

    Until then the old file stays as it is, and nothing but a whole file ever has its name, even
    if the process is killed. Any exception removes the new file. Its name has the suffix of
    `path`, by which writers choose a format, and is otherwise plain, so that other programs can
    be given it. A link stays a link; a file that was there keeps its permissions. Devices and
    pipes cannot be replaced: there `path` itself is yielded, to be written as it comes.

    Raises
    ------
    OSError
        If there is no such folder, or no permission, as `open` would; it names `path`.
    """
    name = os.fspath(path)
    try:
        target, old = _target(name)
        new = _beside(target) if old is None or stat.S_ISREG(old.st_mode) else None
    except OSError as error:  # it names a folder, or the new file, which nobody asked for
        raise OSError(error.errno, error.strerror, name) from None
    if new is None:
        yield Path(name)
        return
    try:
        with _locked(new):
            yield new
            _store(new)
            if old is not None:
                with suppress(PermissionError):  # only root can give files away
                    os.chown(new, old.st_uid, old.st_gid)
                new.chmod(stat.S_IMODE(old.st_mode))
            os.replace(new, target)
    except BaseException:
        new.unlink(missing_ok=True)
        raise


def remove_unfinished(folder: Path) -> None:
    """Remove the new files of killed processes from a folder; those still written to are locked."""
    for path in folder.glob(f"{UNFINISHED}*"):
        with suppress(OSError), _locked(path) as is_free:
            if is_free:
                path.unlink()


@contextmanager
def _locked(path: Path) -> Iterator[bool]:
    """Hold the lock of a file, which ends with the process; yield whether it was to be had.

    Windows needs none: what is open there cannot be removed.
    """
    if sys.platform == "win32":
        yield True
        return
    descriptor = os.open(path, os.O_RDWR | os.O_NOFOLLOW)
    try:
        is_free = True
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:  # another process has it, or there are no locks on this file system
            is_free = False
        yield is_free
    finally:
        os.close(descriptor)


def _target(name: str) -> tuple[Path, os.stat_result | None]:
    """Return the file behind all links, and what is known of it, None if it is not there yet.

    Refuses what `open` would refuse to write to; only asking it to write would empty the file.
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
    """Create an empty file in the same folder, as only within a file system can it be moved."""
    plain = re.fullmatch(r"\.[A-Za-z0-9_]{1,16}", target.suffix)
    new = target.with_name(f"{UNFINISHED}{secrets.token_hex(8)}{plain[0] if plain else ''}")
    os.close(os.open(new, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666))
    return new


def _store(new: Path) -> None:
    """Wait until the bytes are on the disk: a name moved before them could be of an empty file."""
    descriptor = os.open(new, os.O_RDWR)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
