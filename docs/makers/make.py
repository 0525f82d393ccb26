"""Run all measurements, draw the pictures, and update the text: python docs/makers/make.py

Use a quiet machine with `pip install '.[test,peers,engines]'`, gfortran (for numbalsoda), g++ and
Boost's headers. A run takes about an hour; all results then come from one commit and one machine:

    races      docs/data/peers_*.json, by benchmarks/bench_peers.py
    batches    docs/data/batches.json, by benchmarks/bench_batches.py
    engines    docs/data/engines.json, by the adapters of rolling_ellipse.benchmark
    added      scores of problems that engines.json lacks; other scores are preserved
    pictures   docs/*.png and *.gif, by pictures.py; paper/*.png, by paper/figures.py
    gallery    docs/gallery/*.png, from the code in docs/gallery.md
    problems   docs/problems/* and the table in docs/benchmark.md, by problems.py
    notebooks  the outputs of all notebooks; 06 needs the races and the peers
    text       the marked parts of README, speed.md, many.md and benchmark.md, from those files
    dae        the tables of docs/benchmark_dae.md, by dae_table.py

Arguments select steps. --quick takes seconds instead of minutes and shows that everything works;
its figures must not be published.
"""

import argparse
import json
import os
import re
import shutil
import subprocess
import sys
import time
from collections.abc import Callable
from importlib import import_module
from importlib.metadata import version
from pathlib import Path
from tempfile import TemporaryDirectory
from textwrap import fill
from typing import Any

import nbformat
from nbclient import NotebookClient
from pages import table, with_part
from rolling_ellipse import Scene, WorkPrecision, benchmark, simulate
from rolling_ellipse._motion.export.strict import in_lines
from rolling_ellipse.benchmark.adapters import engine

HERE = Path(__file__).resolve().parent
DOCS = HERE.parent
DATA, ROOT = DOCS / "data", DOCS.parent
PAGES = ("README", *(f"docs/{name}" for name in ("index", "speed", "many", "benchmark")))
BENCHMARKS = ROOT / "benchmarks"
sys.path.insert(0, str(BENCHMARKS))
ENGINES = {"MuJoCo": "mujoco", "Drake": "drake", "pymunk": "pymunk"}  # and adapters
LADDER = [1e-2, 1e-3]  # steps of the engines [s]
SCORES = 4  # depth at which engines.json has one score per line
MOTIONS = {
    "R": "rolling over, {:g} half turns",
    "L": "rocking, {:g} half swings",
    "S": "down a slope of 0.1, {:g} half turns",
    "W": "rocking on a slope of 0.1, {:g} half swings",
}
STAMPS = {"commit": ", at commit", "peers": ", beside"}
COLUMNS = [10.0**-k for k in range(2, 15, 3)]
# Time [s] until the default ball of pooltool-billiards 0.3.3, started at 1 m/s without spin, rolls
POOLTOOL = 0.14562399883500798


def races(quick: bool) -> None:
    few = ["--rounds", "2", "--seconds", "5"] if quick else []
    run(BENCHMARKS / "bench_peers.py", "--save", DATA, *few)


def batches(quick: bool) -> None:
    run(BENCHMARKS / "bench_batches.py", "--save", DATA)


def engines(quick: bool) -> None:
    """Run the engines on the problems; a quick run uses only the coarser step."""
    import common

    found: dict[str, Any] = {"machine": common.machine(), "engines": {}}
    for name, adapter in ENGINES.items():
        module = import_module(f"rolling_ellipse.benchmark.adapters.{adapter}")
        begin = time.perf_counter()
        scores = benchmark.run(module.simulate, ladder=LADDER[: 1 if quick else None])
        found["engines"][name] = {
            **described(module, adapter),
            "seconds": round(time.perf_counter() - begin, 1),
            "verdict": scores.verdict(),
            "scores": scores.records(),
        }
    keep(found)
    text(quick)


def added(quick: bool) -> None:
    """Run the engines on problems without a score.

    For an engine that is not installed, only problems that it would refuse can be scored.
    """
    from pictures import restored

    path = DATA / "engines.json"
    found = json.loads(path.read_text(encoding="utf-8"))
    for name, known in found["engines"].items():
        there = {row["problem"] for row in known["scores"]}
        new = [one.id for one in benchmark.problems() if one.id not in there]
        try:
            module = import_module(f"rolling_ellipse.benchmark.adapters.{ENGINES[name]}")
            simulate, on = module.simulate, described(module, ENGINES[name])
        except ModuleNotFoundError:
            simulate, on = engine(refuses), {}
        if on and on["version"] != known["version"]:
            raise ValueError(f"{name} must be {known['version']} for one table, got {on}")
        begin = time.perf_counter()
        scores = benchmark.run(simulate, problems=new, ladder=LADDER)
        rows = [*known["scores"], *scores.records()]
        rows.sort(key=lambda row: str(row["problem"]))
        known |= on | {"verdict": restored(rows).verdict(), "scores": rows}
        known["seconds"] = round(known["seconds"] + time.perf_counter() - begin, 1)
    keep(found)
    text(quick)


def refuses(scene: Scene, step: float) -> Any:
    """Raise ValueError for a scene that SDF cannot express, as every adapter does."""
    scene.to_sdf()
    raise ModuleNotFoundError("the engine must be installed for a problem that it may support")


def described(module: Any, name: str) -> dict[str, str]:
    settings = " ".join(str(module.__doc__).partition("\n\n")[2].split())
    return {"version": version(name), "settings": settings}


def keep(found: dict[str, Any]) -> None:
    plain = json.dumps(found)  # contains NaN, which JSON lacks
    known = json.loads(plain, parse_constant=lambda name: None)
    (DATA / "engines.json").write_text(in_lines(known, SCORES), encoding="utf-8")


def pictures(quick: bool) -> None:
    run(HERE / "pictures.py")
    run(ROOT / "paper" / "figures.py")


def gallery(quick: bool) -> None:
    run(HERE / "gallery.py")


def problems(quick: bool) -> None:
    import problems

    problems.main()
    write_part(DOCS / "benchmark.md", "problems", problems.listed())


def run(*command: str | Path) -> None:
    subprocess.run([sys.executable, *map(str, command)], check=True)


def notebooks(quick: bool) -> None:
    """Run each notebook in a temporary folder, and store its outputs."""
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
        for cell in notebook.cells:  # keep the tags of cells that the site folds
            cell.metadata = {"tags": cell.metadata.tags} if "tags" in cell.metadata else {}
        nbformat.write(notebook, path)


def text(quick: bool) -> None:
    for path in (ROOT / f"{name}.md" for name in PAGES):
        path.write_text(quoted(path.read_text(encoding="utf-8")), encoding="utf-8")


def dae(quick: bool) -> None:
    import dae_table

    for made in (dae_table.ida, dae_table.radau, dae_table.reference):
        write_part(DOCS / "benchmark_dae.md", made.__name__, made())


STEPS: dict[str, Callable[[bool], None]] = {
    step.__name__: step
    for step in (races, batches, engines, added, pictures, gallery, problems, notebooks, text, dae)
}

# ------------------------------------------------------------------------------ marked parts


def quoted(page: str) -> str:
    """Return a page with its marked parts recomputed."""
    parts = {"speed": speed, "batches": throughput, "engines": engine_table, "others": others,
             "lead": lead}  # fmt: skip
    found = [name for name in parts if f"<!-- {name}: made by docs/makers/make.py -->\n" in page]
    if not found:
        raise ValueError(f"the page must have a mark of {', '.join(parts)}")
    for name in found:
        page = with_part(page, name, parts[name](), "make.py")
    return page


def write_part(path: Path, name: str, made: str) -> None:
    page = path.read_text(encoding="utf-8")
    path.write_text(with_part(page, name, made, "make.py"), encoding="utf-8")


def speed() -> str:
    """Return text about one race, and tables of all races, lost races and times of calls."""
    import bench_peers

    rows, behind = [], []
    for name, motion in MOTIONS.items():
        for path in sorted(DATA.glob(f"peers_{name}_*.json"), key=half_turns):
            race = WorkPrecision.load(path)
            cells = [bench_peers.factor(race, decade) for decade in COLUMNS]
            what = motion.format(half_turns(path))
            rows.append([what, *cells])
            said = [line for line in race.verdict().splitlines() if bench_peers.AHEAD in line]
            where, _, length = what.partition(", ")
            behind += [lost(line, f"{length} {where}", bench_peers.AHEAD) for line in said]
    drawn = WorkPrecision.load(DATA / "peers_R_10.37.json")
    head = ["best peer's time / package's best, error up to", *(f"{d:.0e}" for d in COLUMNS)]
    body = table(head, rows)
    if any("*" in cell for row in rows for cell in row):
        body += "\n\\* relative to the peers that were run; for the others no time was left\n"
    on = drawn.machine
    stamp = f"Least of {on['rounds']} rounds on {on['processor']}, {on['vectors']}, {on['date']}"
    beside = "".join(f"{word} {on[of]}" for of, word in STAMPS.items() if of in on)
    if behind:
        head = ["race", "peer", "errors", "times as fast as `flow`", "steps of the peer"]
        body += (
            "\nA peer is ahead in these races, because its few steps cost less than the initial "
            f"work of `flow`:\n\n{table(head, behind)}"
        )
    return f"{chart(drawn, bool(behind))}\n\n{body}{calls()}\n{stamp}{beside}.\n"


def chart(race: WorkPrecision, behind: bool) -> str:
    """Return sentences about the race in the chart, which `flow` must lead at every error."""
    (leader, errors), *others = race.unbeaten().items()
    assert leader == "flow" and not others
    least = min(race.least(error)[leader] for error in errors)
    short = (
        " In short races on slopes a peer can be faster: these cells are marked *behind*, and a "
        "second table gives the reason."
    )
    text = (
        "`flow` returns the exact state of a rolling body at any array of times, without steps. "
        "In the race of the chart, ten half turns of the 2:1 ellipse on level ground (to "
        f"t = {race.reference.t_end:.5g} s), no other method is as fast at any error from "
        f"{max(errors):.0e} to {min(errors):.0e}. A call takes {1e6 * least:.3g} µs for a known "
        "scene; the last table also has the time for a new one. Errors are measured against a "
        "quadrature in 40 digits."
    )
    return fill(text + short * behind, 130)


def lost(line: str, race: str, ahead: str) -> list[str]:
    """Return a table row from the line of a verdict about a peer that is ahead."""
    found = re.findall(r"([\d.]+) × at (\S+) \((\d+)", line)
    columns = zip(*found, strict=True)
    factors, errors, steps = (" to ".join(dict.fromkeys((each[0], each[-1]))) for each in columns)
    return [race, line.partition(ahead)[0], errors, factors, steps]


def calls() -> str:
    """Return a table of call times of the package and the fastest peers, or "" without a file."""
    path = DATA / "calls.json"
    if not path.exists():
        return ""
    known = json.loads(path.read_text(encoding="utf-8"))["R"]
    own = ("flow", "exact")
    peers = sorted(known.keys() - {*own}, key=lambda name: known[name][1])[:3]
    rows = [[name, *(f"{1e6 * each:.3g}" for each in known[name])] for name in (*own, *peers)]
    return "\n" + table(["a call [µs]", "empty", "a known scene", "a new scene"], rows)


def lead() -> str:
    """Return text for the first page with the ratio of the best peer's time to `flow`'s."""
    race = WorkPrecision.load(DATA / "peers_R_10.37.json")
    least = race.least(1e-8)
    peers = {run.name for run in race.runs if "peer" in run.tags}
    ratio = min(least[name] for name in peers & least.keys()) / least["flow"]
    return (
        f"**{ratio:.3g} × as fast** as the best of {len(peers)} other integrators: ten half turns, "
        "to within 1e-8. A million turns\ncost no more than one.\n"
    )


def others() -> str:
    """Return a table that compares other programs with the package, with a number for each."""
    race = WorkPrecision.load(DATA / "peers_R_10.37.json")
    least = race.least(1e-8)
    rows = []
    for name in ("SciPy", "heyoka"):
        best = min(time for contender, time in least.items() if contender.startswith(name))
        ratio = float(f"{best / least['flow']:.3g}")
        figure = f"ten half turns to within 1e-8 take {ratio:g} × the time"
        rows.append([name, "integrates; no contact", figure])
    for name in ("MuJoCo", "Drake"):
        scores = json.loads((DATA / "engines.json").read_text(encoding="utf-8"))["engines"][name]
        finest = min(score["setting"] for score in scores["scores"])
        passed = [score["passed"] for score in scores["scores"] if score["setting"] == finest]
        figure = f"passes {sum(passed)} of {len(passed)} known answers at steps of {finest:g} s"
        rows.append([name, "contact, in time steps", figure])
    mass, radius = 0.170097, 0.028575
    how = {"mass": mass, "inertia": 0.4 * mass * radius**2, "friction": 0.2}
    ball = Scene(radius, radius, x_dot=1.0, omega=0.0, **how)
    off = abs(simulate(ball, 1.0).events[0].t - POOLTOOL)
    figure = f"its ball slips for {POOLTOOL:.6f} s; a circle here agrees to within {off:.0e} s"
    rows.append(["pooltool", "circles (balls), exactly", figure])
    return table(("program", "what it does", "compared with this package"), rows)


def half_turns(path: Path) -> float:
    """Return the number of half turns in the name of a race's file."""
    return float(path.stem.rpartition("_")[2])


def throughput() -> str:
    """Return sentences with the costs of a large run, or "" if there are no measurements."""
    path = DATA / "batches.json"
    if not path.exists():
        return ""
    known = json.loads(path.read_text(encoding="utf-8"))
    exact, contact, pool = known["exact"], known["contact"], known["pool"]
    return (
        f"For planning (measured on {known['machine']['processor']}): with `out=`, an exact motion "
        f"with one sample takes\n{1e6 * exact['seconds']:.2g} µs on one core and "
        f"{exact['bytes']:.0f} bytes, and {exact['bytes a sample']:.0f} bytes for each further "
        f"sample. A motion with slips\nand jumps takes {1e3 * contact['seconds']:.2g} ms, "
        f"{contact['bytes']:.0f} bytes, and {contact['bytes a sample']:.0f} bytes for each further "
        f"sample. A pool of {pool['processes']} processes\n"
        f"wrote {round(pool['motions a second'], -3):,.0f} exact motions a second.\n"
    )


def engine_table() -> str:
    """Return a table of problems and steps, and the settings and verdicts of the engines."""
    known = json.loads((DATA / "engines.json").read_text(encoding="utf-8"))
    on, lines = known["machine"], []
    cells: dict[str, list[str]] = {}
    head, seconds = ["problem"], 0.0
    for name, found in known["engines"].items():
        lines.append(f"* **{name} {found['version']}.** {found['verdict']} {found['settings']}")
        steps = {score["setting"]: None for score in found["scores"]}
        head += [f"{name}, {step:g} s" for step in steps]
        seconds += found["seconds"]
        for score in found["scores"]:
            cells.setdefault(score["problem"], []).append(engine_cell(score))
    rows = [[f"`{problem}`", *row] for problem, row in cells.items()]
    stamp = (
        f"All runs together took {seconds:.0f} s on {on['processor']}, {on['date']}. "
        "[`engines.json`](data/engines.json) has every score."
    )
    return "\n".join([table(head, rows), *lines, "", stamp]) + "\n"


def engine_cell(score: dict[str, Any]) -> str:
    """Return the error over the condition number (bold if passed), any wrong answer, or a dash."""
    if score["over_condition"] is None:
        return "–"
    error = f"{score['over_condition']:.0e}"
    if score["answer"] != "right":
        return f"{error}, {score['answer']}"
    return f"**{error}**" if score["passed"] else error


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
