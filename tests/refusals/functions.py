"""Refusals of numbers and arrays, and of functions of scenes."""

from concurrent.futures import ThreadPoolExecutor
from decimal import Decimal
from io import StringIO
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np
import rolling_ellipse as rl
from oracles.paths import ROOT
from oracles.quantities import Pint
from rolling_ellipse import Impulse, Scene, course, geometry, impacts, scenes

from refusals import INF, NAN, NOT_FINITE, NOT_POSITIVE, Row, wrong

ROLLING = Scene(2.0, 1.0, omega=1.0)
AIR = Scene(2.0, 1.0, z=3.0)
AT_REST = Scene(2.0, 1.0)
Q, Q_DOT = rl.kinematics(0.3, 1.0, a=2.0, b=1.0)
WITH_WRONG = [[0.0, 1.0, value, 0.0, 1.0] for value in NOT_FINITE]
AXES: dict[str, Any] = {"a": 2.0, "b": 1.0}
FLOW: dict[str, Any] = {"t": 1.0, **AXES, "theta": 0.2, "omega": 1.0}
TURN: dict[str, Any] = {
    **AXES, "theta": 0.0, "omega": 1.0, "friction": 0.5, "gravity": 9.81, "gyration2": 1.25,
}  # fmt: skip
WORKERS = [0, -2, 1025, 2**40, "x", 2.0, 1.5, True, None, ThreadPoolExecutor]
HIT: dict[str, Any] = {
    "theta": 0.3, "x_dot": 0.0, "z_dot": -1.0, "omega": 0.0, "friction": 0.3, "restitution": 0.5,
    **AXES,
}  # fmt: skip
#: theta, x_dot, z_dot and omega before an impact, in four rows.
BEFORE: Any = np.array([[0.0], [0.0], [-1.0], [0.0]])
AFTER: Any = np.zeros((3, 1))
UPWARDS: Any = -BEFORE
MASKED: Any = [[0.0, 0.0], np.ma.array([-1.0, -1.0], mask=[False, True]), [-1.0, -1.0], [0.0, 0.0]]
SEEDS = [-1, 2**53 + 1, 1.5, "7", True, [1]]
TABLE = "ROLLING_ELLIPSE_IMPACTS"
IMPACTS = "theta,x_dot,y_dot,omega,x_dot_after,y_dot_after,omega_after"
TWO_IMPACTS: Any = np.zeros((3, 2))
FILM: dict[str, Any] = {
    "t": [0.1, 0.2, 0.3], "x": [0.0, 0.1, 0.2], "scene": Scene(2.0, 1.0, omega=1.0),
    "free": "omega", "sigma": 0.1,
}  # fmt: skip
TRACK: dict[str, Any] = {
    "path": {"t": [0.0, 1.0], "x": [0.0, 1.0], "word": ["a", "b"], "two": [[0.0, 1.0]]},
    "t": "t", "x": "x",
}  # fmt: skip
TURNS: dict[str, Any] = {"t": FILM["t"], "theta": [0.0, 0.1, 0.2], "scene": FILM["scene"]}
ENDLESS = Scene(2.0, 1.0, omega=1.0, friction=INF)
ROWS = np.arange(1.0, 12.0)
SAMPLES: dict[str, Any] = {
    "t": np.arange(6.0), "x": np.zeros(6), "z": np.ones(6), "theta": np.zeros(6),
    "scene": Scene(2.0, 1.0),
}  # fmt: skip
DEEP: list[Any] = []
DEEP.append(DEEP)


def press(of: Scene, **options: Any) -> Any:
    return lambda _: rl.blow_to(of, **options)


def written(folder: Path, content: bytes) -> Path:
    path = folder / "t.csv"
    path.write_bytes(content)
    return path


def marked_by(folder: Path, scale: float) -> Any:
    """The mark of task 8.1 if all measured numbers are multiplied by a scale."""
    rows = scale * np.vstack(course.measured_impacts()).T
    np.savetxt(folder / "seen.csv", rows, delimiter=",", header=IMPACTS, comments="")
    with patch.dict("os.environ", {TABLE: str(folder / "seen.csv")}):
        return course.mark("8.1", 1.0)


REFUSALS: list[Row] = [
    ("a", lambda _: Scene(Decimal("sNaN"), 1.0)),  # type: ignore[arg-type]
    *wrong(
        rl.flow, FLOW,
        t=[*NOT_FINITE, 1e30, "x", Pint(1.0), np.ma.array([1.0, 2.0], mask=[True, False]),
           10**400, np.array([np.longdouble("1e400")]), [1.0, INF]],
        a=NOT_POSITIVE, b=NOT_POSITIVE, gravity=NOT_POSITIVE,
        gyration2=[*NOT_POSITIVE, 1e40, 3.6e-6, 4.4e6],
        theta=[*NOT_FINITE, [1.0, NAN]], omega=[*NOT_FINITE, [1.0, NAN]], workers=WORKERS,
        slope=[*NOT_FINITE, 1.6, -30, "x", [0.1, NAN]],
    ),
    *wrong(rl.flow, FLOW | {"slope": 0.1}, t=[*NOT_FINITE, 1e30], a=NOT_POSITIVE,
           gravity=NOT_POSITIVE, gyration2=NOT_POSITIVE, omega=NOT_FINITE, workers=WORKERS),
    *wrong(
        rl.flow_jacobian, FLOW, wrt=[[], "x", 3, ["t", "t"], "gyration2"], t=[*NOT_FINITE, "x"],
        a=NOT_POSITIVE, workers=WORKERS,
    ),
    # after 1e11 s, rounding limits the accuracy of the differences to 0.03
    ("wrt", lambda _: rl.flow_jacobian(1e11, **AXES, theta=1.0, omega=3.0)),
    *wrong(rl.classify, TURN, a=NOT_POSITIVE, b=NOT_POSITIVE, gravity=NOT_POSITIVE,
           gyration2=NOT_POSITIVE, theta=NOT_FINITE, omega=NOT_FINITE, friction=[-1.0, NAN],
           workers=WORKERS),
    *((f"{name}[999]", lambda _, name=name, value=value: rl.classify(
        **{**TURN, name: [TURN[name]] * 999 + [value], "workers": 2}))
      for name, value in (*dict.fromkeys(TURN, NAN).items(), ("a", -1.0), ("friction", -1.0))),
    ("a/b", lambda _: rl.classify(a=1001.0, b=1.0, omega=0.0)),
    *(("a[1]", lambda _, value=value: rl.flow(**{**FLOW, "a": [2.0, value]}))
      for value in NOT_POSITIVE),
    ("a/b", lambda _: rl.flow(**{**FLOW, "a": 1001.0})),
    *(("arguments", lambda _, call=call: call([1.0, 2.0], [2.0, 2.0, 2.0])) for call in (
        lambda two, three: rl.flow(**{**FLOW, "t": two, "a": three}),
        lambda two, three: rl.classify(**{**TURN, "a": two, "b": three}),
        lambda two, three: rl.kinematics(two, three, **AXES),
        lambda two, three: rl.constraints([Q] * 2, [Q_DOT] * 3, **AXES),
        lambda two, three: impacts.collide(**{**HIT, "theta": two, "omega": three}))),
    *wrong(rl.thresholds, AXES, a=NOT_POSITIVE, b=NOT_POSITIVE, gravity=NOT_POSITIVE,
           gyration2=NOT_POSITIVE, friction=[-0.1, -INF, NAN]),
    ("a/b", lambda _: rl.thresholds(1001.0, 1.0)),
    *wrong(geometry.support, {"theta": 0.3, **AXES},
           theta=[[[0.0, 1.0], [INF, 2.0]], np.zeros((1,) * 33), [DEEP]]),
    *(row for name in geometry.__all__ for row in wrong(
        getattr(geometry, name), {"theta": 0.3, **AXES},
        theta=NOT_FINITE, a=NOT_POSITIVE, b=NOT_POSITIVE)),
    *wrong(rl.kinematics, {"theta": 0.3, "omega": 1.0, **AXES},
           theta=NOT_FINITE, omega=NOT_FINITE, a=NOT_POSITIVE, b=NOT_POSITIVE),
    *wrong(rl.constraints, {"q": Q, "q_dot": Q_DOT, **AXES},
           q=[[1.0], *WITH_WRONG, np.ma.masked_equal(Q, Q[2]), *map(np.zeros, (0, 4, 6))],
           q_dot=[*WITH_WRONG, *(np.zeros((3, length)) for length in (0, 4, 6, 10))],
           a=NOT_POSITIVE, b=NOT_POSITIVE),
    # functions of a scene
    *wrong(rl.certify, {}, scene=[None, 1, "report", (2.0, 1.0), [1.0] * 10**5, "x" * 10**5]),
    *wrong(rl.period, {}, scene=[None, 1, AIR, scenes.slope]),
    *wrong(rl.required_friction, {"scene": ROLLING}, scene=[None], to=["slide", None]),
    *wrong(rl.required_friction, {"scene": AXES}, to=["slide"], workers=WORKERS),
    ("scenes['b'][1]", lambda _: rl.required_friction({"a": 2.0, "b": [1.0, -1.0]})),
    *wrong(rl.rolling_equation, {}, scene=[None]),
    *(("y", lambda _, y=y: rl.rolling_equation(ROLLING)(0.0, y)) for y in (1.0, [1.0], [1.0] * 4)),
    *wrong(Scene.from_density, {**AXES, "density": 1.0, "thickness": 0.1},
           a=["2"], density=NOT_POSITIVE, thickness=NOT_POSITIVE),
    *wrong(rl.outcome, {"scene": ROLLING}, impulse=[1, Impulse.press(1.0, [0.0, 5.0])]),
    *wrong(rl.outcome, {}, scene=["flat"]),
    ("impulse", lambda _: rl.outcome(Scene(2.0, 1.0, mass=1e-20), Impulse(jx=[0.0, 1e40], dz=1.0))),
    *wrong(rl.blow_to, {"distance": 1.0}, scene=[None, AIR, scenes.drop, scenes.rolling]),
    *wrong(rl.blow_to, {"scene": ROLLING}, distance=["1", 3.0, INF, NAN]),
    *wrong(rl.blow_to, {"scene": AT_REST, "distance": 1.0}, omega=["1", 0.0, NAN]),
    *wrong(rl.blow_to, {"scene": AT_REST, "omega": 1.0}, distance=[-1.0, 0.0, 1e-300]),
    *wrong(rl.blow_to, {"scene": scenes.report}, distance=[0.0, 1e-300, 2.01]),
    ("distance", press(Scene(2.0, 1.0, friction=0.05), distance=1.5)),
    ("distance", press(Scene(20.0, 1.0), distance=5.0)),
    ("omega", press(Scene(2.0, 1.0, friction=0.1), distance=1.5, omega=1.0)),
    ("omega", press(Scene(2.0, 1.0, theta=1.2), distance=1.1, omega=40.0)),
    ("omega", press(Scene(2.0, 1.0, slope=0.1), distance=1.0)),
    ("omega", press(Scene(1.0, 1.0), distance=0.5)),
    # impacts
    *wrong(impacts.kinetic_speed, {"x_dot": 0.0, "z_dot": 1.0, "omega": 0.0, "gyration2": 1.0},
           x_dot=[NAN], z_dot=[[2.0, NAN]], gyration2=[-1.0]),
    *(row for law in impacts.LAWS for row in wrong(
        impacts.collide, {**HIT, "law": law},
        theta=[NAN, [0.3, NAN]], x_dot=[INF], z_dot=[NAN], omega=[-INF, "x"], a=[-1.0], b=[0.0],
        gyration2=[0.0], friction=[-0.1, NAN, [0.3, NAN]], restitution=[1.1, -0.1])),
    ("a/b", lambda _: impacts.collide(**{**HIT, "a": 4000.0})),
    *wrong(impacts.collide, HIT, law=["kane"]),
    *wrong(impacts.fit, {"before": BEFORE, "after": AFTER, **AXES},
           before=[[1.0], UPWARDS, MASKED, BEFORE[:3], BEFORE[:, :0], BEFORE + NAN],
           after=[TWO_IMPACTS, AFTER[0], AFTER + INF], minimise=["mean"], law=["kane"], b=[-0.3],
           gyration2=[0.0], sigma=[0.0, -1.0, INF, NAN, "1", 1e-200, 1e-160, 1e155, 1e200]),
    # the course
    *wrong(course.sheet, {"number": 1}, number=[0, 11, "1", 1.5, None], seed=SEEDS),
    *wrong(course.sheet(1).save, {}, path=["sheet.pdf", "", None]),
    ("folder", lambda folder: (folder / "01.png").write_bytes(b"mine")
     and course.sheet(1).save(folder / "sheet.md")),  # type: ignore[func-returns-value]
    *wrong(course.tasks, {}, seed=SEEDS), *wrong(course.film, {}, seed=SEEDS),
    *wrong(course.measured_impacts, {}, seed=SEEDS),
    *wrong(course.mark, {"task": "1.1", "answer": 1.0}, seed=SEEDS),
    *(("table", lambda _, head=head: course.mark_table(StringIO(head)))
      for head in ("", "student,seed,task\n", "a b c", "student,seed,task,answer,Answer\n",
                   'student,seed,task,"answer\n')),
    ("table", lambda folder: course.mark_table(written(folder, b"student,seed,task,answer\n\x81"))),
    *wrong(course.mark_table, {}, table=[None, 3]),
    *wrong(course.mark, {"answer": 1.0}, task=["0.1", "3,2", 1.1, None, [1.1], ""]),
    *wrong(course.mark, {"task": "1.1"},
           answer=[*NOT_FINITE, "0.2", [0.2], None, 2j, (), {}, True]),
    (TABLE, patch.dict("os.environ", {TABLE: str(ROOT / "reference/slope_reference.csv")})(
        lambda _: course.measured_impacts())),
    (TABLE, lambda folder: marked_by(folder, NAN)), (TABLE, lambda folder: marked_by(folder, 0.0)),
    # films
    *wrong(rl.fit_motion, FILM,
           t=[[0.3, 0.2, 0.1], [-0.1, 0.1, 0.2], "x", NAN],
           x=[[0.0, 1.0], [[0.0] * 3], [0.0, INF, 0.0]], scene=[None, 1],
           sigma=[0.0, -1.0, NAN, 1e-300, 1e300, {"z": 1e300}, {"x": 0.0}, {"y": 1.0}],
           loss=["median", None],
           free=["t", "mu", "z", "jx", ("omega", "omega"), (), ("omega", "x", "theta", "mass")]),
    ("free", lambda _: rl.fit_motion(**FILM | {"scene": ENDLESS, "free": "friction"})),
    ("free", lambda _: rl.fit_motion(**FILM | {"x": [0.0, NAN, NAN]})),
    *wrong(rl.fit_motion, FILM | {"z": [9.0] * 3, "free": "scale"},
           free=[("scale", "gravity", "a", "b"), ("clock", "x", "theta", "omega"), "zoom"]),
    *(("x", lambda _, free=free: rl.fit_motion(**TURNS, free=free)) for free in ("clock", "scale")),
    ("z", lambda _: rl.fit_motion(**FILM | {"free": "ground"})),
    *wrong(rl.read_track, TRACK,
           t=["s", 1, [1.0]], x=["X1", "", 0, ["x"], "word", "two"], z=["q"], theta=["x_dot"],
           points=["x", ("x", "x"), ("x", "t", "x", "t"), 4 * "x"],
           fps=[0.0, -1.0, NAN], scale=NOT_POSITIVE, y_up=[1, None], clockwise=["no"],
           degrees=[0.5]),
    *wrong(rl.read_track, {"path": {"t": [0.0, 1.0], "x": [NAN, NAN]}, "t": "t"}, x=["x", None]),
    *wrong(rl.read_track, {"path": {"t": [0.0, 1.0, 1.0], "x": [0.0] * 3}, "x": "x"}, t=["t"]),
    *wrong(rl.read_track, {"path": {"x": [0.0, 1.0]}, "x": "x"}, fps=[None]),
    *wrong(rl.read_track, {"path": {n: [0.0, 1.0] for n in "abcd"}, "fps": 9.0},
           points=["abcd", tuple("abc"), tuple("abcd")]),
    *wrong(rl.read_track, {"t": "t", "x": "x"}, path=[3.5, None, "", "\0"]),
    *wrong(rl.read_track, {"path": ROOT / "README.md"}, delimiter=[", ", 3], decimal=["x", 1]),
    *(("path", lambda folder, text=text: rl.read_track(written(folder, text), x="x"))
      for text in ("t,x\n0,1".encode("utf-16"), b"x\n" + 200_000 * b"1", b"", b"\n \n", b"x\n0,5\n",
                   b"t,x\n0,1\nt,x\n1,2\n", b't,x\n0,"1\n', b"t,x\n\x81,1")),
    *wrong(rl.read_track, {"x": "x"}, path=[{}]),
    ("t, x, z and theta", lambda _: rl.read_track({"x": [9e307]}, x="x", fps=9.0, scale=1e300)),
    ("x", lambda folder: rl.read_track(written(folder, b"t,x\n"), t="t")),
    ("scene", lambda _: rl.fit_motion(**FILM | {"t": [1e20, 2e20, 3e20]})),
    ("t", lambda _: rl.fit_motion(1e18 * ROWS, z=9 - 0.05 * ROWS**2, scene=ENDLESS, free="omega")),
    *wrong(rl.Trajectory.from_arrays, SAMPLES,
           t=[np.zeros(6), -np.arange(6.0), [0.0, 1.0], np.arange(6.0) - 1, "x",
              [0.0, 1e-320, 1.0, 2.0, 3.0, 4.0], np.arange(6) * 5e-324,
              [0.0, 1.0, 1.0 + 2e-16, 2.0, 3.0, 4.0]],
           x=[np.zeros(5), np.full(6, NAN), "x"], z=[[0.0]], theta=[[INF] * 6], scene=[None]),
    ("theta", lambda _: rl.Trajectory.from_arrays(np.arange(6.0), theta=np.ones((1, 6)),
                                                   scene=rl.scenes.rocking)),
    ("trajectory", lambda _: rl.Trajectory.from_arrays(**SAMPLES).when(theta=1.0)),
]  # fmt: skip
