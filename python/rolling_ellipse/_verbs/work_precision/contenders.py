"""Who takes part: the package's own methods, `flow`, and peers, all asked in the same way."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..._ask.check import FloatArray, choice, shown
from ..._ask.scene import Scene
from ..._ask.settings import DEFAULTS, METHODS, MODELS, STABILIZATIONS, settings
from ..._motion.stability import advice
from ..._motion.status import Status
from ..._motion.trajectory import Trajectory
from ..flow import arguments_of, flow, period
from ..simulate import sample_times

TOLERANCES, STEPS = "tolerances", "steps"

_RELATIVE = 100.0  # rtol over atol
_HELD = ("ROLLING", "REST")
_PAIRS = ("dop853", "dopri5", "auto")
_OF_ROLLING = ("dop853", "dopri5", "rk4", "gauss", "radau")
_OF_MULTIPLIERS = (
    "multipliers/dop853/projection", "multipliers/rk4/none", "multipliers/rk4/baumgarte",
    "multipliers/rk4/projection", "multipliers/rk4/projection+energy", "multipliers/radau/ggl",
)  # fmt: skip


class Stopped(Exception):
    """A run that has no answer: the name of its status, and the reason."""


@dataclass(frozen=True)
class Contender:
    """A way to compute a motion, over a ladder of settings (None: it has none).

    `prepare(scene, t_end, setting)` returns a function of nothing that returns theta, omega, x at
    the end. It may have `sample`, a function of times that returns a Trajectory or theta, omega, x;
    `counts`, those of its last call; and `advice`, what should be known of its answer.
    """

    name: str
    model: str
    method: str
    stabilization: str
    ladder: str | None
    tags: tuple[str, ...]
    prepare: Callable[[Scene, float, float], Any]


class _Flow:
    def __init__(self, scene: Scene, t_end: float, _: float) -> None:
        start = scene.initial_state
        if scene.slope or start.mode.name not in _HELD:
            raise ValueError("flow must be given a scene that rolls on level ground")
        self.x, self.t_end, self.arguments = start.x, t_end, arguments_of(scene)

    def __call__(self) -> tuple[float, float, float]:
        theta, omega, x = flow(self.t_end, **self.arguments)
        return theta, omega, self.x + x

    def sample(self, times: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        theta, omega, x = flow(times, **self.arguments)
        return theta, omega, self.x + x


class _Simulation:
    advice = ""

    def __init__(self, scene: Scene, t_end: float, arguments: dict[str, Any]) -> None:
        self.scene = replace(scene)  # a new one, whose own set-up is paid for again
        self.settings = tuple((DEFAULTS.__getstate__() | arguments).values())
        self.times = np.array([t_end])

    def __call__(self) -> tuple[float, float, float]:
        motion = self.sample(self.times)
        return float(motion.theta[0]), float(motion.omega[0]), float(motion.x[0])

    def sample(self, times: FloatArray) -> Trajectory:
        """Do all that `simulate` does but warn."""
        motion = Trajectory.computed(self.scene, settings(*self.settings), sample_times(times))
        if motion.status is not Status.COMPLETED:
            raise Stopped(motion.status.name, motion.message)
        told = advice(motion)
        self.advice, self.last = self.advice or told or "", motion
        return motion

    @property
    def counts(self) -> dict[str, int]:
        return self.last.stats | {"rejected": self.last.stats.get("rejected_steps", 0)}


def own_contenders(methods: Any, scene: Scene, rolls: bool) -> list[Contender]:
    """Return those that are named, or those that suit a scene."""
    if methods is None:
        methods = _suitable(scene, rolls)
    if isinstance(methods, str):
        methods = (methods,)
    if not isinstance(methods, Sequence):
        raise TypeError(f"methods must be a sequence of names or mappings, got {shown(methods)}")
    return [_own(spec) for spec in methods]


def _suitable(scene: Scene, rolls: bool) -> tuple[str, ...]:
    if scene.initial_state.mode.name not in _HELD:
        return ("contact",)
    if scene.slope:
        return ("contact", "exact", *_OF_ROLLING, *_OF_MULTIPLIERS)
    if not rolls:  # exact rolling shows what a poorer model says of such a scene
        return ("contact", "exact")
    return ("flow", "exact", *_OF_ROLLING, *_OF_MULTIPLIERS)


def _own(spec: Any) -> Contender:
    """Return the contender of "flow", a method, "model/method/stabilization", or arguments."""
    if spec == "flow":
        return Contender("flow", "rolling", "exact", "", None, ("own", "exact"), _Flow)
    if isinstance(spec, str):
        return _simulation(spec, _parts(spec))
    if not isinstance(spec, Mapping) or not all(isinstance(key, str) for key in spec):
        raise TypeError(
            f"methods must be names, or mappings of arguments of simulate, got {shown(spec)} "
            "among them"
        )
    arguments = dict(spec)
    name = arguments.pop("name", "/".join(str(value) for value in arguments.values()))
    if not isinstance(name, str):
        raise TypeError(f"name of a method must be a string, got {shown(name)}")
    return _simulation(name, arguments)


def _parts(spec: str) -> dict[str, Any]:
    """Return the arguments that a name stands for."""
    model, *rest = spec.split("/")
    if model in METHODS and model != "auto" and not rest:
        return {"model": "rolling", "method": model}
    if model in MODELS and model != "auto" and len(rest) <= 2:
        names = dict(zip(("method", "stabilization"), rest, strict=False))
        known = {"method": METHODS, "stabilization": STABILIZATIONS}
        if all(value in known[name] for name, value in names.items()):
            return {"model": model, **names}
    listed = ", ".join(repr(name) for name in ("flow", *METHODS[1:], *MODELS[1:]))
    raise ValueError(
        f"methods must be among {listed}, or 'model/method/stabilization', got {shown(spec)}"
    )


def _simulation(name: str, arguments: dict[str, Any]) -> Contender:
    taken = {"model", "method", "stages", "stabilization", "baumgarte", "max_steps", "max_events"}
    for argument in arguments:
        choice("arguments of methods", argument, (*sorted(taken), "rest_speed"))
    model = choice("model", arguments.get("model", "rolling"), MODELS)
    method = choice("method", arguments.get("method", "auto"), METHODS)
    how = {"model": model, **arguments}
    ladder: str | None = TOLERANCES if method in _PAIRS else STEPS
    if method == "exact" or model == "contact":
        ladder = None

    def prepare(scene: Scene, t_end: float, setting: float) -> _Simulation:
        at = {"rtol": setting, "atol": setting / _RELATIVE} if ladder == TOLERANCES else {}
        return _Simulation(scene, t_end, how | at | ({"step": setting} if ladder == STEPS else {}))

    default = DEFAULTS.stabilization if model == "multipliers" else ""
    stabilization = str(arguments.get("stabilization", default))
    return Contender(name, model, method, stabilization, ladder, ("own", model), prepare)


def of_peer(peer: Any) -> Contender:
    """Return the contender that is a peer; TypeError if it has no name or cannot prepare."""
    name = getattr(peer, "name", None)
    if not isinstance(name, str) or not callable(getattr(peer, "prepare", None)):
        raise TypeError(f"peers must have a name and a function prepare, got {shown(peer)}")
    ladder = choice(f"ladder of {name}", getattr(peer, "ladder", TOLERANCES), (TOLERANCES, STEPS))
    tags = dict.fromkeys(["peer", *(str(tag) for tag in getattr(peer, "tags", ()))])

    def prepare(scene: Scene, t_end: float, setting: float) -> Any:
        run = peer.prepare(scene, t_end, setting)
        if not callable(run):
            raise TypeError(f"prepare of {name} must return a function, got {shown(run)}")
        return run

    return Contender(name, "rolling", name, "", ladder, tuple(tags), prepare)


def default_steps(scene: Scene, t_end: float) -> list[float]:
    """Return 4 to 2048 steps a half turn or half swing, none longer than the whole."""
    try:
        half = period(scene) / 2
    except ValueError:  # a slope, or no rolling
        half = math.inf
    if not math.isfinite(half):
        half = math.pi * math.sqrt(max(scene.a, scene.b) / scene.gravity)
    return [half / 2**k for k in range(2, 12) if half / 2**k <= t_end] or [t_end]
