"""Objects of the package survive pickles, copies and pools of processes unchanged."""

import copy
import dataclasses
import inspect
import math
import os
import pickle
import subprocess
import sys
from collections.abc import Callable
from functools import cache, partial
from io import StringIO
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
import rolling_ellipse as rl
from matplotlib import pyplot
from oracles.paths import TESTS
from oracles.pickles import COPIES, core_objects, fitted, require_same
from oracles.programs import printed
from oracles.trajectory import MOTIONS, TIMES
from rolling_ellipse import _core, simulate
from rolling_ellipse._ask.settings import Settings


def printed_motion() -> Any:
    q, q_dot = rl.kinematics(0.3, 2.0, a=2.0, b=1.0)
    how: dict[str, Any] = {"equations": "printed", "consistent": "project"}
    return rl.report.simulate(q, q_dot, TIMES / 4, a=2.0, b=1.0, **how)


def integration_error() -> rl.IntegrationError:
    with pytest.raises(rl.IntegrationError) as caught:
        simulate(rl.scenes.bounce, TIMES, max_events=1)
    caught.value.add_note("while a million were simulated")
    return caught.value


@cache
def raced() -> rl.WorkPrecision:
    return rl.work_precision(rl.scenes.rolling, 1.0, methods=["flow"], rounds=2)


OBJECTS: dict[str, Callable[[], Any]] = {
    **MOTIONS,
    "scene": lambda: rl.scenes.report,
    "scene of its own": lambda: rl.Scene(0.7, 1.9, z=3.0, x_dot=1.0, friction=0.3, slope=0.1),
    "impulse": lambda: rl.Impulse(jx=1.0, jz=-2.0, dx=0.1),
    "impulses": lambda: rl.Impulse(jx=[1.0, 2.0], jz=-2.0, dx=[[0.1], [0.2]]),
    "initial state": lambda: rl.scenes.jump.initial_state,
    "event": lambda: MOTIONS["contact"]().events[0],
    "certificate": lambda: rl.certify(rl.scenes.report),
    "thresholds": lambda: rl.thresholds(2.0, 1.0),
    "settings": lambda: MOTIONS["gauss"]().settings,
    "arrays": lambda: rl.simulate_many([rl.scenes.report], TIMES, returns="x"),
    "event table": lambda: MOTIONS["contact"]().events.table,
    "event arrays": lambda: rl.simulate_many([rl.scenes.jump], 1.0, returns="events"),
    "ends": lambda: rl.ends([rl.scenes.report], 1.0),
    "sample": lambda: MOTIONS["contact"]().at(0.3),
    "constraints": lambda: MOTIONS["rolling"]().constraint_residuals(),
    "integration error": integration_error,
    **{kind.__name__: partial(kind, "why") for kind in (
        rl.ValidityWarning, rl.CompletenessWarning, rl.ExtrapolationWarning, rl.StabilityWarning,
        rl.WorkerError, rl.report.InconsistentStartWarning)},
    "work-precision": raced,
    "printed motion": printed_motion,
    "start": lambda: printed_motion().start,
    "errata": rl.report.errata,
    "comparison": lambda: rl.report.errata()[0].evaluate(),
    "fitted impacts": fitted,
    "sensitivity": lambda: MOTIONS["rolling"]().sensitivity("omega"),
    "course": lambda: (
        rl.course.tasks()[-1], rl.course.mark("1.1", 0.2), rl.course.sheet(1),
        rl.course.mark_table(StringIO("student,seed,task,answer\nAda,7,1.1,0.2")),
    ),
    "growth": lambda: MOTIONS["rolling"]().growth("omega"),
    "fit": lambda: rl.fit_motion(
        TIMES, rl.simulate(rl.scenes.rolling, TIMES).x, scene=rl.scenes.rolling, free="omega"
    ),
    "explorer": lambda: rl.explore(rl.scenes.report),
    "codes": lambda: (rl.Mode.SLIDING, rl.EventKind.JAM, rl.Outcome.EDGE, rl.Status.JAMMED,
                      rl.Validity.EDGE),
}  # fmt: skip


def test_the_comparison_detects_a_changed_bit_or_flag() -> None:
    for change in (np.array([1.0, 2.0]), np.array([1.0, math.nextafter(2, 3)])):
        change.flags.writeable = change[1] == 2.0
        fixed = np.array([1.0, 2.0])
        fixed.flags.writeable = False
        with pytest.raises(AssertionError):
            require_same([fixed], [change])


def public_classes(*modules: ModuleType) -> set[type]:
    found = [getattr(module, name) for module in modules for name in module.__all__]
    return {thing for thing in found if inspect.isclass(thing)}


def parts(thing: Any) -> set[type]:
    inner = set().union(*(parts(part) for part in thing)) if isinstance(thing, tuple) else set()
    return {type(thing)} | inner


def test_every_public_class_is_tested() -> None:
    here = set().union(*(parts(make()) for make in OBJECTS.values()))
    assert not public_classes(rl, rl.report, rl.impacts, rl.course) - here
    assert Settings in here


@pytest.mark.parametrize("copied", COPIES.values(), ids=COPIES)
@pytest.mark.parametrize("make", OBJECTS.values(), ids=OBJECTS)
def test_an_object_survives_every_kind_of_copy_unchanged(
    make: Callable[[], Any], copied: Callable[[Any], Any]
) -> None:
    require_same(make(), copied(make()))


def test_cached_values_do_not_enlarge_a_pickle() -> None:
    motion = MOTIONS["contact"]()
    size = len(pickle.dumps(motion))
    for name in ("q", "energy", "r_ddot", "contact_x", "events"):
        getattr(motion, name)
    assert len(pickle.dumps(motion)) == size < 9 * 8 * TIMES.size + 4000
    assert copy.copy(motion).q is motion.q  # a shallow copy recomputes nothing
    assert copy.copy(motion)._solution is motion._solution


POOLS = """
import multiprocessing, pickle, sys
import rolling_ellipse as rl

if __name__ == "__main__":
    jobs, path = pickle.loads(sys.stdin.buffer.read())
    with multiprocessing.get_context(sys.argv[1]).Pool(2) as pool:
        found = pool.starmap(rl.simulate, jobs)
        try:
            pool.apply(rl.simulate, jobs[-1], {"max_events": 1})
        except rl.IntegrationError as error:
            found.append(error.trajectory)
    with open(path, "wb") as file:
        pickle.dump(found, file)
"""


@pytest.mark.parametrize("how", ["fork", "spawn", "forkserver"])
def test_process_pools_return_motions_unchanged(how: str, tmp_path: Path) -> None:
    program, path = tmp_path / "pools.py", tmp_path / "found"
    program.write_text(POOLS)
    scenes = (rl.scenes.report, rl.scenes.rocking, rl.scenes.bounce)
    jobs: list[Any] = list(zip(scenes, (TIMES, 1.0, TIMES), strict=True))
    given = pickle.dumps((jobs, os.fspath(path)))
    subprocess.run([sys.executable, program, how], input=given, timeout=120, check=True)
    expected = [*(simulate(*job) for job in jobs), MOTIONS["stopped"]()]
    returned = pickle.loads(path.read_bytes())
    for one, other in zip(expected, returned, strict=True):
        require_same(one.sol(0.01), other.sol(0.01))
        changed = {"settings": other.settings, "message": other.message}
        require_same(dataclasses.replace(one, **changed), other)


PICTURES = (
    rl.plot, rl.plot_strobe, rl.plot_phase, rl.plot_energy, rl.plot_constraints, rl.plot_curves,
    rl.plot_forces, rl.plot_paths, rl.plot_error,
)  # fmt: skip


def lines_of(picture: Any) -> list[Any]:
    return [each for each in vars(picture).values() if hasattr(each, "get_xydata")]


@pytest.mark.parametrize("draw", PICTURES, ids=lambda draw: draw.__name__)
def test_pickled_or_copied_pictures_keep_their_curves(draw: Callable[..., Any]) -> None:
    picture = draw(MOTIONS["contact"]())
    pyplot.close("all")
    for copied in (COPIES["protocol 0"], COPIES["protocol 5"], copy.copy):
        again = copied(picture)
        assert type(again) is type(picture)
        for line, same in zip(*map(lines_of, (picture, again)), strict=True):
            assert np.array_equal(line.get_xydata(), same.get_xydata(), equal_nan=True)


def test_all_classes_of_the_core_are_tested() -> None:
    bound = {name for name, kind in vars(_core).items() if type(kind).__name__ == "pybind11_type"}
    assert bound == set(core_objects())


CORE = """
import copy, pickle, sys
sys.path.insert(0, sys.argv[1])
from oracles.pickles import COPIES, core_objects

for thing in core_objects().values():
    for copied in COPIES.values():
        try:
            copied(thing)
        except TypeError as error:
            print(error)
"""


def test_objects_of_the_core_cannot_be_pickled_or_copied() -> None:
    """The attempts run in a separate process, which a pickled object of the core might crash."""
    refusals = [f"_core.{name} cannot be pickled or copied" for name in core_objects()]
    assert printed(CORE, TESTS).splitlines() == [text for text in refusals for _ in COPIES]
