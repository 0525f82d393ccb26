"""Refusals of times and settings."""

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import rolling_ellipse as rl
from rolling_ellipse import Scene, report, scenes

from refusals import INF, NAN, Row, wrong

ROLLING = Scene(2.0, 1.0, omega=1.0)
AIR = Scene(2.0, 1.0, z=3.0)
USUAL: dict[str, Any] = {"scene": ROLLING, "t": 1.0}
Q, Q_DOT = rl.kinematics(0.3, 1.0, a=2.0, b=1.0)
PRINTED: dict[str, Any] = {
    "q": Q, "q_dot": Q_DOT, "a": 2.0, "b": 1.0, "equations": "printed", "consistent": "project",
}  # fmt: skip
UNKNOWN: list[Any] = ["", "Auto", "no_such", "rk5", None, 1, ["auto"]]


def run(**options: Any) -> Callable[[Path], Any]:
    return lambda _: rl.simulate(**{**USUAL, **options})


multipliers = partial(run, model="multipliers")

REFUSALS: list[Row] = [
    *wrong(
        rl.simulate, USUAL,
        scene=[None, 2.0, "report", (2.0, 1.0), [1.0] * 10**5, "x" * 10**5],
        t=[(0, 6), NAN, INF, -1.0, [[1.0]], [[0.0, 1.0]], [1.0, 1.0], [0.0, 2.0, 1.0], [-1.0, 0.0],
           [0.0, NAN], [0.0, INF], [], 1e30, (0.0, 2.5), (-0.0, 1e9)],
        model=UNKNOWN, method=UNKNOWN, rtol=[-1.0], max_steps=[0, 2**31, 500.0], baumgarte=[1.0],
        rest_speed=[-1.0], step=[0.1],
    ),
    ("model", run(scene=AIR, model="rolling")),
    ("rtol", run(rtol=0.0, atol=0.0)),
    ("baumgarte", multipliers(baumgarte=(-1.0, 1.0))),
    ("step", run(method="rk4")),
    *wrong(rl.simulate, {**USUAL, "method": "rk4"}, step=[0.0, 2.0, 1e-18]),
    *(("method", run(model="contact", method=name))
      for name in ("exact", "dop853", "dopri5", "rk4", "gauss", "radau")),
    ("method", multipliers(method="exact")),
    ("stabilization", run(model="rolling", stabilization="none")),
    ("stabilization", multipliers(method="radau", step=0.1)),
    ("stabilization", multipliers(method="rk4", step=0.1, stabilization="ggl")),
    ("stages", run(method="rk4", step=0.1, stages=3)),
    ("stages", run(method="gauss", step=0.1, stages=5)),
    ("rest_speed", run(scene=scenes.drop, rest_speed=1.0)),
    (rl.IntegrationError, run(scene=scenes.jump, t=5.0, max_events=1)),
    *wrong(report.simulate, PRINTED, t=[(0.0, 6.0)]),
    *(("step", lambda _, method=method, t=t, step=step: report.simulate(
        **PRINTED, method=method, t=t, step=step))
      for method in ("dopri5", "rk4") for step, t in ((1e-300, 1.0), (2e-15, 1.0), (1e-10, 1e6))),
]  # fmt: skip
