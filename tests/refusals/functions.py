"""Refusals of numbers and arrays, and of the functions that are asked of scenes."""

from decimal import Decimal
from typing import Any

import numpy as np
import rolling_ellipse as rl
from oracles.quantities import Pint
from rolling_ellipse import Impulse, Scene, _core, geometry, impacts, scenes

from refusals import INF, NAN, NOT_FINITE, NOT_POSITIVE, Row, wrong

ROLLING = Scene(2.0, 1.0, omega=1.0)
AIR = Scene(2.0, 1.0, z=3.0)
AT_REST = Scene(2.0, 1.0)
Q, Q_DOT = rl.kinematics(0.3, 1.0, a=2.0, b=1.0)
AXES: dict[str, Any] = {"a": 2.0, "b": 1.0}
FLOW: dict[str, Any] = {"t": 1.0, **AXES, "theta": 0.2, "omega": 1.0}
HIT: dict[str, Any] = {
    "x_dot": 0.0, "z_dot": -1.0, "omega": 0.0, "friction": 0.3, "restitution": 0.5, **AXES,
}  # fmt: skip
SEVEN = [np.array([value]) for value in (1.0, 2.0, 1.0, 0.2, 1.0, 9.81, 1.25)]  # of the core
#: Four columns of what is measured before an impact, three after.
BEFORE: Any = np.array([[0.0], [0.0], [-1.0], [0.0]])
AFTER: Any = np.zeros((3, 1))
UPWARDS: Any = -BEFORE
TWO_IMPACTS: Any = np.zeros((3, 2))
DEEP: list[Any] = []
DEEP.append(DEEP)


def press(of: Scene, **options: Any) -> Any:
    return lambda _: rl.blow_to(of, **options)


REFUSALS: list[Row] = [
    ("a", lambda _: Scene(Decimal("sNaN"), 1.0)),  # type: ignore[arg-type]
    *wrong(
        rl.flow, FLOW,
        t=[*NOT_FINITE, 1e30, "x", Pint(1.0), np.ma.array([1.0, 2.0], mask=[True, False]),
           10**400, np.array([np.longdouble("1e400")]), [1.0, INF]],
        a=NOT_POSITIVE, b=NOT_POSITIVE, gravity=NOT_POSITIVE,
        gyration2=[*NOT_POSITIVE, 1e40, 3.6e-6, 4.4e6],
        theta=[*NOT_FINITE, [1.0, NAN]], omega=[*NOT_FINITE, [1.0, NAN]], workers=[0, -2, "x"],
    ),
    *(("a[1]", lambda _, value=value: rl.flow(**{**FLOW, "a": [2.0, value]}))
      for value in NOT_POSITIVE),
    ("a/b", lambda _: rl.flow(**{**FLOW, "a": 1001.0})),
    ("arguments", lambda _: rl.flow(**{**FLOW, "t": [1.0, 2.0], "a": [2.0, 2.0, 2.0]})),
    *wrong(rl.thresholds, AXES, a=NOT_POSITIVE, b=NOT_POSITIVE, gravity=NOT_POSITIVE,
           gyration2=NOT_POSITIVE, friction=[-0.1, -INF, NAN]),
    ("a/b", lambda _: rl.thresholds(1001.0, 1.0)),
    *wrong(geometry.support, {"theta": 0.3, **AXES}, theta=[NAN, np.zeros((1,) * 33), [DEEP]]),
    *wrong(rl.kinematics, {"theta": 0.3, "omega": 1.0, **AXES},
           theta=NOT_FINITE, omega=NOT_FINITE, a=NOT_POSITIVE, b=NOT_POSITIVE),
    *wrong(rl.constraints, {"q": Q, "q_dot": Q_DOT, **AXES},
           q=[[1.0], [NAN] * 5], a=NOT_POSITIVE, b=NOT_POSITIVE),
    # questions to scenes
    *wrong(rl.certify, {}, scene=[None, 1, "report", (2.0, 1.0), [1.0] * 10**5, "x" * 10**5]),
    *wrong(rl.period, {}, scene=[None, 1, AIR, scenes.slope]),
    *wrong(rl.outcome, {"scene": ROLLING}, impulse=[1, Impulse.press(1.0, [0.0, 5.0])]),
    ("scenes", lambda _: _core.first_refused(np.ones((2, 2)), False)),
    ("level", lambda _: _core.flow_array(1, SEVEN, 1, "x")),
    ("scene", press(AIR, distance=1.0)),
    ("scene", press(Scene(2.0, 1.0, omega=3.2), distance=1.0)),
    ("distance", press(ROLLING, distance=3.0)),
    ("distance", press(AT_REST, distance=-1.0, omega=1.0)),
    ("distance", press(AT_REST, distance=0.0, omega=1.0)),
    ("distance", press(Scene(2.0, 1.0, friction=0.05), distance=1.5)),
    ("omega", press(Scene(2.0, 1.0, friction=0.1), distance=1.5, omega=1.0)),
    ("omega", press(AT_REST, distance=1.0, omega=0.0)),
    ("omega", press(Scene(2.0, 1.0, slope=0.1), distance=1.0)),
    ("omega", press(Scene(1.0, 1.0), distance=0.5)),
    # impacts
    *wrong(impacts.kinetic_speed, {"x_dot": 0.0, "z_dot": 1.0, "omega": 0.0, "gyration2": 1.0},
           x_dot=[NAN], gyration2=[-1.0]),
    *wrong(impacts.collide, {"theta": 0.3, **HIT}, theta=[NAN]),
    *wrong(impacts.fit, {"before": BEFORE, "after": AFTER, **AXES},
           before=[[1.0], UPWARDS], after=[TWO_IMPACTS]),
]  # fmt: skip
