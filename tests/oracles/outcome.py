"""Random scenes to classify, many at once."""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from rolling_ellipse import Scene, classify

import oracles.geometry
import oracles.rolling
from oracles.rolling import Motion

Floats = NDArray[np.float64]
Codes = NDArray[np.int8]
FRICTIONS = [0.0, 0.05, 0.3, 1.0, 3.0, math.inf]


class Sample(NamedTuple):
    """Columns of scenes."""

    a: Floats
    b: Floats
    omega: Floats
    theta: Floats
    friction: Floats
    gravity: Floats
    gyration2: Floats

    def motion(self) -> Motion:
        return oracles.rolling.motion(
            self.a, self.b, self.gyration2, self.gravity, self.theta, self.omega
        )

    def only(self, rows: Any) -> "Sample":
        return Sample(*(field[rows] for field in self))

    def outcomes(self) -> Codes:
        found = classify(**self._asdict())
        assert isinstance(found, np.ndarray)
        return found

    def scene(self, row: int) -> Scene:
        """The scene of a row with mass 1, whose moment of inertia is gyration2."""
        a, b, omega, theta, friction, gravity, inertia = (float(field[row]) for field in self)
        return Scene(
            a, b, omega=omega, theta=theta, friction=friction, gravity=gravity, inertia=inertia
        )


def random_sample(count: int, seed: int) -> Sample:
    """Scenes of every shape up to 100:1 at any angle, some on an axis, some hundreds of turns away;
    at rest, rocking or rolling over, up to beyond the loss of contact; with friction from a list,
    at random, or close to the need of the whole motion."""
    rng = np.random.default_rng(seed)
    thin, ordinary = rng.uniform(-2, 2, count), rng.uniform(-0.5, 0.5, count)
    b = 10 ** rng.uniform(-1, 1, count)
    a = b * 10 ** np.where(rng.random(count) < 0.5, thin, ordinary)
    gravity = 10 ** rng.uniform(-1, 2, count)
    spread = np.maximum(a, b) ** 2 * 10 ** rng.uniform(-2, 0, count)
    gyration2 = np.where(rng.random(count) < 0.5, (a * a + b * b) / 4, spread)
    angles = [np.zeros(count), rng.uniform(-4, 4, count), rng.uniform(-1e3, 1e3, count)]
    theta = np.choose(rng.choice(3, count, p=[0.2, 0.7, 0.1]), angles)

    # the kinetic energy at the start, in units of the barrier and of the loss of contact
    still = oracles.rolling.motion(a, b, gyration2, gravity, theta, 0.0)
    one = oracles.rolling.motion(a, b, gyration2, gravity, theta, 1.0)
    barrier = still.gravity * np.abs(still.a - still.b)
    loss = oracles.rolling.contact_loss_lift(a, b, gyration2, gravity)
    over = np.maximum(barrier - still.lift, 0)
    kinds = [
        np.zeros(count),
        barrier * 10 ** rng.uniform(-4, 0, count),
        over * rng.uniform(0.5, 1.5, count),
        np.maximum(loss - still.lift, 0) * rng.uniform(0, 1.2, count),
        loss * 10 ** rng.uniform(-1, 2, count),
    ]
    kinetic = np.choose(rng.choice(5, count, p=[0.1, 0.2, 0.25, 0.3, 0.15]), kinds)
    omega = np.sqrt(kinetic / (one.lift - still.lift)) * rng.choice([-1, 1], count)
    needed = oracles.rolling.extremes(one._replace(lift=still.lift + kinetic)).needed.astype(float)
    near = needed * (1 + rng.choice([-1, 1], count) * 10 ** rng.uniform(-5, -1, count))
    anything = 10 ** rng.uniform(-2, 0.7, count)
    choices = [rng.choice(FRICTIONS, count), anything, np.where(np.isfinite(needed), near, np.inf)]
    friction = np.choose(rng.integers(3, size=count), choices)
    return Sample(a, b, omega.astype(float), theta, friction, gravity, gyration2)
