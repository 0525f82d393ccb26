"""Refusals of scenes, impulses, times and settings."""

import math
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import rolling_ellipse as rl
from rolling_ellipse import Impulse, Scene, report, scenes

from refusals import INF, NAN, NOT_FINITE, NOT_POSITIVE, Row, wrong

ROLLING = Scene(2.0, 1.0, omega=1.0)
AIR = Scene(2.0, 1.0, z=3.0)
AXES: dict[str, Any] = {"a": 2.0, "b": 1.0}
USUAL: dict[str, Any] = {"scene": ROLLING, "t": 1.0}
Q, Q_DOT = rl.kinematics(0.3, 1.0, a=2.0, b=1.0)
PRINTED: dict[str, Any] = {
    "q": Q, "q_dot": Q_DOT, **AXES, "equations": "printed", "consistent": "project",
}  # fmt: skip
UNKNOWN: list[Any] = ["", "auto ", "no_such", "rk5", None, 1, ["auto"]]
PRESS, MANY_BLOWS = Impulse.press(1.0, 0.5), Impulse.press([1.0, 2.0], 0.5)


def run(**options: Any) -> Callable[[Path], Any]:
    return lambda _: rl.simulate(**{**USUAL, **options})


def from_a_file(folder: Path) -> Scene:
    (folder / "scene.json").write_bytes(b"PK\x03\x04\xff")
    return Scene.from_json(folder / "scene.json")


HEAD, OLDER = '{"version": 1, "a": 2, "b": 1', "#a=2&b=1&mass=1&omega=0&theta=0&k=1&slip=0"
SOURCES: list[tuple[str, Any]] = [
    *(("source", source) for source in (
        42, None, b"{}", "", "scene.json", "{", "[1]", '{"a":' * 50_000, f"{HEAD}, 1}}",
        f'{HEAD}, "x": {"1" * 5000}}}', f'{HEAD}, "mu": 0.3}}', f'{HEAD}, "t": 6}}',
        "#a=2&b=1&fricton=1", "#a=2&b=1&height=0&z=2")),
    ("theta", "#a=2&b=1&theta=1_0"),
    ("version", '{"a": 2, "b": 1}'), ("a", '{"version": 1}'), ("b", '{"version": 1, "a": 2}'),
    *(("version", f'{{"version": {value}, "a": 2, "b": 1, "new": 3}}')
      for value in ("2", "0", "1.0", "true", "null", '"1"', "[1]")),
    ("a", HEAD + ', "a": 2}'), ("dx", HEAD + ', "impulse": {"dx": 1, "dx": 2}}'),
    *(("theta", f'{HEAD}, "theta": {value}}}') for value in (
        "NaN", "null", "true", '"0.5"', '"nan"', "[0]", "{}", '"inf"', "-Infinity", "1" * 400)),
    *(("impulse", f'{HEAD}, "impulse": {value}}}')
      for value in ("48", '"press"', "[1]", '{"F": 48}', '{"jz": -1, "dx": 3}')),
    *(("jx", f'{HEAD}, "impulse": {{"jx": {value}}}}}')
      for value in ("NaN", "null", '"inf"', "[1]")),
    ("z", HEAD + ', "z": 0.5}'), ("friction", HEAD + ', "friction": -1}'),
    ("a", "#"), ("a", "https://pages.example/live"), ("b", "file:///live.html#a=2"),
    *(("b", f"#a=2&b={text}") for text in ("", "nan", "pi", "10°", "-1")),
    ("b", "#a=2&b=1&b=1"), ("jx", "#a=2&b=1&jx=x"), ("jx", "#a=2&b=1&jx=inf"),
    ("height", OLDER), ("height", OLDER + "&height=nan"), ("z", OLDER + "&height=inf"),
    ("mass", "#a=2&b=1&k=1"), ("inertia", OLDER.replace("k=1", "k=0&height=0")),
    ("theta", OLDER.replace("theta=0", "theta=inf&height=0")),
]  # fmt: skip
RESISTED = Scene(2.0, 1.0, theta=0.3, friction=1.0, rolling_resistance=0.02)
rolling = partial(rl.simulate, **USUAL, model="rolling")
multipliers = partial(rl.simulate, **USUAL, model="multipliers")

REFUSALS: list[Row] = [
    # scenes and impulses
    *wrong(
        Scene, AXES,
        a=[*NOT_POSITIVE, 1e40], b=NOT_POSITIVE, mass=NOT_POSITIVE, gravity=NOT_POSITIVE,
        inertia=[*NOT_POSITIVE, 1e40, 3.6e-6, 4.4e6], slope=[math.pi / 2, -2.0, 30.0, *NOT_FINITE],
        friction=[-0.1, -1e-300, -INF, NAN, 1e7], restitution=[-0.1, 1.0000001, *NOT_FINITE],
        rolling_resistance=[-1e-300, 0.5000001, *NOT_FINITE, "1 mm"],
        theta=[*NOT_FINITE, 1e51], omega=[*NOT_FINITE, 1e51, 1e8], x=[*NOT_FINITE, 1e51],
        x_dot=[*NOT_FINITE, 1e8], z=[*NOT_FINITE, 1e13, 0.5, 0.9], z_dot=[*NOT_FINITE, -0.1, 1e8],
        impulse=[1, 48.0, (0.0, -48.0), "press", Impulse(jx=1e9), Impulse(jx=[1.0, 2.0]),
                 Impulse(jx=0.0, jz=-1.0, dx=3.0)],
    ),
    *(("a/b", lambda _, a=a, b=b: Scene(a, b))
      for a, b in ((1e4, 1.0), (1000.1, 1.0), (1.0, 1000.1), (1e-9, 1.0), (1.0, 1e-20))),
    *wrong(Impulse, {}, **{
        name: [*NOT_FINITE, 1e51, [1.0, 1e60], *([1.0, -2.0, value] for value in NOT_FINITE)]
        for name in ("jx", "jz", "dx", "dz")
    }),
    *wrong(Impulse.press, {"F": 48.0, "d": 1.5}, F=[*NOT_FINITE, 1e51], d=[*NOT_FINITE, -1e51]),
    *wrong(Scene, {"a": 1e-20, "b": 1e-20, "z": 1e-9}, x_dot=[1e3], z_dot=[-1e3]),
    *((TypeError, lambda _, of=of: of(a=2.0, b=1.0, mu=0.3)) for of in (Scene, rl.classify)),
    ("changes", lambda _: ROLLING.replace(color=1)),
    *wrong(ROLLING.replace, {}, omega=[NAN], z=[0.5], b=[-1.0]),
    *(("z", lambda _, new=new: Scene(2.0, 1.0, z=1.0).replace(**new))
      for new in ({"theta": 0.5}, {"b": 1.5})),
    ("impulse", lambda _: Scene(2.0, 1.0, impulse=Impulse.press(48.0, 1.5)).replace(a=1.4)),
    *wrong(AIR.to_mjcf, {}, timestep=[*NOT_POSITIVE, 5e-324, 1e300], contact_steps=NOT_POSITIVE),
    ("restitution", lambda _: AIR.replace(restitution=0.5).to_mjcf()),
    *(("friction", lambda _, to=to: to()) for to in (AIR.to_mjcf, AIR.to_sdf)),
    # scenes as text, and links to the live page with the names of Scene or with older names
    *((key, lambda _, source=source: Scene.from_json(source)) for key, source in SOURCES),
    ("source", from_a_file),
    *wrong(ROLLING.to_link, {}, t=[*NOT_POSITIVE, "6"], page=[None, 5, b"page"]),
    # bodies with rolling resistance
    *(("rolling_resistance", lambda _, verb=verb: verb(RESISTED)) for verb in (
        Scene.to_sdf, rl.period, rl.outcome, rl.required_friction,
        partial(rl.required_friction, to="rest"), partial(rl.blow_to, distance=1.0),
        partial(rl.blow_to, distance=1.0, omega=3.0), partial(rl.work_precision, t_end=1.0),
        lambda scene: rl.rolling_equation(scene)(0.0, [0.1, 0.2]),
        lambda scene: rl.outcome(scene, Impulse.press(1.0, [0.5, 0.6])),
    )),
    *(("rolling_resistance", run(scene=RESISTED, **how)) for how in (
        {"model": "rolling"}, {"model": "multipliers"}, {"method": "dopri5"})),
    ("wrt", lambda _: rolling(scene=Scene(2.0, 1.0, omega=5.4, friction=1.0)).sensitivity(
        "rolling_resistance", side=1)),
    # times and settings
    *wrong(
        rl.simulate, USUAL,
        scene=[None, 2.0, "report", (2.0, 1.0), [1.0] * 10**5, "x" * 10**5],
        t=[(0, 6), NAN, INF, -1.0, [[1.0]], [[0.0, 1.0]], [1.0, 1.0], [0.0, 2.0, 1.0], [-1.0, 0.0],
           [0.0, NAN], [0.0, INF], [], 1e25, 1e30, "1", (0.0, 2.5), (-0.0, 1e9)],
        model=[*UNKNOWN, "falling"], method=UNKNOWN, rtol=[-1.0, NAN, INF, "tight"],
        atol=[-1e-9, NAN, INF], max_steps=[0, 2**31, 500.0, 1e6], max_events=[0, -3],
        baumgarte=[1.0, (1.0,), (1.0, 2.0, 3.0)], rest_speed=[-1.0, 0.0, NAN, INF],
        step=[0.1], stabilization=["glue", None],
        blows=[3, None, (1.0, PRESS), [(1.0, PRESS, PRESS)], [(1.0, None)], [(1.0, MANY_BLOWS)],
               [("1", PRESS)], [(NAN, PRESS)], [(-1.0, PRESS)], [(INF, PRESS)], [(9.0, PRESS)],
               [(0.5, PRESS), (0.25, PRESS)], [(0.5, Impulse.press(1.0, 9.0))],
               [(0.5, Impulse(jx=1e50))]],
        stop=["x", "", 42, 1.5, object(), len, ["slip", "x"], ("decided", "rest"), np.ma.masked],
        count=[0, 2, -1, 1.5, "x"],
    ),
    *wrong(rl.simulate, {"scene": scenes.jump, "t": INF, "stop": "impact"},
           t=[-1.0, NAN, [0.0, INF]], count=[0, 10_001], max_events=[0]),
    *(("stop", run(stop="impact", **how)) for how in (
        {"model": "rolling"}, {"model": "multipliers"}, {"method": "dopri5"})),
    *(("blows", run(blows=[(0.5, PRESS)], **how)) for how in (
        {"model": "rolling"}, {"model": "multipliers"}, {"method": "dopri5"})),
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
