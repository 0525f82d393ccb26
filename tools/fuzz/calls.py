"""Cases of the fuzzer, such as a call to a public function, or a motion and calls that use it.

A case is a list of lines of Python. Each line is an expression, assigned to a name if later lines
use its value. A line with the word "forged" uses damaged data, which may contain NaN and break
promises.
"""

from __future__ import annotations

import inspect
import math
import re
from collections.abc import Callable
from typing import Any

import rolling_ellipse as rl
from hypothesis import strategies as st

from . import damage, scenes
from .scenes import Body
from .values import SHAPES, Draw, call

MODULES = {"rl": rl, "rl.geometry": rl.geometry, "rl.impacts": rl.impacts, "rl.report": rl.report}
#: Public functions by their names in the lines.
FUNCTIONS: dict[str, Callable[..., Any]] = {
    f"{prefix}.{name}": getattr(module, name)
    for prefix, module in MODULES.items()
    for name in module.__all__
    if inspect.isfunction(getattr(module, name))
}
PICTURES = tuple(name for name in FUNCTIONS if "plot" in name or "animate" in name)
#: Functions with cases of their own, which `any_function` does not draw.
OWN = ("rl.simulate", "rl.simulate_many", "rl.ends", "rl.load", "rl.load_many", *PICTURES)
#: Functions that use files or take seconds per call; tests/refusals tests their arguments.
SLOW = (
    "rl.examples", "rl.explore", "rl.fit_motion", "rl.read_track", "rl.work_precision",
    "rl.report.errata", "rl.report.errata_table",
)  # fmt: skip
PLAIN = tuple(name for name in FUNCTIONS if name not in (*OWN, *SLOW))

Ask = Callable[[Draw, Body], object]


def _beside(name: str) -> Callable[[Draw, Body], float]:
    return lambda draw, of: of.values[name] * draw.pick(1.0, 1.0, draw.between(0.999, 1.001))


def _time(draw: Draw, of: Body) -> float:
    size = draw.pick(draw.between(0, 20), draw.power(-3, 3), draw.power(-250, 250))
    return draw.pick(1, -1) * of.clock * size


#: How to draw a number for an argument, by its name; functions of arrays get arrays of these.
NUMBERS: dict[str, Callable[[Draw, Body], float]] = {
    **{name: _beside(name) for name in ("a", "b", "mass")},
    "t": _time,
    "theta": scenes.angle,
    "omega": scenes.speed,
    "slope": lambda d, of: of.values["slope"],
    "x_dot": scenes.velocity,
    "z_dot": scenes.velocity,
    "friction": scenes.friction,
    "restitution": lambda d, of: d.pick(0.0, 1.0, d.between(0, 1), 5e-324),
    "gyration2": lambda d, of: of.length**2 * d.pick(0.25, d.between(0.01, 1), d.power(-6, 6)),
    "gravity": lambda d, of: of.values["gravity"],
    "F": lambda d, of: of.length / of.clock * d.power(-2, 2) * d.between(-1, 1),
    **dict.fromkeys(("d", "distance"), lambda d, of: of.length * d.between(-1, 1)),
    **dict.fromkeys(("jx", "jz", "dx", "dz"), lambda d, _: d.between(-3, 3)),
}  # fmt: skip
#: Prefixes of the names of functions whose arguments are single numbers.
OF_NUMBERS = ("thresholds", "blow_to", "fit", "eq_48", "struck_speed", "simulate")


def _vector(entries: int) -> Ask:
    def asked(draw: Draw, _: Body) -> object:
        shape = (*draw.pick((), (), (3,), (0,), (2, 2)), entries)
        return draw.array([draw.between(-3, 3) for _ in range(math.prod(shape))], shape)

    return asked


def _state(place: int) -> Ask:
    """Coordinates (place 0) or velocities (place 1) that meet the constraints, or any numbers."""

    def asked(draw: Draw, of: Body) -> object:
        if draw.chance(0.3):
            return _vector(5)(draw, of)
        start = (repr(f(draw, of)) for f in (scenes.angle, scenes.speed))
        axes = {name: repr(of.values[name]) for name in ("a", "b")}
        return f"{call('rl.kinematics', *start, **axes)}[{place}]"

    return asked


def _rows(count: int) -> Ask:
    def asked(draw: Draw, _: Body) -> object:
        rows = ((-3, 3), (-2, 2), (-3, -1), (-0.1, 0.1))[-count:]
        return [[draw.between(*row) for _ in range(2)] for row in rows]

    return asked


def _one(*texts: object) -> Ask:
    return lambda draw, _: draw.pick(*texts)


#: Other arguments by name, as source text.
OTHERS: dict[str, Ask] = {
    "scene": lambda d, of: d.hostile() if d.chance(0.02) else scenes.scene(d, of, 0.1),
    "workers": _one(1, 1, 2, 3, -1, 100),
    "q": _state(0), "q_dot": _state(1), "q_ddot": _vector(5), "multipliers": _vector(4),
    "law": _one("'stronge'", "'poisson'", "'newton'", "'all'"),
    "minimise": _one("'median'", "'rms'"), "sigma": _one("None", 0.1),
    "before": _rows(4), "after": _rows(3),
    "printed": _one("()", "rl.report.CODE", "rl.report.MATRIX", "rl.report.EQ_32", "('tan', 'f1')"),
    "complete": _one("True", "False"), "case": _one("'1'", "'2'", "'as_it_is'"),
    "to": _one("'roll'", "'rest'"), "wrt": _one("'t'", "'theta'", "('a', 'omega')", "('gravity',)"),
    "impulse": lambda d, of: d.pick("None", scenes.impulse(d, of)),
    # options of `report.simulate`
    "equations": _one("'corrected'", "'printed'"), "method": _one("'dopri5'", "'rk4'", "'dop853'"),
    "consistent": _one("'refuse'", "'project'", "'as_given'"),
    "stabilization": _one("'none'", "'baumgarte'", "'projection'"), "baumgarte": _one((1.0, 1.0)),
    "rtol": _one(1e-6), "atol": _one(1e-6), "step": lambda d, of: of.clock * d.power(-2, 0),
    "max_steps": lambda d, of: d.count(100),
}  # fmt: skip


def arguments(draw: Draw, of: Body, name: str) -> dict[str, str]:
    """Arguments of a public function: all required ones and some optional ones."""
    shape = () if name.rpartition(".")[2].startswith(OF_NUMBERS) else draw.pick(*SHAPES)
    found = {}
    for each, parameter in inspect.signature(FUNCTIONS[name]).parameters.items():
        optional = parameter.default is not parameter.empty
        if optional and each not in ("max_steps", "gravity") and draw.chance(0.6):
            continue
        number = NUMBERS.get(each)
        if each in ("t", "step") and name == "rl.report.simulate":
            number = lambda d, body: body.clock * d.between(0.01, 3)  # noqa: E731
        if number is None:
            found[each] = str(OTHERS[each](draw, of))
        elif shape == () or draw.chance(0.6):
            found[each] = repr(number(draw, of))
        else:
            values = [number(draw, of) for _ in range(math.prod(shape))]
            found[each] = draw.array(values, shape)
    return draw.mutated(found)


def any_function(draw: Draw, of: Body) -> list[str]:
    """One call to a public function, and the representations of its result as text and HTML."""
    asked = (*["rl.flow"] * 6, *["rl.classify", "rl.certify", "rl.period", "rl.blow_to"] * 3)
    asked += ("rl.outcome", "rl.thresholds", "rl.impacts.collide", "rl.report.simulate") * 2
    name = draw.pick(*asked, *PLAIN)
    line = f"found = {call(name, **arguments(draw, of, name))}"
    return [line, "(repr(found), str(found), getattr(found, '_repr_html_', str)())"]


# -------------------------------------------------------------------- scenes, motions, and files

QUANTITIES = (
    "t", "theta", "omega", "x", "status", "message", "valid_until", "t_end", "span",
    *(name for name, each in vars(rl.Trajectory).items()
      if not name.startswith("_") and (isinstance(each, property) or hasattr(each, "func"))),
)  # fmt: skip
MEMBERS = ("t", "theta", "omega", "x", "mode", "z", "coordinates", "start")
JSON = ("None", "0", "-1", "1e308", "nan", "inf", "'x'", "[]", "{}", "[1]", "{'a': 1.0}", "True",
        "'COMPLETED'", "'contact'", "'rolling'", "'multipliers'", "2**70", "'\\x00'")  # fmt: skip
ARRAYS = (
    "np.zeros(0)", "np.zeros(1)", "np.zeros(3)", "np.zeros((3, 2))", "np.zeros(5000)", "None",
    "trajectory.t[:-1]", "np.full(trajectory.t.shape, nan)", "trajectory.t.astype(complex)",
    "np.zeros(trajectory.t.shape, np.float32)", "[1.0]", "np.array('x')", "np.array(1.0)", "[None]",
    "np.zeros(3, dtype=np.int8)", "np.array([1j])",
)  # fmt: skip
FILE = "'trajectory.npz'"
SPOIL = (
    *[f"damage.flip({FILE}, {{share}}, {{mask}})"] * 3,
    *[f"damage.member({FILE}, {{member!r}}, {{array}})"] * 2,
    *[f"damage.fact({FILE}, {{share}}, {{json}})"] * 7,
    f"Path({FILE}).write_bytes({{bytes}})",
)  # fmt: skip
VALUES = ("theta=trajectory.theta[{n} % trajectory.t.size]", "x=trajectory.x[0]", "omega={number}",
          "z=trajectory.z[-1]", "contact_x={number}", "function=lambda m: m.normal_force - 1",
          "function=lambda m: m.t", "function=lambda m: 1.0", "function=3", "x={hostile}",
          "theta={number}, direction={sign}", "theta={number}, z=1.0")  # fmt: skip
TIMES = (
    *["trajectory.t_end * np.array([{share}, {other_share}, 0.5])"] * 5, "trajectory.t_end",
    "trajectory.t", "trajectory.t[::-3]", "[]", "np.nextafter(trajectory.t_end, inf)", "-5e-324",
    "[0.0, -0.0]", "np.full(3, trajectory.t_end)", "{hostile}", "trajectory.t_end / 10**{hundred}",
)  # fmt: skip
ORDER = "np.random.default_rng({n}).permutation(ascending.t.size)"
QUANTITY = "trajectory.{quantity}"
FORGED = ("forged.{quantity}",) * 3
SAME = "promises.same(trajectory, other)"

#: Lines that use a motion, with their weights; `filled` replaces the names in braces.
QUESTIONS: tuple[tuple[int, tuple[str, ...]], ...] = (
    (20, (QUANTITY, QUANTITY, QUANTITY)),
    (4, ("(repr(trajectory), hash(trajectory), trajectory._repr_html_())",
         "trajectory == copy.deepcopy(trajectory) or 1 / 0")),
    (10, ("other = trajectory.sol({times})", "other.{quantity}")),
    (4, ("other = trajectory.sol(trajectory.t)", "promises.same_at_samples(trajectory, other)")),
    (3, ("ascending = trajectory.sol(np.sort([*trajectory.t, *trajectory.t[::{nine}]]))",
         f"order = {ORDER}", "other = trajectory.sol(ascending.t[order])",
         "promises.same_in_any_order(ascending, other, order)")),
    (5, ("scene = trajectory.scene_at({share} * trajectory.t_end)",
         "rl.simulate(scene, trajectory.t_end, max_steps=500, max_events=20, "
         "raise_on_failure=False)")),
    (1, ("trajectory.scene_at({hostile})",)),
    (6, ("times = trajectory.t.size and trajectory.when({value})",
         "trajectory.at({share} * trajectory.t_end)")),
    (3, ("trajectory.constraint_residuals()",)),
    (3, (f"trajectory.save({FILE})", f"other = rl.load({FILE})", SAME, "other.{quantity}")),
    (1, ("trajectory.save({path})",)),
    (1, (f"Path({FILE}).write_bytes({{bytes}})", "forged = rl.load({path})")),
    (6, (f"trajectory.save({FILE})", "{spoil}", f"forged = rl.load({FILE})", *FORGED[:2],
         "forged.sol(forged.t_end)")),
    (3, ("other = pickle.loads(pickle.dumps(trajectory, {protocol}))", SAME,
         "other.sol(other.t_end).x")),
    (2, ("other = {copied}(trajectory)", SAME, "other.sol(other.t_end).x")),
    (5, ("forged = replace(trajectory, {field}={array})", *FORGED,
         "forged.constraint_residuals()")),
    (1, ("forged = replace(trajectory, coordinates=({array}, trajectory.q_dot))", *FORGED)),
    (2, ("forged = replace(trajectory, contact=trajectory.contact and "
         "trajectory.contact._replace({part}={array}))", *FORGED)),
    (2, ("pickle.loads(pickle.dumps(trajectory.events)) == trajectory.events or 1 / 0",
         "(repr(trajectory.events), trajectory.events._repr_html_())")),
    (1, ("trajectory.to_dataframe()", "trajectory.to_xarray()",
         "trajectory.events.to_dataframe()")),
    (1, ("picture = {picture}", "plt.close('all')")),
)  # fmt: skip
WEIGHTED = tuple(lines for weight, lines in QUESTIONS for _ in range(weight))


def filled(draw: Draw, of: Body, line: str) -> str:
    """Replace each name in braces in a line with a randomly drawn expression."""

    def picture() -> str:
        name = draw.pick(*(name for name in PICTURES if name != "rl.plot_phase_map"))
        first, *others = inspect.signature(FUNCTIONS[name]).parameters
        odd = [draw.pick(*others)] if draw.chance(0.3) else []
        return call(name, **{first: "trajectory"}, **{each: draw.odd(each) for each in odd})

    makes: dict[str, Callable[[], object]] = {
        "quantity": lambda: draw.pick(*QUANTITIES), "share": draw.share,
        "other_share": lambda: draw.pick(0.0, 1.0, draw.share()), "n": lambda: draw.whole(0, 999),
        "times": lambda: filled(draw, of, draw.pick(*TIMES)), "mask": lambda: draw.whole(1, 255),
        "nine": lambda: draw.whole(1, 9), "extreme": draw.extreme, "hostile": draw.hostile,
        "value": lambda: filled(draw, of, draw.pick(*VALUES)),
        "number": lambda: draw.between(-3, 3), "sign": lambda: draw.pick(1, -1, 0, 2, "None"),
        "spoil": lambda: filled(draw, of, draw.pick(*SPOIL)),
        "protocol": lambda: draw.whole(0, 5), "hundred": lambda: draw.whole(0, 300),
        "member": lambda: draw.pick(*MEMBERS),
        "array": lambda: draw.pick(*ARRAYS),
        "json": lambda: draw.pick(*JSON), "picture": picture,
        "bytes": lambda: draw.pick("b''", "b'PK'", "b'PK\\x05\\x06' + bytes(18)", "b'{}'"),
        "path": lambda: draw.pick("Path('trajectory.npz')", "b'trajectory.npz'", "'no/file.npz'",
                                  "'.'", "'a\\0b'", "1.0", "['trajectory.npz']", "None", "''"),
        "copied": lambda: draw.pick("copy.copy", "copy.deepcopy", "replace"),
        "field": lambda: draw.pick("t", "theta", "omega", "x", "contact", "coordinates"),
        "part": lambda: draw.pick("z", "x_dot", "z_dot", "normal_force", "friction_force", "mode"),
    }  # fmt: skip

    def one(found: re.Match[str]) -> str:
        value = makes[found[1]]()
        return repr(value) if found[2] else str(value)

    return re.sub(rf"\{{({'|'.join(makes)})(!r)?\}}", one, line)


def motion(draw: Draw, of: Body) -> list[str]:
    """A motion, and up to two groups of lines that use it."""
    t, last = scenes.times(draw, of)
    asked = {"scene": scenes.scene(draw, of, 0.03), "t": t, **scenes.settings(draw, last)}
    asked = draw.mutated(asked) if draw.chance(0.35) else asked
    lines = [f"trajectory = {call('rl.simulate', **asked)}"]
    for _ in range(draw.pick(1, 1, 0, 2)):
        lines += [filled(draw, of, line) for line in draw.pick(*WEIGHTED)]
    return lines


def scene(draw: Draw, of: Body) -> list[str]:
    press = {"F": "5.0", "d": repr(draw.between(-1, 1))}
    change = {draw.pick("a", "theta", "z", "friction", "omga"): repr(draw.between(-3, 3))}
    return [
        f"scene = {scenes.scene(draw, of, 0.6)}",
        "state = scene.initial_state",
        "(repr(state), str(state), state._repr_html_())",
        "(scene.gyration2, hash(scene), str(scene), scene._repr_html_())",
        "eval('rl.' + repr(scene).replace('Impulse', 'rl.Impulse')) == scene or 1 / 0",
        f"pickle.loads(pickle.dumps(scene, {draw.whole(0, 5)})) == scene or 1 / 0",
        "trajectory = rl.simulate(scene, [0.0], model='contact', max_steps=2000, max_events=100)",
        "promises.same_mode(state, trajectory)",
        call("scene.replace", **draw.mutated(change)),
        call("scene.to_mjcf", timestep=draw.hostile(), contact_steps=draw.odd("contact_steps")),
        f"rl.outcome(scene, {call('rl.Impulse.press', **draw.mutated(press))})",
    ]


def many(draw: Draw, of: Body) -> list[str]:
    """Several scenes, in a list or from arrays, and a folder of their motions."""
    t, last = scenes.times(draw, of)
    columns = {name: draw.array([NUMBERS[name](draw, of) for _ in range(3)])
               for name in ("a", "b", "theta", "omega")}  # fmt: skip
    columns["gravity"] = repr(of.values["gravity"])
    asked = {
        "scenes": draw.pick(call("dict", **draw.mutated(columns)),
                            f"[{scenes.scene(draw, of)}] * {draw.count(20)}"),
        "t": t, **scenes.settings(draw, last), "workers": draw.pick("1", "2", "-1"),
    }  # fmt: skip
    asked = draw.mutated(asked) if draw.chance(0.3) else asked
    lines = [f"found = {call('rl.simulate_many', **asked)}", "repr(found[:3])"]
    only = {name: asked[name] for name in ("scenes", "t", "workers", "rest_speed") if name in asked}
    lines += [f"repr({call('rl.ends', **only)})"] if draw.chance(0.3) else []
    if draw.chance(0.3):
        file = f"sorted(map(str, Path(folder).iterdir()))[-{draw.pick(1, 2)}]"
        lines += [
            f"folder = {call('rl.simulate_many', **{**asked, 'out': 'tempfile.mkdtemp()'})}",
            "promises.same(found, list(rl.load_many(folder)))",
            f"damage.flip({file}, {draw.share()!r}, {draw.whole(1, 255)})",
            "forged = list(rl.load_many(path=folder))",
        ]
    return lines


_TABLE = "t,x,z,theta,x_dot,z_dot,omega\\n" + "".join(f"{t / 2},0,1,0,0,0,0\\n" for t in range(9))
#: Contents of files: texts in other encodings, huge fields, odd bytes, damaged tables.
CONTENTS = (
    *(f"'{_TABLE}'.encode('{code}')" for code in ("utf-8", "utf-8-sig", "utf-16", "utf-32")),
    f"'{_TABLE}'.replace('omega', 'größe').encode('latin-1')", f"b'{_TABLE}' + b'1' * 200_000",
    f"b'{_TABLE}'.replace(b'0', b'{{extreme}}')", f"b'{_TABLE}'[:{{n}} % 120]", "bytes({n})",
    f"b'{_TABLE}'.replace(b',', b';')", f"b'{_TABLE}'.replace(b'0', b'\"')",
    "b'{{}}'", "b'PK\x03\x04'",
)  # fmt: skip
#: Calls that read or write at a path where a hostile object may be.
ON_FILES = (
    *["rl.load(path='there/a')", "rl.WorkPrecision.load(path='there/a')"],
    *["forged = rl.read_track(path='there/a', t='t', x='x', z='z', scale={extreme})"] * 3,
    *["forged = rl.read_track(path='there/a', theta='theta', fps={extreme})"] * 2,
    *["forged = rl.benchmark.score(results='there')"] * 2,
    "rl.load_many(path='there')",
    "promises.marked('8.1', ROLLING_ELLIPSE_IMPACTS='there/a')",
    "promises.keeps(rl.examples, folder='there')",
    "promises.keeps(rl.benchmark.export, folder='there')",
)
NAMES_OF = {
    "score": ("roll.rock.csv", "roll.rock.events.csv"), "load_many": ("request.npz", "end.json"),
    "examples": ("01_first_roll.ipynb", "reference", "reference/well_reference.csv"),
    "export": ("README.txt", "roll.rock.csv", "roll.rock.json", "mine.txt"),
}  # fmt: skip


def files(draw: Draw, of: Body) -> list[str]:
    """A file or another object at a path, and a call that reads or writes at this path."""
    line, kind = draw.pick(*ON_FILES), draw.pick(*["file"] * 8, *damage.THINGS)
    names = next((each for part, each in NAMES_OF.items() if f".{part}" in line), ("a",))
    content = filled(draw, of, draw.pick(*CONTENTS))
    return [f"damage.put({kind!r}, 'there/{draw.pick(*names)}', {content})", filled(draw, of, line)]


def arrays(draw: Draw, of: Body) -> list[str]:
    """A motion from arrays of extreme numbers."""
    size = draw.pick(1.0, 1.0, draw.power(-320, 307))
    tracks = {
        name: draw.array([draw.between(-3, 3) * scale for _ in range(6)])
        for name, scale in (("x", size), ("z", 1.0), ("theta", draw.pick(1.0, size)))
    }
    times = f"np.arange(6) ** 1.5 * {draw.pick(1.0, draw.power(-323, 307))}"
    asked = draw.mutated({"t": times, **tracks, "scene": scenes.scene(draw, of)})
    lines = [f"forged = {call('rl.Trajectory.from_arrays', **asked)}"]
    return [*lines, *(filled(draw, of, line) for line in FORGED), "forged.sol(forged.t_end)"]


#: Kinds of cases with their weights, the simplest first.
CASES: dict[Callable[[Draw, Body], list[str]], int] = {
    motion: 90, any_function: 70, scene: 16, files: 10, many: 4, arrays: 4,
}  # fmt: skip
_KINDS = tuple(kind for kind, weight in CASES.items() for _ in range(weight))


@st.composite
def cases(draw: st.DrawFn) -> list[str]:
    choices = Draw(draw)
    kind = choices.pick(*_KINDS)
    return kind(choices, scenes.body(choices))
