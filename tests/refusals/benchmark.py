"""Refusals of `benchmark`: unknown names, and malformed results."""

import os
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rolling_ellipse import Scene, benchmark
from rolling_ellipse._command_line import act, benchmark_parser
from rolling_ellipse.benchmark.adapters import engine

from refusals import Row, wrong

STICK = benchmark.problem("slide.stick")
T = STICK.output_times
STATES = STICK.exact(T)


def exact(one: Any, t: Any, setting: Any) -> Any:
    return one.exact(t)


def broken(one: Any, t: Any, setting: Any) -> Any:
    return 1 / 0


def forgets(one: Any, t: Any, setting: Any) -> None:
    """Return nothing."""


def scored(states: Any, **others: Any) -> Callable[[Path], Any]:
    return lambda _: benchmark.score({STICK.id: benchmark.Result(states, **others)})


HEAD = "t,x,z,theta,vx,vz,omega\n"


def written(
    text: str | bytes, events: str = "", name: str = "slide.stick.csv"
) -> Callable[[Path], Any]:
    """Score a file of states, and a file of events if `events` is not empty."""

    def call(folder: Path) -> Any:
        (folder / name).write_bytes(text if isinstance(text, bytes) else text.encode())
        if events:
            (folder / "slide.stick.events.csv").write_text(events)
        return benchmark.score(folder)

    return call


def scored_pipe(folder: Path) -> Any:
    """Score a pipe without a writer, for which a reader would wait forever."""
    os.mkfifo(folder / "slide.stick.csv")
    return benchmark.score(folder)


def folder_called(name: str) -> Callable[[Path], Any]:
    """Score a result beside a folder with the name of a table."""

    def call(folder: Path) -> Any:
        (folder / name).mkdir()
        return written(HEAD + "0,0,1,0,3,0,0\n")(folder)

    return call


def taken(folder: Path) -> Any:
    (folder / "README.txt").write_text("mine")
    return benchmark.export(folder)


def told(*arguments: str) -> Callable[[Path], Any]:
    return lambda _: act(benchmark_parser().parse_args(list(arguments)))


def module_that_fails(folder: Path) -> Any:
    (folder / "module_that_fails.py").write_text("1 / 0\n")
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(folder)
        return told("run", "module_that_fails:f")(folder)


def without_mujoco(folder: Path) -> Any:
    with pytest.MonkeyPatch.context() as patch:
        patch.delitem(sys.modules, "rolling_ellipse.benchmark.adapters.mujoco", raising=False)
        patch.setitem(sys.modules, "mujoco", None)
        return told("run", "mujoco")(folder)


def _rows() -> Iterator[Row]:
    yield from wrong(benchmark.problem, {}, id=["slide", 3])
    yield from wrong(benchmark.problems, {}, tags=[["gpu"]])
    yield from wrong(benchmark.run, {"mine": exact}, tolerance=[0.0, np.nan], tags=[["gpu"], "gpu"])
    yield from wrong(benchmark.run, {"mine": exact}, problems=["slide", ["roll.rock", "jam"], 3])
    yield from wrong(benchmark.run, {}, mine=[3, lambda one, t: t, sorted])
    yield from wrong(benchmark.run, {"mine": exact}, ladder=["ab", 0.1, [0.1, -0.1], [np.inf]])
    yield from wrong(benchmark.score, {}, results=["no/such/folder", {"jam": STATES}])
    yield from wrong(benchmark.score, {"results": {}}, problems=["slide"], tags=["gpu"])
    yield from wrong(benchmark.run(exact, problems=STICK).order, {}, problem=["slide"])
    yield "results", written("", name="roll.rok.csv")
    yield "results", written("", name="roll.rock.CSV")
    yield "results", written("", name="roll.rock.events.csv")
    yield "results", written(HEAD.encode("utf-16"))
    yield "results", written(HEAD.encode() + b"0,0,1,0,3,0,0\n\x81")  # neither UTF-8 nor cp1252
    yield "results", written(HEAD + "0,0,1,0,3,0,0,5\n")
    yield "results", written(HEAD + '0,0,1,0,3,0,"0\n')
    yield "results", written(HEAD + "0,0,1,0,3,0,0\n", "kind,t\nSTICK,1,4\n")
    yield "results", written("x" * 200_000)
    yield "results", scored_pipe
    yield "folder", taken
    yield TypeError, lambda _: benchmark.score(3)
    yield "scores", lambda _: benchmark.Scores().plot()
    yield from wrong(benchmark.run(exact, problems=[STICK]).plot, {}, path=[""], figsize=[3])
    yield from wrong(benchmark.gradients()[0].error, {}, value=[1.0, [1.0, 2.0]])
    yield "problem", lambda _: benchmark.problem("jam").ode()
    slips = ["slide.slope", "slide.stick", "leave.slip_then_lift", "hit.drop_stick", "jam"]
    yield from wrong(lambda problem: benchmark.problem(problem).dae("ggl"), {}, problem=slips)
    yield from wrong(benchmark.problem("roll.roll").dae, {}, index=[0, "ida"])
    yield "rolling_resistance", lambda _: benchmark.problem("roll.resist").ode()
    yield "rolling_resistance", lambda _: benchmark.problem("slide.resist").ode()
    yield "rolling_resistance", lambda _: benchmark.problem("roll.resist").dae()
    yield "states", scored(STATES[:, :5])
    yield TypeError, scored("x")
    yield "t", scored(STATES, t=T[1:])
    yield "t", scored(STATES, t=T[::-1])
    yield "t", scored(STATES, t=np.where(T == 1.0, np.nan, T))
    yield "states", scored([*STATES, STATES[0]])
    yield "states", scored(STATES.T)
    yield "events", scored(STATES, events=[("HOP", 1.0)])
    yield "events", scored(STATES, events=[("STICK", 1.0, 2.0)])
    yield "events", scored(STATES, events=["STICK"])
    yield TypeError, scored(STATES, events=3)
    yield TypeError, scored(STATES, events=[("STICK", "soon")])
    for bad in (np.nan, np.inf, -np.inf):
        yield "t", scored(STATES, events=[("STICK", bad)])
    yield "normal_force", scored(STATES, normal_force=T[1:])
    yield TypeError, scored(STATES, friction_force="x")
    yield "z", written("t,x\n0,0\n")
    for word in ("fast", "1_0"):
        yield "x_dot", written(HEAD + f"0,0,1,0,{word},0,0\n")
    for name in ("hit.bounce.csv", "slide.stick.events.csv"):
        yield "results", folder_called(name)
    yield "z", written(HEAD + "0,0,1,0,3,0,0\n0.01,0.03\n")
    yield "t", written(HEAD + "nan,0,1,0,3,0,0\n")
    for events in ("STICK,soon", "STICK,nan", "STICK,", "STICK"):
        yield "t", written(HEAD + "0,0,1,0,3,0,0\n", f"kind,t\n{events}\n")
    yield "kind", written(HEAD + "0,0,1,0,3,0,0\n", "kind,t\nHOP,1\n")
    yield "kind", written(HEAD + "0,0,1,0,3,0,0\n", "STICK,1.4\n")
    yield "run", told("run", "exact")
    yield "run", told("run", "json:nothing")
    yield "run", told("run", "../x:f")
    yield "run", told("run", "json:dumps")
    yield RuntimeError, told("run", f"{__name__}:broken")
    yield RuntimeError, module_that_fails
    yield "states", told("run", f"{__name__}:forgets")
    yield ImportError, without_mujoco
    simulate = engine(lambda scene, step: scene.to_sdf())
    yield from wrong(simulate, {"problem": STICK, "times": T}, setting=[0.0, 0.003])
    yield NotImplementedError, lambda _: simulate(Scene(2.0, 1.0), T)


REFUSALS: list[Row] = list(_rows())
