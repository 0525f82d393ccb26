"""Run the suite with every Python that the package declares.

    python tools/pythons.py FOLDER [--quick] [PYTHON ...]

creates FOLDER, which must not exist. PYTHON is a version (3.14, or 3.14t without the GIL) or the
path of an interpreter. The default is every version in the classifiers of pyproject.toml, with and
without the GIL where both exist. A version is looked up on the PATH. If it is not found and the
script runs as root, mmdebstrap creates a Debian system in FOLDER with g++ and this Python. Nothing
of the host is mounted in this system. A Python without the GIL is built from Debian's source (ten
minutes). Requirements that have a wheel are installed in a new environment. For each Python a line
is printed with versions, requirements without a wheel, pytest's counts, and reasons for skipped
tests. FOLDER/VERSION.log has the output.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from check_packaging import ROOT, new_folder, run
from oldest_versions import PROJECT, requirements

PREFIX = "Programming Language :: Python :: 3."
DECLARED = [f"3.{each.removeprefix(PREFIX)}" for each in PROJECT["classifiers"] if PREFIX in each]
FREE_THREADED = [f"{each}t" for each in DECLARED if each >= "3.13"]
LIBRARIES = "zlib1g-dev,libbz2-dev,liblzma-dev,libffi-dev,libssl-dev,libsqlite3-dev"
CERTIFICATES = Path("etc/ssl/certs/ca-certificates.crt")
SUITES = ("trixie", "sid")
WHOLE, QUICK = ["-n", "logical", "--dist", "loadfile"], ["-m", "quick"]
INSTALL = ("-m", "pip", "install", "--quiet")
VERSIONS = """\
import platform, sysconfig, matplotlib, numpy
numbers = numpy.__version__, matplotlib.__version__
print(platform.python_version(), "NumPy {}, matplotlib {}".format(*numbers), sep=", ")
print(sysconfig.get_config_var("Py_GIL_DISABLED") or 0)
"""
BUILD = """\
cd /tmp && apt-get update --quiet
apt-get source --quiet --download-only python{version}
mkdir python && tar -xf python{version}_*.orig.tar.xz -C python --strip-components=1
cd python && ./configure --quiet --disable-gil
make --silent -j "$(nproc)" && make --silent install
"""


def chroot(version: str, folder: Path) -> list[str]:
    """The words that start a command in a new Debian system with a Python of this version."""
    number = version.rstrip("t")
    if os.geteuid() != 0 or shutil.which("mmdebstrap") is None:
        sys.exit(f"no python{version} on the PATH: install it, or run this as root with mmdebstrap")
    packages = f"python{number}-venv,python{number}-dev,g++,ca-certificates"
    packages += f",make,xz-utils,{LIBRARIES}" if version != number else ""
    for suite in SUITES:
        lines = [f"{kind} http://deb.debian.org/debian {suite} main" for kind in ("deb", "deb-src")]
        system = folder / f"{version}-{suite}"
        try:
            run("mmdebstrap", "--variant=apt", '--aptopt=Acquire::Check-Valid-Until "false"',
                f"--include={packages}", suite, system, *lines, cwd=folder)  # fmt: skip
            break
        except SystemExit as failed:
            said = str(failed)
    else:
        why = re.search(r"^E: .*", said, re.MULTILINE) or [said[-60:]]
        sys.exit(f"not in Debian's {' and '.join(SUITES)} ({why[0]}): give the path of one")
    shutil.copy(Path("/") / CERTIFICATES, system / CERTIFICATES)  # certificate authorities for pip
    for name in run("git", "ls-files", cwd=ROOT).splitlines():
        (system / "project" / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, system / "project" / name)
    words = ["unshare", "--mount", "--pid", "--fork", "--mount-proc", f"--root={system}"]
    inside = [*words, "--wd=/project", "env", "PATH=/usr/local/bin:/usr/bin:/usr/sbin:/bin:/sbin"]
    if version != number:
        run(*inside, "sh", "-ec", BUILD.format(version=number), cwd=folder)
    return [*inside, f"PIP_CERT=/{CERTIFICATES}"]


def start(python: str, folder: Path) -> tuple[list[str], str]:
    """The words that precede each command of an interpreter, and the interpreter's name."""
    name = f"python{python}" if re.fullmatch(r"3\.\d+t?", python) else python
    try:
        run(name, "-c", "import ensurepip", cwd=folder)  # a shim on the PATH may have no Python
    except (SystemExit, OSError):
        if name == python:
            sys.exit("no Python with venv that starts: give a version or the path of another")
        return chroot(python, folder), name
    return [], name


def outcome(python: str, log: Path, arguments: list[str]) -> str:
    """One line about an interpreter; raise SystemExit with this line if the suite fails."""
    folder = log.parent
    before, interpreter = start(python, folder)
    environment = Path("/environment") if before else log.with_suffix("")
    words = [*before, environment / "bin" / "python"]
    run(*before, interpreter, "-m", "venv", environment, cwd=folder)
    run(*words, *INSTALL, "--prefer-binary", "/project" if before else ROOT, cwd=folder)
    missing = []
    for needed in requirements("test"):
        try:
            run(*words, *INSTALL, "--only-binary", ":all:", needed, cwd=folder)
        except SystemExit:
            missing.append(re.split("[>=]", needed)[0])
    versions, gil = run(*words, "-c", VERSIONS, cwd=folder).splitlines()
    variables = {"PYTHON_GIL": "0"} if int(gil) else {}  # some modules would turn the GIL on
    command = [*words, "-m", "pytest", "-p", "no:cacheprovider", *arguments]
    with log.open("w") as to:
        done = subprocess.run(command, cwd=ROOT, env=os.environ | variables, stdout=to, stderr=to)
    said = log.read_text(encoding="utf-8")
    skipped = re.findall(r"^SKIPPED \[(\d+)\] \S+ (.*)", said, re.MULTILINE)
    reasons = "; ".join(f"{count} {reason}" for count, reason in skipped) or "none"
    without = f", without {', '.join(missing)}" if missing else ""
    line = f"{versions}{without}: {said.splitlines()[-1].strip('= ')}; skipped: {reasons}"
    if done.returncode:
        sys.exit(line)
    return line


def main() -> None:
    parser = argparse.ArgumentParser(usage="%(prog)s FOLDER [--quick] [PYTHON ...]")
    parser.add_argument("folder", metavar="FOLDER", type=new_folder)
    parser.add_argument("pythons", nargs="*", default=[*DECLARED, *FREE_THREADED])
    parser.add_argument("--quick", action="store_true")
    options = parser.parse_intermixed_args()
    code = 0
    for python in options.pythons:
        log = options.folder / f"{Path(python).name}.log"
        try:
            line = outcome(python, log, QUICK if options.quick else WHOLE)
        except SystemExit as failed:
            code, line = 1, str(failed)
            if not log.exists():
                log.write_text(line, encoding="utf-8")
        print(f"{python}: {line.splitlines()[-1]}", flush=True)
    sys.exit(code)


if __name__ == "__main__":
    main()
