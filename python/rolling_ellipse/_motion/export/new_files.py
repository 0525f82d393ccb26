"""Files written into a user's folder, without overwriting files or following links."""

from __future__ import annotations

from pathlib import Path

from .atomic import write


def write_new(folder: Path, files: dict[str, bytes]) -> list[Path]:
    """Write files, given by their paths in a folder; return the paths of new files.

    Raises
    ------
    ValueError
        If a different file or a link exists at one of the paths. No file is written then.
    OSError
        If a file cannot be written. Each file is written completely or not at all.
    """
    kept = {name for name, content in files.items() if _is_there(folder / name, content)}
    if others := [name for name in sorted(files) if name not in kept and _is_taken(folder, name)]:
        raise ValueError(f"folder must contain no other {', '.join(others)}, got {str(folder)!r}")
    missing = [folder / name for name in sorted(files) if name not in kept]
    for path in missing:
        path.parent.mkdir(parents=True, exist_ok=True)
        write(path, files[path.relative_to(folder).as_posix()])
    return missing


def _is_there(path: Path, content: bytes) -> bool:
    is_file = path.is_file() and not path.is_symlink() and path.stat().st_size == len(content)
    return is_file and path.read_bytes() == content


def _is_taken(folder: Path, name: str) -> bool:
    """Return whether the path of a new file exists, or passes through a link or a file."""
    path = folder / name
    between = [part for part in path.parents if part != folder and part.is_relative_to(folder)]
    blocked = [part.is_symlink() or (part.exists() and not part.is_dir()) for part in between]
    return path.is_symlink() or path.exists() or any(blocked)
