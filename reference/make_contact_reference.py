"""Compute `contact_reference.csv`: rolling, sliding, flight and impacts, to 30 digits.

The tests compare the contact model with this table. contact_motion.py computes the motions.

    python make_contact_reference.py            computes and checks the table (15 minutes, one core)

Every value was computed twice, with series of order 50 and 60 and with 64 and 76 digits. The two
values must agree to `AGREEMENT`, relative to magnitudes above 1; the largest difference was
6.0e-47. The energy minus the work of friction and of the impacts must be constant to `AGREEMENT` of
its magnitude; the largest sum of changes was 2.6e-51.

Units. The unit of an answer y is the effect of a relative change of 2.2e-16 of each input (theta0:
absolute). Answers are the time of an event and the state just after the event; the effect on the
state includes the effect of the changed time:

    unit_y = 2.2e-16 (sum over p of |dy/dp| |p| + |dy/dtheta0|)

over p in (a, b, mass, I, g, alpha, mu, e, omega0, x0, z0, x_dot0, z_dot0), computed from one-sided
differences of 1e-12 with 42 digits. Inputs other than I that are zero, infinite or omitted are left
out, as is theta0 of a body dropped flat. A scene is rejected if the kinds of its events change with
an input. A scene ends before the first event with a unit above `UNIT_LIMIT`, because the inputs do
not determine later answers.

A scene has a row for each event, and a row `state` for its end. A jam ends a scene.
"""

import math
import random
import time
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import gmpy2
from contact_motion import VALUES, Body, Row, Scene, Undecided, follow, peak_of_friction, rows_of
from gmpy2 import mpfr
from runs import ROUNDING, log_uniform, write_table
from series import Road

TABLE = Path(__file__).with_name("contact_reference.csv")
AGREEMENT = 1e-34
UNIT_LIMIT = 1e-9
FIELDS = [name for name in Scene._fields if name != "rolling_resistance"]
RESULTS = ["event", *Row._fields, *(f"unit_{name}" for name in VALUES)]
TABLE_ROAD = Road(64, 50, 1e-50)
CHECK_ROAD = Road(76, 60, 1e-57)
UNIT_ROAD = Road(42, 30, 1e-31)
UNIT_CHANGE = 1e-12
MOST_EVENTS = 6


def inputs(fields: list[str]) -> list[str]:
    """Return the columns of a scene's fields; fields that a motion changes have the suffix 0."""
    return [name + "0" if name in VALUES else name for name in fields]


# ---------------------------------------------------------------- units


def is_flat_drop(scene: Scene) -> bool:
    """Return whether a body drops at theta = 0 on level ground, without spin or slip.

    Any other angle would change the kind of motion.
    """
    moving = scene.theta or scene.omega or scene.x_dot or scene.slope
    return scene.z is not None and not moving


def units(scene: Scene, ends: Sequence[float]) -> list[list[float]]:
    """Return the units of all events and of the states at some times."""
    with UNIT_ROAD.context():
        rows, _ = rows_of(scene, ends, UNIT_ROAD)
        total = [[mpfr(0)] * len(VALUES) for _ in rows]
        k2 = Body(scene).k2
        for name in Scene._fields:
            old = mpfr(scene.mass) * k2 if name == "inertia" else getattr(scene, name)
            if name == "mass" or (name == "theta" and is_flat_drop(scene)):
                continue
            if old is None or not gmpy2.is_finite(mpfr(old)) or (old == 0 and name != "theta"):
                continue
            old = mpfr(old)
            change = UNIT_CHANGE if name == "theta" else UNIT_CHANGE * old
            changed, _ = rows_of(scene._replace(**{name: old + change}), ends, UNIT_ROAD)
            if [row.kind for row in rows] != [row.kind for row in changed]:
                raise Undecided("events of another kind nearby")
            # k^2 = I/m changes with the mass as much as with the inertia
            times = 2 if name == "inertia" and scene.inertia is not None else 1
            for sums, new, was in zip(total, changed, rows, strict=True):
                for i, (p, q) in enumerate(zip(new[1:], was[1:], strict=True)):
                    sums[i] += times * abs(p - q)
        return [[float(one * ROUNDING / UNIT_CHANGE) for one in sums] for sums in total]


# ---------------------------------------------------------------- the scenes

RESTITUTIONS = (0.0, 0.3, 0.8, 1.0)
FRICTIONS = (0.0, 0.05, 0.2, 0.5, 1.0, math.inf)


class Family(NamedTuple):
    """Name and number of scenes, their given inputs, and the kinds of events required, in order."""

    name: str
    scenes: int
    start: str  # "air", "slide" or "roll"
    wanted: tuple[str, ...] = ()
    shape: str = "any"
    given: dict[str, Any] = {}  # noqa: RUF012
    most_events: int = MOST_EVENTS
    states: tuple[float, ...] = (1.0,)  # times of the states / end
    lever: tuple[float, float] | None = None  # range of rolling_resistance / min(a, b)


def random_axes(rng: random.Random, shape: str) -> tuple[float, float]:
    """Return random semi-axes of a lying or standing body."""
    longer = log_uniform(rng, 0.3, 3.0)
    if shape == "circle":
        return longer, longer
    ratios = {"thin": (10, 50), "thin standing": (10, 500)}
    ratio = log_uniform(rng, *ratios.get(shape, (1.1, 4.0)))
    lying = rng.random() < 0.6 and not shape.endswith("standing")
    return (longer, longer / ratio) if lying else (longer / ratio, longer)


def random_scene(rng: random.Random, family: Family) -> Scene:
    a, b = random_axes(rng, family.shape)
    mass = 1.0 if rng.random() < 0.3 else log_uniform(rng, 0.1, 30.0)
    gravity = rng.choice([9.81, 9.81, 1.62, 3.7])
    disc = mass * (a * a + b * b) / 4
    inertia = None if rng.random() < 0.5 else disc * log_uniform(rng, 0.2, 3.0)
    slope = 0.0 if rng.random() < 0.5 else rng.choice([-1, 1]) * rng.uniform(0.02, 0.6)
    rate = math.sqrt(gravity / max(a, b))
    speed = math.sqrt(gravity * max(a, b))
    values: dict[str, Any] = {"mass": mass, "gravity": gravity, "inertia": inertia, "slope": slope}
    values |= {"friction": log_uniform(rng, 0.03, 1.5), "restitution": rng.choice(RESTITUTIONS)}
    values |= {"theta": rng.uniform(-3.0, 3.0), "omega": rate * rng.uniform(-2.5, 2.5)}
    values["x"] = rng.choice([0.0, rng.uniform(-2, 2)])
    if family.start == "air":
        above = rng.uniform(0.02, 1.0) * min(a, b)
        height = math.hypot(a * math.sin(values["theta"]), b * math.cos(values["theta"]))
        values |= {"z": height + above, "x_dot": speed * rng.uniform(-1, 1)}
        values["z_dot"] = speed * rng.uniform(-1, 0.5)
    elif family.start == "slide":
        values["x_dot"] = speed * rng.uniform(-2, 2)
    if family.lever:
        values["rolling_resistance"] = min(a, b) * log_uniform(rng, *family.lever)
    values |= family.given
    if "above" in values:
        values["z"] = b + values.pop("above")
    return Scene(*(None if one is None else float(f"{one:.6g}") for one in Scene(a, b, **values)))


def contains(kinds: list[str], wanted: tuple[str, ...]) -> bool:
    """Return whether the required kinds occur in this order."""
    rest = iter(kinds)
    return all(kind in rest for kind in wanted)


NO_SPIN = {"omega": 0.0, "x_dot": 0.0, "z_dot": 0.0}
FLAT = {**NO_SPIN, "theta": 0.0, "slope": 0.0}
UNLIMITED = {"friction": math.inf}
FAMILIES = [
    *(
        Family("drop", 1, "air", ("impact",), given={"restitution": e, "friction": mu})
        for e in RESTITUTIONS
        for mu in FRICTIONS
    ),
    *(
        Family("plumb", 1, "air", ("impact",), given={**NO_SPIN, "restitution": e, "friction": mu})
        for e, mu in ((0.0, 0.2), (0.3, math.inf), (0.8, 0.5), (1.0, 0.0))
    ),
    Family("grip", 6, "slide", ("stick",), given={"slope": 0.0}),
    Family("reverse", 5, "slide", ("reverse",)),
    Family("slip", 5, "roll", ("slip",)),
    Family("slip", 3, "roll", ("slip",), given=UNLIMITED),
    Family("short", 3, "roll", ("slip", "stick")),
    Family("jump", 4, "roll", ("slip", "lift_off", "impact")),
    Family("jump", 2, "roll", ("slip", "lift_off", "impact"), given=UNLIMITED),
    Family("lift", 3, "slide", ("lift_off", "impact")),
    Family("thin", 3, "air", ("impact",), "thin"),
    Family("thin", 3, "slide", ("stick",), "thin"),
    Family("circle", 2, "air", ("impact", "impact"), "circle"),
    Family("circle", 2, "slide", ("stick",), "circle"),
    Family("circle", 1, "air", ("impact",), "circle", {"restitution": 0.0, "friction": 0.2}),
    Family("standing", 3, "roll", ("slip", "stick"), "standing"),
    Family("slope", 2, "roll", ("slip",), given={"slope": 0.5}),
    Family("slope", 2, "slide", ("stick",), given={"slope": -0.4}),
    Family("long", 1, "air", 10 * ("impact",), given={"restitution": 1.0}, most_events=15),
    Family("long", 1, "air", 6 * ("impact",), given={"restitution": 0.8}, most_events=15),
    Family("long", 1, "roll", 3 * ("slip", "stick"), most_events=15),
    Family("jam", 3, "slide", ("jam",), given={"friction": 4.0}),
    *(
        Family("rest", 1, "air", ("rest",), shape, {**FLAT, "above": 0.6, "restitution": e}, 50)
        for e, shape in ((0.3, "any"), (0.5, "standing"), (0.3, "circle"))
    ),
    Family("rest", 1, "air", ("impact",), "any", {**FLAT, "above": 0.6, "restitution": 0.0}),
    Family("upright", 4, "roll", ("slip", "stick"), "thin standing"),
    Family("upright", 4, "roll", ("slip", "lift_off"), "thin standing"),
    *(
        Family("ice", 1, "slide", ("reverse", "reverse"), given={"friction": mu, "slope": 0.0})
        for mu in (1e-300, 1e-12, 1e-8, 1e-5, 1e-3)
    ),
    Family("hops", 3, "roll", 30 * ("impact",), given={"restitution": 1.0}, most_events=40),
]
EXPLICIT = [
    ("jump-1", Scene(2.0, 1.0, omega=4.7, friction=0.5)),
    ("jump-2", Scene(2.0, 1.0, omega=5.0, friction=1.0, restitution=0.5)),
    ("jump-3", Scene(2.0, 1.0, omega=5.2, friction=0.2)),
    ("jump-4", Scene(2.0, 1.0, omega=5.0)),
    ("slip-1", Scene(2.0, 1.0, omega=4.5, friction=0.3)),
    ("slip-2", Scene(2.0, 1.0, omega=4.85)),
    ("jam-1", Scene(2.0, 1.0, theta=0.9, x_dot=5.0, friction=3.0)),
]


# ---------------------------------------------------------------- the table


class Checked(NamedTuple):
    """The lines of a scene, its kinds of events, and the results of its checks."""

    lines: list[list[str]]
    kinds: list[str]
    disagreement: float
    energy_change: float
    worst_unit: float


def cut(rows: list[Row], kept: int, stop: Any) -> float:
    """Return a time between the last event to keep and the next event."""
    last = rows[kept - 1].t if kept else mpfr(0)
    return float(last + (stop - last) * 0.6)


def planned(scene: Scene, longest: float, most_events: int) -> tuple[float, list[list[float]]]:
    """Return an end time after the events that the inputs determine, and the units up to this
    time."""
    with UNIT_ROAD.context():
        found = follow(scene, longest, UNIT_ROAD, most_events + 1)
        rows, end = found.rows, longest
        if rows and rows[-1].kind == "jam":
            if len(rows) > 1:
                raise Undecided("a jam on the way")
            return 0.0, units(scene, [0.0])
        if found.lost is not None:
            end = cut(rows, len(rows), found.lost)
        elif len(rows) > most_events:
            end = cut(rows, most_events, rows[most_events].t)
        while True:
            kept = sum(row.t <= end for row in rows)
            if kept == 0:
                raise Undecided("nothing happens")
            found_units = units(scene, [end])
            wild = [i for i, row in enumerate(found_units) if max(row) > UNIT_LIMIT]
            if not wild:
                return end, found_units
            if wild[0] == 0:
                raise Undecided("the inputs do not fix the answer")
            stop = rows[wild[0]].t if wild[0] < kept else end
            end = cut(rows, wild[0], stop)


def difference(one: Sequence[Any], other: Sequence[Any]) -> float:
    """Return the largest difference of two lists of values, relative where the value is above 1."""
    return max(float(abs(p - q) / max(abs(q), 1)) for p, q in zip(one, other, strict=True))


def checked(
    name: str, scene: Scene, ends: Sequence[float], unit: list[list[float]], fields: list[str]
) -> Checked:
    """Return the lines of a scene: its events and its states at some times, with the inputs
    `fields`."""
    with TABLE_ROAD.context():
        rows, change = rows_of(scene, ends, TABLE_ROAD)
        digits = [[f"{one:.29e}" for one in row[1:]] for row in rows]
        energy = float(change)
    kinds = [row.kind for row in rows]
    with CHECK_ROAD.context():
        others, _ = rows_of(scene, ends, CHECK_ROAD)
        assert kinds == [row.kind for row in others]
        apart = max(difference(p[1:], q[1:]) for p, q in zip(rows, others, strict=True))
    assert max(apart, energy) < AGREEMENT and len(unit) == len(rows), (scene, apart, energy)
    given = [getattr(scene, field) for field in fields]
    texts = [name, *("" if one is None else repr(float(one)) for one in given)]
    lines = [
        [*texts, str(i), row.kind, *digits[i], *(f"{one:.2e}" for one in unit[i])]
        for i, row in enumerate(rows)
    ]
    return Checked(lines, kinds, apart, energy, max(map(max, unit)))


def make_scene(
    name: str, scene: Scene, longest: float, family: Family, fields: list[str]
) -> Checked:
    """Return the lines of a scene, whose motion ends where the inputs no longer determine it."""
    end, unit = planned(scene, longest, family.most_events)
    ends = [share * end for share in family.states]
    made = checked(name, scene, ends, units(scene, ends) if ends[1:] else unit, fields)
    if not contains(made.kinds, family.wanted):
        raise Undecided("not what was wanted")
    return made


def drawn(rng: random.Random, family: Family, name: str, fields: list[str]) -> Checked:
    """Return a random scene of a family whose motion is decided and has the wanted kinds of
    events."""
    while True:
        scene = random_scene(rng, family)
        if family.name == "short":
            peak = peak_of_friction(scene)
            if not 0.03 < peak < 1.5:
                continue
            scene = scene._replace(friction=peak * (1 - log_uniform(rng, 1e-4, 1e-2)))
        natural = math.sqrt(max(scene.a, scene.b) / scene.gravity)
        try:
            longest = natural * rng.uniform(3.0, 8.0) * family.most_events / MOST_EVENTS
            with UNIT_ROAD.context():
                found = follow(scene, longest, UNIT_ROAD, family.most_events)
            if not contains([row.kind for row in found.rows], family.wanted):
                continue
            if family.name == "short":
                times = {row.kind: row.t for row in reversed(found.rows)}
                if not 0 < times["stick"] - times["slip"] < 0.2 * natural:
                    continue
            return make_scene(name, scene, longest, family, fields)
        except Undecided:
            continue


def make_table(
    path: Path, seed: int, known: list[Checked], families: list[Family], fields: list[str]
) -> None:
    """Write the table of known scenes and of scenes drawn from families, and print the checks."""
    rng, made, began = random.Random(seed), list(known), time.perf_counter()
    numbers = Counter(one.lines[0][0].rpartition("-")[0] for one in known)
    for family in families:
        for _ in range(family.scenes):
            numbers[family.name] += 1
            made.append(drawn(rng, family, f"{family.name}-{numbers[family.name]}", fields))
        print(f"{family.name}: {time.perf_counter() - began:.0f} s so far", flush=True)
    columns = ["name", *inputs(fields), *RESULTS]
    write_table(path, columns, (line for one in made for line in one.lines))
    print(len(made), "scenes", dict(Counter(kind for one in made for kind in one.kinds)))
    print(f"apart {max(one.disagreement for one in made):.1e}")
    print(f"energy {max(one.energy_change for one in made):.1e}")
    print(f"units {max(one.worst_unit for one in made):.1e}")


if __name__ == "__main__":
    explicit = [
        make_scene(name, scene, 2.5, Family(name, 1, "given"), FIELDS) for name, scene in EXPLICIT
    ]
    make_table(TABLE, 20260117, explicit, FAMILIES, FIELDS)
