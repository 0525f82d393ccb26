"""The contact model agrees with 30 digits (reference/make_contact_reference.py).

Every event has a time and a state just after it, each with a unit: its change when every input
changes by a relative 2.2e-16, the shift of the event itself included. The claim: events of the same
kinds in the same order, every value within 8 units plus the rounding of the two doubles that
represent it, which is an ulp of the value itself and the effect of two ulp of theta on the other
values.
"""

import functools
import itertools
import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import mpmath
import numpy as np
import pytest
from numpy.typing import NDArray
from oracles import table
from oracles.geometry import Support, support
from rolling_ellipse import EventKind, Scene, Status, simulate

INPUTS = (
    "a", "b", "mass", "gravity", "inertia", "slope", "friction", "restitution", "theta", "omega",
    "x", "z", "x_dot", "z_dot",
)  # fmt: skip
VALUES = ("t", "theta", "omega", "x", "z", "x_dot", "z_dot")
COLUMNS = {name: name + "0" if name in VALUES else name for name in INPUTS}  # field: column
UNITS = 8  # claimed largest error, in units of the table


class Motion(NamedTuple):
    """A scene with kinds, values as decimal text (n, 7) and units (n, 7) of its events and end."""

    name: str
    parameters: dict[str, float]
    kinds: list[str]
    values: list[list[str]]
    units: NDArray[np.float64]

    @property
    def family(self) -> str:
        """The name without its number."""
        return self.name.rsplit("-")[0]

    @property
    def scene(self) -> Scene:
        """The scene of the table's parameters."""
        parameters: dict[str, Any] = dict(self.parameters)
        return Scene(parameters.pop("a"), parameters.pop("b"), **parameters)

    @property
    def gyration2(self) -> float:
        """k^2 = I/m [m^2]."""
        p = self.parameters
        disc = p["mass"] * (p["a"] ** 2 + p["b"] ** 2) / 4
        return p.get("inertia", disc) / p["mass"]

    @property
    def rounding(self) -> NDArray[np.float64]:
        """Rounding of a state of doubles (n, 7): theta is known to an ulp or two.

        h, h' and their rates change with theta.
        """
        p, values = self.parameters, np.array(self.values, float)
        ulp: NDArray[np.float64] = np.spacing(np.abs(values))
        theta, omega = values[:, 1], np.abs(values[:, 2])
        h, dh, ddh = np.abs(np.array([support(each, p["a"], p["b"]) for each in theta], float)).T
        moved = 2 * ulp[:, 1]
        effects = (0, 1, 0, h, dh, dh * omega, ddh * omega)
        return ulp + np.stack([np.broadcast_to(e * moved, theta.shape) for e in effects], axis=1)

    @property
    def sizes(self) -> NDArray[np.float64]:
        """Sizes of the values (n, 7); the tests of the judge change a value by 1e-9 of its size.

        A time has its own size. A component of the state that passes through zero does not measure
        a method's error, so a size belongs to the state as a whole: for theta a radian at least,
        because the shape depends on it like that; for the centre the longer semi-axis, by which a
        turn moves it; for rates the speed V, where m V^2/2 is the kinetic energy plus the weight
        times the longer semi-axis, and V/k.
        """
        p, values = self.parameters, np.array(self.values, float)
        longer, k2 = max(p["a"], p["b"]), self.gyration2
        t, theta, omega, x, z, x_dot, z_dot = np.abs(values).T
        speed = np.sqrt(x_dot**2 + z_dot**2 + k2 * omega**2 + 2 * p["gravity"] * longer)
        columns = (
            t, np.maximum(theta, 1), speed / math.sqrt(k2), np.maximum(x, longer),
            np.maximum(z, longer), speed, speed,
        )  # fmt: skip
        return np.stack(columns, axis=1)


def read_table() -> list[Motion]:
    """The scenes of the table with their references, in its order."""
    lines = table.rows("contact_reference")
    return [
        Motion(
            name,
            {name: float(rows[0][c]) for name, c in COLUMNS.items() if rows[0][c]},
            [row["kind"] for row in rows],
            [[row[value] for value in VALUES] for row in rows],
            np.array([[float(row[f"unit_{value}"]) for value in VALUES] for row in rows]),
        )
        for name, group in itertools.groupby(lines, key=lambda row: row["name"])
        for rows in [list(group)]
    ]


MOTIONS = read_table()
each_motion = pytest.mark.parametrize("motion", MOTIONS, ids=[one.name for one in MOTIONS])


# ------------------------------------------------------------------------------ comparison


class Computed(NamedTuple):
    """Kinds and values (n, 7) of the package's events and last sample, and its status."""

    kinds: list[str]
    values: list[list[float]]
    status: Status


def computed(scene: Scene, end: float) -> Computed:
    """The package's answer; a jam at the start (end = 0) also ends a simulation of 1 s."""
    found = simulate(scene, end or 1.0, model="contact", raise_on_failure=False)
    rows = [
        [event.t, *(getattr(event.state_after, name) for name in VALUES[1:])]
        for event in found.events
    ]
    last = [float(getattr(found, name)[-1]) for name in VALUES]
    return Computed([one.kind.name.lower() for one in found.events], [*rows, last], found.status)


@functools.cache
def answer(number: int) -> Computed:
    """The package's answer to a scene of the table."""
    motion = MOTIONS[number]
    return computed(motion.scene, float(motion.values[-1][0]))


def errors(motion: Motion, values: list[list[float]]) -> NDArray[np.float64]:
    """|value - reference| (n, 7)."""
    differences = [
        [abs(table.difference(v, e)) for v, e in zip(*pair, strict=True)]
        for pair in zip(values, motion.values, strict=True)
    ]
    return np.array(differences)


def shares(motion: Motion, values: list[list[float]]) -> NDArray[np.float64]:
    """Errors (n, 7) divided by the claimed bound; a time 0 must be exact."""
    allowed = UNITS * motion.units + motion.rounding
    found: NDArray[np.float64] = errors(motion, values) / np.maximum(allowed, 1e-300)
    return found


# ----------------------------------------------------------------------------- the package


@each_motion
def test_events_and_states_are_right(motion: Motion) -> None:
    """Kinds of events agree, and times and states have the claimed accuracy."""
    found = answer(MOTIONS.index(motion))
    assert [*found.kinds, "state"] == motion.kinds
    assert found.status is (Status.JAMMED if "jam" in motion.kinds else Status.COMPLETED)
    assert shares(motion, found.values).max() <= 1


def test_an_error_of_1e_9_is_seen() -> None:
    """The judge is sharp: 1e-9 of the size of any value of a first event exceeds ten bounds."""
    for motion in MOTIONS:
        values = np.array(motion.values, float)
        off = shares(motion, (values + 1e-9 * motion.sizes).tolist())
        assert shares(motion, values.tolist()).max() <= 0.5  # doubles are half an ulp off
        assert off[0, motion.sizes[0] > 0].min() > 10, motion.name


def test_a_small_change_of_an_input_is_seen() -> None:
    """1e-9 more gravity is seen in every scene in which anything moves."""
    compared = 0
    for motion in MOTIONS:
        if "jam" in motion.kinds:
            continue
        heavier = {**motion.parameters, "gravity": motion.parameters["gravity"] * (1 + 1e-9)}
        changed = motion._replace(parameters=heavier)
        found = computed(changed.scene, float(motion.values[-1][0]))
        if [*found.kinds, "state"] == motion.kinds:
            assert shares(motion, found.values).max() > 1, motion.name
            compared += 1
    assert compared >= 100  # of 110: jams, and motions that reach other events, are left out


# ------------------------------------------------------------------------------- the table


def test_table_covers_what_it_promises() -> None:
    """The table has all kinds of events, friction, restitution, slopes, round and thin bodies."""
    kinds = [kind for one in MOTIONS for kind in one.kinds]
    least = {"slip": 30, "stick": 30, "reverse": 8, "lift_off": 12, "impact": 80}
    least |= {"rest": 3, "jam": 4, "state": 60}
    assert {kind: min(kinds.count(kind), count) for kind, count in least.items()} == least
    assert {kind.name.lower() for kind in EventKind.__members__.values()} == set(least) - {"state"}
    drops = [one.parameters for one in MOTIONS if one.family == "drop"]
    wanted = itertools.product((0, 0.3, 0.8, 1), (0, 0.05, 0.2, 0.5, 1, math.inf))
    assert {(p["restitution"], p["friction"]) for p in drops} == set(wanted)
    columns = {
        name: np.array([one.parameters.get(name, math.nan) for one in MOTIONS]) for name in INPUTS
    }
    slope, ratio = columns["slope"], columns["a"] / columns["b"]
    assert (slope > 0).sum() >= 10 and (slope < 0).sum() >= 10 and (slope == 0).sum() >= 20
    assert (ratio == 1).sum() >= 5 and (ratio < 0.9).sum() >= 15 and (ratio > 1.1).sum() >= 25
    assert (np.maximum(ratio, 1 / ratio) > 10).sum() >= 6
    assert (columns["mass"] != 1).sum() >= 30 and (columns["gravity"] != 9.81).sum() >= 20
    assert np.isfinite(columns["inertia"]).sum() >= 20
    # a larger unit would mean that the scene itself does not determine the answer
    assert max(one.units.max() for one in MOTIONS) <= 1e-9


class Laws:
    """A scene in mpf, and the laws for its states (theta, omega, x, z, x_dot, z_dot)."""

    def __init__(self, motion: Motion) -> None:
        p = {name: mpmath.mpf(value) for name, value in motion.parameters.items()}
        self.a, self.b, self.mu, self.e = p["a"], p["b"], p["friction"], p["restitution"]
        disc = p["mass"] * (self.a**2 + self.b**2) / 4
        self.k2 = p.get("inertia", disc) / p["mass"]
        self.down = p["gravity"] * mpmath.sin(p["slope"])
        self.level = p["gravity"] * mpmath.cos(p["slope"])
        h, arm, _ = self.support(p["theta"])
        place = p["theta"], p["omega"], p["x"]
        if "z" in p:
            self.start = (*place, p["z"], p.get("x_dot", 0), p.get("z_dot", 0))
        else:
            self.start = (*place, h, p.get("x_dot", h * p["omega"]), arm * p["omega"])

    def support(self, theta: Any) -> Support:
        return support(theta, self.a, self.b)

    def flown(self, state: Any, t: Any) -> tuple[Any, ...]:
        """State after a flight of time t."""
        theta, omega, x, z, x_dot, z_dot = state
        x, z = x + (x_dot + self.down * t / 2) * t, z + (z_dot - self.level * t / 2) * t
        return theta + omega * t, omega, x, z, x_dot + self.down * t, z_dot - self.level * t

    def motion(self, state: Any) -> tuple[Any, Any, Any]:
        """Slip, gap rate, and the size of their terms."""
        theta, omega, _, _, x_dot, z_dot = state
        h, arm, _ = self.support(theta)
        size = abs(x_dot) + abs(z_dot) + (h + abs(arm)) * abs(omega) + mpmath.sqrt(self.level * h)
        return x_dot - h * omega, z_dot - arm * omega, size

    def forces(self, state: Any) -> tuple[Any, Any, Any, Any]:
        """c, N and F of rolling per mass, and the size of their terms."""
        theta, omega = state[:2]
        h, arm, bend = self.support(theta)
        spin = omega**2
        spin_up = self.down * h - arm * (self.level + (h + bend) * spin)
        spin_up /= self.k2 + h**2 + arm**2
        c = self.level + bend * spin
        friction = h * spin_up + arm * spin - self.down
        size = self.level + abs(self.down) + (h + abs(arm) + abs(bend)) * (spin + abs(spin_up))
        return c, c + arm * spin_up, friction, size

    def collided(self, before: Any, after: Any) -> None:
        """Newton's and Coulomb's laws hold, energy never grows, and e holds while slip lasts."""
        h, arm, _ = self.support(after[0])
        slip, rate, size = self.motion(before)
        new_slip, new_rate, new_size = self.motion(after)
        small = SMALL * (size + new_size)
        along, away = after[4] - before[4], after[5] - before[5]
        assert rate < 0 and new_rate > -small and away > -small
        turned = self.k2 * (after[1] - before[1]) + h * along + arm * away
        assert abs(turned) < small * (self.k2 / h + h + abs(arm))
        if not mpmath.isinf(self.mu):
            assert abs(along) < self.mu * away + small
        assert along * (slip + new_slip) + away * (rate + new_rate) < small * (size + new_size)
        if self.mu == 0 or (not mpmath.isinf(self.mu) and slip * new_slip > small * size):
            assert abs(along + self.mu * away * mpmath.sign(slip)) < small
            assert abs(new_rate + self.e * rate) < small


SMALL = mpmath.mpf("1e-23")


@each_motion
def test_table_keeps_the_laws(motion: Motion) -> None:
    """The table's numbers, computed in another coordinate, satisfy the laws of the support
    function.

    The numbers are rounded at 5e-30; 1e-23 of the added terms exceeds all roundings.
    """
    with mpmath.workdps(50):
        laws = Laws(motion)
        last: Sequence[Any] = laws.start
        then, flying = mpmath.mpf(0), motion.kinds[0] == "impact"
        for kind, texts in zip(motion.kinds, motion.values, strict=True):
            t, *state = map(mpmath.mpf, texts)
            slip, rate, size = laws.motion(state)
            h = laws.support(state[0])[0]
            if flying and kind != "rest":  # rest comes after infinitely many bounces
                flown = laws.flown(last, t - then)
                for i in (0, 2, 3) if kind == "impact" else range(6):
                    assert abs(flown[i] - state[i]) < SMALL * (1 + abs(state[i]) + size)
                if kind == "impact":
                    laws.collided(flown, state)
            else:
                assert kind != "impact"
            if kind != "state" or not flying:
                assert abs(state[3] - h) < SMALL * h
            if kind in ("slip", "stick", "reverse", "lift_off", "rest", "jam"):
                assert abs(rate) < SMALL * size
            if kind in ("slip", "stick", "reverse", "rest"):
                assert abs(slip) < SMALL * size
            c, normal, friction, terms = laws.forces(state)
            if kind == "lift_off" and abs(slip) > SMALL * size:
                assert abs(c) < SMALL * terms
            elif kind == "slip" and mpmath.isinf(laws.mu):
                assert abs(normal) < SMALL * terms
            elif kind == "slip":
                assert abs(abs(friction) - laws.mu * normal) < SMALL * terms * (1 + laws.mu)
            elif kind == "stick":
                assert normal > 0 and abs(friction) <= laws.mu * normal
            opens = rate > SMALL * size or c < 0
            flying = kind == "lift_off" or (kind == "impact" and opens)
            last, then = state, t
