"""Compute `resistance_reference.csv`: motions with rolling resistance, to 30 digits.

    python make_resistance_reference.py         computes and checks the table (8 minutes, one core)

This table is like that of make_contact_reference.py, with the column `rolling_resistance` and with
states at more times. Named scenes come first: rocking and rolling that end flat or on the tip,
slides during which the body does not turn or stops turning, and turning points at which slip
starts.
"""

import math
from pathlib import Path

from contact_motion import Scene
from make_contact_reference import Family, checked, make_table, units

TABLE = Path(__file__).with_name("resistance_reference.csv")


def scene(a: float, b: float, lever: float, friction: float = 1.0, **given: float) -> Scene:
    """Return a scene with a lever of rolling resistance."""
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
    """Return a family of scenes with random levers of `least` to 0.5 times the shorter
    semi-axis."""
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


if __name__ == "__main__":
    fields = [*Scene._fields]
    named = [
        checked(name, one, ends, units(one, ends), fields) for name, (one, ends) in NAMED.items()
    ]
    make_table(TABLE, 20270508, named, FAMILIES, fields)
