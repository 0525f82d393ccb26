"""The numbers in the problem files are the doubles nearest to the exact motion of their scene.

The files were generated with power series; these tests use other methods. Flights before the first
impact, bounces of a body that lies flat, and a disc that slides down a slope have closed forms.
Rolling is computed with 45 digits from the energy integral of reference/make_rolling_reference.py,
and its forces from Newton's second law.
"""

import json
from functools import cache
from typing import Any

import make_rolling_reference as reference
import mpmath
import pytest
from mpmath import mp, mpf
from oracles.paths import ROOT

FOLDER = ROOT / "python" / "rolling_ellipse" / "benchmark" / "problems"
ROLLING = ("brink.back", "brink.over", "roll.circle", "roll.rock", "roll.roll", "roll.thin")
DIGITS = 40


@cache
def rule() -> reference.Rule:
    """Gauss rule with 40 nodes on each panel, and panels that grow by a factor of 1.8. It is
    accurate to DIGITS digits."""
    return reference.gauss_rule(40, 1.8)


def rolled(scene: dict[str, float], t: Any) -> list[Any]:
    """State and forces at time t of a body that rolls from the start in a problem file."""
    a, b, mass, inertia, g = (mpf(scene[key]) for key in ("a", "b", "mass", "inertia", "gravity"))
    k2 = inertia / mass
    start = reference.Scene(a, b, k2, g, mpf(scene["theta"]), mpf(scene["omega"]))
    theta, omega, x = moving(start).state(t)
    sin, cos = mpmath.sin(theta), mpmath.cos(theta)
    h = mpmath.sqrt(a**2 * sin**2 + b**2 * cos**2)
    o, r = (a**2 - b**2) * sin * cos / h, a**2 * b**2 / h**3
    alpha = -o * (g + r * omega**2) / (k2 + h**2 + o**2)
    forces = g + o * alpha + (r - h) * omega**2, h * alpha + o * omega**2
    return [scene["x"] + x, h, theta, h * omega, o * omega, omega, *(mass * f for f in forces)]


@cache
def moving(start: reference.Scene) -> reference.RollingEllipse | reference.RollingCircle:
    return reference.motion(start, rule())


def nearest(value: Any) -> float:
    with mp.workprec(53):
        return float(+value) if abs(value) > mpf(10) ** (10 - DIGITS) else 0.0


def problem(name: str) -> Any:
    return json.loads((FOLDER / f"{name}.json").read_text(encoding="utf-8"))


def unlike(known: list[float], exact: list[Any]) -> list[tuple[float, float]]:
    """Each stored number that is not the nearest double, paired with that double. If the exact
    value is midway between two doubles, both count as nearest."""
    return [
        (p, q)
        for p, value in zip(known, exact, strict=True)
        if p != (q := nearest(value)) and abs(value - p) - abs(value - q) > mpf(10) ** (10 - DIGITS)
    ]


@pytest.mark.parametrize("name", ROLLING)
def test_rolling_problems_store_the_doubles_nearest_to_the_exact_values(name: str) -> None:
    data = problem(name)
    with mp.workdps(DIGITS + 5):
        rows = ((known, rolled(data["scene"], mpf(t))) for t, *known in data["states"])
        wrong = [pair for known, exact in rows for pair in unlike(known, exact)]
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
    """A fall from rest at z takes sqrt(2 (z - b)/g), and each later flight twice that time."""
    data = problem("hit.bounce_flat")
    with mp.workdps(DIGITS):
        z, b, g = (mpf(data["scene"][key]) for key in ("z", "b", "gravity"))
        first = mpmath.sqrt(2 * (z - b) / g)
        known = [event["t"] for event in data["events"]]
        wrong = unlike(known, [(2 * k + 1) * first for k in range(len(known))])
        speeds = [event[side][4] for event in data["events"] for side in ("before", "after")]
        wrong += unlike(speeds, [-g * first, g * first] * len(known))
    assert wrong == [] and len(known) == 30
