"""The common problem of all peers: the equation of rolling and the numbers of a scene.

With A = a^2, B = b^2, u = h^2 = B + (A - B) sin^2 and S = k^2 + A + B, the inertia of rolling is D
= S - AB/u, and the equation of motion needs neither h' nor the radius of curvature:

    (S u - AB) theta'' = h u sigma - (A - B) sin cos (gamma h + AB omega^2 / u),  x' = h omega,

where sigma and gamma are the components of gravity along the ground and into it. This is physics
(18) with fewer products, which makes the peers faster: heyoka takes half the time.
Near the flat position, S u - AB magnifies rounding errors by A/(k^2 + B), which is less than 4 for
a uniform body.
"""

import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from importlib import metadata
from typing import Any, NamedTuple

import numpy as np
from rolling_ellipse import Mode, Scene

Rates = Callable[[Any, Any, Any], tuple[Any, Any]]
MOST_STEPS = 1_000_000  # limit on the steps of one run


class Problem(NamedTuple):
    """Body, start, end and tolerances of one run."""

    body: tuple[float, ...]  # B, A - B, AB, S [m^2, m^4], gamma, sigma [m/s^2], k^2 [m^2]
    start: tuple[float, float, float]  # initial theta [rad], omega [rad/s], x [m]
    t_end: float  # end of the run [s]
    rtol: float
    atol: float
    pace: float  # time scale of the motion [s]


def problem(scene: Scene, t_end: float, setting: float) -> Problem:
    """The problem of a scene; raise a ValueError if the scene does not roll."""
    at = scene.initial_state
    if at.mode is not Mode.ROLLING:
        raise ValueError(f"peers integrate rolling only, and this scene starts {at.mode.name}")
    for name, value in (("t_end", t_end), ("setting", setting)):
        if not 0 < value < math.inf:
            raise ValueError(f"{name} must be positive and finite, got {value!r}")
    a2, b2 = scene.a**2, scene.b**2
    spread = (scene.a - scene.b) * (scene.a + scene.b)
    gamma, sigma = (scene.gravity * part(scene.slope) for part in (math.cos, math.sin))
    k2 = scene.gyration2
    body = (b2, spread, a2 * b2, k2 + a2 + b2, gamma, sigma, k2)
    pace = 1 / (abs(at.omega) + math.sqrt(scene.gravity / max(scene.a, scene.b)))
    start = (at.theta, at.omega, at.x)
    return Problem(body, start, float(t_end), setting, setting / 100, pace)


def rates_with(sin: Any, cos: Any, sqrt: Any) -> Rates:
    """A function that computes theta'' and x' from theta, omega and the body with a library's sin,
    cos and sqrt."""

    def rates(theta: Any, omega: Any, body: Any) -> tuple[Any, Any]:
        s, c = sin(theta), cos(theta)
        u = body[0] + body[1] * s * s
        h = sqrt(u)
        hu = h * u
        load = body[4] * hu + body[2] * omega * omega
        turn = body[5] * hu * u - body[1] * s * c * load
        return turn / (u * (body[3] * u - body[2])), h * omega

    return rates


RATES = rates_with(math.sin, math.cos, math.sqrt)


class Integration(ABC):
    """A prepared run of one problem; only the call is timed."""

    counts: dict[str, int]

    @abstractmethod
    def __call__(self) -> tuple[float, float, float]:
        """Integrate anew, and return theta, omega and x at the end."""


@dataclass(frozen=True)
class Peer:
    """A contender of a race: an integrator of some library."""

    name: str
    library: str  # library with its version
    run: Callable[[Problem], Integration]  # compiles, allocates, and returns the prepared run
    least: float = 0.0  # smallest tolerance that the library accepts
    tags: tuple[str, ...] = ("peer", "compiled")

    def prepare(self, scene: Scene, t_end: float, setting: float) -> Integration:
        """Prepare a run of a new scene; raise a ValueError if the peer cannot integrate the
        scene."""
        if setting < self.least:
            raise ValueError(f"{self.name} takes tolerances from {self.least:.1e}, got {setting}")
        return self.run(problem(scene, t_end, setting))


def version(library: str) -> str:
    """The name and the installed version of a distribution."""
    return f"{library} {metadata.version(library)}"


def columns(states: Any) -> tuple[Any, Any, Any]:
    """theta, omega and x from an array with one state per row."""
    theta, omega, x = np.ascontiguousarray(np.asarray(states).T)
    return theta, omega, x


def finite(theta: float, omega: float, x: float) -> tuple[float, float, float]:
    """The state theta, omega, x; raise a RuntimeError if it is not finite."""
    if not math.isfinite(theta + omega + x):
        raise RuntimeError(f"the state is not finite: {theta}, {omega}, {x}")
    return theta, omega, x
