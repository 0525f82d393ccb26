"""Run the suite with exactly the oldest versions that pyproject.toml declares.

    python3.11 tools/oldest_versions.py FOLDER [argument of pytest ...]

creates a virtual environment in FOLDER, which must not exist, builds the package there with the
oldest build requirements and runs pytest. With --list it only prints the versions.
"""

import argparse
import re
import subprocess
import sys
import tomllib
from itertools import chain

from check_packaging import ROOT, environment, install, new_folder

SETTINGS = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
PROJECT = SETTINGS["project"]

# The type check is left out, since the annotations need the stubs of a current NumPy.
TYPES = "tests/project/test_codebase.py::test_the_tools_accept_the_sources[mypy]"
NO_TYPES = ("--deselect", TYPES)

# Old versions warn about newer versions of other packages.
NO_DEPRECATIONS = ("-Wignore::DeprecationWarning", "-Wignore::PendingDeprecationWarning")


def oldest(requirement: str) -> str:
    """The oldest version that a requirement allows, as the requirement name==version."""
    found = re.fullmatch(r"([\w-]+)(?:>=|==)([\w.]+)(?:,.*)?", requirement)
    if found is None:
        sys.exit(f"every requirement must state its oldest version, got {requirement!r}")
    return f"{found[1]}=={found[2]}"


def requirements(extra: str) -> list[str]:
    """Requirements of an extra, and of the extras that it names."""
    own = rf"{PROJECT['name']}\[(.+)\]"
    found = []
    for needed in PROJECT["optional-dependencies"][extra]:
        extras = re.fullmatch(own, needed)
        inner = [requirements(each) for each in extras[1].split(",")] if extras else [[needed]]
        found += chain.from_iterable(inner)
    return found


def oldest_versions() -> list[str]:
    """Requirements to build, run and test the package, with their oldest versions."""
    groups = SETTINGS["build-system"]["requires"], PROJECT["dependencies"], requirements("test")
    return [oldest(needed) for needed in chain(*groups)]


def main() -> None:
    parser = argparse.ArgumentParser(usage="%(prog)s [--list] FOLDER [argument of pytest ...]")
    parser.add_argument("folder", metavar="FOLDER", nargs="?", type=new_folder)
    parser.add_argument("--list", action="store_true")
    options, arguments = parser.parse_known_args()
    versions = oldest_versions()
    if options.list:
        print("\n".join(versions))
        return
    if options.folder is None:
        parser.error("FOLDER is missing")
    declared = PROJECT["requires-python"].removeprefix(">=")
    running = f"{sys.version_info.major}.{sys.version_info.minor}"
    if running != declared:
        sys.exit(f"this must be run by the oldest Python declared, {declared}, got {running}")
    python = environment(options.folder, sys.executable)
    install(python, *versions)
    install(python, "--no-build-isolation", "--no-deps", ROOT)
    tests = subprocess.run(
        [python, "-m", "pytest", *NO_DEPRECATIONS, *NO_TYPES, *arguments], cwd=ROOT
    )
    sys.exit(tests.returncode)


if __name__ == "__main__":
    main()
