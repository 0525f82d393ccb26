"""Compare the bits that tests/core/golden.cpp prints, built with many compilers and flags.

    python tools/same_bits.py FOLDER                 all builds whose compiler is on this machine
    python tools/same_bits.py FOLDER --only clang    all builds with this word in their name
    python tools/same_bits.py FOLDER --write         g++ -O3 only, writes tests/core/golden.txt

The builds stay in FOLDER; with ccache a second run is quick. Builds for one target must agree to
the last bit. Two other targets have C libraries that round sin and cos differently: aarch64, which
also has no vector lanes (g++-aarch64-linux-gnu and qemu-user), and Windows
(g++-mingw-w64-x86-64-posix and wine64). Builds for each of them must agree, too, and may differ
from builds for x86-64 Linux by no more than the bound of tests/oracles/golden.py. Otherwise the
exit code is 1. The packages libc++-dev and libc++abi-dev provide libc++.
"""

import argparse
import hashlib
import os
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests"))

from oracles.golden import GOLDEN, OTHER_LIBRARY, difference, read  # noqa: E402

ARM = "aarch64-linux-gnu-g++"
WINDOWS = "x86_64-w64-mingw32-g++-posix"

# CMake settings for cross compilers.
SETTINGS = {
    ARM: ["-DCMAKE_SYSTEM_NAME=Linux", "-DCMAKE_SYSTEM_PROCESSOR=aarch64"],
    WINDOWS: [
        "-DCMAKE_SYSTEM_NAME=Windows", "-DCMAKE_SYSTEM_PROCESSOR=x86_64",
        "-DCMAKE_EXE_LINKER_FLAGS=-static",
    ],
}  # fmt: skip


@dataclass(frozen=True)
class Build:
    """A compiler and its flags; `target` is the target of a cross compiler, or empty."""

    compiler: str
    flags: str

    @property
    def name(self) -> str:
        return f"{self.compiler} {self.flags}"

    @property
    def target(self) -> str:
        return self.compiler if self.compiler in SETTINGS else ""

    def command(self, folder: Path) -> list[str]:
        if self.target == ARM:
            qemu = shutil.which("qemu-aarch64") or shutil.which("qemu-aarch64-static")
            return [qemu or "qemu-aarch64", "-L", "/usr/aarch64-linux-gnu", str(folder / "golden")]
        if self.target == WINDOWS:
            return ["wine", str(folder / "golden.exe")]
        return [str(folder / "golden")]


BUILDS = (
    *(Build("g++", flags) for flags in ("-O3", "-O2", "-O0", "-O3 -flto", "-O3 -march=native")),
    *(Build("clang++", flags) for flags in ("-O2", "-O0", "-O3 -march=native")),
    Build("clang++", "-O2 -stdlib=libc++"),
    *(Build(ARM, flags) for flags in ("-O3", "-O2", "-O0")),
    *(Build(WINDOWS, flags) for flags in ("-O3", "-O2")),  # -O0 misrounds square roots
)


def output(build: Build, folder: Path, jobs: int) -> str:
    """Output of the built program; the script ends if the build fails."""
    place = folder / build.name.replace(" ", "").replace("+", "p").replace("=", "-")
    eigen = [str(at) for part in sys.path if (at := Path(part, "cmeel.prefix")).is_dir()]
    launcher = shutil.which("ccache")
    configure = [
        "cmake", "-S", ROOT, "-B", place, "-DROLLING_ELLIPSE_PYTHON=OFF",
        "-DROLLING_ELLIPSE_TESTS=ON", "-DCMAKE_BUILD_TYPE=None",
        f"-DCMAKE_CXX_COMPILER={build.compiler}", f"-DCMAKE_CXX_FLAGS={build.flags}",
        f"-DCMAKE_PREFIX_PATH={';'.join(eigen)}", *SETTINGS.get(build.target, []),
        *([f"-DCMAKE_CXX_COMPILER_LAUNCHER={launcher}"] if launcher else []),
    ]  # fmt: skip
    compile_it = ["cmake", "--build", place, "--target", "golden", "--parallel", str(jobs)]
    alone = os.environ | {"WINEPREFIX": str(folder / "wine"), "WINEDEBUG": "-all"}
    for command in (configure, compile_it, build.command(place)):
        words = [str(part) for part in command]
        done = subprocess.run(words, capture_output=True, text=True, env=alone)
        if done.returncode != 0:
            sys.exit(f"{build.name}:\n{done.stdout[-3000:]}\n{done.stderr[-3000:]}")
    return done.stdout


def compare(texts: dict[Build, str]) -> bool:
    """Print the differences between builds; return whether all agree."""
    holds = True
    firsts: dict[str, Build] = {}
    for build, text in texts.items():
        first = firsts.setdefault(build.target, build)
        if text != texts[first]:
            holds = False
            print(f"{build.name} differs from {first.name}:")
            print(*difference(read(texts[first])[1], read(text)[1]))
    for build, text in texts.items():
        worst, where = difference(read(GOLDEN.read_text(encoding="utf-8"))[1], read(text)[1])
        print(f"{build.name:<32} {worst:.1e} from golden.txt")
        if worst > OTHER_LIBRARY:
            holds = False
            print(where)
    return holds


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--only", default="", help="a word of the builds' names")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--write", action="store_true", help="make tests/core/golden.txt")
    chosen = parser.parse_args()
    if chosen.write:
        GOLDEN.write_text(output(BUILDS[0], chosen.folder, chosen.jobs), encoding="utf-8")
        return
    texts = {}
    for build in BUILDS:
        if chosen.only not in build.name:
            continue
        if shutil.which(build.compiler) is None:
            print(f"{build.name:<32} not on this machine")
            continue
        texts[build] = text = output(build, chosen.folder, chosen.jobs)
        library, _, records = text.partition("\n")
        digest = hashlib.sha256(records.encode()).hexdigest()[:16]
        print(f"{build.name:<32} {digest}  {library}", flush=True)
    if not texts:
        sys.exit(f"no build has {chosen.only!r} in its name and its compiler on this machine")
    sys.exit(0 if compare(texts) else 1)


if __name__ == "__main__":
    main()
