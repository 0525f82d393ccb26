"""Tests of a second build of the core, without optimisation, and of its test programs.

This build must agree with the installed extension bit for bit in the motions of every model and the
results of every proof (golden.cpp). These must also equal the committed records (golden.txt) if the
C library is the same. Another version of the library, or the same one on a processor without fused
multiply-add, rounds sin, cos, exp and log differently; then the differences must stay within the
bound of oracles/golden.py.
"""

import os
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest
from oracles.golden import (
    OTHER_LIBRARY,
    Record,
    blocks,
    bodies_through_python,
    difference,
    golden,
    motion_through_python,
    outcomes_through_python,
    printed,
)  # fmt: skip
from oracles.paths import ROOT

Build = tuple[str, list[Record]]  # name of the C library, and records
LIBRARY, RECORDS = golden()
MOTIONS = [name for name in blocks(RECORDS, "motion")]
OTHERS = ("body", "rolled", "thresholds", "classify")


def found(name: str) -> str | None:
    """Path of a program next to the interpreter (from the test extra), otherwise on the PATH."""
    scripts = sysconfig.get_path("scripts")
    return shutil.which(name, path=os.pathsep.join((scripts, os.environ.get("PATH", ""))))


def run(*command: str) -> str:
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=1200)
    assert done.returncode == 0, f"{command}:\n{done.stdout[-5000:]}\n{done.stderr[-5000:]}"
    return done.stdout


@pytest.fixture(scope="module")
def build(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Build the programs, which takes one core a minute; return their folder."""
    cmake, ninja = found("cmake"), found("ninja")
    compiler = os.environ.get("CXX") or found("c++") or found("g++") or found("clang++")
    for name, program in {"CMake": cmake, "C++ compiler": compiler}.items():
        if program is None:
            pytest.skip(f"there is no {name} on this machine")
    assert cmake and compiler
    folder = tmp_path_factory.mktemp("core")
    eigen = [str(at) for place in sys.path if (at := Path(place, "cmeel.prefix")).is_dir()]
    run(
        cmake, "-S", str(ROOT), "-B", str(folder), "-DROLLING_ELLIPSE_PYTHON=OFF",
        "-DROLLING_ELLIPSE_TESTS=ON", "-DCMAKE_BUILD_TYPE=None", "-DCMAKE_CXX_FLAGS=-O0",
        f"-DCMAKE_CXX_COMPILER={compiler}", f"-DCMAKE_PREFIX_PATH={';'.join(eigen)}",
        *(["-G", "Ninja", f"-DCMAKE_MAKE_PROGRAM={ninja}"] if ninja else []),
    )  # fmt: skip
    run(cmake, "--build", str(folder), "--parallel", str(os.cpu_count() or 1))
    return folder


@pytest.fixture(scope="module")
def second(build: Path) -> Build:
    return printed(build / "golden")


@pytest.mark.parametrize("program", ["core_test", "threads_test", "allocations_test", "lanes_test"])
def test_every_core_program_passes(program: str, build: Path) -> None:
    if program == "lanes_test" and not (build / program).exists():
        pytest.skip("this processor has no lanes of its own")
    assert "all hold" in run(str(build / program))


def test_the_second_build_agrees_with_the_committed_records(second: Build) -> None:
    library, records = second
    worst, where = difference(RECORDS, records)
    print(library, worst, where)
    assert worst <= (0.0 if library == LIBRARY else OTHER_LIBRARY), where


def test_a_c_library_that_rounds_differently_stays_within_the_bound(
    build: Path, second: Build
) -> None:
    """GLIBC_TUNABLES makes glibc round as on a processor without fused multiply-add."""
    library, records = printed(build / "golden", GLIBC_TUNABLES="glibc.cpu.hwcaps=-FMA,-AVX2,-FMA4")
    if library == second[0]:
        pytest.skip(f"{library} has one rounding only")
    worst, where = difference(second[1], records)
    print(library, worst, where)
    assert 0 < worst <= OTHER_LIBRARY, where


def test_the_records_cover_all_models_methods_stabilizations_and_events_except_blows() -> None:
    motions = [each.words for each in RECORDS if each.kind == "motion"]
    stabilizations = {words[3] for words in motions if words[1] == "multipliers"}
    assert stabilizations == {"none", "baumgarte", "projection", "projection+energy", "ggl"}
    solutions = {each.words for each in RECORDS if each.kind == "solution"}
    assert {model for model, _ in solutions} == {"rolling", "multipliers", "contact"}
    methods = {method for _, method in solutions}
    assert methods == {"exact", "dop853", "dopri5", "rk4", "gauss", "radau"}
    events = {each.words[0] for each in RECORDS if each.kind == "event"}
    assert events == {"slip", "stick", "reverse", "lift_off", "impact", "rest", "jam"}


def compare(mine: list[Record], through_python: list[Record], bound: float) -> None:
    worst, where = difference(mine, through_python)
    print(worst, where)
    assert worst <= bound, where


@pytest.mark.parametrize("name", MOTIONS)
def test_motions_computed_through_python_stay_within_the_bound(name: str) -> None:
    """Without a compiler the bits of this C library are unknown, so that only the bound applies."""
    motion = [each for each in blocks(RECORDS, "motion")[name] if each.kind not in OTHERS]
    compare(motion[2:], list(motion_through_python(motion)), OTHER_LIBRARY)


@pytest.mark.parametrize("name", MOTIONS)
def test_motions_computed_by_the_extension_equal_the_second_build_bit_for_bit(
    name: str, second: Build
) -> None:
    motion = [each for each in blocks(second[1], "motion")[name] if each.kind not in OTHERS]
    compare(motion[2:], list(motion_through_python(motion)), 0.0)


def test_bodies_rolled_by_the_extension_equal_the_second_build_bit_for_bit(second: Build) -> None:
    bodies = [each for each in second[1] if each.kind in ("body", "rolled")]
    compare(bodies, bodies_through_python(bodies), 0.0)


def test_outcomes_of_the_extension_equal_those_of_the_second_build(second: Build) -> None:
    outcomes = [each for each in second[1] if each.kind in ("thresholds", "classify")]
    compare(outcomes, list(outcomes_through_python(outcomes)), 0.0)
