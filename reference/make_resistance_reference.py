"""Make `resistance_reference.csv`: motions with rolling resistance, to 30 digits.

    python make_resistance_reference.py         makes and checks the table (8 minutes, one core)

Like make_contact_reference.py, with the column `rolling_resistance` and two more states of a scene,
at times between. Named scenes come first: rocking and rolling that ends, in the flat position and
on the tip, a slide that holds the body or stops turning, and turns where slip starts.
"""

import math
import random
import time
from collections import Counter
from pathlib import Path

from contact_motion import VALUES, Scene
from make_contact_reference import (
    RESULTS,
    Checked,
    Family,
    checked,
    drawn,
    report,
    units,
)
from runs import write_table

TABLE = Path(__file__).with_name("resistance_reference.csv")
FIELDS = [*Scene._fields]
INPUTS = [name + "0" if name in VALUES else name for name in FIELDS]


def scene(a: float, b: float, lever: float, friction: float = 1.0, **given: float) -> Scene:
    """A scene with a lever of rolling resistance."""
    return Scene(a, b, rolling_resistance=lever, friction=friction, **given)


TIP = math.pi / 2 - 0.1
NAMED = {  # scenes and the times of their states
    "rocks": (scene(2.0, 1.0, 0.01, theta=0.5), (1.0, 20.0, 60.0)),
    "rolls over": (scene(2.0, 1.0, 0.02, omega=3.2), (1.0, 8.0, 12.0)),
    "small": (scene(0.035, 0.025, 2e-4, theta=0.6, omega=6.0), (0.5, 2.0, 10.0)),
    "on a slope": (scene(2.0, 1.0, 0.05, slope=0.1, theta=0.2, omega=1.0), (1.0, 3.0, 9.0)),
    "disc": (scene(1.0, 1.0, 0.02, 0.2, x_dot=3.0), (0.3, 5.0, 16.0)),
    "held slide": (scene(2.0, 1.0, 0.02, 0.01, x_dot=1.0), (5.0, 11.0)),
    "slide that turns": (
        scene(2.0, 1.0, 0.05, 0.3, theta=0.4, omega=-2.0, x_dot=2.0),
        (0.2, 1.0, 1.5),
    ),
    "disc from rest": (scene(1.0, 1.0, 0.05, slope=0.1), (1.0, 2.0)),
    "slip at a turn": (scene(1.0, 1.0, 0.05, 0.1, slope=0.3, omega=-1.0), (0.3, 2.0)),
    "held at a turn": (scene(1.0, 1.0, 0.35, 0.2, slope=0.3, omega=-1.0), (0.1, 2.0)),
    "rest on the tip": (scene(2.0, 1.0, 0.05, theta=TIP, omega=0.2), (0.5, 1.0)),
    "short of the tip": (scene(2.0, 1.0, 0.05, theta=TIP, omega=0.19), (0.5, 2.0)),
    "slips at once": (scene(2.0, 1.0, 0.02, 0.05, theta=0.6), (0.5, 1.2)),
    "lifts off": (scene(2.0, 1.0, 0.05, math.inf, omega=5.2), (0.1, 0.25, 0.3)),
    "stays": (scene(2.0, 1.0, 0.05, slope=0.02, theta=0.01), (1.0, 2.0)),
}


def family(
    name: str, scenes: int, start: str, wanted: tuple[str, ...], shape: str = "any",
    least: float = 1e-3, **given: float,
) -> Family:  # fmt: skip
    """A family of scenes with levers drawn from the least one to half of the shorter semi-axis."""
    return Family(
        name, scenes, start, wanted, shape, given, states=(0.3, 0.7, 1.0), lever=(least, 0.5)
    )


FAMILIES = [
    family("rest", 2, "roll", ("rest",), least=0.05),
    family("grip", 2, "slide", ("stick", "rest"), slope=0.0),
    family("reverse", 2, "slide", ("reverse", "stick")),
    family("slip", 2, "roll", ("slip", "stick"), least=1e-6),
    family("slope", 1, "roll", ("slip",), slope=0.4),
    family("slope", 1, "slide", ("stick",), slope=-0.4),
    family("unlimited", 2, "roll", ("slip",), friction=math.inf),
    family("ice", 1, "slide", ("lift_off",), friction=0.0),
    family(
        "ice", 2, "air", ("impact", "rest"), slope=0.0, friction=0.0, x_dot=0.0, restitution=0.0
    ),
    family("bounce", 3, "air", ("impact", "impact")),
    family("land", 2, "air", ("impact", "stick"), restitution=0.0),
    family("jump", 1, "roll", ("slip", "lift_off", "impact")),
    family("circle", 2, "slide", ("stick", "rest"), "circle", slope=0.0),
    family("circle", 1, "air", ("impact", "rest"), "circle", restitution=0.0, slope=0.0),
    family("thin", 2, "slide", ("stick",), "thin"),
    family("thin standing", 2, "roll", ("slip", "stick"), "thin standing"),
    family("light", 2, "slide", ("stick",), inertia=0.01, mass=1.0, least=0.2),
    family("jam", 1, "slide", ("jam",), friction=4.0)._replace(states=(1.0,)),
]


def make_table(seed: int) -> None:
    """Write the table."""
    rng = random.Random(seed)
    began = time.perf_counter()
    numbers: Counter[str] = Counter()
    made: list[Checked] = []
    for name, (one, ends) in NAMED.items():
        made.append(checked(name, one, ends, units(one, ends), FIELDS))
    for each in FAMILIES:
        for _ in range(each.scenes):
            numbers[each.name] += 1
            made.append(drawn(rng, each, f"{each.name}-{numbers[each.name]}", FIELDS))
        print(f"{each.name}: {time.perf_counter() - began:.0f} s so far", flush=True)
    columns = ["name", *INPUTS, *RESULTS]
    write_table(TABLE, columns, (line for one in made for line in one.lines))
    report(made)


if __name__ == "__main__":
    make_table(seed=20270508)
