"""The contact model agrees with references of 30 digits (reference/make_contact_reference.py and,
with rolling resistance, make_resistance_reference.py).

Each event has a time and a state just after it. The unit of each of these values is its change when
every input changes by a relative 2.2e-16, including the shift of the event itself. Events must have
the same kinds in the same order, and every value must be within 8 units plus its rounding: an ulp
of the value itself, and the effect of two ulps of theta on the other values.
"""

import itertools
import math
from typing import NamedTuple

import numpy as np
import pytest
from numpy.typing import NDArray
from oracles import table
from oracles.geometry import support
from rolling_ellipse import EventKind, Scene, Status, simulate

STATE = ("theta", "omega", "x", "z", "x_dot", "z_dot")
VALUES = ("t", *STATE)
UNITS = 8  # claimed bound of the errors, in units of the table


class Motion(NamedTuple):
    """A scene with the kinds of its events and states, their values as decimal text (n, 7), and
    their units (n, 7)."""

    name: str
    scene: Scene
    kinds: list[str]
    values: list[list[str]]
    units: NDArray[np.float64]

    @property
    def rounding(self) -> NDArray[np.float64]:
        """Rounding errors of states in doubles (n, 7). An error of theta by two ulps also changes
        h, h' and their rates."""
        scene, values = self.scene, np.array(self.values, float)
        ulp: NDArray[np.float64] = np.spacing(np.abs(values))
        theta, omega = values[:, 1], np.abs(values[:, 2])
        h, dh, ddh = np.abs(np.array([support(each, scene.a, scene.b) for each in theta], float)).T
        moved = 2 * ulp[:, 1]
        effects = (0, 1, 0, h, dh, dh * omega, ddh * omega)
        return ulp + np.stack([np.broadcast_to(e * moved, theta.shape) for e in effects], axis=1)


def read_table() -> list[Motion]:
    """All scenes with their references, in the order of the tables."""
    lines = [*table.rows("contact_reference"), *table.rows("resistance_reference")]
    return [
        Motion(
            name,
            table.scene_of(rows[0]),
            [row["kind"] for row in rows],
            [[row[value] for value in VALUES] for row in rows],
            np.array([[float(row[f"unit_{value}"]) for value in VALUES] for row in rows]),
        )
        for name, group in itertools.groupby(lines, key=lambda row: row["name"])
        for rows in [list(group)]
    ]


MOTIONS = read_table()
each_motion = pytest.mark.parametrize("motion", MOTIONS, ids=[one.name for one in MOTIONS])


def shares(motion: Motion, values: list[list[float]]) -> NDArray[np.float64]:
    """Errors (n, 7) divided by the claimed bound; a time of 0 must be exact."""
    allowed = UNITS * motion.units + motion.rounding
    off: NDArray[np.float64] = table.differences(values, motion.values)
    return off / np.maximum(allowed, 1e-300)


@each_motion
def test_events_and_states_agree_with_a_30_digit_reference(motion: Motion) -> None:
    """Motions with a jam are simulated for 1 s, and must end at the jam."""
    rows = zip(motion.kinds, motion.values, strict=True)
    times = [float(values[0]) for kind, values in rows if kind == "state"]
    jams = "jam" in motion.kinds
    mine = simulate(motion.scene, 1.0 if jams else times, model="contact", raise_on_failure=False)
    kinds = [event.kind.name.lower() for event in mine.events]
    assert kinds == [kind for kind in motion.kinds if kind != "state"]
    assert mine.status is (Status.JAMMED if jams else Status.COMPLETED)
    after = ((each.t, each.state_after) for each in mine.events)
    events = ([t, *(getattr(state, name) for name in STATE)] for t, state in after)
    states = ([float(getattr(mine, name)[i]) for name in VALUES] for i in range(-len(times), 0))
    values = [next(states if kind == "state" else events) for kind in motion.kinds]
    assert shares(motion, values).max() <= 1


def test_an_error_of_1e_11_is_detected() -> None:
    """An error of 1e-11 in any value of a first event is more than ten times its bound."""
    for motion in MOTIONS:
        values = np.array(motion.values, float)
        off = shares(motion, (values + 1e-11 * np.maximum(np.abs(values), 1)).tolist())
        assert shares(motion, values.tolist()).max() <= 0.5  # doubles are half an ulp off
        assert off[0].min() > 10, motion.name


def test_the_tables_cover_all_kinds_of_events_and_bodies() -> None:
    kinds = [kind for one in MOTIONS for kind in one.kinds]
    least = {"slip": 30, "stick": 30, "reverse": 8, "lift_off": 12, "impact": 80}
    least |= {"rest": 3, "jam": 4, "state": 60}
    assert {kind: min(kinds.count(kind), count) for kind, count in least.items()} == least
    # test_blows_in_motion.py compares the motion after a blow with a motion that starts with it.
    kinds_known = {kind.name.lower() for kind in EventKind.__members__.values()}
    assert kinds_known - {"blow"} == set(least) - {"state"}
    scenes = [one.scene for one in MOTIONS]
    drops = [one.scene for one in MOTIONS if one.name.startswith("drop-")]
    wanted = itertools.product((0, 0.3, 0.8, 1), (0, 0.05, 0.2, 0.5, 1, math.inf))
    assert {(each.restitution, each.friction) for each in drops} == set(wanted)
    slope = np.array([each.slope for each in scenes])
    ratio = np.array([each.a / each.b for each in scenes])
    assert (slope > 0).sum() >= 10 and (slope < 0).sum() >= 10 and (slope == 0).sum() >= 20
    assert (ratio == 1).sum() >= 5 and (ratio < 0.9).sum() >= 15 and (ratio > 1.1).sum() >= 25
    assert (np.maximum(ratio, 1 / ratio) > 10).sum() >= 6
    assert sum(each.rolling_resistance > 0 for each in scenes) >= 40
    assert sum(each.mass != 1 for each in scenes) >= 30
    assert sum(each.gravity != 9.81 for each in scenes) >= 20
    assert sum(each.inertia is not None for each in scenes) >= 20
    # a larger unit would mean that the scene itself does not determine the answer
    assert max(one.units.max() for one in MOTIONS) <= 1e-9
