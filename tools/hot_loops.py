"""Count the instructions of five standard jobs, and compare them with the counts on record.

    cmake --preset release && cmake --build --preset release
    python tools/hot_loops.py build/release/hot_jobs             (exit code 1: a count grew by 5 %)
    python tools/hot_loops.py build/release/hot_jobs --write     (writes the record)

Unlike times, instructions do not depend on the load of the machine. Valgrind counts them. It has no
AVX-512, so the program uses AVX2. The counts belong to the compiler and the C library that the
record names; counts of others are not judged.
"""

import argparse
import json
import platform
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

RECORD = Path(__file__).resolve().parents[1] / "benchmarks" / "hot_loops.json"
JOBS = (
    "exact flow, one state",
    "exact flow, a table and 1000 samples",
    "contact, ten events",
    "dop853, ten half turns",
    "multipliers, 100 steps of rk4",
)
SLACK = 0.05


def instructions(program: Path, job: int) -> tuple[int, str]:
    """Number of instructions of a job, and the vector level of the program."""
    with tempfile.TemporaryDirectory() as folder:
        command = [
            "valgrind", "--tool=callgrind", "--collect-atstart=no", "--toggle-collect=counted(*",
            f"--callgrind-out-file={folder}/counts", str(program), str(job),
        ]  # fmt: skip
        done = subprocess.run(command, capture_output=True, text=True)
    found = re.search(r"Collected : (\d+)", done.stderr)
    if done.returncode != 0 or found is None or found[1] == "0":
        sys.exit(f"{' '.join(command)}\n{done.stderr}")
    return int(found[1]), done.stdout.strip()


def made_by(program: Path, level: str) -> dict[str, str]:
    """The compiler, the C library, the machine and the vector level of a program."""
    compilers = set(re.findall(rb"(?:GCC: |clang version )[^\0\n]{3,60}", program.read_bytes()))
    return {
        "compiler": ", ".join(sorted(each.decode("ascii", "replace") for each in compilers)),
        "C library": " ".join(platform.libc_ver()),
        "machine": platform.machine(),
        "vectors": level,
    }


def main() -> int:
    parser = argparse.ArgumentParser(description=str(__doc__).partition("\n")[0])
    parser.add_argument("program", type=Path)
    parser.add_argument("--write", action="store_true", help="make the counts the record")
    options = parser.parse_args()
    if shutil.which("valgrind") is None:
        sys.exit("valgrind must be installed")
    counts = [instructions(options.program, job) for job in range(len(JOBS))]
    found = {name: count for name, (count, _) in zip(JOBS, counts, strict=True)}
    by = made_by(options.program, counts[0][1])
    if options.write:
        record = {"made by": by, "instructions": found}
        RECORD.write_text(json.dumps(record, indent=2) + "\n", encoding="utf-8")
    record = json.loads(RECORD.read_text(encoding="utf-8"))
    print(f"{'instructions':40} {'now':>12} {'on record':>12}  ratio")
    worst = 0.0
    for name, count in found.items():
        before = record["instructions"][name]
        worst = max(worst, count / before)
        print(f"{name:40} {count:12d} {before:12d} {count / before:6.3f}")
    if record["made by"] != by:
        print(f"not judged: this is {by}, the record {record['made by']}")
        return 0
    return 1 if worst > 1 + SLACK else 0


if __name__ == "__main__":
    sys.exit(main())
