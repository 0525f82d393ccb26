"""Hypothesis strategies for bodies, grounds, starts and times over the accepted ranges."""

import math
from typing import Any

from hypothesis import strategies as st
from rolling_ellipse import Impulse, Scene, geometry

from oracles.numbers import EPS

Draw = Any  # the argument that st.composite passes

#: Angles on and near quarter turns.
QUARTERS = st.builds(
    lambda k, beside: k * math.pi / 2 + beside,
    st.integers(-9, 9),
    st.sampled_from([0.0, 1e-90, 1e-9, -1e-6, 1e-3]),
)
SIGNS = st.sampled_from([1.0, -1.0])


def numbers(low: float, high: float) -> st.SearchStrategy[float]:
    """Numbers in a range; those up to 1e-100 in magnitude become 0."""
    return st.floats(low, high).map(lambda value: value if abs(value) > 1e-100 else 0.0)


def powers(low: float, high: float) -> st.SearchStrategy[float]:
    """Positive numbers between 10^low and 10^high, with uniformly distributed exponents."""
    return st.floats(low, high).map(lambda exponent: 10.0**exponent)


ANGLES = st.one_of(numbers(-4.0, 4.0), QUARTERS, numbers(-1e4, 1e4))
FRICTIONS = st.one_of(
    st.sampled_from([0.0, math.inf]),
    numbers(0.0, 3.0),
    st.builds(pow, st.just(10.0), st.floats(-3, 4)),
)
SLOPES = st.one_of(numbers(-1.5, 1.5), st.builds(math.copysign, st.floats(1e-6, 0.3), SIGNS))


@st.composite
def bodies(draw: Draw, thinnest: float = 3.0) -> dict[str, float]:
    """a, b, gravity and gyration2 of circles, near circles and thin bodies, lying or standing."""
    size = draw(powers(-3, 3))
    near = st.builds(lambda e, s: 1 + s * 10.0**e, st.floats(-15, -1), SIGNS)
    thin = st.floats(-thinnest, thinnest).map(lambda exponent: 10.0**exponent)
    ratio = draw(st.one_of(st.just(1.0), near, st.floats(0.3, 3.0), thin))
    limit = 1e3 * (1 - 1e-9)  # ratios up to this are accepted even after a and b are rounded
    ratio = min(max(ratio, 1 / limit), limit)
    a, b = (size, size / ratio) if ratio > 1 else (size * ratio, size)
    spread2 = max(a, b) ** 2
    shares = powers(-6, 0).map(lambda share: share * spread2)
    gravity = draw(powers(-1, 2))
    gyration2 = draw(st.one_of(st.just((a * a + b * b) / 4), shares))
    return {"a": a, "b": b, "gravity": gravity, "gyration2": gyration2}


def rate(body: dict[str, float]) -> float:
    """Rate at which a body falls over, sqrt(g/long) [1/s]."""
    return math.sqrt(body["gravity"] / max(body["a"], body["b"]))


@st.composite
def motions(draw: Draw, thinnest: float = 3.0) -> dict[str, float]:
    """A rolling body, from slow rocking to fast turning."""
    body = draw(bodies(thinnest))
    speed = draw(st.one_of(st.just(0.0), powers(-6, 2), st.floats(0.1, 5.0)))
    omega = draw(SIGNS) * speed * rate(body)
    return {"theta": draw(ANGLES), "omega": omega, **body}


@st.composite
def spans(draw: Draw, motion: dict[str, float], most: float) -> float:
    """A time [s] of at most `most` half turns or swings."""
    half_turns = draw(powers(-3, math.log10(most)))
    return float(half_turns * math.pi / max(abs(motion["omega"]), rate(motion)))


def at_its_limit(values: dict[str, Any]) -> dict[str, Any]:
    """The omega that makes the body weightless, h'' omega^2 = -g cos(slope), if friction is below 1
    and such a speed exists; otherwise the friction that rolling needs, to within rounding."""
    a, b, theta, slope = (values[name] for name in ("a", "b", "theta", "slope"))
    h, tilt = geometry.support(theta, a=a, b=b), geometry.support_slope(theta, a=a, b=b)
    radius = (a * b) ** 2 / h**3
    into, along = values["gravity"] * math.cos(slope), values["gravity"] * math.sin(slope)
    if radius < h and values["friction"] < 1:
        omega = math.copysign(math.sqrt(into / (h - radius)), values["omega"])
        return {"omega": omega} if abs(omega) < 1e5 * rate(values) else {}
    spin2 = values["omega"] ** 2
    inertia = values["inertia"] / values["mass"] + h**2 + tilt**2
    acceleration = (along * h - tilt * (into + radius * spin2)) / inertia
    normal = into + tilt * acceleration + (radius - h) * spin2
    needed = abs(h * acceleration + tilt * spin2 - along)
    return {"friction": needed / normal} if 0 < needed < 1e4 * normal else {}


@st.composite
def scene_arguments(draw: Draw, /, **given: Any) -> dict[str, Any]:
    """Keyword arguments of a Scene on any ground, in any state, some with a blow or at a limit."""
    of = draw(motions(thinnest=1.5))
    mass = draw(powers(-2, 2))
    values = {
        **{name: of[name] for name in ("a", "b", "gravity", "theta", "omega")},
        "mass": mass,
        "inertia": mass * of["gyration2"],
        "slope": draw(st.one_of(st.just(0.0), SLOPES)),
        "friction": draw(FRICTIONS),
        "restitution": draw(st.one_of(st.sampled_from([0.0, 1.0]), numbers(0.0, 1.0))),
        **given,
    }
    if draw(st.integers(0, 7)) == 7:
        for name, value in at_its_limit(values).items():
            if name not in given:
                values[name] = value * (1 + draw(st.integers(-3, 3)) * EPS / 2)
    start = draw(st.sampled_from(["rolling", "sliding", "air", "struck"]))
    speed = rate(of) * max(of["a"], of["b"])
    if start == "sliding":
        values["x_dot"] = draw(numbers(-3.0, 3.0)) * speed
    elif start == "air":
        height = geometry.support(of["theta"], a=of["a"], b=of["b"])
        values["z"] = height * (1 + draw(powers(-2, 1)))
        values["x_dot"] = draw(numbers(-3.0, 3.0)) * speed
        values["z_dot"] = draw(numbers(-3.0, 3.0)) * speed
    elif start == "struck":
        reach = min(of["a"], of["b"])
        jx, jz = (draw(numbers(-2.0, 2.0)) * mass * speed for _ in range(2))
        dx, dz = (draw(numbers(-0.7, 0.7)) * reach for _ in range(2))
        values["impulse"] = Impulse(jx=jx, jz=jz, dx=dx, dz=dz)
    return values


def scenes(**given: Any) -> st.SearchStrategy[Scene]:
    return scene_arguments(**given).map(lambda values: Scene(**values))


def clock(scene: Scene) -> float:
    """Time in which a body falls over [s]."""
    return math.sqrt(max(scene.a, scene.b) / scene.gravity)
