"""Refusals of the report's equations and of their motions."""

from functools import partial
from typing import Any

import rolling_ellipse as rl
from rolling_ellipse import report

from refusals import ANYTHING, INF, NOT_FINITE, Row, but, wrong

Q, Q_DOT = rl.kinematics(0.3, 1.0, a=2.0, b=1.0)
WITH_WRONG = [[0.0, 1.0, value, 0.0, 1.0] for value in NOT_FINITE]
AXES: dict[str, Any] = {"a": 2.0, "b": 1.0}
BODY: dict[str, Any] = {**AXES, "mass": 1.0, "gravity": 9.81}
STATE: dict[str, Any] = {"q": Q, "q_dot": Q_DOT}
RUN: dict[str, Any] = {**STATE, "t": 0.1, **BODY}
PRINTED: dict[str, Any] = {**RUN, "equations": "printed", "consistent": "project"}
rows = partial(wrong, report.simulate)

REFUSALS: list[Row] = [
    *wrong(report.f1, STATE, case=[*ANYTHING, "3"], q=WITH_WRONG, q_dot=WITH_WRONG),
    *wrong(report.f2, {}, q=[[1.0, 2.0], *WITH_WRONG]),
    *wrong(report.eq_39, {"q": Q, **BODY}, q_ddot=WITH_WRONG),
    *wrong(report.eq_41, {"q": Q, "q_ddot": Q_DOT, **BODY}, complete=ANYTHING),
    *wrong(report.eqs_33_to_37, {"q": Q, "q_ddot": Q_DOT, **BODY},
           multipliers=[[1.0], *([value, 0.0, 0.0, 0.0] for value in NOT_FINITE)]),
    *wrong(report.constraint_matrix, {"q": Q, **AXES}, q=WITH_WRONG, b=[0.0]),
    *wrong(report.contact_x, AXES, q=WITH_WRONG),
    *wrong(report.eq_48, {"d": 1.0, **AXES, "mass": 1.0}, impulse=NOT_FINITE),
    *wrong(report.case_sign, {}, theta=NOT_FINITE),
    *(row for call in (report.eq_5, report.case_lead, report.appendix_b_radius)
      for row in wrong(call, AXES, theta=NOT_FINITE)),
    *wrong(report.consistent_rates, {"q": Q, **AXES}, omega=NOT_FINITE),
    # motions
    *(row for usual in (RUN, PRINTED) for row in rows(
        usual, q=[*ANYTHING, [1, 2, 3], *WITH_WRONG], q_dot=[*ANYTHING, [[0] * 5]],
        equations=ANYTHING, consistent=[*ANYTHING, "maybe"], method=[*ANYTHING, "euler", "exact"],
        stabilization=[*ANYTHING, "glue"], max_steps=[*but([], 42), 0], printed=but([], 42),
        t=[-1.0, [0.0, 2.0, 1.0]], a=[-1.0], b=[0.0], gravity=[-1.0], mass=[0.0], step=[0.0],
        rtol=[-1e-3], atol=[INF], baumgarte=[10.0])),
    ("q", lambda _: report.simulate(2 * Q, Q_DOT, 0.1, **AXES)),
    *rows(RUN, printed=[("f1",)]),
    *rows(PRINTED, printed=[("f1", "f9")], baumgarte=[(1.0, 1.0)], step=[1e-30],
          stabilization=["none", "projection"]),
    *(("step", lambda _, usual=usual: report.simulate(**usual, method="rk4"))
      for usual in (RUN, PRINTED)),
    ("step", lambda _: report.simulate(**RUN, stabilization="ggl")),
    *rows({**RUN, "method": "rk4"}, stabilization=["ggl"]),
    ("stabilization", lambda _: report.simulate(**RUN, method="radau", step=0.1)),
    *rows({**RUN, "stabilization": "baumgarte"}, baumgarte=[(10.0, -1.0)]),
]  # fmt: skip
