"""Random scenes on level ground, many at once, with the extremes of their motions."""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from rolling_ellipse import Scene

import oracles.geometry
import oracles.rolling
from oracles.numbers import PI, Long
from oracles.rolling import Motion

Floats = NDArray[np.float64]


class Sample(NamedTuple):
    """Scenes as columns; inertia = nan stands for a uniform disc."""

    a: Floats
    b: Floats
    mass: Floats
    gravity: Floats
    inertia: Floats
    friction: Floats
    theta: Floats
    omega: Floats

    def motion(self, rows: Any = slice(None)) -> Motion:
        """The rolling motions of the scenes, from exactly the doubles given to the package."""
        a, b, mass, gravity, inertia, _, theta, omega = (field[rows] for field in self)
        gyration2 = gyration2_of(a, b, mass, inertia)
        return oracles.rolling.motion(a, b, gyration2, gravity, theta, omega)

    def scene(self, row: int) -> Scene:
        a, b, mass, gravity, inertia, friction, theta, omega = (float(field[row]) for field in self)
        moment = None if math.isnan(inertia) else inertia
        state: dict[str, Any] = {"friction": friction, "theta": theta, "omega": omega}
        return Scene(a, b, mass=mass, gravity=gravity, inertia=moment, **state)

    def only(self, rows: Any) -> "Sample":
        return Sample(*(field[rows] for field in self))

    def arguments(self) -> dict[str, Floats]:
        """Arguments of `classify`."""
        gyration2 = gyration2_of(self.a, self.b, self.mass, self.inertia).astype(float)
        columns = self._asdict() | {"gyration2": gyration2}
        return {name: columns[name] for name in columns if name not in ("mass", "inertia")}


def gyration2_of(a: Floats, b: Floats, mass: Floats, inertia: Floats) -> Long:
    wide = [np.asarray(field, np.longdouble) for field in (a, b, mass, inertia)]
    return np.where(np.isnan(inertia), (wide[0] ** 2 + wide[1] ** 2) / 4, wide[3] / wide[2])


def random_bodies(count: int, rng: np.random.Generator) -> tuple[Floats, ...]:
    """Columns a, b, mass, gravity, inertia. a/b covers six decades; half of the shapes are
    ordinary, a tenth nearly circular. Half of the inertias are those of discs, the others range
    from nearly that of a point to that of a hoop."""
    thin, ordinary = rng.uniform(-2.999, 2.999, count), rng.uniform(-1.1, 1.1, count)
    ratio = 10 ** np.where(rng.random(count) < 0.5, thin, ordinary)
    circular = 1 + rng.choice([-1, 1], count) * 10 ** rng.uniform(-8, -1, count)
    ratio = np.where(rng.random(count) < 0.1, circular, ratio)
    b = 10 ** rng.uniform(-2, 2, count)
    a = b * ratio
    mass, gravity = 10 ** rng.uniform(-2, 3, count), 10 ** rng.uniform(-1, 2, count)
    inertia = mass * np.maximum(a, b) ** 2 * 10 ** rng.uniform(-3, 0, count)
    return a, b, mass, gravity, np.where(rng.random(count) < 0.5, np.nan, inertia)


def random_lifts(still: Motion, loss: Long, rng: np.random.Generator) -> Long:
    """E/m above rest in the flat position: swings of all sizes, rotations up to and beyond the loss
    of contact, and many values close to the separatrix and to the loss of contact."""
    count = still.a.size
    barrier = still.gravity * np.abs(still.a - still.b)
    side = rng.choice([-1, 1], count)
    kinds = [
        barrier * rng.uniform(0, 1, count),
        barrier * 10 ** rng.uniform(-5, 0, count),
        barrier + np.abs(loss - barrier) * rng.uniform(0, 1, count),
        loss * 10 ** rng.uniform(-0.5, 2, count),
        barrier * (1 + side * 10 ** rng.uniform(-12, -2, count)),
        loss * (1 + side * 10 ** rng.uniform(-9, -2, count)),
    ]
    chosen: Long = np.choose(rng.integers(len(kinds), size=count), kinds)
    return chosen


def random_states(moving: Motion, rng: np.random.Generator) -> tuple[Floats, Floats]:
    """theta and omega at a random point of each motion, up to 300 turns away. A tenth of the bodies
    are at rest, some of them flat."""
    count = moving.a.size
    on = oracles.rolling.chart(moving)
    sine, cosine = on.sides(on.top * rng.uniform(0, 1, count))
    phi = np.arctan2(sine, cosine) * rng.choice([-1, 1], count)
    far = np.where(rng.random(count) < 0.3, 600, 2)
    lies = moving.a >= moving.b
    flat = np.where(lies, 0, PI / 2) + PI * np.round(far * rng.uniform(-1, 1, count))
    theta = (flat + phi).astype(float)
    sides = oracles.geometry.reduced(theta, moving.a, moving.b)
    omega = oracles.rolling.speed(moving, *sides).astype(float)
    at_rest = rng.random(count)
    theta = np.where((at_rest < 0.05) & lies, 0.0, theta)
    return theta, np.where(at_rest < 0.1, 0.0, omega) * rng.choice([-1, 1], count)


def random_frictions(needed: Long, rng: np.random.Generator) -> Floats:
    """Infinite friction, no friction, values from 0.05 to 2, and values that differ from the needed
    friction by a relative 1e-9 to 0.1."""
    count = needed.size
    near = needed * (1 + rng.choice([-1, 1], count) * 10 ** rng.uniform(-9, -1, count))
    anything = 10 ** rng.uniform(np.log10(0.05), np.log10(2.0), count)
    near = np.where((needed > 0.01) & (needed < 3), near, anything)
    kinds = [np.full(count, np.inf), np.zeros(count), anything, anything, near, near, near]
    return np.choose(rng.integers(len(kinds), size=count), kinds).astype(float)


def random_sample(count: int, seed: int) -> tuple[Sample, oracles.rolling.Extremes]:
    """Random scenes and the extremes of their motions, which do not depend on friction."""
    rng = np.random.default_rng(seed)
    a, b, mass, gravity, inertia = random_bodies(count, rng)
    gyration2 = gyration2_of(a, b, mass, inertia)
    loss = oracles.rolling.contact_loss_lift(a, b, gyration2, gravity)
    still = oracles.rolling.motion(a, b, gyration2, gravity, np.where(a >= b, 0.0, np.pi / 2), 0.0)
    theta, omega = random_states(still._replace(lift=random_lifts(still, loss, rng)), rng)
    frictionless = Sample(a, b, mass, gravity, inertia, np.zeros(count), theta, omega)
    truth = oracles.rolling.extremes(frictionless.motion())
    return frictionless._replace(friction=random_frictions(truth.needed, rng)), truth
