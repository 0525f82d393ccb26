"""Contenders of a race: the package's own methods, `flow`, and peers, behind one interface."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from ..._ask.check import FloatArray, choice, shown
from ..._ask.scene import Scene
from ..._ask.settings import DEFAULTS, METHODS, MODELS, STABILIZATIONS, settings
from ..._motion.stability import advice
from ..._motion.status import IntegrationError, Status
from ..._motion.trajectory import Trajectory
from ..flow import arguments_of, flow, period
from ..simulate import sample_times
from .run import Run

TOLERANCES, STEPS = "tolerances", "steps"

_RELATIVE = 100.0  # rtol over atol
_HELD = ("ROLLING", "REST")
_PAIRS = ("dop853", "dopri5", "auto")
_OF_ROLLING = ("dop853", "dopri5", "rk4", "gauss", "radau")
_OF_MULTIPLIERS = (
    "multipliers/dop853/projection", "multipliers/rk4/none", "multipliers/rk4/baumgarte",
    "multipliers/rk4/projection", "multipliers/rk4/projection+energy", "multipliers/radau/ggl",
)  # fmt: skip
_ARGUMENTS = sorted(DEFAULTS.__getstate__().keys() - {"rtol", "atol", "step"})


@dataclass(frozen=True)
class Contender:
    """A method or peer, by the protocol of peers; its call may also have `advice` on its answer."""

    run: Run  # its name, model, method, stabilization and tags
    ladder: str | None  # None: it has no setting
    prepare: Callable[[Scene, float, float], Any]


def _prepared_flow(scene: Scene, t_end: float, _: float) -> Any:
    start = scene.initial_state
    if scene.slope or start.mode.name not in _HELD:
        raise ValueError("flow must be given a scene that rolls on level ground")
    arguments = arguments_of(scene)

    def sample(times: Any) -> tuple[Any, Any, Any]:
        theta, omega, x = flow(times, **arguments)
        return theta, omega, start.x + x

    call: Any = partial(sample, t_end)
    call.sample = sample
    return call


class _Simulation:
    advice = ""

    def __init__(
        self, arguments: dict[str, Any], ladder: str | None, scene: Scene, t_end: float,
        setting: float,
    ) -> None:  # fmt: skip
        self.scene = replace(scene)  # a new scene, so that its own set-up is timed again
        how = {TOLERANCES: {"rtol": setting, "atol": setting / _RELATIVE}, STEPS: {"step": setting}}
        given = arguments | how.get(ladder or "", {})
        self.settings = tuple((DEFAULTS.__getstate__() | given).values())
        self.times = np.array([t_end])

    def __call__(self) -> tuple[float, float, float]:
        motion = self.sample(self.times)
        return float(motion.theta[0]), float(motion.omega[0]), float(motion.x[0])

    def sample(self, times: FloatArray) -> Trajectory:
        """Do all that `simulate` does except warn."""
        motion = Trajectory.computed(self.scene, settings(*self.settings), sample_times(times))
        if motion.status is not Status.COMPLETED:
            raise IntegrationError(motion)
        self.advice, self.last = self.advice or advice(motion) or "", motion
        return motion

    @property
    def counts(self) -> dict[str, int]:
        return self.last.stats | {"rejected": self.last.stats.get("rejected_steps", 0)}


def own_contenders(methods: Any, scene: Scene, rolls: bool) -> list[Contender]:
    """Return the contenders that `methods` names, or by default those that suit the scene."""
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
    if scene.slope or rolls:
        return ("contact" if scene.slope else "flow", "exact", *_OF_ROLLING, *_OF_MULTIPLIERS)
    return ("contact", "exact")  # "exact" shows that a model without slip has no answer


def _own(spec: Any) -> Contender:
    """Return the contender of "flow", a method, "model/method/stabilization", or a mapping."""
    if isinstance(spec, str):
        name, arguments = spec, _named(spec)
    elif isinstance(spec, Mapping) and all(isinstance(key, str) for key in spec):
        arguments = dict(spec)
        name = arguments.pop("name", "/".join(map(str, arguments.values())))
    else:
        raise TypeError(
            f"methods must be names, or mappings of arguments of simulate, got {shown(spec)} "
            "among them"
        )
    if not isinstance(name, str):
        raise TypeError(f"name of a method must be a string, got {shown(name)}")
    if arguments is None:
        run = Run(name, "rolling", "exact", "", tags=("own", "exact"))
        return Contender(run, None, _prepared_flow)
    for argument in arguments:
        choice("arguments of methods", argument, tuple(_ARGUMENTS))
    model = choice("model", arguments.get("model", "rolling"), MODELS)
    method = choice("method", arguments.get("method", "auto"), METHODS)
    ladder: str | None = TOLERANCES if method in _PAIRS else STEPS
    if method == "exact" or model == "contact":
        ladder = None
    default = DEFAULTS.stabilization if model == "multipliers" else ""
    stabilization = str(arguments.get("stabilization", default))
    run = Run(name, model, method, stabilization, tags=("own", model))
    return Contender(run, ladder, partial(_Simulation, {"model": model, **arguments}, ladder))


def _named(name: str) -> dict[str, Any] | None:
    """Return the arguments of `simulate` that a name stands for, None for "flow"."""
    if name == "flow":
        return None
    parts = ["rolling", name] if name in METHODS[1:] else name.split("/")
    if len(parts) <= 3 and all(
        map(tuple.__contains__, (MODELS[1:], METHODS, STABILIZATIONS), parts)
    ):
        return dict(zip(("model", "method", "stabilization"), parts, strict=False))
    listed = ", ".join(repr(name) for name in ("flow", *METHODS[1:], *MODELS[1:]))
    raise ValueError(
        f"methods must be among {listed}, or 'model/method/stabilization', got {shown(name)}"
    )


def of_peer(peer: Any) -> Contender:
    """Return the contender of a peer, or raise TypeError if it has no name or no `prepare`."""
    name = getattr(peer, "name", None)
    if not isinstance(name, str) or not callable(getattr(peer, "prepare", None)):
        raise TypeError(f"peers must have a name and a function prepare, got {shown(peer)}")
    ladder = choice(f"ladder of {name}", getattr(peer, "ladder", TOLERANCES), (TOLERANCES, STEPS))
    tags = dict.fromkeys(["peer", *(str(tag) for tag in getattr(peer, "tags", ()))])
    return Contender(Run(name, "rolling", name, "", tags=tuple(tags)), ladder, peer.prepare)


def default_steps(scene: Scene, t_end: float) -> list[float]:
    """Return steps from a quarter to a 2048th of a half turn or half swing, up to `t_end` [s]."""
    try:
        half = period(scene) / 2
    except ValueError:  # a slope, or no rolling
        half = math.inf
    if not math.isfinite(half):
        half = math.pi * math.sqrt(max(scene.a, scene.b) / scene.gravity)
    return [half / 2**k for k in range(2, 12) if half / 2**k <= t_end] or [t_end]
