"""Public functions give bit-identical results for arrays of any memory layout.

Each row of a result equals a single call bit for bit. Functions of numbers broadcast, and each
element of a result equals a single call bit for bit.
"""

import inspect
import itertools
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
import rolling_ellipse as rl
from rolling_ellipse import Impulse, Scene, Trajectory, benchmark, geometry, impacts, report

Array = np.ndarray[Any, np.dtype[np.float64]]
COUNT = 100  # rows of each array
AXES: dict[str, Any] = {"a": 2.0, "b": 1.0}
HEAVY: dict[str, Any] = {**AXES, "mass": 3.0, "gravity": 9.81}
rng = np.random.default_rng(8)


def within(low: float, high: float, *shape: int) -> Array:
    return rng.uniform(low, high, (COUNT, *shape))


BODY = {"a": within(0.5, 3), "b": within(0.4, 2)}
START = {"theta": within(-3, 3), "omega": within(-4, 4)}
MOTION = rl.simulate(Scene(**AXES, omega=3.2), 6.0)
ROLL = benchmark.problem("roll.roll")
HIT: dict[str, Any] = {
    "theta": within(-1.5, 1.5), "x_dot": within(0, 1), "z_dot": within(-2.8, -2.4),
    "omega": within(-8, 8),
}  # fmt: skip
AFTER = np.stack(impacts.collide(**HIT, a=0.035, b=0.025, friction=0.2, restitution=0.5))
AFTER += rng.normal(0, 0.03, AFTER.shape)
TIMES = np.sort(within(0, 5))
Q, Q_DOT = rl.kinematics(START["theta"], START["omega"], **AXES)
FORCES = {"q": Q, "q_ddot": within(-1, 1, 5)}
DAE = {form: ROLL.dae(form) for form in ("index3", "index2", "index1", "ggl")}


def drawn(form: str) -> dict[str, Array]:
    """States y near the exact motion, and random rates, for one form of the equations."""
    y = DAE[form].exact(TIMES)
    return {"y": y + 0.1 * within(-1, 1, y.shape[1]), "yp": within(-1, 1, y.shape[1])}


@dataclass(frozen=True)
class Call:
    """A function and its arrays. If `rows` is true, it can also be called with each row alone."""

    function: Callable[..., Any]
    given: dict[str, Array]
    rows: bool = True


def of_body(function: Callable[..., Any], *names: str, **body: Any) -> Call:
    arrays = {"q": Q, "q_dot": Q_DOT + 0.1, "multipliers": within(-1, 1, 4), **FORCES, **START}
    return Call(lambda **given: function(**given, **body), {name: arrays[name] for name in names})


def film(t: Array, x: Array, z: Array, theta: Array) -> Any:
    scene = MOTION.scene.replace(omega=3.1)
    found = rl.fit_motion(t, x, z, theta, scene=scene, free=("omega",), sigma=0.01)
    return found.scene.omega, found.errors


SAMPLES = {name: np.array(getattr(MOTION, name)[::20]) for name in ("t", "x", "z", "theta")}
STATES = ROLL.exact(ROLL.output_times) + 1e-3
BLOWS = {"jx": within(-3, 3), "jz": within(-9, 0), "dx": within(-1, 1), "dz": within(-1, 1)}
ACCELERATED = ("eq_39", "lambda4_numerator", "eq_40", "complete_f", "eq_41", "eq_42", "multipliers")
FIRST = np.linspace(0, 9, 7)
CALLS: dict[str, Call] = {
    "flow": Call(rl.flow, {"t": within(-2, 9), **BODY, **START, "gyration2": within(0.2, 2),
                           "gravity": within(1.6, 9.8)}),
    # times of one motion share a table, so that single times agree only to within rounding
    "flow: times": Call(lambda t: rl.flow(t, **AXES, theta=0.1, omega=3.0), {"t": TIMES}, False),
    "flow: slope": Call(rl.flow, {"t": within(0, 5), **BODY, **START, "slope": within(-0.4, 0.4)}),
    "flow_jacobian": Call(
        rl.flow_jacobian, {"t": within(0, 2), **BODY, **START, "gravity": within(1.6, 9.8)}),
    "classify": Call(rl.classify, {**BODY, **START, "friction": within(0, 1),
                                   "gravity": within(1.6, 9.8), "gyration2": within(0.2, 2)}),
    "outcome": Call(lambda **blow: rl.outcome(Scene(2, 1), Impulse(**blow)), BLOWS),
    "Impulse.press": Call(
        lambda F, d: rl.outcome(Scene(2, 1), Impulse.press(F, d)),
        {"F": within(0, 9), "d": within(-2, 2)}),
    "ends": Call(
        lambda t, **s: {name: each for name, each in vars(
            rl.ends({**s, "friction": 0.4}, t)).items() if isinstance(each, np.ndarray)},
        {"t": within(0, 2), **BODY, **START}),
    "Ends.go_on": Call(
        lambda t, **s: {name: each for name, each in vars(
            rl.ends(s, 0.5).go_on(t)).items() if isinstance(each, np.ndarray)},
        {"t": within(1, 2), **BODY, **START}),
    "simulate_many": Call(
        lambda **s: rl.simulate_many({**s, "friction": 0.4}, FIRST / 9, returns=("x", "theta")),
        {**BODY, **START}),
    "simulate": Call(lambda t: rl.simulate(rl.scenes.jump, t), {"t": TIMES}, False),
    "Trajectory.sol": Call(lambda t: MOTION.sol(t), {"t": TIMES[::-1].copy()}, False),
    "Trajectory.when": Call(
        lambda theta: np.reshape(MOTION.when(theta=theta), np.shape(theta)), {"theta": TIMES}),
    "Trajectory.from_arrays": Call(
        lambda **tracks: Trajectory.from_arrays(**tracks, scene=MOTION.scene), SAMPLES, False),
    "fit_motion": Call(film, SAMPLES, False),
    "constraints": of_body(
        lambda **given: vars(rl.constraints(**given)), "q", "q_dot", **AXES),
    "kinematics": of_body(rl.kinematics, "theta", "omega", **AXES),
    "rolling_equation": Call(
        lambda y: rl.rolling_equation(MOTION.scene)(0.0, y.T).T, {"y": within(-4, 4, 3)}),
    **{f"geometry.{name}": Call(getattr(geometry, name), {"theta": within(-9, 9), **BODY})
       for name in geometry.__all__},
    **{f"impacts.collide: {law}": Call(
        lambda law=law, **hit: impacts.collide(**hit, law=law),
        {**HIT, **BODY, "friction": within(0, 1), "restitution": within(0, 1)})
       for law in impacts.LAWS},
    "impacts.kinetic_speed": Call(
        impacts.kinetic_speed,
        {name: HIT[name] for name in ("x_dot", "z_dot", "omega")} | {"gyration2": within(0.2, 1)}),
    **{f"impacts.fit: {measure}": Call(
        lambda before, after, measure=measure: vars(
            impacts.fit(before, after, a=0.035, b=0.025, minimise=measure)),
        {"before": np.stack(list(HIT.values())), "after": AFTER}, False)
       for measure in ("median", "rms")},
    "report.constraint_matrix": of_body(report.constraint_matrix, "q", **AXES),
    "report.constraint_matrix: right": of_body(report.constraint_matrix, "q", **AXES, printed=()),
    "report.constraint_matrix: eq 32": of_body(
        report.constraint_matrix, "q", **AXES, printed=report.EQ_32),
    "report.consistent_rates": of_body(report.consistent_rates, "q", "omega", **AXES),
    "report.simulate": Call(
        lambda q, q_dot, t: report.simulate(q, q_dot, t, **AXES, equations="printed", printed=()).q,
        {"q": Q[0], "q_dot": Q_DOT[0] , "t": FIRST / 90}, False),
    **{f"report.{name}": of_body(getattr(report, name), "theta", **AXES)
       for name in ("eq_5", "case_lead", "appendix_b_radius")},
    "report.case_sign": of_body(report.case_sign, "theta"),
    **{f"report.{name}": of_body(getattr(report, name), "q", **AXES)
       for name in ("f3", "f4", "appendix_b_r_x", "contact_x")},
    "report.f1": of_body(lambda q, q_dot: report.f1(q, q_dot, case="as_it_is"), "q", "q_dot"),
    "report.f2": of_body(report.f2, "q"),
    **{f"report.{name}": of_body(getattr(report, name), "q", "q_dot", **AXES)
       for name in ("eq_38", "constraint_rates")},
    **{f"report.{name}": of_body(getattr(report, name), "q", "q_ddot", **HEAVY)
       for name in ACCELERATED},
    "report.eq_41: complete": of_body(report.eq_41, "q", "q_ddot", **HEAVY, complete=True),
    **{f"report.{name}": of_body(getattr(report, name), "q", "q_ddot", "multipliers", **HEAVY)
       for name in ("eqs_33_to_37", "equations_of_motion")},
    **{f"benchmark.Dae.residual: {form}": Call(
        lambda y, yp, form=form: DAE[form].residual(0.0, y, yp), drawn(form)) for form in DAE},
    **{f"benchmark.Dae.jacobian: {form}": Call(
        lambda y, yp, form=form: DAE[form].jacobian(0.0, y, yp, 0.7),
        {name: values[0] for name, values in drawn(form).items()}, False) for form in DAE},
    "benchmark.Dae.states": Call(DAE["ggl"].states, {"y": drawn("ggl")["y"]}),
    "benchmark.Dae.exact": Call(DAE["ggl"].exact, {"t": TIMES}, False),
    "benchmark.Problem.exact": Call(ROLL.exact, {"t": TIMES}, False),
    "benchmark.Ode.exact": Call(ROLL.ode().exact, {"t": TIMES}, False),
    **{f"benchmark.Ode.rhs: {name}": Call(
        lambda y, name=name: np.asarray(benchmark.problem(name).ode().rhs(0.0, np.asarray(y).T)).T,
        {"y": within(-3, 3, 6)}) for name in ("roll.roll", "slide.stick", "hit.drop_slip")},
    "benchmark.Ode.jump": Call(
        lambda y: benchmark.problem("hit.drop_slip").ode().jump(0.3, y, 0).y0,
        {"y": np.array([0.0, 1.5, 0.4, 0.3, -3.0, 0.5])}, False),
    "benchmark.Gradient.error": Call(
        benchmark.gradients()[0].error, {"value": within(-1, 1)[:6]}, False),
    "benchmark.run": Call(
        lambda states: benchmark.run(lambda *_: states, problems=[ROLL]).records(),
        {"states": STATES}, False),
    "benchmark.score": Call(
        lambda states: benchmark.score({ROLL.id: states}).records(), {"states": STATES}, False),
}  # fmt: skip
LAYOUTS: dict[str, Callable[[Array], Array]] = {
    "Fortran": np.asfortranarray,
    "strided": lambda v: np.repeat(v, 2, axis=-1)[..., ::2],
    "column": lambda v: np.stack([v, v, v], axis=-1)[..., 1],
    "row": lambda v: np.stack([v, v])[1],
    "reversed": lambda v: np.flip(np.flip(v).copy()),
    "read-only": lambda v: np.frombuffer(v.tobytes()).reshape(v.shape),
    "unaligned": lambda v: np.ndarray(v.shape, buffer=b" " + v.tobytes(), offset=1),
    "big-endian": lambda v: v.astype(">f8"),
}  # fmt: skip
each_call = pytest.mark.parametrize("name", CALLS)


def leaves(result: Any) -> list[Any]:
    """The numbers, arrays and strings in a result."""
    if isinstance(result, Trajectory):
        names = ("t", "x", "z", "theta", "omega", "mode", "q", "q_dot")
        return [getattr(result, name) for name in names]
    if isinstance(result, dict):
        return [leaf for value in result.values() for leaf in leaves(value)]
    if isinstance(result, (list, tuple)):
        return [leaf for value in result for leaf in leaves(value)]
    return [result]


def bits(result: Any) -> list[Any]:
    return [
        (leaf.shape, leaf.dtype, leaf.tobytes()) if isinstance(leaf, np.ndarray) else repr(leaf)
        for leaf in leaves(result)
    ]


@each_call
def test_results_are_bit_identical_for_every_memory_layout(name: str) -> None:
    call = CALLS[name]
    given = {key: values.copy() for key, values in call.given.items()}
    expected = bits(call.function(**given))
    for layout, laid in LAYOUTS.items():
        arrays = {key: laid(values) for key, values in given.items()}
        assert bits(call.function(**arrays)) == expected, layout
        for key, values in arrays.items():
            assert np.array_equal(values, call.given[key]), f"{layout}: {key} was changed"


@pytest.mark.parametrize("name", [name for name, call in CALLS.items() if call.rows])
def test_each_row_of_a_batch_equals_a_single_call_bit_for_bit(name: str) -> None:
    """Successive rows have different memory layouts."""
    call, layouts = CALLS[name], list(LAYOUTS.values())
    many = leaves(call.function(**call.given))
    for k in range(COUNT):
        laid = layouts[k % len(layouts)]
        row = {key: laid(each[k]) if each.ndim > 1 else each[k] for key, each in call.given.items()}
        for whole, alone in zip(many, leaves(call.function(**row)), strict=True):
            if isinstance(whole, np.ndarray):
                pair = (np.asarray(each, whole.dtype) for each in (whole[k], alone))
                assert len({each.tobytes() for each in pair}) == 1, k


OF_NUMBERS = [name for name in CALLS if name.startswith(("geometry", "impacts.c", "impacts.k"))]
each_of_numbers = pytest.mark.parametrize("name", [*OF_NUMBERS, "flow", "flow: slope", "classify"])
SHAPES = ((3, 1, 5), (4, 1), (5,), ())  # of successive arguments; they broadcast to (3, 4, 5)


def shaped(name: str, *shapes: tuple[int, ...]) -> dict[str, Array]:
    """The arguments of a function, resized to the given shapes in turn."""
    sizes = zip(CALLS[name].given.items(), itertools.cycle(shapes))
    return {key: np.resize(values, shape) for (key, values), shape in sizes}


def answers(name: str, given: dict[str, Any]) -> tuple[Any, ...]:
    answer = CALLS[name].function(**given)
    return answer if isinstance(answer, tuple) else (answer,)


@each_of_numbers
def test_each_element_of_a_result_equals_a_single_call(name: str) -> None:
    given = shaped(name, *SHAPES)
    arrays, every = answers(name, given), np.broadcast_arrays(*given.values())
    assert all(values.shape == (3, 4, 5) for values in arrays)
    assert all(values.dtype == (np.int8 if name == "classify" else float) for values in arrays)
    for index in np.ndindex(3, 4, 5):
        one = dict(zip(given, (float(values[index]) for values in every), strict=True))
        for kind in (float, np.float64, np.array):
            alone = answers(name, {key: kind(value) for key, value in one.items()})
            assert all(type(value) in (float, rl.Outcome) for value in alone)
            assert alone == tuple(values[index] for values in arrays)


@each_of_numbers
@pytest.mark.parametrize("shape", [(0,), (0, 4), (1,), (1, 1)])
def test_results_have_the_shape_of_the_arguments_and_their_own_memory(
    name: str, shape: Any
) -> None:
    given = shaped(name, (), shape)
    for values in answers(name, given):
        assert values.shape == shape
        assert not any(np.shares_memory(values, each) for each in given.values())


@each_of_numbers
def test_an_invalid_value_next_to_an_empty_array_is_rejected(name: str) -> None:
    given = {key: float(value) for key, value in shaped(name, ()).items()}
    for empty, wrong in itertools.permutations(given, 2):
        with pytest.raises(ValueError, match=rf"^{wrong}(\[0\])? must be"):
            answers(name, given | {empty: np.empty((2, 0)), wrong: np.nan})


def test_coordinates_broadcast_over_all_but_their_last_axis() -> None:
    theta, omega = np.linspace(-2.0, 5.0, 4)[:, None], np.array([0.5, -1.0, 3.0])
    q, q_dot = rl.kinematics(theta, omega, **AXES)
    residuals = vars(rl.constraints(q.tolist(), q_dot, **AXES))
    assert q.shape == q_dot.shape == (4, 3, 5)
    assert [values.shape for values in residuals.values()] == [(4, 3, 3), (4, 3, 4), (4, 3), (4, 3)]
    for i, j in np.ndindex(4, 3):
        single = rl.kinematics(float(theta[i, 0]), float(omega[j]), **AXES)
        assert np.array_equal(single, [q[i, j], q_dot[i, j]])
        alone = vars(rl.constraints(*single, **AXES))
        assert all(np.array_equal(alone[name], residuals[name][i, j]) for name in residuals)
        assert np.ndim(alone["gap"]) == np.ndim(alone["slip"]) == 0
    for one, other in ((q, q_dot[0, 0]), (q[:, :1], q_dot[:1])):
        assert rl.constraints(one, other, **AXES).velocity.shape == (4, 3, 4)
    assert rl.constraints(np.empty((0, 5)), np.empty((0, 5)), **AXES).position.shape == (0, 3)


ANY_KIND = {"Any", "Sequence[Any]", "ArrayLike"}  # annotations of arguments that may be arrays
NO_ARRAYS = {"path", "folder", "figure", "figsize", "ax", "workers", "peers", "printed", "xp"}


def public() -> Iterator[tuple[str, Any]]:
    """Public functions and methods, with names qualified by their module and class."""
    for name in (each for each in dir(rl) if not each.startswith("_")):
        thing = getattr(rl, name)
        inside = getattr(thing, "__all__", ()) if inspect.ismodule(thing) else ()
        for label, one in [(name, thing), *((f"{name}.{k}", getattr(thing, k)) for k in inside)]:
            if inspect.isfunction(one):
                yield label, one
            elif inspect.isclass(one):
                methods = [(k, getattr(one, k)) for k in dir(one) if not k.startswith("_")]
                yield from ((f"{label}.{k}", f) for k, f in methods if hasattr(f, "__code__"))


def takes_arrays(function: Any) -> bool:
    arguments = inspect.signature(function).parameters.values()
    return "array_like" in (function.__doc__ or "") or any(
        each.annotation in ANY_KIND and each.name not in NO_ARRAYS and each.kind != each.VAR_KEYWORD
        for each in arguments
    )


def test_every_function_that_takes_arrays_is_tested() -> None:
    """A function takes arrays if its docstring has the word array_like, or if the annotation of an
    argument allows an array."""
    found = {name for name, function in public() if takes_arrays(function)}
    assert len(found) > 50
    assert found <= {name.partition(":")[0] for name in CALLS}
