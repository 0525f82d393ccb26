"""Make one-line changes in the sources, each of which the tests should notice.

    python tools/mutants.py core --count 100 --folder /tmp/mutants
    python tools/mutants.py python --count 30 --folder /tmp/mutants
    python tools/mutants.py core --only src/contact/slide.cpp:52:3 --folder /tmp/mutants

copies the checkout to FOLDER and draws changes (signs, sines and cosines, factors, < and <=,
indices, tolerances, and/or, min/max) from lines all over the sources. For each change it builds the
copy and runs the nearest tests, the programs of tests/core, and the quick tests of every folder, up
to the first that fails. With --thorough the whole suite is run last. Mutants that no test notices
are listed; mutants that do not compile do not count. At the end the tests must pass without a
mutant. Results are stored in FOLDER/SIDE.json; the same command continues where it was stopped. The
script needs the build and test requirements.
"""

import argparse
import filecmp
import json
import os
import random
import re
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]

# Patterns and their replacements. Strings and comments are not changed.
CHANGES = {
    "sign": [(r" \+ ", " - "), (r" - ", " + "), (r"([=(,] ?)-(?=[\w(])", r"\1"),
             (r" \+= ", " -= "), (r" -= ", " += ")],
    "function": [(r"\bsin\(", "cos("), (r"\bcos\(", "sin("), (r"\bmax\(", "min("),
                 (r"\bmin\(", "max("), (r"\bfloor\(", "ceil("), (r"\b(std::|np\.)?abs\(", "("),
                 (r"\bsquare\(", "(")],
    "factor": [(r"\b0\.5 \*", "0.51 *"), (r"\b2 \*", "3 *"), (r" \* ", " / "), (r" / ", " * ")],
    "comparison": [(r" < ", " <= "), (r" <= ", " < "), (r" > ", " >= "), (r" >= ", " > "),
                   (r" == ", " != "), (r" != ", " == ")],
    "logic": [(r" && ", " || "), (r" \|\| ", " && "), (r"\btrue\b", "false"),
              (r"\bfalse\b", "true"), (r" and ", " or "), (r" or ", " and "),
              (r"\bif not ", "if "), (r"\bTrue\b", "False"), (r"\bFalse\b", "True")],
    "index": [(r"\[0\]", "[1]"), (r"\[1\]", "[0]"), (r" \+ 1\b", " + 2"), (r" - 1\b", " - 2"),
              (r"= 0;", "= 1;"), (r"= 1;", "= 0;")],
    "tolerance": [(r"\b(\d+)e-(\d+)\b", r"\1e-3"), (r"\b(\d+) \* epsilon\b", r"1000000 * epsilon")],
}  # fmt: skip

# Test folders by the innermost listed folder of a source file; "core" and "python" are for files in
# none of these folders. Other source folders have their tests in a folder of the same name.
NEAREST = {
    "bindings": ["refusals", "trajectory", "border", "batches"],
    "core": ["trajectory", "contact", "rolling"],
    "geometry": ["geometry", "rolling"],
    "multipliers": ["multipliers", "trajectory", "stability"],
    "numerics": ["rolling", "proof", "contact"],
    "proof": ["proof", "outcome", "contact"],
    "rolling": ["rolling", "integrator", "contact"],
    "scene": ["scene", "contact", "refusals"],
    "_ask": ["scene", "refusals", "border"],
    "_motion": ["trajectory", "contact", "border", "sensitivity"],
    "_command_line": ["project", "border", "trajectory"],
    "_verbs": ["trajectory", "outcome", "refusals", "proof", "rolling", "fit"],
    "batches": ["batches", "refusals"],
    "export": ["export", "refusals", "trajectory"],
    "films": ["fit"],
    "python": ["trajectory", "scene", "outcome", "refusals", "border", "batches"],
}

# Programs of tests/core that take only seconds.
PROGRAMS = ("core_test", "threads_test", "lanes_test", "golden")

# The tests must not import an editable installation instead of the copy.
NOT_EDITABLE = """\
import sys
sys.meta_path = [finder for finder in sys.meta_path if "ScikitBuild" not in type(finder).__name__]
"""

# Files without mutants: they are written by programs or only list names.
LEFT_OUT = ("gauss_legendre.hpp", "collocation.hpp", "_core.pyi")


@dataclass(frozen=True)
class Mutant:
    """A source line with one change."""

    path: str  # path of the source in the project
    line: int  # number of the line, from 1 on
    number: int  # number of this change among the changes of the line
    kind: str  # key of CHANGES
    was: str  # the old line without its indent
    now: str

    @property
    def name(self) -> str:
        return f"{self.path}:{self.line}:{self.number}"


def changes(line: str) -> Iterator[tuple[str, str]]:
    """All possible changes of a line, each with its kind and the new line."""
    code = re.split(r"//|  # ", line)[0]
    for kind, rules in CHANGES.items():
        for pattern, replacement in rules:
            for found in re.finditer(pattern, code):
                new = found.expand(replacement)
                yield kind, line[: found.start()] + new + line[found.end() :]


def mutants_of(path: Path) -> Iterator[Mutant]:
    is_core = path.suffix in (".cpp", ".hpp")
    passive = r"\s*(#|//|template|static_assert|using |\"|import |from |def |class |raise )"
    in_text = False
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
        if not is_core and line.count('"""') % 2:
            in_text = not in_text
            continue
        if in_text or re.match(passive, line) or '"' in line:
            continue
        for index, (kind, now) in enumerate(changes(line)):
            name = path.relative_to(ROOT).as_posix()
            yield Mutant(name, number, index, kind, line.strip(), now.strip())


def drawn(side: str, count: int, seed: int) -> list[Mutant]:
    """Mutants of all files in random order. The share of a file is proportional to the square root
    of the number of its mutants."""
    folder, suffixes = ("src", (".cpp", ".hpp")) if side == "core" else ("python", (".py",))
    random_ = random.Random(seed)
    order = []
    for path in sorted((ROOT / folder).rglob("*")):
        if path.suffix not in suffixes or path.name in LEFT_OUT:
            continue
        found = list(mutants_of(path))
        random_.shuffle(found)
        order += [((i + random_.random()) / len(found) ** 0.5, m) for i, m in enumerate(found)]
    return [m for _, m in sorted(order, key=lambda pair: (pair[0], pair[1].name))[:count]]


class Workshop:
    """A copy of the project in which the mutants are built and tested one by one."""

    def __init__(self, folder: Path, processes: int):
        self.took: dict[tuple[str, ...], float] = {}  # duration of tests that passed [s]
        self.printed: dict[str, bytes] = {}  # output of PROGRAMS for the unchanged sources
        self.spread = ["-n", str(processes), "--dist", "loadfile"] if processes > 1 else []
        self.copy = folder / "copy"
        self.objects = folder / "objects"
        self.site = folder / "site"
        skipped = shutil.ignore_patterns(".git", ".venv", "build", "__pycache__", ".*_cache")
        shutil.copytree(ROOT, self.copy, ignore=skipped, copy_function=renew, dirs_exist_ok=True)
        self.environment = {**os.environ, "PYTHONPATH": str(self.site), "CI": "true"}

    def configure(self) -> None:
        import pybind11

        eigen = subprocess.run(
            [sys.executable, "-m", "cmeel", "cmake"], check=True, capture_output=True, text=True
        ).stdout.strip()
        subprocess.run(
            ["cmake", "-S", self.copy, "-B", self.objects, "-G", "Ninja",
             "-DCMAKE_BUILD_TYPE=None", "-DCMAKE_CXX_FLAGS=-O1", "-DROLLING_ELLIPSE_TESTS=ON",
             f"-DPython_EXECUTABLE={sys.executable}",
             f"-Dpybind11_DIR={pybind11.get_cmake_dir()}",
             f"-DCMAKE_PREFIX_PATH={eigen}"],
            check=True, stdout=subprocess.DEVNULL,
        )  # fmt: skip

    def build(self) -> bool:
        done = subprocess.run(["cmake", "--build", self.objects], capture_output=True)
        if done.returncode:
            return False
        package = self.site / "rolling_ellipse"
        shutil.copytree(self.copy / "python" / "rolling_ellipse", package, dirs_exist_ok=True)
        for built in [*self.objects.glob("_core*.*"), *self.objects.glob("*.zip")]:
            shutil.copy2(built, package)
        (self.site / "sitecustomize.py").write_text(NOT_EDITABLE, encoding="utf-8")
        return True

    def require_tested(self) -> None:
        """Exit if the tests would not import the copy."""
        code = "import rolling_ellipse; print(rolling_ellipse.__file__)"
        command = [sys.executable, "-c", code]
        done = subprocess.run(command, env=self.environment, capture_output=True, text=True)
        if not done.stdout.startswith(str(self.site)):
            sys.exit(f"another installation is found first: {done.stdout}{done.stderr}")

    def failing(self, *arguments: str) -> str:
        """The first test that fails, or "one that takes too long" if the tests take more than 60 s
        plus five times the usual time; "" if they pass."""
        usual = 60.0 if arguments else 1500.0
        seconds = 60 + 5 * self.took.get(arguments, usual)
        begin = time.monotonic()
        command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider",
                   *self.spread, *arguments]  # fmt: skip
        try:
            done = subprocess.run(
                command, cwd=self.copy, env=self.environment, capture_output=True, text=True,
                timeout=seconds,
            )  # fmt: skip
        except subprocess.TimeoutExpired:
            return "one that takes too long"
        if done.returncode == 4 and "while loading conftest" not in done.stderr:
            sys.exit(done.stderr)
        if done.returncode not in (0, 5):  # pytest's exit code 5: no test was selected
            named = re.search(r"^(?:FAILED|ERROR) (\S+)", done.stdout, re.MULTILINE)
            return named[1] if named else f"exit code {done.returncode}"
        self.took[arguments] = time.monotonic() - begin
        return ""

    def failing_program(self) -> str:
        """The first of PROGRAMS that fails, hangs, or prints other bits than in the first call."""
        for name in PROGRAMS:
            if not (program := self.objects / name).exists():
                continue
            try:
                done = subprocess.run([program], capture_output=True, timeout=60)
            except subprocess.TimeoutExpired:
                return name
            if done.returncode or self.printed.setdefault(name, done.stdout) != done.stdout:
                return name
        return ""

    def judged(self, mutant: Mutant, thorough: bool) -> tuple[str, str]:
        """The stage that noticed a mutant, and the test that failed; or "build" if the mutant does
        not compile, or "alive" if no stage noticed it."""
        path = self.copy / mutant.path
        whole = path.read_text(encoding="utf-8")
        lines = whole.splitlines(keepends=True)
        old = lines[mutant.line - 1]
        assert old.strip() == mutant.was, f"{mutant.name}: the sources have changed since"
        lines[mutant.line - 1] = old.replace(mutant.was, mutant.now)
        path.write_text("".join(lines), encoding="utf-8")
        try:
            if not self.build():
                return "build", ""
            for stage, arguments in stages(mutant.path, thorough):
                programs = stage == "programs"
                if by := self.failing_program() if programs else self.failing(*arguments):
                    return stage, by
            return "alive", ""
        finally:
            path.write_text(whole, encoding="utf-8")


def renew(source: str, target: str) -> None:
    """Copy a file if it differs, so that a leftover mutant is undone and rebuilt."""
    if not (os.path.exists(target) and filecmp.cmp(source, target, shallow=False)):
        shutil.copyfile(source, target)


def nearest(path: str) -> list[str]:
    parts = Path(path).parts
    side, begin = ("core", 1) if parts[0] == "src" else ("python", 2)
    for folder in reversed(parts[begin:-1] or [Path(path).stem]):
        own = folder.removeprefix("_")
        if folder in NEAREST or (ROOT / "tests" / own).is_dir():
            return NEAREST.get(folder, [own])
    return NEAREST[side]


def stages(path: str, thorough: bool) -> Iterator[tuple[str, tuple[str, ...]]]:
    """The stages that test a mutant, each with its arguments for pytest."""
    for folder in nearest(path):
        yield folder, (f"tests/{folder}", "-m", "quick")
    if path.startswith("src"):
        yield "programs", ()
    for folder in nearest(path):
        yield folder, (f"tests/{folder}",)
    yield "quick", ("-m", "quick")
    if thorough:
        yield "all", ()


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("side", choices=["core", "python"])
    parser.add_argument("--folder", type=Path, required=True)
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", help="PATH:LINE:NUMBER, the name of a mutant")
    parser.add_argument("--thorough", action="store_true")
    parser.add_argument("--processes", type=int, default=1, help="processes that share the tests")
    parser.add_argument("--list", action="store_true", help="only draw and print")
    options = parser.parse_args()
    if options.only:
        path = ROOT / options.only.split(":")[0]
        todo = [mutant for mutant in mutants_of(path) if mutant.name == options.only]
    else:
        todo = drawn(options.side, options.count, options.seed)
    if options.list:
        for mutant in todo:
            print(f"{mutant.name} {mutant.kind}\n    {mutant.was}\n    {mutant.now}")
        return
    options.folder.mkdir(parents=True, exist_ok=True)
    results = options.folder / f"{options.side}.json"
    known = json.loads(results.read_text()) if results.exists() else {}
    workshop = Workshop(options.folder, options.processes)
    workshop.configure()
    if not workshop.build():
        sys.exit("the unchanged sources do not build")
    workshop.require_tested()
    if by := workshop.failing_program() or workshop.failing("-m", "quick"):
        sys.exit(f"{by} fails with the unchanged sources")
    for i, mutant in enumerate(todo):
        if mutant.name in known and not options.only:
            continue
        begin = time.monotonic()
        fate, by = workshop.judged(mutant, options.thorough)
        known[mutant.name] = {**asdict(mutant), "fate": fate, "by": by}
        results.write_text(json.dumps(known, indent=1))
        took = f"{time.monotonic() - begin:.0f} s"
        print(f"{i + 1}/{len(todo)} {mutant.name} {mutant.kind}: {fate}, {took} {by}", flush=True)
        if fate == "alive":
            print(f"    {mutant.was}\n    {mutant.now}", flush=True)
    fates = [fate for m in todo if (fate := known[m.name]["fate"]) != "build"]
    if not workshop.build():
        sys.exit("the unchanged sources do not build any more")
    for folder in sorted(set(fates) - {"programs", "quick", "all", "alive"}):
        if by := workshop.failing(f"tests/{folder}"):
            sys.exit(f"{by} fails with the unchanged sources")
    print(f"{sum(fate != 'alive' for fate in fates)} of {len(fates)} noticed")


if __name__ == "__main__":
    main()
