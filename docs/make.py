"""Make all measurements, pictures and the text that quotes them: python docs/make.py

On a quiet machine, with `pip install '.[test,peers]'`, gfortran (for numbalsoda), g++ and Boost's
headers; it takes about an hour, and everything is then of one commit and one machine:

    races      docs/peers_*.json, by benchmarks/bench_peers.py
    batches    docs/batches.json, by benchmarks/bench_batches.py
    pictures   docs/*.png and *.gif, by docs/make_pictures.py
    notebooks  the outputs of all notebooks, 06 with the races and beside the peers
    text       the marked parts of README.md, from the files of the first two

Named steps are made alone. --quick takes seconds instead of minutes and shows that everything
works; its figures are not for keeping.
"""

import argparse
import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory

import nbformat
from nbclient import NotebookClient
from rolling_ellipse import WorkPrecision

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent
README = ROOT / "README.md"
BENCHMARKS = ROOT / "benchmarks"
sys.path.insert(0, str(BENCHMARKS))
MOTIONS = {"R": "rolling over, {:g} half turns", "L": "rocking, {:g} half swings"}
STAMPS = {"commit": ", at commit", "peers": ", beside"}
COLUMNS = [10.0**-k for k in range(2, 15, 3)]


def races(quick: bool) -> None:
    few = ["--rounds", "2", "--seconds", "5"] if quick else []
    run(BENCHMARKS / "bench_peers.py", "--save", HERE, *few)


def batches(quick: bool) -> None:
    run(BENCHMARKS / "bench_batches.py", "--save", HERE)


def pictures(quick: bool) -> None:
    run(HERE / "make_pictures.py")


def run(*command: str | Path) -> None:
    subprocess.run([sys.executable, *map(str, command)], check=True)


def notebooks(quick: bool) -> None:
    """Run each notebook in a temporary folder, and keep its outputs."""
    os.environ["ROLLING_ELLIPSE_PEERS"] = str(BENCHMARKS)
    os.environ["ROLLING_ELLIPSE_SECONDS"] = "2" if quick else "60"
    for path in sorted((ROOT / "notebooks").glob("*.ipynb")):
        print(path.name, flush=True)
        notebook = nbformat.read(path, 4)
        metadata = notebook.metadata.copy()
        with TemporaryDirectory() as folder:
            for module in path.parent.glob("*.py"):  # notebooks import modules from their folder
                shutil.copy(module, folder)
            resources = {"metadata": {"path": folder}}
            NotebookClient(notebook, None, resources=resources, timeout=None).execute()
        notebook.metadata = metadata
        for cell in notebook.cells:
            cell.metadata = {}
        nbformat.write(notebook, path)


def text(quick: bool) -> None:
    README.write_text(quoted(README.read_text(encoding="utf-8")), encoding="utf-8")


STEPS: dict[str, Callable[[bool], None]] = {
    step.__name__: step for step in (races, batches, pictures, notebooks, text)
}

# ------------------------------------------------------------------------------ marked parts


def quoted(page: str) -> str:
    """A page with its marked parts made anew."""
    for name, part in (("speed", speed()), ("batches", throughput())):
        begin, end = f"<!-- {name}: made by docs/make.py -->\n", f"<!-- end of {name} -->\n"
        before, _, rest = page.partition(begin)
        _, found, after = rest.partition(end)
        if not found:
            raise ValueError(f"the page must have {begin!r} and {end!r}")
        page = before + begin + part + end + after
    return page


def speed() -> str:
    """Text and table of the races: the leaders of one race, and the peers' ratios in all races."""
    import bench_peers

    rows = []
    for name, motion in MOTIONS.items():
        for path in sorted(HERE.glob(f"peers_{name}_*.json"), key=half_turns):
            race = WorkPrecision.load(path)
            cells = [bench_peers.factor(race, decade) for decade in COLUMNS]
            rows.append([f"{motion.format(half_turns(path))}", *cells])
    drawn = WorkPrecision.load(HERE / "peers_R_10.37.json")
    head = ["best peer's time / package's best, error up to", *(f"{d:.0e}" for d in COLUMNS)]
    lines = [f"| {' | '.join(row)} |" for row in (head, ["---"] * len(head), *rows)]
    if any("*" in line for line in lines[2:]):
        lines.append("\n\\* of those that were run")
    on = drawn.machine
    stamp = f"Least of {on['rounds']} rounds on {on['processor']}, {on['vectors']}, {on['date']}"
    beside = "".join(f"{word} {on[of]}" for of, word in STAMPS.items() if of in on)
    told = [line for line in drawn.verdict().splitlines() if line[0] != " "]
    verdict = "\n".join(f"* {line}" for line in told[1:])
    table = "\n".join(lines)
    return f"{told[0]}\n\n{verdict}\n\n{table}\n\n{stamp}{beside}.\n"


def half_turns(path: Path) -> float:
    """Number of half turns in the name of a race's file."""
    return float(path.stem.rpartition("_")[2])


def throughput() -> str:
    """Sentences with the figures for planning a large run, if they were measured."""
    path = HERE / "batches.json"
    if not path.exists():
        return ""
    known = json.loads(path.read_text(encoding="utf-8"))
    exact, contact, pool = known["exact"], known["contact"], known["pool"]
    return (
        f"To plan by, as measured on {known['machine']['processor']}: with `out=` an exact motion "
        f"with one sample takes\n{1e6 * exact['seconds']:.2g} µs of one core and "
        f"{exact['bytes']:.0f} bytes, and {exact['bytes a sample']:.0f} for each further sample; "
        f"one with slips and jumps\n{1e3 * contact['seconds']:.2g} ms, {contact['bytes']:.0f} "
        f"bytes, and {contact['bytes a sample']:.0f}. A pool of {pool['processes']} processes "
        f"wrote {round(pool['motions a second'], -3):,.0f} exact motions a second.\n"
    )


def main() -> None:
    options = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    options.add_argument("steps", nargs="*", metavar="step", help=", ".join(STEPS))
    options.add_argument("--quick", action="store_true", help="figures that are not for keeping")
    chosen = options.parse_args()
    unknown = set(chosen.steps) - set(STEPS)
    if unknown:
        options.error(f"steps must be among {', '.join(STEPS)}, got {', '.join(sorted(unknown))}")
    for name, step in STEPS.items():
        if not chosen.steps or name in chosen.steps:
            print(f"--- {name}", flush=True)
            step(chosen.quick)


if __name__ == "__main__":
    main()
