"""Several Python threads get the same bits as a single thread, even from shared objects."""

import pickle
import random
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from operator import attrgetter
from threading import Event
from typing import Any

import numpy as np
import pytest
import rolling_ellipse as rl
from oracles.pickles import require_same
from oracles.threads import at_once
from rolling_ellipse import Scene, _core, scenes, simulate
from rolling_ellipse._ask.records import cached_property
from rolling_ellipse._motion import trajectory as trajectories

THREADS, CALLS_EACH = 8, 1000
PLACES = 5  # different calls of each kind, so that threads do different work at the same time
BODY = {"a": 2.0, "b": 1.0}
TIMES = np.linspace(0.0, 1.0, 20)
ROLLED = simulate(scenes.rolling, 4.0)
TOUCHED = simulate(scenes.drop, 2.0)
STEPPED = simulate(scenes.rocking, 1.0, model="multipliers", rtol=1e-6)
DOWNHILL = simulate(scenes.slope, 2.0)


def rolling(i: int) -> Scene:
    return scenes.rolling.replace(omega=1.0 + 0.6 * i)


def solved(i: int, **settings: Any) -> rl.Trajectory:
    return simulate(rolling(i), TIMES, **settings)


def all_of(motion: rl.Trajectory) -> list[Any]:
    names = ("x", "z", "psi", "r", "omega_dot", "normal_force", "energy", "multipliers", "turns",
             "friction_needed", "mode", "contact_x", "x_ddot", "events")  # fmt: skip
    return [getattr(motion, name) for name in names]


# Calls by kind: pure functions of an integer from 0 to PLACES - 1.
KINDS: dict[str, Callable[[int], Any]] = {
    "flow": lambda i: rl.flow(0.3 * i, **BODY, theta=0.1, omega=3.2),
    "flow, times": lambda i: rl.flow(TIMES + i, **BODY, theta=0.1, omega=1.0 + i),
    "flow, many times": lambda i: rl.flow(
        np.linspace(0.0, 9.0 + i, 3000), **BODY, theta=0.1, omega=1.0 + i, workers=2
    ),
    "flow, bodies": lambda i: rl.flow(
        2.0, a=2.0, b=np.linspace(0.5, 1.5 + i, 2000), theta=0.1, omega=1.0, workers=2
    ),
    "classify": lambda i: rl.classify(**BODY, theta=0.1, omega=1.0 + i, friction=0.4),
    "classify, bodies": lambda i: rl.classify(
        **BODY, theta=0.1, omega=np.linspace(0.0, 3.0 + i, 2500), friction=0.4, workers=2
    ),
    "auto": lambda i: all_of(solved(i)),
    "exact": lambda i: solved(i, model="rolling", method="exact"),
    "rk4": lambda i: solved(i, model="rolling", method="rk4", step=0.02),
    "dopri5": lambda i: solved(i, model="rolling", method="dopri5", rtol=1e-6),
    "gauss": lambda i: solved(i, model="rolling", method="gauss", step=0.05),
    "radau": lambda i: solved(i, model="rolling", method="radau", step=0.05),
    "projection": lambda i: all_of(solved(i, model="multipliers", rtol=1e-6)),
    "ggl": lambda i: solved(
        i, model="multipliers", method="radau", stabilization="ggl", step=0.05
    ),
    "contact": lambda i: all_of(simulate(scenes.drop.replace(theta=0.1 + 0.2 * i), 1.0)),
    "slide": lambda i: all_of(simulate(scenes.slip.replace(friction=0.1 + 0.1 * i), TIMES)),
    "slope": lambda i: all_of(simulate(scenes.slope.replace(slope=0.02 * (i + 1)), TIMES)),
    "settings": lambda i: solved(i, rtol=1e-9 * (1 + random.Random(i).random())),
    "many": lambda i: rl.simulate_many([rolling(i), scenes.jump, scenes.drop], TIMES, workers=2),
    "certify": lambda i: rl.certify(rolling(i)),
    "certify, slope": lambda i: rl.certify(scenes.slope.replace(slope=0.02 * (i + 1))),
    "thresholds": lambda i: rl.thresholds(**BODY, friction=0.1 + 0.1 * i).slip_speed,
    "period": lambda i: rl.period(rolling(i)),
    "outcome": lambda i: rl.outcome(rolling(i)),
    "blows": lambda i: rl.outcome(scenes.report, rl.Impulse(jx=np.linspace(-9.0, 9.0, 20 + i))),
    "required": lambda i: rl.required_friction(rolling(i)),
    "constraints": lambda i: rl.constraints(
        *rl.kinematics(0.3 * i, np.linspace(-1.0, 1.0, 9), **BODY), **BODY
    ),
    "geometry": lambda i: rl.geometry.arc_length(np.linspace(0.0, 1.0 + i, 50), **BODY),
    "refused": lambda i: refusal(lambda: Scene(2.0, -1.0 - i)),
    "sol, exact": lambda i: all_of(ROLLED.sol(np.linspace(0.0, 3.0, 100 + i))),
    "sol, contact": lambda i: all_of(TOUCHED.sol(np.linspace(0.0, 2.0, 100 + i))),
    "sol, steps": lambda i: all_of(STEPPED.sol(np.linspace(0.0, 1.0, 100 + i))),
    "sol, slope": lambda i: all_of(DOWNHILL.sol(np.linspace(0.0, 2.0, 100 + i))),
    "at": lambda i: (ROLLED.at(0.1 * i), TOUCHED.at(0.4 * i), STEPPED.at(0.2 * i)),
    "when": lambda i: (ROLLED.when(theta=0.2 + 0.5 * i), TOUCHED.when(z=1.0 + 0.1 * i)),
    "scene at": lambda i: ROLLED.scene_at(0.7 * i),
}  # fmt: skip


def refusal(call: Callable[[], Any]) -> str:
    with pytest.raises(ValueError) as caught:
        call()
    return str(caught.value)


def test_concurrent_mixed_calls_equal_single_threaded_ones_bit_for_bit() -> None:
    """Each of eight threads makes 1000 of these calls in its own random order."""
    alone = {(kind, place): call(place) for kind, call in KINDS.items() for place in range(PLACES)}

    def work(thread: int) -> None:
        draw = random.Random(thread)
        order = list(alone) * (1 + CALLS_EACH // len(alone))
        draw.shuffle(order)
        for kind, place in order[:CALLS_EACH]:
            require_same(KINDS[kind](place), alone[kind, place], f"{kind}, {place}")

    assert at_once([partial(work, thread) for thread in range(THREADS)]) == [None] * THREADS


def late_names(of: Any) -> list[str]:
    """Public properties of an object that are computed when they are first read."""
    return [
        name
        for kind in type(of).__mro__
        for name, value in vars(kind).items()
        if isinstance(value, cached_property) and not name.startswith("_")
    ]


LATE: dict[str, Callable[[], Any]] = {
    "exact": lambda: simulate(scenes.rolling, TIMES),
    "contact": lambda: simulate(scenes.drop, 2.0),
    "multipliers": lambda: simulate(scenes.rocking, TIMES, model="multipliers", rtol=1e-6),
    "slope": lambda: simulate(scenes.slope, TIMES),
    "scene": lambda: Scene(2.0, 1.0, theta=0.3, omega=1.0),
    "thresholds": lambda: rl.thresholds(2.0, 1.0, gyration2=0.0435, friction=0.3),
    "settings": lambda: simulate(scenes.rolling, TIMES, rtol=3e-9).settings,
}


@pytest.mark.parametrize("make", LATE.values(), ids=LATE)
def test_lazily_computed_properties_are_the_same_in_all_threads(make: Callable[[], Any]) -> None:
    """Eight threads read the properties of a new object at once, in rotated orders."""

    def comparable(value: Any) -> Any:
        """The value itself, or the class name for an object of the core, which has no fields."""
        kind = type(value)
        return kind.__name__ if kind.__module__ == _core.__name__ else value

    names = late_names(make())
    assert names
    alone = {name: comparable(getattr(make(), name)) for name in names}
    for turn in range(10):
        shared = make()

        def ask(thread: int, shared: Any = shared, turn: int = turn) -> dict[str, Any]:
            first = (thread + turn) % len(names)
            return {name: getattr(shared, name) for name in names[first:] + names[:first]}

        for read in at_once([partial(ask, thread) for thread in range(THREADS)]):
            require_same({name: comparable(read[name]) for name in names}, alone)


def test_late_names_finds_the_cached_properties_of_a_trajectory() -> None:
    seen = {"events", "psi", "energy", "normal_force", "turns", "reason", "stats"}
    assert seen <= set(late_names(ROLLED))


READS: dict[str, tuple[str, Callable[[rl.Trajectory], Any]]] = {
    "energy": ("touch", lambda motion: motion.energy),
    "q": ("details", lambda motion: motion.q),
    "sol": ("_core.simulate", lambda motion: motion.sol([1.0])),
}


@pytest.mark.parametrize(("within", "read"), READS.values(), ids=READS)
def test_computing_a_property_of_one_motion_does_not_block_another_motion(
    within: str, read: Callable[[rl.Trajectory], Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    """While one thread is held inside a property of a motion, another thread reads the same
    property of another motion."""
    held, other = (pickle.loads(pickle.dumps(TOUCHED)) for _ in range(2))
    begun, released, usual = Event(), Event(), attrgetter(within)(trajectories)

    def slowly(of: Any, *more: Any) -> Any:
        if of is held or of is held.scene.core:
            begun.set()
            released.wait()
        return usual(of, *more)

    monkeypatch.setattr(f"{trajectories.__name__}.{within}", slowly)
    with ThreadPoolExecutor(2) as pool:
        first = pool.submit(read, held)
        begun.wait()
        try:
            second = pool.submit(read, other).result(timeout=60)
        finally:
            released.set()
        require_same(second, first.result())
