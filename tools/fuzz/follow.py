"""What is asked of a trajectory after it was made: its arrays, methods, copies, files, pictures."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

from . import promises
from .case import Line
from .scenes import Body
from .values import EXTREMES, Draw, call, text

ARRAYS = (
    "t", "x", "z", "theta", "psi", "r", "x_dot", "z_dot", "omega", "psi_dot", "r_dot", "x_ddot",
    "z_ddot", "omega_dot", "psi_ddot", "r_ddot", "q", "q_dot", "contact_x", "turns",
    "normal_force", "friction_force", "friction_needed", "multipliers", "energy",
    "kinetic_energy", "potential_energy", "mode",
)  # fmt: skip
FACTS = ("events", "success", "stats", "message", "reason", "valid_until", "t_end", "span")
MEMBERS = ("t", "theta", "omega", "x", "about", "mode", "z", "coordinates", "start")
FACT_KEYS = (
    "schema", "scene", "settings", "status", "events", "model", "method", "message", "reason",
    "valid_until", "t_end", "span", "stats",
)  # fmt: skip
JSON = (
    "None", "0", "-1", "1e308", "nan", "inf", "'x'", "[]", "{}", "[1]", "{'a': 1.0}", "True",
    "'COMPLETED'", "'contact'", "'rolling'", "'multipliers'", "'JAMMED'", "2**70", "'\\x00'",
)  # fmt: skip
FILE = "'trajectory.npz'"
NEST = '{"scene": '
DIGITS = "'1' * 5000"  # more than Python makes an int of

Follow = Callable[[Draw, Body], Iterator[Line]]


def arrays(draw: Draw, _: Body) -> Iterator[Line]:
    for name in draw.random.sample((*ARRAYS, *FACTS), 3):
        yield Line(f"trajectory.{name}", does=f"Trajectory.{name}")
    if draw.chance(0.2):
        yield Line("(repr(trajectory), hash(trajectory))", does="Trajectory.__repr__")
        yield Line("trajectory._repr_html_()", does="Trajectory._repr_html_")
        yield Line("trajectory == copy.deepcopy(trajectory) or 1 / 0", does="Trajectory.__eq__")


def sol(draw: Draw, of: Body) -> Iterator[Line]:
    end = "trajectory.t_end"
    inside = [draw.random.random() for _ in range(draw.count(30))]
    code = draw.weighted(
        (
            f"{end} * np.array({inside})", end, f"{end} * {inside[0]}", "trajectory.t",
            "trajectory.t[::-3]", "[]", f"np.nextafter({end}, inf)", "-5e-324", "[0.0, -0.0]",
            f"np.full(3, {end})", draw.hostile(), f"{end} / {draw.power(0, 300)!r}",
        ),
        (6, 1, 2, 1, 1, 0.2, 0.3, 0.2, 0.5, 0.5, 1, 1),
    )  # fmt: skip
    yield Line(call("trajectory.sol", code), "other", "Trajectory.sol")
    name = draw.pick(*ARRAYS)
    yield Line(f"other.{name}", does=f"Trajectory.{name}")


def sol_at_samples(_draw: Draw, _: Body) -> Iterator[Line]:
    code = "trajectory.sol(trajectory.t)"
    yield Line(code, "again", "Trajectory.sol", promises.same_at_samples)


def sol_in_any_order(draw: Draw, _: Body) -> Iterator[Line]:
    """Times shuffled, and some of them twice."""
    ascending = f"np.sort([*trajectory.t, *trajectory.t[::{draw.count(9)}]])"
    yield Line(f"trajectory.sol({ascending})", "ascending", "Trajectory.sol")
    order = f"np.random.default_rng({draw.count(1000)}).permutation(ascending.t.size)"
    yield Line(order, "order", "permutation")
    code = "trajectory.sol(ascending.t[order])"
    yield Line(code, "again", "Trajectory.sol", promises.same_in_any_order)


def scene_at(draw: Draw, _: Body) -> Iterator[Line]:
    share = draw.pick("0.0", "1.0", repr(draw.random.random()), repr(draw.random.random()))
    code = f"{share} * trajectory.t_end" if draw.chance(0.9) else draw.hostile()
    yield Line(call("trajectory.scene_at", code), "scene", "Trajectory.scene_at")
    if draw.chance(0.5):
        options = {"max_steps": "500", "max_events": "20", "raise_on_failure": "False"}
        yield Line(call("rl.simulate", "scene", "trajectory.t_end", **options), "on", "simulate")


def when(draw: Draw, _: Body) -> Iterator[Line]:
    """At a value that one of the samples has, in a sense or both."""
    name = draw.pick("theta", "x", "z", "omega", "contact_x")
    sample = f"trajectory.{name}[{draw.random.randrange(100)} % trajectory.t.size]"
    given = {name: sample if draw.chance(0.7) else text(draw.between(-3, 3))}
    if draw.chance(0.2):
        given = {
            "function": draw.pick(
                "lambda m: m.normal_force - 1", "lambda m: m.t", "lambda m: 1.0", "3"
            )
        }
    if draw.chance(0.4):
        given["direction"] = draw.pick("1", "-1", "0", "2", "None")
    given = draw.mutated(given) if draw.chance(0.1) else given
    code = ", ".join(f"{key}={value}" for key, value in given.items())
    made = f"trajectory.t.size and trajectory.when({code})"
    yield Line(made, "times", "Trajectory.when", patience=20)
    share = draw.pick("0.0", "1.0", repr(draw.random.random()), "2.0")
    yield Line(f"trajectory.at({share} * trajectory.t_end)", does="Trajectory.at")


def residuals(_draw: Draw, _: Body) -> Iterator[Line]:
    yield Line("trajectory.constraint_residuals()", does="Trajectory.constraint_residuals")


def save_and_load(draw: Draw, _: Body) -> Iterator[Line]:
    yield Line(f"trajectory.save({FILE})", does="Trajectory.save")
    yield Line(f"rl.load({FILE})", "loaded", "load", promises.same_as_trajectory)
    name = draw.pick(*ARRAYS, *FACTS)
    yield Line(f"loaded.{name}", does=f"Trajectory.{name}")


def saved_elsewhere(draw: Draw, _: Body) -> Iterator[Line]:
    """A path that cannot be written, or is none; numbers would be open files of the fuzzer."""
    path = draw.hostile() if draw.chance(0.5) else draw.pick(
        "Path('trajectory.npz')", "b'trajectory.npz'", "'missing/file.npz'", "'.'", "'a\\0b'",
        "1.0", "['trajectory.npz']",
    )  # fmt: skip
    if "'" not in path:
        path = "None"
    yield Line(f"trajectory.save({path})", does="Trajectory.save")


def damaged_file(draw: Draw, _: Body) -> Iterator[Line]:
    yield Line(f"trajectory.save({FILE})", does="Trajectory.save")
    member, key = text(draw.pick(*MEMBERS)), text(draw.pick(*FACT_KEYS))
    share = repr(draw.random.random())
    values = draw.pick(
        "np.zeros(3)", "np.zeros((2, 2))", "np.array('x')", "np.array([1j])", "np.array(5.0)",
        "np.array([nan])", "np.zeros(0)", "np.zeros(3, dtype=np.int8)", "np.zeros(10**6)",
    )  # fmt: skip
    yield Line(
        draw.weighted(
            (
                f"damage.cut({FILE}, {share})",
                f"damage.flip({FILE}, {share}, {draw.random.randrange(1, 256)})",
                f"damage.member({FILE}, {member}, {values})",
                f"damage.member({FILE}, {member}, None)",
                f"damage.fact({FILE}, {key}, {draw.pick(*JSON)})",
                f"damage.inner_fact({FILE}, {share}, {draw.pick(*JSON)})",
                bomb(draw, member),
            ),
            (1, 3, 2, 1, 3, 4, 3),
        ),
        does="damage",
    )
    yield Line(f"rl.load({FILE})", "loaded", "load", forgery=True)
    for name in draw.random.sample((*ARRAYS, *FACTS), 2):
        yield Line(f"loaded.{name}", does=f"loaded.{name}", forgery=True)
    if draw.chance(0.3):
        yield Line("loaded.sol(loaded.t_end)", does="loaded.sol", forgery=True)


def bomb(draw: Draw, member: str) -> str:
    """Small files that would become large, or deep, if somebody unpacked them."""
    shape = draw.pick("(10**18,)", "(-1,)", "(2**62, 2**62)", "(3.0,)", "(1,)*40", "('a',)", "3")
    kind = draw.pick("<f8", "O", "<U1000000000", "V8", ">f8", "f8,i4", "M8[s]", "x")
    said = repr(f"{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}\n")
    long = f"'{{' + ' ' * {draw.count(10**7)}"
    header = draw.pick(said, said, long, "'(' * 9000", "''")
    return draw.pick(
        f"damage.packed({FILE}, {draw.pick('10**9', '10**6')})",
        f"damage.header({FILE}, {member}, {header}, {draw.pick('1', '2', '3')})",
        f"damage.twice({FILE}, {draw.pick(text('t'), text('about'))})",
        f"damage.nested({FILE}, {draw.count(10**6)}, {draw.pick(text('['), text(NEST))})",
        f"damage.text({FILE}, {draw.pick(text(''), text('1e999'), text('null'), DIGITS)})",
    )


def pickled(draw: Draw, _: Body) -> Iterator[Line]:
    same = promises.same_as_trajectory
    code = f"pickle.loads(pickle.dumps(trajectory, {draw.random.randrange(6)}))"
    yield Line(code, "copied", "pickle", same)
    yield Line("copied.sol(copied.t_end).x", does="pickle")
    what, share = draw.pick("trajectory", "trajectory.scene"), draw.random.random()
    bits = f"{draw.random.randrange(6)}, {share!r}, {draw.random.randrange(1, 256)}"
    made = f"damage.unpickled({what}, {bits})"
    yield Line(made, does="damage", patience=10, forgery=True)  # pickle itself asks for gigabytes


def copied(draw: Draw, _: Body) -> Iterator[Line]:
    does = draw.pick("copy.copy", "copy.deepcopy", "replace")
    yield Line(f"{does}(trajectory)", "copied", does, promises.same_as_trajectory)
    yield Line("copied.sol(copied.t_end).x", does=does)


def replaced(draw: Draw, _: Body) -> Iterator[Line]:
    """A trajectory with fields that do not go together: to be refused, or to be harmless."""
    values = draw.pick(
        "np.zeros(0)", "np.zeros(1)", "np.zeros(3)", "np.zeros((3, 2))", "np.zeros(5000)", "None",
        "trajectory.t[:-1]", "np.zeros(trajectory.t.shape, np.float32)",
        "np.full(trajectory.t.shape, nan)",
        "trajectory.t.astype(complex)", "[1.0]", "'x'", "np.array(1.0)", "[None]",
    )  # fmt: skip
    field = draw.pick("t", "theta", "omega", "x", "theta", "omega", "x", "contact", "coordinates")
    if field == "contact" and draw.chance(0.7):
        inner = draw.pick("z", "x_dot", "z_dot", "normal_force", "friction_force", "mode")
        whole = "trajectory.contact"
        values = f"{whole} and {whole}._replace({inner}={values})"
    elif field == "coordinates" and draw.chance(0.7):
        values = f"({values}, trajectory.q_dot)"
    yield Line(f"replace(trajectory, {field}={values})", "forged", "replace", forgery=True)
    for name in draw.random.sample(ARRAYS, 4):
        yield Line(f"forged.{name}", does=f"replaced.{name}", forgery=True)
    yield Line("forged.constraint_residuals()", does="replaced.residuals", forgery=True)


def tables(draw: Draw, _: Body) -> Iterator[Line]:
    name = draw.pick("to_dataframe", "to_xarray")
    yield Line(f"trajectory.{name}()", does=f"Trajectory.{name}", patience=2)


def event(draw: Draw, _: Body) -> Iterator[Line]:
    yield Line("[(e.t, e.kind, e.state_before, e.state_after) for e in trajectory.events]", "",
               "Trajectory.events")  # fmt: skip
    yield Line("pickle.loads(pickle.dumps(trajectory.events)) == trajectory.events", does="pickle")
    yield Line("(repr(trajectory.events), trajectory.events._repr_html_())", does="Events")
    if draw.chance(0.1):
        yield Line("trajectory.events.to_dataframe()", does="Events.to_dataframe", patience=2)


def picture(draw: Draw, of: Body) -> Iterator[Line]:
    """A plot of one motion or two, or a film of a few frames."""
    motions = draw.pick("trajectory", "trajectory", "[trajectory, rl.simulate(rl.scenes.drop, 2)]")
    name = draw.pick(
        "plot", "plot_strobe", "plot_phase", "plot_forces", "plot_energy", "plot_constraints",
        "plot_paths", "plot_error", "animate",
    )  # fmt: skip
    options: dict[str, str] = {}
    if name in ("plot", "plot_strobe"):
        motions = "trajectory"
        some = {"count": text(draw.count(30)), "t_end": "trajectory.t_end / 2"}
    elif name == "animate":
        options = {"max_frames": text(draw.count(6)), "width": text(draw.pick(160, 320))}
        suffix = draw.pick("gif", "gif", "html", "png", "")
        some = {
            "path": text(f"film.{suffix}"), "fps": draw.pick("25.0", "50", "10", "30"),
            "speed": draw.pick("1.0", "0.1", repr(draw.power(-3, 3))),
            "dpi": draw.pick("100.0", "50", "1.0"), "labels": draw.pick("['a', 'b']", "'ab'"),
        }  # fmt: skip
    else:
        some = {"labels": draw.pick("['a']", "['a', 'b']", "'a'", "['$', '_b']")}
        some |= {"kind": draw.pick("'energies'", "'error'")} if name == "plot_energy" else {}
        some |= {"fold": draw.pick("True", "False")} if name == "plot_phase" else {}
    if name == "plot" or name == "animate":
        some["figure"] = draw.pick("None", "plt.figure()", "plt.figure(figsize=(3, 9))")
    else:
        some["ax"] = draw.pick("None", "plt.figure().add_subplot()", "plt.subplots(2)[1]")
    options |= {key: value for key, value in some.items() if draw.chance(0.4)}
    if draw.chance(0.3):
        key = draw.pick(*options, *some)
        options[key] = draw.pick(*EXTREMES[:14], draw.pick("None", "'x'", "[]", "1j", "True"))
    yield Line(call(f"rl.{name}", motions, **options), "picture", name, patience=6)
    if name == "animate":
        frame = draw.pick("0", "-1", "len(picture.t) - 1", draw.hostile())
        yield Line(f"picture.draw({frame})", does="RollingAnimation.draw", patience=2)
    yield Line("plt.close('all')", does="close")


# (what, weight): a newcomer adds a line
FOLLOWS: tuple[tuple[Follow, float], ...] = (
    (arrays, 10),
    (sol, 5),
    (sol_at_samples, 2),
    (sol_in_any_order, 1),
    (scene_at, 3),
    (when, 3),
    (residuals, 2),
    (save_and_load, 1.0),
    (saved_elsewhere, 0.3),
    (damaged_file, 1.5),
    (pickled, 0.7),
    (copied, 0.5),
    (replaced, 1.5),
    (event, 1),
    (tables, 0.2),
    (picture, 0.12),
)


def follow(draw: Draw, of: Body, made: Line) -> Iterator[Line]:
    """The line that makes a trajectory, and up to three questions to it."""
    yield replace(made, name="trajectory")
    questions, weights = zip(*FOLLOWS, strict=True)
    for _ in range(draw.pick(0, 1, 1, 2)):
        yield from draw.weighted(questions, weights)(draw, of)
