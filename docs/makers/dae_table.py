"""Compute the tables of benchmark_dae.md: runs of IDA and solve_dae, and the reference states.

make.py adds the folder of `common` to the path.
"""

import re
import time
from importlib.metadata import version
from pathlib import Path

import common
import numpy as np
import sksundae
from pages import table
from rolling_ellipse import benchmark

PAGE = Path(__file__).parents[1] / "benchmark_dae.md"
NAMES = [
    "rest.lie", "roll.circle", "roll.rock", "roll.roll", "roll.thin", "brink.back", "brink.over"
]  # fmt: skip
Q, Q_V, ALL = "q", "q, v", "all"
RUNS = [  # form, tolerance, entries whose local errors are tested
    ("index1", 2e-15, Q_V), ("ggl", 3e-14, Q_V), ("index2", 3e-14, Q_V), ("index3", 3e-14, Q_V),
    ("index3", 1e-8, Q), ("ggl", 3e-14, ALL), ("index2", 3e-14, ALL),
]  # fmt: skip


def scored(problem: benchmark.Problem) -> np.ndarray:
    """Return the tabulated times at which states are scored, without the start."""
    times = problem.times[problem.times > 0]
    return times[(times < problem.horizon) | (problem.horizon == problem.t_end)]


def tested(dae: benchmark.Dae, which: str) -> np.ndarray:
    """Return a mask of the entries whose local errors the solver tests."""
    if which == Q_V:
        return ~dae.algebraic
    return np.arange(len(dae.names)) < (5 if which == Q else len(dae.names))


def solver(library: str):
    """Return the function `solve` that the page shows for a library."""
    programs = re.findall(r"```python\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.S)
    names: dict = {}
    exec(next(each for each in programs if f"from {library}" in each), names)
    return names["solve"]


def outcome(problem: benchmark.Problem, dae: benchmark.Dae, found, states) -> tuple[str, str]:
    """Return the largest error, or "" if the run failed, and how the run ended."""
    if not found.success:
        reached = max(found.t, default=0.0)  # the last requested time reached
        return "", f"t = {reached:.2g} s: {found.message}"
    off = np.abs(dae.states(states) - problem.exact(found.t)) / problem.scales
    return f"{off.max():.1e}", "done"


def ida() -> str:
    """Run IDA on all problems, and return the table of results."""
    head = ("problem", "form", "tolerance", "in the test", "error", "F", "J", "s", "outcome")
    rows = []
    solve = solver("sksundae")
    for name in NAMES:
        problem = benchmark.problem(name)
        times = np.append(0.0, scored(problem))
        for form, rtol, which in RUNS:
            dae = problem.dae(form)
            begun = time.perf_counter()
            found = solve(dae, times, rtol, tested(dae, which))
            seconds = time.perf_counter() - begun
            error, said = outcome(problem, dae, found, found.y)
            row = name, form, rtol, which, error, found.nfev, found.njev, f"{seconds:.2g}", said
            rows.append(row)
            print(*row, flush=True)
    on = common.machine()
    versions = f"scikit-sundae {sksundae.__version__}, SUNDIALS {sksundae.SUNDIALS_VERSION}"
    return table(head, rows) + f"\n{versions}, on {on['processor']}, {on['date']}.\n"


def radau() -> str:
    """Run solve_dae on three problems, and return the table of results."""
    rows = []
    solve = solver("solve_dae")
    for name in ("roll.circle", "roll.roll", "brink.over"):
        problem = benchmark.problem(name)
        times = np.append(0.0, scored(problem))
        for form in ("index1", "ggl", "index2", "index3"):
            dae = problem.dae(form)
            found = solve(dae, times[times <= 5], 1e-8)
            error, said = outcome(problem, dae, found, np.transpose(found.y))
            row = name, form, error, found.nfev, found.njev, found.nlu, said
            rows.append(row)
            print(*row, flush=True)
    head = ("problem", "form", "error", "F", "J", "LU", "outcome")
    return table(head, rows) + f"\nsolve_dae {version('solve_dae')}.\n"


def reference() -> str:
    """Return the table of the states at the last scored time."""
    rows = []
    for name in NAMES:
        problem = benchmark.problem(name)
        at = np.flatnonzero(problem.times == scored(problem)[-1])[0]
        state = dict(zip(("x", "z", "θ", "ẋ", "ż", "ω"), problem.states[at], strict=True))
        psi, r = problem.dae(3).exact(problem.times[at])[3:5]
        forces = {"λ1": problem.friction_force[at], "λ2": problem.normal_force[at]}
        row = {"problem": name, "t": problem.times[at], **state, "ψ": psi, "r": r, **forces}
        rows.append([f"{one:.16g}" if isinstance(one, float) else one for one in row.values()])
    return table(list(row), rows)
