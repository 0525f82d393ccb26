"""Who takes part: the package's own methods, `flow`, and peers, all asked in the same way."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Protocol

import numpy as np

from ..._ask.check import FloatArray, choice, shown
from ..._ask.scene import Scene
from ..._ask.settings import DEFAULTS, METHODS, MODELS, STABILIZATIONS, settings
from ..._motion.stability import advice
from ..._motion.status import Status
from ..._motion.trajectory import Trajectory
from ..flow import arguments_of, flow, period
from ..simulate import sample_times

State = tuple[float, float, float]  # theta, omega, x
TOLERANCES, STEPS = "tolerances", "steps"

_RELATIVE = 100.0  # rtol over atol
_HELD = ("ROLLING", "REST")
_PAIRS = ("dop853", "dopri5", "auto")
_OF_ROLLING = ("dop853", "dopri5", "rk4", "gauss", "radau")
_OF_MULTIPLIERS = (
    "multipliers/dop853/projection", "multipliers/rk4/none", "multipliers/rk4/baumgarte",
    "multipliers/rk4/projection", "multipliers/rk4/projection+energy", "multipliers/radau/ggl",
)  # fmt: skip


class Peer(Protocol):
    """Another program. It may also have `ladder` ("tolerances" or "steps") and `tags`."""

    name: str

    def prepare(self, scene: Scene, t_end: float, setting: float) -> Callable[[], Any]:
        """Return a function of nothing that returns theta, omega, x at the end.

        It may have `sample`, a function of sorted times that returns their arrays, and `counts`, a
        mapping with "steps", "rejected" and "evaluations" of the last call. ValueError refuses.
        """


class Stopped(Exception):
    """A run that has no answer; `status` says in which way."""

    def __init__(self, status: str, reason: str) -> None:
        super().__init__(reason)
        self.status = status


class Runner:
    """A contender at one setting, ready to run; `advice` is that of `simulate` on its motion."""

    advice = ""

    def end(self) -> State:
        """Return the state at the end: what is timed."""
        raise NotImplementedError

    def sampled(self, times: FloatArray) -> Trajectory | None:
        """Return the motion at the times, if it can be had."""
        raise NotImplementedError

    def counts(self) -> Mapping[str, int]:
        """Return steps, rejected steps and evaluations of the last call, where known."""
        return {}


@dataclass(frozen=True)
class Contender:
    """A way to compute a motion, over a ladder of settings (None: it has none)."""

    name: str
    model: str
    method: str
    stabilization: str
    ladder: str | None
    tags: tuple[str, ...]
    prepare: Callable[[Scene, float, float], Runner]


# ------------------------------------------------------------------------ the package's own


class _Flow(Runner):
    def __init__(self, scene: Scene, t_end: float, _: float) -> None:
        start = scene.initial_state
        if scene.slope or start.mode.name not in _HELD:
            raise ValueError("flow must be given a scene that rolls on level ground")
        self.scene, self.x = scene, start.x
        self.arguments, self.t_end = arguments_of(scene), t_end

    def end(self) -> State:
        theta, omega, x = flow(self.t_end, **self.arguments)
        return theta, omega, self.x + x

    def sampled(self, times: FloatArray) -> Trajectory:
        theta, omega, x = flow(times, **self.arguments)
        return rolling_motion(self.scene, times, theta, omega, self.x + x)


class _Simulation(Runner):
    def __init__(self, scene: Scene, t_end: float, arguments: dict[str, Any]) -> None:
        self.scene = replace(scene)  # a new one, whose own set-up is paid for again
        self.settings = tuple((DEFAULTS.__getstate__() | arguments).values())
        self.times = np.array([t_end])
        self.last: Trajectory | None = None

    def end(self) -> State:
        motion = self._run(self.times)
        return float(motion.theta[0]), float(motion.omega[0]), float(motion.x[0])

    def sampled(self, times: FloatArray) -> Trajectory:
        return self._run(times)

    def counts(self) -> Mapping[str, int]:
        stats = self.last.stats if self.last else {}
        return stats | {"rejected": stats.get("rejected_steps", 0)}

    def _run(self, times: FloatArray) -> Trajectory:
        """Do all that `simulate` does but warn."""
        how = settings(*self.settings)
        motion = Trajectory.computed(self.scene, how, sample_times(times))
        if motion.status is not Status.COMPLETED:
            raise Stopped(motion.status.name, motion.message)
        told = advice(motion)
        self.advice, self.last = self.advice or told or "", motion
        return motion


def rolling_motion(scene: Scene, t: FloatArray, theta: Any, omega: Any, x: Any) -> Trajectory:
    """Return states of rolling as a Trajectory, which knows what follows from them."""
    return Trajectory(
        t, theta, omega, x, scene=scene, model="rolling", method="exact", status=Status.COMPLETED,
        message="", reason="", valid_until=math.inf, t_end=float(t[-1]), span=float(t[-1]),
        settings=DEFAULTS,
    )  # fmt: skip


def own_contenders(methods: Any, scene: Scene, rolls: bool) -> list[Contender]:
    """Return those that are named, or those that suit a scene.

    Raises
    ------
    ValueError, TypeError
        If there is none, a name is unknown, or one comes twice.
    """
    if methods is None:
        return [_own(spec) for spec in _suitable(scene, rolls)]
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
    if method == "exact" or model == "contact":
        ladder = None
    else:
        ladder = TOLERANCES if method in _PAIRS else STEPS

    def prepare(scene: Scene, t_end: float, setting: float) -> Runner:
        if ladder == TOLERANCES:
            at: dict[str, Any] = {"rtol": setting, "atol": setting / _RELATIVE}
        else:
            at = {"step": setting} if ladder else {}
        return _Simulation(scene, t_end, how | at)

    default = DEFAULTS.stabilization if model == "multipliers" else ""
    stabilization = str(arguments.get("stabilization", default))
    return Contender(name, model, method, stabilization, ladder, ("own", model), prepare)


# -------------------------------------------------------------------------------------- peers


class _PeerRunner(Runner):
    def __init__(self, scene: Scene, run: Any) -> None:
        self.scene, self.run = scene, run

    def end(self) -> State:
        theta, omega, x = self.run()
        return float(theta), float(omega), float(x)

    def sampled(self, times: FloatArray) -> Trajectory | None:
        if not hasattr(self.run, "sample"):
            return None
        return rolling_motion(self.scene, times, *self.run.sample(times))

    def counts(self) -> Mapping[str, int]:
        return getattr(self.run, "counts", None) or {}


def peer_contenders(peers: Any) -> list[Contender]:
    """Return the contenders of peers.

    Raises
    ------
    TypeError
        If one has no name or cannot prepare.
    """
    return [_peer(peer) for peer in peers]


def _peer(peer: Peer) -> Contender:
    name = getattr(peer, "name", None)
    if not isinstance(name, str) or not callable(getattr(peer, "prepare", None)):
        raise TypeError(f"peers must have a name and a function prepare, got {shown(peer)}")
    ladder = choice(f"ladder of {name}", getattr(peer, "ladder", TOLERANCES), (TOLERANCES, STEPS))
    tags = tuple(str(tag) for tag in getattr(peer, "tags", ()))

    def prepare(scene: Scene, t_end: float, setting: float) -> Runner:
        run = peer.prepare(scene, t_end, setting)
        if not callable(run):
            raise TypeError(f"prepare of {name} must return a function, got {shown(run)}")
        return _PeerRunner(scene, run)

    own_tags = ("peer", *(tag for tag in tags if tag != "peer"))
    return Contender(name, "rolling", name, "", ladder, own_tags, prepare)


# ------------------------------------------------------------------------------------ ladders


def default_tolerances() -> list[float]:
    return [10.0**-k for k in range(2, 15)]


def default_steps(scene: Scene, t_end: float) -> list[float]:
    """Return 4 to 2048 steps a half turn or half swing, none longer than the whole."""
    try:
        half = period(scene) / 2
    except ValueError:  # a slope, or no rolling
        half = math.inf
    if not math.isfinite(half):
        half = math.pi * math.sqrt(max(scene.a, scene.b) / scene.gravity)
    return [half / 2**k for k in range(2, 12) if half / 2**k <= t_end] or [t_end]
