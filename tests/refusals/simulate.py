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


rolling = partial(rl.simulate, **USUAL, model="rolling")
multipliers = partial(rl.simulate, **USUAL, model="multipliers")

REFUSALS: list[Row] = [
    *wrong(
        rl.simulate, USUAL,
        scene=[None, 2.0, "report", (2.0, 1.0), [1.0] * 10**5, "x" * 10**5],
        t=[(0, 6), NAN, INF, -1.0, [[1.0]], [[0.0, 1.0]], [1.0, 1.0], [0.0, 2.0, 1.0], [-1.0, 0.0],
           [0.0, NAN], [0.0, INF], [], 1e25, 1e30, "1", (0.0, 2.5), (-0.0, 1e9)],
        model=[*UNKNOWN, "falling"], method=UNKNOWN, rtol=[-1.0, NAN, INF, "tight"],
        atol=[-1e-9, NAN, INF], max_steps=[0, 2**31, 500.0, 1e6], max_events=[0, -3],
        baumgarte=[1.0, (1.0,), (1.0, 2.0, 3.0)], rest_speed=[-1.0, 0.0, NAN, INF],
        step=[0.1], stabilization=["glue", None],
    ),
    *(("model", run(scene=scene, model=model))
      for scene in (AIR, scenes.drop, scenes.slip) for model in ("rolling", "multipliers")),
    ("rtol", run(rtol=0.0, atol=0.0)),
    *wrong(multipliers, {}, baumgarte=[
        (-1.0, 1.0), (1.0, NAN), (INF, 1.0), (1.0, 1e308), ("a", 1.0)]),
    *wrong(multipliers, {"method": "rk4"}, step=[-0.1]),
    *wrong(multipliers, {}, method=["exact", "gauss"], stages=[3]),
    *(("step", run(method=method)) for method in ("rk4", "gauss", "radau")),
    *wrong(rolling, {"method": "rk4"}, step=[0.0, -0.1, 2.0, 1e-18, [0.1, 0.2]]),
    *(("step", run(method=method, step=step)) for method, step in (
        ("dop853", NAN), ("gauss", INF), ("radau", 2.5), ("exact", 0.1))),
    *wrong(rolling, {"method": "gauss", "step": 0.1}, stages=[1, 5, 2.5]),
    *(("stages", run(method=method, stages=3, **step))
      for method, step in (("rk4", {"step": 0.1}), ("exact", {}))),
    *(("method", run(model="contact", method=name))
      for name in ("exact", "dop853", "dopri5", "rk4", "gauss", "radau")),
    *(("stabilization", run(model=model, stabilization=name))
      for model, name in (("rolling", "none"), ("auto", "ggl"))),
    *(("stabilization", run(model="multipliers", method="radau", step=0.1, stabilization=name))
      for name in ("projection", "none")),
    *(("stabilization", run(model="multipliers", method=method, step=step, stabilization="ggl"))
      for method, step in (("auto", None), ("dop853", None), ("dopri5", None), ("rk4", 0.1))),
    *(("rest_speed", run(scene=scenes.drop, rest_speed=speed)) for speed in (0.04, 1.0)),
    (rl.IntegrationError, run(scene=scenes.jump, t=5.0, max_events=1)),
    *wrong(report.simulate, PRINTED, t=[(0.0, 6.0)]),
    *(("step", lambda _, method=method, t=t, step=step: report.simulate(
        **PRINTED, method=method, t=t, step=step))
      for method in ("dopri5", "rk4") for step, t in ((1e-300, 1.0), (1e-15, 1.0), (1e-10, 1e6))),
]  # fmt: skip
