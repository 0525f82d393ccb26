"""The numbers of the files are the doubles nearest to the motion of the scene in the file.

The methods differ from the maker's power series. Flights before the first impact, bounces of a flat
body, and a disc that slides down a slope have closed forms. For rolling: with s = theta, or theta =
theta_m cos s in a swing, the energy gives dt/ds in closed form. Times and paths are its integrals
in 40 digits, and the states at given times come from Newton's method.
"""

import json
from collections.abc import Callable
from typing import Any, NamedTuple

import mpmath
import pytest
from mpmath import mp, mpf
from oracles.paths import ROOT

FOLDER = ROOT / "python" / "rolling_ellipse" / "benchmark" / "problems"
ROLLING = ("brink.back", "brink.over", "roll.circle", "roll.rock", "roll.roll", "roll.thin")
DIGITS = 40


class Contact(NamedTuple):
    """Height of the centre, its derivative by theta, and the radius of curvature."""

    h: Any
    o: Any
    r: Any


class Rolling:
    """A body that rolls on level ground, from the numbers of a file."""

    def __init__(self, scene: dict[str, float]) -> None:
        self.mass, self.g, self.x = mpf(scene["mass"]), mpf(scene["gravity"]), mpf(scene["x"])
        self.a2, self.b2 = mpf(scene["a"]) ** 2, mpf(scene["b"]) ** 2
        self.k2 = mpf(scene["inertia"]) / self.mass
        theta, omega = mpf(scene["theta"]), mpf(scene["omega"])
        self.energy = self.inertia(theta) * omega**2 / 2 + self.g * self.contact(theta).h
        top = self.energy / self.g  # height at which it would turn
        self.swings = top**2 < self.a2 and self.a2 > self.b2
        if self.swings:
            self.most = mpmath.asin(mpmath.sqrt((top**2 - self.b2) / (self.a2 - self.b2)))
            self.top, self.s = top, mpf(0) if omega == 0 else -mp.pi / 2
        else:
            self.s = theta
        assert abs(self.theta(self.s) - theta) < mpf(10) ** (3 - DIGITS)

    def contact(self, theta: Any) -> Contact:
        sin, cos = mpmath.sin(theta), mpmath.cos(theta)
        h = mpmath.sqrt(self.a2 * sin**2 + self.b2 * cos**2)
        return Contact(h, (self.a2 - self.b2) * sin * cos / h, self.a2 * self.b2 / h**3)

    def inertia(self, theta: Any) -> Any:
        """About the contact, per mass."""
        h, o, _ = self.contact(theta)
        return self.k2 + h**2 + o**2

    def theta(self, s: Any) -> Any:
        return self.most * mpmath.cos(s) if self.swings else s

    def slowness(self, s: Any) -> Any:
        """dt/ds, without the difference of energies that cancels at a turn."""
        theta = self.theta(s)
        h = self.contact(theta).h
        if not self.swings:
            return mpmath.sqrt(self.inertia(theta) / 2 / (self.energy - self.g * h))
        below, above = self.most - theta, self.most + theta
        squares = (self.a2 - self.b2) * mpmath.sinc(below) * mpmath.sinc(above)
        return mpmath.sqrt(self.inertia(theta) * (self.top + h) / (2 * self.g * squares))

    def advance(self, s: Any) -> Any:
        """dx/ds."""
        slope = -self.most * mpmath.sin(s) if self.swings else 1
        return self.contact(self.theta(s)).h * slope

    def row(self, s: Any, x: Any) -> list[Any]:
        theta = self.theta(s)
        h, o, r = self.contact(theta)
        omega = (-self.most * mpmath.sin(s) if self.swings else 1) / self.slowness(s)
        alpha = -o * (self.g + r * omega**2) / self.inertia(theta)
        normal = self.mass * (self.g + o * alpha + (r - h) * omega**2)
        friction = self.mass * (h * alpha + o * omega**2)
        return [x, h, theta, h * omega, o * omega, omega, normal, friction]


def integral(of: Callable[[Any], Any], low: Any, high: Any) -> Any:
    """Gauss-Legendre, halved until two orders agree."""
    value, error = mp.quad(of, [low, high], method="gauss-legendre", error=True, maxdegree=5)
    if error < mpf(10) ** (4 - DIGITS):
        return value
    middle = (low + high) / 2
    return integral(of, low, middle) + integral(of, middle, high)


def nearest(value: Any) -> float:
    with mp.workprec(53):
        return float(+value) if abs(value) > mpf(10) ** (10 - DIGITS) else 0.0


def problem(name: str) -> Any:
    return json.loads((FOLDER / f"{name}.json").read_text(encoding="utf-8"))


def unlike(known: list[float], exact: list[Any]) -> list[tuple[float, float]]:
    """Numbers for which another double is nearer; midway between two, both count as nearest."""
    return [
        (p, q)
        for p, value in zip(known, exact, strict=True)
        if p != (q := nearest(value)) and abs(value - p) - abs(value - q) > mpf(10) ** (10 - DIGITS)
    ]


@pytest.mark.parametrize("name", ROLLING)
def test_each_value_is_the_double_nearest_to_the_exact_one(name: str) -> None:
    data, wrong = problem(name), []
    with mp.workdps(DIGITS + 5):
        body = Rolling(data["scene"])
        s, x, now = body.s, body.x, mpf(0)
        for t, *known in data["states"]:
            while abs(ahead := (mpf(t) - now) / body.slowness(s)) > mpf(10) ** (2 - DIGITS):
                ahead = min(ahead, mpf(1) / 4)
                now += integral(body.slowness, s, s + ahead)
                x += integral(body.advance, s, s + ahead)
                s += ahead
            wrong += unlike(known, body.row(s, x))
    assert wrong == [], f"{len(wrong)} of {8 * len(data['states'])}"


FLYING = [path.stem for path in sorted(FOLDER.glob("*.json")) if path.stem[:3] in ("hit", "law")]


@pytest.mark.parametrize("name", FLYING)
def test_a_flight_is_the_parabola_given_by_its_start(name: str) -> None:
    data = problem(name)
    with mp.workdps(DIGITS):
        x, z, theta, x_dot, z_dot, omega = (mpf(data["scene"][key]) for key in data["columns"][1:7])
        g, wrong, count = mpf(data["scene"]["gravity"]), [], 0
        for known in data["states"]:
            if known[0] < data["events"][0]["t"]:
                t, count = mpf(known[0]), count + 1
                place = [x + x_dot * t, z + (z_dot - g * t / 2) * t, theta + omega * t]
                wrong += unlike(known[1:], [*place, x_dot, z_dot - g * t, omega, mpf(0), mpf(0)])
    assert wrong == [] and count >= 1


def test_a_disc_slides_down_a_slope_under_constant_forces() -> None:
    data = problem("slide.slope")
    with mp.workdps(DIGITS):
        given = {key: mpf(value) for key, value in data["scene"].items()}
        weight, wrong = given["mass"] * given["gravity"], []
        normal = weight * mpmath.cos(given["slope"])
        friction = -given["friction"] * normal
        ahead = (weight * mpmath.sin(given["slope"]) + friction) / given["mass"]
        turning = -given["a"] * friction / given["inertia"]
        for known in data["states"]:
            t = mpf(known[0])
            place = [ahead * t**2 / 2, given["a"], turning * t**2 / 2]
            rates = [ahead * t, mpf(0), turning * t]
            wrong += unlike(known[1:], [*place, *rates, normal, friction])
    assert wrong == [] and len(data["states"]) > 20


def test_bounces_of_a_flat_body_are_equally_spaced_in_time() -> None:
    """From rest at z: the first after sqrt(2 (z - b)/g), the others after twice that."""
    data = problem("hit.bounce_flat")
    with mp.workdps(DIGITS):
        z, b, g = (mpf(data["scene"][key]) for key in ("z", "b", "gravity"))
        first = mpmath.sqrt(2 * (z - b) / g)
        known = [event["t"] for event in data["events"]]
        wrong = unlike(known, [(2 * k + 1) * first for k in range(len(known))])
        speeds = [event[side][4] for event in data["events"] for side in ("before", "after")]
        wrong += unlike(speeds, [-g * first, g * first] * len(known))
    assert wrong == [] and len(known) == 30
