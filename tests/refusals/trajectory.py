"""Refusals of a trajectory with wrong fields, and of wrong arguments of its methods."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any
from unittest import mock

import numpy as np
import rolling_ellipse as rl
from oracles.report import lifted
from rolling_ellipse import Scene, scenes

from refusals import INF, NAN, Row, wrong

MOTION = rl.simulate(Scene(2.0, 1.0, omega=1.0), np.linspace(0.0, 0.5, 6))
TURNING = rl.simulate(Scene(2.0, 1.0, omega=3.2), [0.0, 1e9])
CONTACT = rl.simulate(scenes.jump, np.linspace(0.0, 2.0, 6))
DROPPED = rl.simulate(Scene(2.0, 1.0, theta=0.5, z=2.5, restitution=0.0), 0.6)
BOUNCED = rl.simulate(scenes.bounce, 6.0)
CHAOS = Scene(1.0, 0.7, theta=0.7, z=2.0, omega=0.3, friction=0.0, restitution=1.0)
FLAT = Scene(2.0, 1.0, z=1.5, restitution=0.5, friction=0.3)
AT_REST = rl.simulate(Scene(2.0, 1.0), 1.0)
JAMMED = rl.simulate(Scene(2.0, 1.0, theta=0.9, x_dot=5.0, friction=3.0), 1.0)
NOISY = rl.simulate(scenes.rolling, 3.0, model="rolling", method="dop853", rtol=1e-4)
STARTED = lifted(1.0)
N = MOTION.t.size


def contact(**changes: Any) -> Any:
    assert CONTACT.contact is not None
    return CONTACT.contact._replace(**changes)


def without(package: str, call: Callable[[], Any]) -> Any:
    with mock.patch.dict("sys.modules", {package: None}):
        return call()


NO_ARRAYS = [1j * np.zeros(N), ["a"] * N, [[0.0], [1.0, 2.0]], None]
TABLE = np.zeros((N, 5))

GIVEN = rl.Trajectory.from_arrays(MOTION.t, MOTION.x, MOTION.z, MOTION.theta, scene=MOTION.scene)

REFUSALS: list[Row] = [
    *wrong(
        partial(replace, CONTACT), {},
        t=[*NO_ARRAYS, np.zeros((N, 1))], theta=[*NO_ARRAYS, np.zeros(N + 1)],
        omega=[*NO_ARRAYS, 1.0], x=[*NO_ARRAYS, np.zeros(3)],
        coordinates=[1, (TABLE,), (TABLE[1:],) * 2, (TABLE, np.zeros(5))],
        start=[1, (TABLE,) * 2], contact=[1, (1, 2)], scene=[None], settings=[1],
        status=[None, "COMPLETED"], reason=[3.5], message=[None], model=["auto"], method=[None],
        kept_events=[(1,), []], stats=[None], t_end=[None, "late"], span=["late"],
        valid_until=["late"],
    ),
    ("theta", lambda _: replace(MOTION, t=[0.0])),  # type: ignore[arg-type]
    ("z", lambda _: replace(CONTACT, contact=contact(z=np.zeros(4)))),
    *(("mode", lambda _, mode=mode: replace(CONTACT, contact=contact(mode=mode)))
      for mode in (np.zeros(4), np.full(N, 9), np.full(N, 0.5))),
    *wrong(MOTION.sol, {}, t=[[[0.1]], 1.0, -1e-9, NAN, [0.0, 0.6], INF, "now"]),
    *wrong(MOTION.at, {}, t=[-1e-9, 0.6, NAN, "now"]),
    *wrong(
        MOTION.when, {},
        theta=[np.ones((1, 1)), NAN], x=[INF, [0.5, NAN]], omega=["1"], z=[["1"]],
        function=[1.0, lambda at: [1.0], lambda at: 1.0, lambda at: at.q, lambda at: at.t * NAN],
    ),
    *wrong(MOTION.when, {"theta": 0.1}, direction=[2, True]),
    ("function's result", lambda _: MOTION.when(function=lambda at: "x")),
    *wrong(DROPPED.sensitivity, {}, wrt=[
        [], "psi", 5, [5], ["theta", "theta"], "jx", "friction", "restitution"]),
    *wrong(DROPPED.sensitivity, {"wrt": "theta"}, side=[2, 0.5, [1], None, True]),
    *wrong(MOTION.sensitivity, {}, wrt=["x_dot", "z"]),  # both follow from theta and omega
    *(("wrt", lambda _, motion=motion, wrt=wrt: motion.sensitivity(wrt)) for motion, wrt in (
        (rl.simulate(FLAT, 2.0), "theta"),  # settles: nearby motions are unknown
        (rl.simulate(DROPPED.scene, DROPPED.events[0].t), "theta"),  # ends in an impact
        (rl.simulate(scenes.bounce, BOUNCED.events[5].t), "theta"),  # ends in a later impact
        (rl.simulate(CHAOS, 20.0), "theta"),  # changes grow too much
        (rl.simulate(FLAT, 2.0), "slope"),
        (NOISY, "theta"))),
    *(("motion", lambda _, motion=motion: motion.sensitivity("theta"))
      for motion in (STARTED, AT_REST, JAMMED, GIVEN)),
    *wrong(DROPPED.growth, {}, wrt=[[], "psi", 5, ["theta", "theta"], "friction", "t"]),
    *wrong(MOTION.growth, {}, wrt=["x_dot", "z", "z_dot"]),  # all follow from theta and omega
    ("wrt", lambda _: rl.simulate(DROPPED.scene, DROPPED.events[0].t).growth("theta")),
    *(("motion", lambda _, motion=motion: motion.growth())
      for motion in (STARTED, AT_REST, JAMMED, GIVEN, rl.simulate(scenes.drop, 0))),
    *(("wrt", lambda _, motion=motion: motion.growth(("omega", "theta")))
      for motion in (NOISY, TURNING)),  # rough differences; one change outgrows the other
    ("changes", lambda _: DROPPED.sensitivity("theta").forecast(omega=1.0)),
    *wrong(DROPPED.sensitivity("theta").forecast, {}, theta=["x"]),
    *wrong(DROPPED.sensitivity("theta").at, {}, t=[-1.0, 9.0, "now"]),
    ("event", lambda _: TURNING.when(event="roll_over")),
    ("event", lambda _: MOTION.when(event="impacts")),
    *(("exactly one of theta", lambda _, given=given: MOTION.when(**given))
      for given in ({}, {"theta": 1.0, "x": 2.0})),
    ("z", lambda _: TURNING.when(z=1.5)),
    ("function", lambda _: TURNING.when(function=lambda at: at.x)),
    (AttributeError, lambda _: MOTION.vx),  # type: ignore[attr-defined]
    (AttributeError, lambda _: rl.nothing),  # type: ignore[attr-defined]
    (ImportError, lambda _: without("xarray", MOTION.to_xarray)),
    (ImportError, lambda _: without("pandas", MOTION.to_dataframe)),
    (ImportError, lambda _: without("pandas", CONTACT.events.to_dataframe)),
]  # fmt: skip
