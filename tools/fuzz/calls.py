"""The table of calls: what is driven, how often, and how its arguments are drawn."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

from . import promises, scenes
from .case import Line
from .follow import follow
from .values import SHAPES, Draw, call, text

Generator = Callable[[Draw], Iterator[Line]]


@dataclass(frozen=True)
class Call:
    """One entry of the table.

    Attributes
    ----------
    name : str
        For --only and for reports.
    weight : float
        How often, beside the others.
    lines : function
        Draws the lines of a case.
    """

    name: str
    weight: float
    lines: Generator


# ------------------------------------------------------------------------------------- scenes


def make_scene(draw: Draw) -> Iterator[Line]:
    code = scenes.scene(draw, mutate=0.6).code
    yield Line(code, "scene", "Scene")
    yield Line("scene.initial_state", "state", does="Scene.initial_state")
    yield Line("(repr(state), str(state), state._repr_html_())", does="InitialState")
    yield Line("(scene.gyration2, hash(scene), str(scene), scene._repr_html_())", does="Scene")
    yield Line("eval('rl.' + repr(scene).replace('Impulse', 'rl.Impulse')) == scene", does="Scene")
    name = draw.pick("a", "theta", "z", "friction", "omga")
    value = text(draw.between(-3, 3))
    yield Line(call("scene.replace", **draw.mutated({name: value})), does="Scene.replace")
    if draw.chance(0.2):
        protocol = draw.random.randrange(6)
        yield Line(f"pickle.loads(pickle.dumps(scene, {protocol})) == scene", does="pickle")


def make_impulse(draw: Draw) -> Iterator[Line]:
    numbers = {name: text(draw.between(-3, 3)) for name in ("jx", "jz", "dx", "dz")}
    yield Line(call("rl.Impulse", **draw.mutated(numbers)), does="Impulse")
    numbers = {"F": text(draw.between(0, 3)), "d": text(draw.between(-1, 1))}
    yield Line(call("rl.Impulse.press", **draw.mutated(numbers)), does="Impulse.press")


def blows(draw: Draw) -> Iterator[Line]:
    """What becomes of blows, the friction that is needed, and the blow that does something."""
    drawn = scenes.scene(draw)
    yield Line(drawn.code, "scene", "Scene")
    yield Line("rl.required_friction(scene)", does="required_friction")
    strength = drawn.body.a / drawn.body.clock * draw.power(-2, 2)
    reach = drawn.body.a * draw.between(-1, 1)
    numbers = _columns(draw, {"F": lambda: strength * draw.between(-1, 1), "d": lambda: reach})
    yield Line(call("rl.Impulse.press", **draw.mutated(numbers)), "blow", "Impulse.press")
    yield Line(draw.pick("rl.outcome(scene, blow)", "rl.outcome(scene)"), does="outcome")
    wanted = {"scene": "scene", "distance": text(reach)}
    if draw.chance(0.5):
        wanted["omega"] = text(draw.between(-3, 3) / drawn.body.clock)
    yield Line(call("rl.blow_to", **draw.mutated(wanted)), does="blow_to")


def certify(draw: Draw) -> Iterator[Line]:
    yield Line(_scene_or_not(draw), "scene", "Scene")
    yield Line("rl.certify(scene)", "proof", does="certify")
    yield Line("(repr(proof), str(proof), proof._repr_html_())", does="Certificate")


def period(draw: Draw) -> Iterator[Line]:
    yield Line(_scene_or_not(draw), "scene", "Scene")
    yield Line("rl.period(scene)", does="period")


def _scene_or_not(draw: Draw) -> str:
    return draw.hostile() if draw.chance(0.02) else scenes.scene(draw).code


def modes(draw: Draw) -> Iterator[Line]:
    yield Line(scenes.scene(draw).code, "scene", "Scene")
    yield Line("scene.initial_state", "state", "Scene.initial_state")
    code = "rl.simulate(scene, [0.0], model='contact', max_steps=2000, max_events=100)"
    yield Line(code, "trajectory", "simulate", promises.mode_at_start)


# ----------------------------------------------------------------------------------- simulate


def simulate(draw: Draw) -> Iterator[Line]:
    drawn = scenes.scene(draw, mutate=0.03)
    t, last = scenes.times(draw, drawn.body)
    arguments = {"scene": drawn.code, "t": t, **scenes.settings(draw, last, drawn.body.mild)}
    patience = 1
    if draw.chance(0.35):
        arguments = draw.mutated(arguments)
        for name in ("max_steps", "max_events"):  # no more work than the time of a call holds
            arguments[name] = arguments.get(name, "200").replace("2**31 - 1", "2**31")
    elif drawn.body.mild and 0 < last < 20 * drawn.body.clock and draw.chance(0.05):
        arguments = {"scene": drawn.code, "t": t}
        patience = 4  # 1e6 steps at 2 microseconds, where nothing else ends it
    made = Line(call("rl.simulate", **arguments), does="simulate", patience=patience)
    yield from follow(draw, drawn.body, made)


def many(draw: Draw) -> Iterator[Line]:
    """Several scenes, each of its own or of arrays; each beside itself alone, and out of a file."""
    drawn = scenes.scene(draw)
    of = drawn.body
    t, last = scenes.times(draw, of)
    columns = _columns(draw, {**_axes(draw, of), **_start(draw, of)})
    columns["gravity"] = text(of.gravity)
    arrays = "dict(" + ", ".join(f"{k}={v}" for k, v in draw.mutated(columns).items()) + ")"
    which = draw.pick(arrays, f"[{drawn.code}] * {draw.count(20)}", f"iter([{drawn.code}])")
    arguments = {"scenes": which, "t": t, **scenes.settings(draw, last, of.mild)}
    arguments["workers"] = text(draw.pick(1, 2, -1))
    if draw.chance(0.3):
        arguments = draw.mutated(arguments)
        for name in ("max_steps", "max_events"):  # no more work than the time of a call holds
            arguments[name] = arguments.get(name, "200").replace("2**31 - 1", "2**31")
    yield Line(call("rl.simulate_many", **arguments), "found", "simulate_many", patience=4)
    yield Line("repr(found[:3])", does="simulate_many")
    if draw.chance(0.2):
        arguments["out"] = f"'many{draw.random.randrange(10**9)}'"
        code = call("rl.simulate_many", **arguments)
        yield Line(code, "folder", "simulate_many", patience=8)
        yield Line("list(rl.load_many(folder))", "loaded", "load_many", promises.same_many, 8)
        files, share = "sorted(map(str, Path(folder).iterdir()))", draw.random.random()
        file = f"{files}[int({share!r} * len({files}))]"
        bits = f"{draw.random.random()!r}, {draw.random.randrange(1, 256)}"
        yield Line(f"damage.flip({file}, {bits})", does="damage")
        yield Line("list(rl.load_many(path=folder))", does="load_many", patience=8, forgery=True)


def stopped(draw: Draw) -> Iterator[Line]:
    """What an integration raises that stops early: it goes to other processes, too."""
    early = draw.pick("max_events=1", "model='rolling', method='dop853', max_steps=1")
    yield Line(f"caught(rl.simulate, rl.scenes.jump, 5.0, {early})", "error", "IntegrationError")
    protocol = draw.random.randrange(6)
    for code in (
        "(str(error), repr(error), error.trajectory.t)",
        f"pickle.loads(pickle.dumps(error, {protocol})).trajectory",
        "copy.copy(error).trajectory",
    ):
        yield Line(code, does="IntegrationError")


# ------------------------------------------------------------------------- functions of arrays


def _columns(draw: Draw, ranges: dict[str, Callable[[], float]]) -> dict[str, str]:
    """Arguments that broadcast: numbers, and arrays of one shape."""
    shape = draw.pick(*SHAPES)
    size = math.prod(shape)
    found = {}
    for name, number in ranges.items():
        single = shape == () or draw.chance(0.6)
        found[name] = (
            text(number()) if single else draw.array([number() for _ in range(size)], shape)
        )
    return found


def _axes(draw: Draw, of: scenes.Body) -> dict[str, Callable[[], float]]:
    def axis(value: float) -> float:
        return value if draw.chance(0.8) else value * draw.between(0.999, 1.001)

    return {"a": lambda: axis(of.a), "b": lambda: axis(of.b)}


def flow(draw: Draw) -> Iterator[Line]:
    of = scenes.body(draw)

    def time() -> float:
        if of.mild:
            return of.clock * draw.between(-20, 20)
        return draw.pick(1, -1) * of.clock * draw.pick(draw.power(-3, 3), draw.power(-250, 250))

    arguments = _columns(draw, {"t": time, **_axes(draw, of), **_start(draw, of)})
    if draw.chance(0.2):
        arguments["t"] = f"np.linspace(0, {time()!r}, {draw.count(2000)})"
    arguments |= _options(draw, of)
    yield Line(call("rl.flow", **draw.mutated(arguments)), does="flow")


def classify(draw: Draw) -> Iterator[Line]:
    of = scenes.body(draw)
    ranges = {**_axes(draw, of), **_start(draw, of), "friction": lambda: scenes.friction(draw)}
    arguments = _columns(draw, ranges) | _options(draw, of)
    yield Line(call("rl.classify", **draw.mutated(arguments)), does="classify")


def _start(draw: Draw, of: scenes.Body) -> dict[str, Callable[[], float]]:
    return {
        "theta": lambda: scenes.angle(draw, of.mild),
        "omega": lambda: scenes.speed(draw, of),
    }


def _options(draw: Draw, of: scenes.Body) -> dict[str, str]:
    found = {"gravity": text(of.gravity)}
    if draw.chance(0.3):
        found["gyration2"] = text(scenes.gyration2(draw, of))
    if draw.chance(0.2):
        found["workers"] = text(draw.pick(1, 2, 3, -1, 100))
    return found


def thresholds(draw: Draw) -> Iterator[Line]:
    of = scenes.body(draw)
    arguments = {"a": text(of.a), "b": text(of.b), "gravity": text(of.gravity)}
    if draw.chance(0.5):
        arguments["gyration2"] = text(scenes.gyration2(draw, of))
    if draw.chance(0.7):
        arguments["friction"] = text(scenes.friction(draw))
    yield Line(call("rl.thresholds", **draw.mutated(arguments)), "found", "thresholds")
    yield Line("(repr(found), str(found), found._repr_html_())", does="Thresholds")


def kinematics(draw: Draw) -> Iterator[Line]:
    of = scenes.body(draw)
    arguments = _columns(draw, _start(draw, of)) | {"a": text(of.a), "b": text(of.b)}
    yield Line(call("rl.kinematics", **draw.mutated(arguments)), "states", "kinematics")
    axes = {"a": text(of.a), "b": text(of.b)}
    arguments = {"q": "states[0]", "q_dot": "states[1]", **axes}
    if draw.chance(0.3):
        arguments["q"] = draw.array([draw.between(-3, 3) for _ in range(5)])
    yield Line(call("rl.constraints", **draw.mutated(arguments)), does="constraints")


def geometry(draw: Draw) -> Iterator[Line]:
    of = scenes.body(draw)
    name = draw.pick(
        "arc_length", "centre_path", "contact_angle", "contact_distance", "curvature_radius",
        "support", "support_curvature", "support_slope",
    )  # fmt: skip
    arguments = _columns(draw, {"theta": lambda: scenes.angle(draw, of.mild), **_axes(draw, of)})
    yield Line(call(f"rl.geometry.{name}", **draw.mutated(arguments)), does=f"geometry.{name}")


# ------------------------------------------------------------------------------------ impacts


def _velocities(draw: Draw, of: scenes.Body) -> dict[str, Callable[[], float]]:
    def velocity() -> float:
        share = draw.pick(0.0, draw.between(-3, 3), draw.between(-3, 3), draw.between(-1e-9, 1e-9))
        return of.length / of.clock * (share if of.mild else share * draw.power(-50, 50))

    return {
        "theta": lambda: scenes.angle(draw, of.mild), "x_dot": velocity, "z_dot": velocity,
        "omega": lambda: scenes.speed(draw, of),
    }  # fmt: skip


def collide(draw: Draw) -> Iterator[Line]:
    of = scenes.body(draw)
    ranges = {
        **_velocities(draw, of), **_axes(draw, of), "friction": lambda: scenes.friction(draw),
        "restitution": lambda: draw.pick(0.0, 1.0, draw.between(0, 1), 5e-324),
    }  # fmt: skip
    arguments = _columns(draw, ranges)
    if draw.chance(0.4):
        arguments["gyration2"] = text(scenes.gyration2(draw, of))
    if draw.chance(0.6):
        arguments["law"] = text(draw.pick("stronge", "poisson", "newton"))
    yield Line(call("rl.impacts.collide", **draw.mutated(arguments)), does="impacts.collide")
    columns = _columns(draw, {k: v for k, v in _velocities(draw, of).items() if k != "theta"})
    arguments = draw.mutated({**columns, "gyration2": text(scenes.gyration2(draw, of))})
    yield Line(call("rl.impacts.kinetic_speed", **arguments), does="impacts.kinetic_speed")


def fit(draw: Draw) -> Iterator[Line]:
    of, count = scenes.body(draw), draw.pick(1, 2, 5)
    series = [
        [scenes.angle(draw, of.mild) for _ in range(count)],
        [draw.between(-2, 2) for _ in range(count)],
        [draw.between(-3, -1) for _ in range(count)],
        [draw.between(-0.1, 0.1) for _ in range(count)],
    ]
    after = [[draw.between(-2, 2) for _ in range(count)] for _ in range(3)]
    arguments = {"before": text(series), "after": text(after), "a": text(of.a), "b": text(of.b)}
    if draw.chance(0.4):
        arguments["gyration2"] = text(scenes.gyration2(draw, of))
    if draw.chance(0.5):
        arguments["law"] = text(draw.pick("stronge", "poisson", "newton"))
        arguments["minimise"] = text(draw.pick("median", "rms"))
    code = call("rl.impacts.fit", **draw.mutated(arguments))
    yield Line(code, "fitted", "impacts.fit", patience=3)
    yield Line("(fitted.median_error, fitted.rms_error, repr(fitted))", does="FittedImpacts")


# --------------------------------------------------------------------------------- the report

_OF_BODY = {"a", "b", "mass", "gravity"}
REPORT = {  # arguments of each function
    "appendix_b_r_x": ("q", "a", "b"),
    "appendix_b_radius": ("theta", "a", "b"),
    "case_lead": ("theta", "a", "b"),
    "case_sign": ("theta",),
    "complete_f": ("q", "q_ddot", "a", "b", "mass", "gravity"),
    "consistent_rates": ("q", "omega", "a", "b", "printed"),
    "constraint_matrix": ("q", "a", "b", "printed"),
    "constraint_rates": ("q", "q_dot", "a", "b"),
    "contact_x": ("q", "a", "b"),
    "eq_5": ("theta", "a", "b"),
    "eq_38": ("q", "q_dot", "a", "b"),
    "eq_39": ("q", "q_ddot", "a", "b", "mass", "gravity"),
    "eq_40": ("q", "q_ddot", "a", "b", "mass", "gravity"),
    "eq_41": ("q", "q_ddot", "a", "b", "mass", "gravity", "complete"),
    "eq_42": ("q", "q_ddot", "a", "b", "mass", "gravity"),
    "eq_48": ("impulse", "d", "a", "b", "mass"),
    "eqs_33_to_37": ("q", "q_ddot", "multipliers", "a", "b", "mass", "gravity"),
    "equations_of_motion": ("q", "q_ddot", "multipliers", "a", "b", "mass", "gravity"),
    "f1": ("q", "q_dot", "case"),
    "f2": ("q",),
    "f3": ("q", "a", "b"),
    "f4": ("q", "a", "b"),
    "lambda4_numerator": ("q", "q_ddot", "a", "b", "mass", "gravity"),
    "multipliers": ("q", "q_ddot", "a", "b", "mass", "gravity"),
    "struck_speed": ("impulse", "d", "a", "b", "mass"),
}
PRINTED = ("()", "rl.report.CODE", "rl.report.MATRIX", "rl.report.EQ_32", "('tan', 'f1')", "'df3'")


def report_formula(draw: Draw) -> Iterator[Line]:
    """One of the report's equations, at a state that meets its constraints or at any."""
    of, name = scenes.body(draw), draw.pick(*REPORT)
    states = draw.pick((), (), (3,), (0,), (2, 2))
    code = call("rl.kinematics", text(scenes.angle(draw, of.mild)), text(scenes.speed(draw, of)),
                a=text(of.a), b=text(of.b))  # fmt: skip
    if states:
        code = f"[np.broadcast_to(v, {(*states, 5)}) for v in {code}]"
    yield Line(code, "states", "kinematics")

    def vector(entries: int) -> str:
        count = entries * math.prod(states)
        return draw.array([draw.between(-3, 3) for _ in range(count)], (*states, entries))

    drawn = {
        "q": "states[0]" if draw.chance(0.7) else vector(5),
        "q_dot": "states[1]" if draw.chance(0.7) else vector(5),
        "q_ddot": vector(5), "multipliers": vector(4), "a": text(of.a), "b": text(of.b),
        "mass": text(draw.pick(1.0, draw.power(-30, 30))), "gravity": text(of.gravity),
        "theta": _columns(draw, {"theta": lambda: scenes.angle(draw, of.mild)})["theta"],
        "omega": vector(1) + "[..., 0]" if states else "1.0",
        "printed": draw.pick(*PRINTED), "complete": draw.pick("True", "False"),
        "case": draw.pick("'1'", "'2'", "'as_it_is'"), "impulse": text(draw.between(0, 3)),
        "d": text(draw.between(-1, 1)),
    }  # fmt: skip
    arguments = draw.mutated({key: drawn[key] for key in REPORT[name]})
    yield Line(call(f"rl.report.{name}", **arguments), does=f"report.{name}")


def report_simulate(draw: Draw) -> Iterator[Line]:
    of = scenes.body(draw)
    axes = {"a": text(of.a), "b": text(of.b)}
    start = text(scenes.angle(draw, of.mild)), text(scenes.speed(draw, of))
    yield Line(call("rl.kinematics", *start, **axes), "start", "kinematics")
    last = draw.between(0, 3) * of.clock
    times = f"np.linspace(0, {last}, {draw.count(200)})" if last else "[0.0]"
    arguments = {"q": "start[0]", "q_dot": "start[1]", "t": times, **axes}
    arguments |= {"gravity": text(of.gravity), "max_steps": text(draw.count(100))}
    if draw.chance(0.4):
        arguments["q"] = f"start[0] + {text(draw.power(-18, 0))}"
        arguments["consistent"] = text(draw.pick("refuse", "project", "as_given"))
    printed = draw.chance(0.5)
    if printed:
        arguments |= {"equations": "'printed'", "printed": draw.pick(*PRINTED, "None")}
    method = draw.pick("dopri5", "rk4") if printed else draw.pick("dop853", "dopri5", "rk4")
    arguments["method"] = text(method)
    if method == "rk4":
        arguments["step"] = text(last / draw.power(0, 2))
    if not printed and draw.chance(0.3):
        arguments["stabilization"] = text(draw.pick("none", "baumgarte", "projection"))
    if draw.chance(0.4):
        arguments = draw.mutated(arguments)
        if "**" in arguments["max_steps"]:  # no more work than the time of a call holds
            arguments["max_steps"] = "50"
    made = Line(call("rl.report.simulate", **arguments), "motion", "report.simulate", patience=4)
    if not printed:
        yield from follow(draw, of, made)
        return
    yield made
    for what in ("gap", "energy", "constraint_residuals()", "back_substitution()", "start"):
        yield Line(f"motion.{what}", does=f"PrintedMotion.{what}")
    yield Line("repr(motion)", does="PrintedMotion.__repr__")


def errata(draw: Draw) -> Iterator[Line]:
    yield Line("rl.report.errata_table()", does="report.errata_table", patience=4)
    which = draw.random.random()
    code = f"(lambda found: found[int({which} * len(found))].evaluate())(rl.report.errata())"
    yield Line(code, does="report.errata", patience=4)


# ------------------------------------------------------------------- pictures, files, command


def phase_map(draw: Draw) -> Iterator[Line]:
    x, y = draw.pick(("aspect", "energy"), ("aspect", "friction"), ("energy", "friction"),
                     ("speed", "aspect"), ("aspect", "speed"), ("friction", "speed"))  # fmt: skip
    arguments = {"x": text(x), "y": text(y), "resolution": text(draw.count(30)), "workers": "1"}
    some = {
        "b": text(draw.pick(2.0, draw.power(-30, 30))), "gravity": text(draw.power(-30, 30)),
        "x_range": text(_range(draw, x)), "y_range": text(_range(draw, y)),
        **{name: text(_of_map(draw, name)) for name in ("aspect", "energy", "speed", "friction")
           if name not in (x, y) and draw.chance(0.4)},
    }  # fmt: skip
    if "speed" in (x, y):
        some.pop("energy", None)
    arguments |= {name: value for name, value in some.items() if draw.chance(0.5)}
    if draw.chance(0.5):
        arguments = draw.mutated(arguments)
        if arguments["resolution"][:2].isdigit():
            arguments["resolution"] = "20"
    yield Line(call("rl.plot_phase_map", **arguments), does="plot_phase_map", patience=6)
    yield Line("plt.close('all')", does="close")


def explore(draw: Draw) -> Iterator[Line]:
    yield Line(_scene_or_not(draw), "scene", "Scene")
    t_end = draw.pick("None", text(draw.between(0, 3)), text(draw.power(-30, 30)))
    arguments = {"scene": "scene", "t_end": t_end}
    yield Line(call("rl.explore", **draw.mutated(arguments)), "explorer", "explore")
    if draw.chance(0.05):
        yield Line("len(explorer._repr_html_()) > 20_000", does="Explorer", patience=20)


def _of_map(draw: Draw, name: str) -> float:
    return draw.pick(1.5, draw.power(0, 3)) if name == "aspect" else draw.pick(
        0.0, draw.between(0, 3), draw.power(-10, 10)
    )  # fmt: skip


def _range(draw: Draw, name: str) -> tuple[float, float]:
    first, last = sorted((_of_map(draw, name), _of_map(draw, name)))
    return first, draw.pick(last, last * (1 + 2**-52), 2 * last)


# of JSON
TEXTS = ("','", "':'", "'{'", "'['", "']'", "'}'", "'1'", "'null'", "'\"'", "'e-'", "'NaN'", "''")


def race(draw: Draw) -> Iterator[Line]:
    drawn = scenes.scene(draw)
    while not drawn.body.mild:  # others may take a million steps in one call
        drawn = scenes.scene(draw)
    ways = (
        "flow", "exact", "dop853", "dopri5", "rk4", "gauss", "radau", "contact",
        "multipliers/rk4/none", "multipliers/radau/ggl", "multipliers/dop853/projection",
    )  # fmt: skip
    arguments = {
        "scene": drawn.code,
        "t_end": text(drawn.body.clock * draw.between(0.01, 3)),
        "methods": text(draw.random.sample(ways, draw.pick(1, 2, 3))),
        "tolerances": text([draw.power(-14, 0) for _ in range(2)]),
        "steps": text([drawn.body.clock * draw.power(-2, 0)]),
        "samples": "4", "rounds": "2", "max_seconds": "0.2",
    }  # fmt: skip
    if draw.chance(0.4):
        arguments = draw.mutated(arguments)
        if arguments.get("max_seconds", "60")[:1].isdigit():  # no more work than asked for
            arguments["max_seconds"] = "0.2"
    made = call("rl.work_precision", **arguments)  # NaN are the figures of what has no answer
    yield Line(made, "found", does="work_precision", patience=6, forgery=True)
    yield Line("(found.verdict(), found.not_run(1e-8), repr(found))", does="verdict")
    yield Line("found.save('race.json') or repr(rl.WorkPrecision.load('race.json'))", does="save")
    old, new = draw.pick(*TEXTS), draw.pick(*TEXTS, "'['*99999", "'1'*9999")
    spoil = f"damage.line('race.json', {draw.random.random()!r}, {old}, {new})"
    yield Line(spoil, does="damage")
    yield Line("repr(rl.WorkPrecision.load(path='race.json'))", does="load", forgery=True)
    yield Line("found.plot()", does="WorkPrecision.plot", patience=6)
    yield Line("plt.close('all')", does="close")


def load(draw: Draw) -> Iterator[Line]:
    """What is no file of ours; files of ours are read where trajectories are asked."""
    content = draw.pick("b''", "b'PK'", "b'PK\\x05\\x06' + bytes(18)", "b'{}'", "bytes(1000)")
    yield Line(f"Path('other.npz').write_bytes({content})", does="write_bytes")
    path = draw.pick("'other.npz'", "'other.npz'", "'.'", "'missing'", "'\\0'", draw.hostile())
    if path.lstrip("-")[:1].isdigit() or path.startswith(("True", "type(")):
        path = "'missing'"  # an open file of the fuzzer's own, by number
    yield Line(f"rl.load({path})", does="load", forgery=True)


def command(draw: Draw) -> Iterator[Line]:
    names = ("a", "b", "mass", "theta", "omega", "friction", "restitution", "slope", "time")
    arguments = []
    for name in draw.random.sample(names, draw.pick(0, 1, 2, 3)):
        value = draw.pick("1", "0.5", "2", "-1", "x", "nan", "inf", "1e300", "1e-300", "", "1e9")
        if name != "time" or "1e" not in value:  # work that would be asked for
            arguments.append(f"--{name}={value}")
    if draw.chance(0.3):
        arguments += ["--press", draw.pick("20", "-1e-3", "nan"), draw.pick("1", "-1.5", "1e9")]
    if draw.chance(0.2):
        arguments.append(draw.pick("--model=contact", "--model=multipliers", "--method=dop853"))
    arguments += ["--json"] if draw.chance(0.3) else []
    # 1e6 steps, where nothing else ends it
    yield Line(f"command({arguments})", does="python -m rolling_ellipse", patience=8)


# A newcomer adds a line; weights are chosen for some 15 ms a case.
CALLS = (
    Call("simulate", 45, simulate),
    Call("modes", 6, modes),
    Call("many", 2, many),
    Call("stopped", 0.2, stopped),
    Call("scene", 8, make_scene),
    Call("impulse", 1, make_impulse),
    Call("blows", 4, blows),
    Call("certify", 6, certify),
    Call("period", 4, period),
    Call("flow", 8, flow),
    Call("classify", 6, classify),
    Call("thresholds", 4, thresholds),
    Call("kinematics", 3, kinematics),
    Call("geometry", 5, geometry),
    Call("collide", 5, collide),
    Call("fit", 0.05, fit),
    Call("formulas", 4, report_formula),
    Call("report", 1, report_simulate),
    Call("errata", 0.02, errata),
    Call("phase_map", 0.15, phase_map),
    Call("explore", 0.3, explore),
    Call("race", 0.1, race),
    Call("load", 0.3, load),
    Call("command", 0.3, command),
)


def case(seed: int, index: int, only: str = "") -> tuple[str, list[Line]]:
    """The lines of one case, and the name of its entry in the table."""
    draw = Draw(seed, index)
    entries = [entry for entry in CALLS if only in ("", entry.name)]
    entry = draw.weighted(entries, [entry.weight for entry in entries])
    return entry.name, list(entry.lines(draw))
