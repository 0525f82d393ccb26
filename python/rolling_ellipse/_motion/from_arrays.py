"""Trajectories from external samples, such as those of a tracker or another simulator."""

from __future__ import annotations

import math
from contextlib import suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from .._ask.check import FloatArray, finite, shown
from .._ask.reason import in_words
from .._ask.scene import Scene, require_scene
from .._ask.settings import DEFAULTS, GIVEN
from .._core import Mode, Solution
from ..geometry import centre_path, support
from .samples import fields_of, vector
from .status import COMPLETED

if TYPE_CHECKING:
    from .trajectory import Trajectory

_Made = TypeVar("_Made", bound="Trajectory")
_NEAR = 5  # number of samples of a local polynomial
_PIECE = 2**12  # times evaluated at once (at most 20 ms); Ctrl-C acts between pieces
_SMALL = 0.01  # largest gap/max(a, b) and slip/sqrt(g max(a, b)) in rolling


def from_arrays(
    kind: type[_Made],
    t: ArrayLike,
    x: ArrayLike | None = None,
    z: ArrayLike | None = None,
    theta: ArrayLike | None = None,
    *,
    scene: Scene,
) -> _Made:
    """Return a trajectory of external samples, such as those of a tracker or another simulator.

    Each track is interpolated by the fourth-degree polynomial through the five samples around the
    nearest one. Rates have errors of fourth order, and accelerations, which give the forces, of
    third order. Before the first sample the body keeps its first position. It flies if its gap
    exceeds 0.01 max(a, b); otherwise it slides if its contact slips faster than
    0.01 sqrt(gravity max(a, b)), and rolls if not. There are no events: within two samples of an
    impact, rates and forces are wrong.

    Parameters
    ----------
    t : array_like, shape (n,)
        Increasing times since the start of the scene, n >= 5 [s].
    x, z, theta : array_like, shape (n,)
        Centre [m] and angle [rad], unwrapped. If x and z are missing, the body is assumed to roll
        from the start of the scene; this suits angles from an equation of motion.
    scene : Scene
        Body and ground. `plot_error` compares the samples with the motion of this scene.

    Raises
    ------
    ValueError
        If times do not increase or are negative, or arrays differ in length or are not finite.
    TypeError
        If `scene` is not a Scene.

    Examples
    --------
    >>> t = np.linspace(0.0, 2.0, 201)
    >>> theta, omega, x = rl.flow(t, a=2.0, b=1.0, theta=0.5, omega=0.0)
    >>> mine = rl.Trajectory.from_arrays(t, theta=theta, scene=rl.scenes.rocking)
    >>> print(f"{mine.energy[0]:.4f} J at the start, {np.ptp(mine.energy):.0e} J of error")
    12.7513 J at the start, 3e-05 J of error
    """
    times = vector("t", finite("t", t))
    if times.size < _NEAR or times[0] < 0 or not (np.diff(times) > 0).all():
        raise ValueError(f"t must be {_NEAR} or more increasing times >= 0 [s], got {shown(t)}")
    body, given = require_scene(scene), {"x": x, "z": z, "theta": theta}
    if x is None and z is None and theta is not None:
        axes = {"a": body.a, "b": body.b}
        theta = vector("theta", finite("theta", theta))
        path = centre_path([body.theta, *theta], **axes)
        given |= {"x": body.x + path[1:] - path[0], "z": support(theta, **axes)}
    held = [vector(name, finite(name, values), times.size) for name, values in given.items()]
    samples = _Samples(body, times, np.stack(held, axis=1))
    return kind(
        **fields_of(samples.samples(times)), scene=body, model="contact",
        method=GIVEN, status=COMPLETED, message=COMPLETED.value, settings=DEFAULTS,
        reason=in_words([("from_arrays", [])]),
        valid_until=math.inf, t_end=float(times[-1]), span=float(times[-1]), kept_events=(),
    )  # fmt: skip


def between_samples(of: Trajectory) -> Solution:
    """Return the interpolant of a trajectory from arrays, in the form of the core's Solution."""
    times, first = np.unique(of.t, return_index=True)
    tracks = np.stack([of.x, of.z, of.theta], axis=1)[first]
    return _Samples(of.scene, times, tracks)  # type: ignore[return-value]


@dataclass(frozen=True)
class _Samples:
    model: ClassVar[str] = "contact"
    scene: Scene
    t: FloatArray
    tracks: FloatArray

    @np.errstate(over="ignore", invalid="ignore", divide="ignore")
    def samples(self, t: FloatArray) -> tuple[FloatArray, ...]:
        """Return the samples at the given times as arrays, as the core's Solution does."""
        scene, times, near = self.scene, np.maximum(t, self.t[0]), min(_NEAR, self.t.size)
        nearest = np.searchsorted(self.t[1:] / 2 + self.t[:-1] / 2, times)
        first = np.clip(nearest - near // 2, 0, self.t.size - near)
        places = first[:, None] + np.arange(near)
        span = np.ptp(self.t[places], axis=1)[:, None] + (near == 1)
        s = (self.t[places] - times[:, None]) / span
        powers = np.zeros((times.size, _NEAR, 3))
        powers[:, :near] = math.nan
        with suppress(np.linalg.LinAlgError):
            for k in range(0, times.size, _PIECE):
                piece = slice(k, k + _PIECE)
                matrices = s[piece, :, None] ** np.arange(near)
                powers[piece, :near] = np.linalg.solve(matrices, self.tracks[places[piece]])
        rates = powers[:, 0], powers[:, 1] / span, 2 * powers[:, 2] / span**2
        if not np.isfinite(rates).all():
            raise ValueError(
                f"t must give finite rates, got times {np.diff(self.t).min():g} s apart"
            )
        (x, z, theta), (x_dot, z_dot, omega), (x_ddot, z_ddot, _) = (each.T for each in rates)
        length, g, h = max(scene.a, scene.b), scene.gravity, support(theta, a=scene.a, b=scene.b)
        slides = np.abs(x_dot - h * omega) > _SMALL * math.sqrt(g * length)
        mode = np.where(slides, Mode.SLIDING, Mode.ROLLING).astype(np.int8)
        mode[z - h > _SMALL * length] = Mode.FLIGHT
        normal_force = scene.mass * (z_ddot + g * math.cos(scene.slope))
        friction_force = scene.mass * (x_ddot - g * math.sin(scene.slope))
        columns = theta, omega, x, z, x_dot, z_dot, normal_force, friction_force
        return t, *(values.copy() for values in columns), mode

    def passages(self, *_: Any) -> Any:
        raise ValueError("trajectory must be computed to have passages, got one from arrays")

    zeros = passages
