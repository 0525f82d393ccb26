"""Refusals of scenes and impulses."""

import math
from typing import Any

from rolling_ellipse import Impulse, Scene

from refusals import INF, NAN, NOT_FINITE, NOT_POSITIVE, Row, wrong

ROLLING = Scene(2.0, 1.0, omega=1.0)
AXES: dict[str, Any] = {"a": 2.0, "b": 1.0}

REFUSALS: list[Row] = [
    *wrong(
        Scene, AXES,
        a=[*NOT_POSITIVE, 1e40], b=NOT_POSITIVE, mass=NOT_POSITIVE, gravity=NOT_POSITIVE,
        inertia=[*NOT_POSITIVE, 1e40, 3.6e-6, 4.4e6], slope=[math.pi / 2, -2.0, 30.0, *NOT_FINITE],
        friction=[-0.1, -1e-300, -INF, NAN, 1e7], restitution=[-0.1, 1.0000001, *NOT_FINITE],
        theta=[*NOT_FINITE, 1e51], omega=[*NOT_FINITE, 1e51, 1e8], x=[*NOT_FINITE, 1e51],
        x_dot=[*NOT_FINITE, 1e8], z=[*NOT_FINITE, 1e13, 0.5, 0.9], z_dot=[*NOT_FINITE, -0.1, 1e8],
        impulse=[1, 48.0, (0.0, -48.0), "press", Impulse(1e9), Impulse([1.0, 2.0]),
                 Impulse(0.0, -1.0, dx=3.0)],
    ),
    *(("a/b", lambda _, a=a, b=b: Scene(a, b))
      for a, b in ((1e4, 1.0), (1000.1, 1.0), (1.0, 1000.1), (1e-9, 1.0), (1.0, 1e-20))),
    *wrong(Impulse, {}, **{
        name: [*NOT_FINITE, 1e51, [1.0, 1e60], *([1.0, -2.0, value] for value in NOT_FINITE)]
        for name in ("jx", "jz", "dx", "dz")
    }),
    *wrong(Impulse.press, {"F": 48.0, "d": 1.5}, F=[*NOT_FINITE, 1e51], d=[*NOT_FINITE, -1e51]),
    *wrong(Scene, {"a": 1e-20, "b": 1e-20, "z": 1e-9}, x_dot=[1e3], z_dot=[-1e3]),
    ("changes", lambda _: ROLLING.replace(color=1)),
    *wrong(ROLLING.replace, {}, omega=[NAN], z=[0.5], b=[-1.0]),
]  # fmt: skip
