"""`flow_jacobian` is right to 1e-3 from 1 s to 1e9 s, or raises ValueError.

The references compute no differences of motions. One half turn or one swing is integrated with
complex inputs, whose imaginary parts are the derivatives: n periods T move the state by -n T' times
its rates. A run on level ground is not periodic once the ground is tilted; its derivative is the
quadrature of dt/dslope. A circle has closed forms.
"""

import math
from typing import Any

import numpy as np
import pytest
from rolling_ellipse import Scene, flow, flow_jacobian, period
from scipy.integrate import cumulative_simpson, solve_ivp
from sensitivity import chain
from sensitivity.chain import support

GRAVITY = 9.81
TIMES = (1.0, 30.0, 1e3, 1e5, 1e6, 1e7, 1e8, 1e9)
SURE = 1e7  # until this time the rounding of the angle, 1e-8 rad, hides no derivative
GENTLE_SURE = 1e6  # its derivatives grow little, but the rounding of its phase as usual
TINY = 1e-6  # imaginary part of an input, in its natural size; its square is lost in rounding
RUN = {"a": 2.0, "b": 1.0, "theta": 0.3, "omega": 4.0}
FAST = {"a": 1.0, "b": 1.3, "theta": -1.0, "omega": -9.0}
NEARLY = {"a": 1.0, "b": 1.0 + 1e-7, "theta": 0.3, "omega": 4.0}
SWING = {"a": 2.0, "b": 1.0, "theta": 0.3, "omega": 1.0}
GENTLE = {"a": 2.0, "b": 1.0, "theta": 1e-4, "omega": 1e-4}
THIN = {"a": 1.0, "b": 0.1, "theta": 0.05, "omega": 0.5}
WELL = {"a": 2.0, "b": 1.0, "theta": 0.2, "omega": 0.5, "slope": 0.1}
PERIODIC = {"run": RUN, "fast": FAST, "nearly": NEARLY, "swing": SWING, "gentle": GENTLE}
PERIODIC |= {"thin": THIN, "well": WELL}
INPUTS = ("a", "b", "theta", "omega", "gravity", "gyration2", "slope")


def full(given: dict[str, float]) -> dict[str, float]:
    disc = (given["a"] ** 2 + given["b"] ** 2) / 4
    return {"gravity": GRAVITY, "slope": 0.0, "gyration2": disc} | given


def size_of(known: dict[str, float], name: str) -> float:
    spin = math.sqrt(known["gravity"] / max(known["a"], known["b"]))
    return {"theta": 1.0, "slope": 1.0, "omega": max(abs(known["omega"]), spin)}.get(
        name, known[name]
    )


def rates(known: dict[str, Any], theta: Any, omega: Any) -> Any:
    """Rates of theta, omega, x."""
    body, state = known | {"inertia": known["gyration2"], "mass": 1.0}, [0, 0, theta, 0, 0, omega]
    turn = chain.rates("ROLLING", 0, state, body)[5]
    return np.array([omega, turn, support(theta, body)[0] * omega])


def integrated(known: dict[str, float], name: str, t: float) -> tuple[Any, Any]:
    """State at a time, and its derivatives with respect to one input."""
    tiny = TINY * size_of(known, name)
    moved = known | {name: known[name] + 1j * tiny}
    if t == 0:
        start = np.array([moved["theta"], moved["omega"], 0j])
        return start.real, start.imag / tiny
    end = solve_ivp(
        lambda _, y: rates(moved, y[0], y[1]), (0, t), [moved["theta"], moved["omega"], 0j],
        method="DOP853", rtol=1e-13, atol=1e-14 * min(1.0, abs(known["omega"])),
    ).y[:, -1]  # fmt: skip
    return end.real, end.imag / tiny


def periodic(known: dict[str, float], name: str, t: float, state: Any) -> Any:
    """Derivatives after n periods and a rest; `state` is the state at the time."""
    scene = Scene(
        known["a"], known["b"], theta=known["theta"], omega=known["omega"],
        gravity=known["gravity"], slope=known["slope"], inertia=known["gyration2"],
    )  # fmt: skip
    whole = period(scene)
    count = t // whole
    after, moved = integrated(known, name, whole)
    speed = rates(known, known["theta"], known["omega"])
    assert abs(math.sin(after[0] - known["theta"])) < 1e-9
    longer = (float(name == "theta") - moved[0]) / speed[0]  # derivative of the period
    farther = moved[2] + longer * speed[2]  # derivative of the distance in a period
    rest = integrated(known, name, t - count * whole)[1]
    shift = np.array([0, 0, farther]) - longer * rates(known, *state[:2])
    return rest + count * shift


def tilted(known: dict[str, float], state: Any) -> Any:
    """Derivatives of a run with respect to the slope of level ground.

    dt/dslope = -g times the integral of x/(W |omega|^3), where x grows with each half turn. A half
    turn of 1e4 intervals has an error of 1e-12.
    """
    way = math.copysign(1.0, known["omega"])
    turns, rest = divmod(abs(state[0] - known["theta"]), math.pi)

    def parts(end: float) -> tuple[float, float, float]:
        """x, and the integrals of 1/(W |omega|^3) and x/(W |omega|^3) up to an angle."""
        angle = np.linspace(0.0, end, 10_001)
        theta = known["theta"] + way * angle
        h, h1, _ = support(theta, known)
        weight = known["gyration2"] + h**2 + h1**2
        energy = weight[0] * known["omega"] ** 2 / 2 + known["gravity"] * (h[0] - h)
        x = way * cumulative_simpson(h, x=angle, initial=0)
        share = 1 / (weight * (2 * energy / weight) ** 1.5)
        one, first = (cumulative_simpson(f, x=angle, initial=0)[-1] for f in (share, x * share))
        return x[-1], one, first

    (far, one, first), (x, last, late) = parts(math.pi), parts(rest)
    total = turns * first + far * one * turns * (turns - 1) / 2 + late + turns * far * last
    rate = rates(known, *state[:2])
    turned = rate[0] * known["gravity"] * way * total * way
    h = rate[2] / rate[0]
    raised = rates(known | {"slope": 0.5 * math.pi}, state[0], 0.0)[1]  # g h/W
    raised *= (turns * far + x) / h / rate[0]
    return np.array([turned, raised + rate[1] / rate[0] * turned, h * turned])


def check(t: float, given: dict[str, float], name: str, true: Any) -> bool:
    """Return whether the derivatives are returned; then they are right."""
    known = full(given)
    given = given | ({"gyration2": known["gyration2"]} if name != "t" else {})
    try:
        found = flow_jacobian(t, **given, wrt=name)[:, 0]
    except ValueError:
        return False
    length = max(known["a"], known["b"])
    units = np.array([1.0, math.sqrt(known["gravity"] / length), length])
    least = 1 / (size_of(known, name) if name != "t" else 1 / units[1])
    error = np.abs((found - true) / units).max() / max(np.abs(true / units).max(), least)
    assert error < 1e-3, (t, given, name, found, true)
    return True


@pytest.mark.parametrize("kind", PERIODIC)
def test_derivatives_of_periodic_motions_are_right_or_refused(kind: str) -> None:
    known, refused = full(PERIODIC[kind]), set()
    for t in TIMES:
        state = flow(t, **known)
        for name in INPUTS:
            runs = abs(state[0] - known["theta"]) > 2 * math.pi
            if name == "slope" and kind in ("run", "fast", "nearly"):
                true = tilted(known, state) if runs else integrated(known, name, t)[1]
            else:
                true = periodic(known, name, t, state)
            if not check(t, PERIODIC[kind], name, true):
                refused.add((name, t))
        assert check(t, PERIODIC[kind], "t", rates(known, *state[:2]))
    sure = GENTLE_SURE if kind == "gentle" else SURE
    assert not {(name, t) for name, t in refused if t <= sure}


@pytest.mark.parametrize("start", [RUN | {"slope": 0.1}, FAST | {"slope": -0.4},
                                   RUN | {"omega": -4.0, "slope": 0.05}])  # fmt: skip
def test_derivatives_on_slopes_are_right(start: dict[str, float]) -> None:
    """Down a slope, and up it and down again."""
    for t in (1.0, 5.0, 40.0):
        for name in INPUTS:
            assert check(t, start, name, integrated(full(start), name, t)[1])
        assert check(t, start, "t", rates(full(start), *flow(t, **start)[:2]))


@pytest.mark.parametrize("slope", [0.0, 0.2, -1.499])
def test_derivatives_of_circles_are_right_or_refused(slope: float) -> None:
    """omega' = g r sin(slope)/(k^2 + r^2). Only derivatives of 0 need no differences."""
    known = full({"a": 1.5, "b": 1.5, "theta": 0.3, "omega": 4.0, "slope": slope})
    weight = known["gyration2"] + 1.5**2
    push = GRAVITY * 1.5 * math.sin(slope) / weight
    for t in (*TIMES, 1e12) if slope == 0 else TIMES[:-2]:
        ramp, rolled = np.array([t**2 / 2, t, 1.5 * t**2 / 2]), np.array([t, 1.0, 1.5 * t])
        tilt = GRAVITY * 1.5 * math.cos(slope) / weight * ramp
        answers = {"omega": rolled, "slope": tilt, "gravity": push / GRAVITY * ramp}
        answers |= {"theta": np.array([1.0, 0.0, 0.0]), "gyration2": -push / weight * ramp}
        refused = {name for name, true in answers.items() if not check(t, known, name, true)}
        if slope == 0:
            assert refused <= (set() if t <= SURE else {"omega", "slope"})
        assert "theta" not in refused and (t > 1e3 or not refused)
        now = known["omega"] + push * t
        assert check(t, known, "t", np.array([now, push, 1.5 * now]))


def test_a_refusal_names_the_element_of_an_array_only() -> None:
    with pytest.raises(ValueError, match="got 'omega', where steps agree only to"):
        flow_jacobian(1e12, **RUN, wrt="omega")
    with pytest.raises(ValueError, match=r"got 'omega' at \[1\], where steps agree only to"):
        flow_jacobian([1.0, 1e12], **RUN, wrt=("t", "omega"))
