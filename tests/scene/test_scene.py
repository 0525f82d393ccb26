"""Wrong questions are refused by name; what counts as touching, rolling, resting; Scene as a value.

A message names the argument and says what came: `a must be a positive finite length [m], got -1.0`.
"""

import dataclasses
import math
import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from rolling_ellipse import (
    Impulse,
    Mode,
    Scene,
    certify,
    constraints,
    flow,
    geometry,
    kinematics,
    period,
    simulate,
    thresholds,
)

INF, NAN = math.inf, math.nan
FLOW: dict[str, Any] = {"t": 1.0, "a": 2.0, "b": 1.0, "theta": 0.2, "omega": 1.0}


def assert_refused(
    error: type[Exception], name: str, received: str, call: Callable[..., Any], **given: Any
) -> None:
    with pytest.raises(error) as caught:
        call(**given)
    message = str(caught.value)
    assert re.search(rf"\b{name}\b", message), message
    assert received in message, message


def scene(**changes: Any) -> Scene:
    return Scene(**{"a": 2.0, "b": 1.0, **changes})


# --------------------------------------------------------------------------- one number wrong

POSITIVE = [0.0, -0.0, -1.0, INF, -INF, NAN]
FINITE = [INF, -INF, NAN]
WRONG_VALUES = {
    **{name: POSITIVE for name in ("a", "b", "mass", "gravity", "inertia")},
    **{name: FINITE for name in ("theta", "omega", "x", "z", "x_dot", "z_dot")},
    "slope": [math.pi / 2, -math.pi / 2, 2.0, *FINITE],
    "friction": [-0.1, -1e-300, -INF, NAN],
    "restitution": [-0.1, 1.0000001, *FINITE],
}
NO_NUMBERS = ["2.0", [1.0], (2.0,), 1j, {}, object]
MAY_BE_NONE = {"inertia", "z", "x_dot", "z_dot"}


@pytest.mark.parametrize(
    ("name", "value"), [(name, value) for name, values in WRONG_VALUES.items() for value in values]
)
def test_scene_refuses_wrong_values(name: str, value: float) -> None:
    assert_refused(ValueError, name, repr(value), scene, **{name: value})


@pytest.mark.parametrize("name", WRONG_VALUES)
@pytest.mark.parametrize("value", NO_NUMBERS, ids=str)
def test_scene_refuses_what_is_no_number(name: str, value: object) -> None:
    assert_refused(TypeError, name, "got", scene, **{name: value})


@pytest.mark.parametrize("name", sorted(WRONG_VALUES.keys() - MAY_BE_NONE))
def test_scene_refuses_none(name: str) -> None:
    assert_refused(TypeError, name, "None", scene, **{name: None})


@pytest.mark.parametrize("axes", [(1000.1, 1.0), (1.0, 1000.1), (1e-9, 1.0), (1.0, 1e-20)])
def test_scene_refuses_needles(axes: tuple[float, float]) -> None:
    assert_refused(ValueError, "a/b", "got", Scene, a=axes[0], b=axes[1])


@pytest.mark.parametrize("share", [0.9e-6, 1.1e6])
def test_mass_is_neither_at_a_point_nor_far_outside(share: float) -> None:
    assert_refused(ValueError, "inertia", repr(4.0 * share), scene, inertia=4.0 * share)
    assert_refused(ValueError, "gyration2", repr(4.0 * share), flow, **FLOW, gyration2=4.0 * share)


@pytest.mark.parametrize("axes", [(1000.0, 1.0), (1.0, 1000.0), (1e-3, 1.0), (1e-9, 1e-9)])
def test_scene_accepts_the_limits(axes: tuple[float, float]) -> None:
    assert Scene(*axes).initial_state.z > 0
    limits: list[dict[str, Any]] = [
        {"friction": 0.0}, {"friction": INF}, {"restitution": 1.0}, {"slope": -1.5},
    ]  # fmt: skip
    for given in limits:
        Scene(*axes, **given)


def test_numbers_of_any_kind_are_welcome() -> None:
    reference = Scene(2.0, 1.0, omega=3.0)
    for number in (3, np.float64(3), np.float32(3), np.int64(3)):
        assert Scene(2, 1, omega=number) == reference  # type: ignore[arg-type]


def test_scene_wants_names() -> None:
    with pytest.raises(TypeError):
        Scene(2.0, 1.0, 10.0)  # type: ignore[call-arg]
    with pytest.raises(TypeError, match="mas"):
        Scene(2.0, 1.0, mas=10.0)  # type: ignore[call-arg]


# --------------------------------------------------------------------------------- impulses


@pytest.mark.parametrize("name", ["jx", "jz", "dx", "dz"])
@pytest.mark.parametrize("value", FINITE)
def test_impulse_refuses_wrong_values(name: str, value: float) -> None:
    assert_refused(ValueError, name, repr(value), Impulse, **{name: value})


@pytest.mark.parametrize("name", ["jx", "jz", "dx", "dz"])
@pytest.mark.parametrize("value", ["1", None, ["1"], [[1.0], [1.0, 2.0]]], ids=str)
def test_impulse_refuses_what_is_no_number(name: str, value: object) -> None:
    assert_refused(TypeError, name, "got", Impulse, **{name: value})


@pytest.mark.parametrize("name", ["jx", "jz", "dx", "dz"])
@pytest.mark.parametrize("value", FINITE)
def test_impulse_refuses_wrong_values_of_arrays_with_their_index(name: str, value: float) -> None:
    with pytest.raises(ValueError, match=rf"^{name} must be .*, got {value} at index 2$"):
        Impulse(**{name: [1.0, -2.0, value]})
    with pytest.raises(ValueError, match=rf"^{name} must be .*, got {value} at index \(1, 0\)$"):
        Impulse(**{name: [[1.0], [value]]})


def test_an_impulse_of_arrays() -> None:
    jx = np.array([[1.0], [2.0]])
    many = Impulse(jx, -3, dx=[0.0, 0.5, 1.0])
    jx[:] = 7.0
    assert many.shape == (2, 3) and many.jz == -3.0 and type(many.jz) is float
    assert np.array_equal(many.jx, [[1.0], [2.0]])
    assert not many.jx.flags.writeable and not many.dx.flags.writeable
    assert Impulse(1.0).shape == () and Impulse([1.0]).shape == (1,) and Impulse([]).shape == (0,)
    assert type(Impulse(np.array(1.0)).jx) is float
    with pytest.raises(ValueError, match=r"broadcast.*jx \(2,\), dz \(3,\)"):
        Impulse([1.0, 2.0], dz=[1.0, 2.0, 3.0])
    with pytest.raises(
        ValueError, match=r"one blow, got an Impulse of shape \(2, 3\): use outcome"
    ):
        scene(impulse=many)


def test_impulses_of_arrays_are_equal_by_value() -> None:
    one, other = Impulse([1.0, 0.0], dx=2.0), Impulse(np.array([1.0, -0.0]), dx=2.0)
    assert one == other and hash(one) == hash(other) and one != "one"
    for different in (Impulse([1.0, 2.0], dx=2.0), Impulse([[1.0, 0.0]], dx=2.0), Impulse(1.0)):
        assert one != different
    assert Impulse(1.0) != Impulse([1.0])


def test_presses_of_arrays() -> None:
    found = Impulse.press([[1.0], [2.0]], [0.5, -0.5])
    assert found == Impulse(0.0, [[-1.0], [-2.0]], dx=[0.5, -0.5]) and found.shape == (2, 2)
    for name, given in (("F", ([1.0, NAN], 0.5)), ("d", (1.0, [0.5, INF]))):
        with pytest.raises(ValueError, match=rf"^{name} must be .*, got (nan|inf) at index 1$"):
            Impulse.press(*given)
    with pytest.raises(ValueError, match=r"^F must be a finite .* 1e50, got 1e\+51$"):
        Impulse.press(1e51, 0.5)
    with pytest.raises(ValueError, match=r"^d must be a finite .* 1e50, got -1e\+51$"):
        Impulse.press([1.0, 2.0], -1e51)


@pytest.mark.parametrize("position", [0, 1])
def test_press_refuses_wrong_values(position: int) -> None:
    good = [48.0, 1.5]
    for value, error in ((NAN, ValueError), (INF, ValueError), ("1", TypeError), (None, TypeError)):
        given: list[Any] = list(good)
        given[position] = value
        with pytest.raises(error, match=r"\b(F|d)\b" if position == 0 else r"\bd\b"):
            Impulse.press(*given)


@pytest.mark.parametrize("value", [48.0, (0.0, -48.0), "press"])
def test_scene_refuses_an_impulse_that_is_none(value: object) -> None:
    assert_refused(TypeError, "impulse", "got", scene, impulse=value)


def test_impulse_is_a_value() -> None:
    assert Impulse(1.0, 2.0, dx=3.0) == Impulse(1, 2, dx=3, dz=0.0)
    assert hash(Impulse(1.0, 2.0)) == hash(Impulse(1.0, 2.0))
    with pytest.raises(dataclasses.FrozenInstanceError):
        Impulse().jx = 1.0  # type: ignore[misc]


# ---------------------------------------------------------------------------- Scene is a value


def test_scene_is_frozen() -> None:
    one = scene()
    with pytest.raises(dataclasses.FrozenInstanceError):
        one.a = 3.0  # type: ignore[misc]
    with pytest.raises(AttributeError):
        one.gyration2 = 3.0  # type: ignore[misc]


def test_scene_equality_and_hash() -> None:
    assert scene(omega=3.0) == scene(omega=3.0) and hash(scene(omega=3.0)) == hash(scene(omega=3.0))
    assert len({scene(), scene(), scene(omega=1.0)}) == 2
    changes: dict[str, Any] = {
        **{name: 1.5 for name in ("a", "b", "mass", "gravity", "inertia", "z", "x_dot", "z_dot")},
        **{name: 0.25 for name in ("slope", "friction", "restitution", "theta", "omega", "x")},
        "impulse": Impulse(1.0),
    }
    for name, value in changes.items():
        assert scene() != scene(**{name: value}), name
    assert scene() != "a scene"


@pytest.mark.parametrize("name", ["initial_state", "core", "gyration2"])
def test_what_a_scene_keeps_beside_its_numbers_does_not_matter(name: str) -> None:
    """Nor does the sign of zero, as it does not for numbers; what is left out is not what it means.

    A hash that does not go with `==` would lose scenes in sets.
    """
    one, other = scene(omega=3.0, x=0.0), scene(omega=3.0, x=-0.0)
    getattr(one, name)
    assert one == other and hash(one) == hash(other)
    assert scene(inertia=1.25) != scene() and scene(z=1.0) != scene()
    assert one.initial_state == other.initial_state


def test_replace() -> None:
    struck = scene(omega=1.0, friction=0.3, impulse=Impulse.press(48.0, 1.5))
    changed = struck.replace(omega=2.0, impulse=None)
    assert changed == scene(omega=2.0, friction=0.3) and struck.omega == 1.0
    assert struck.replace() == struck
    with pytest.raises(TypeError, match=r"^changes must be of a, b, mass, .*impulse, got omga$"):
        struck.replace(omga=2.0)
    assert_refused(ValueError, "omega", "nan", struck.replace, omega=NAN)
    assert_refused(TypeError, "omega", "'2'", struck.replace, omega="2")


def test_replace_refuses_what_no_longer_goes_together() -> None:
    """A height for one angle or shape is under the ground for another; a blow may miss."""
    touching = scene(z=1.0)
    assert_refused(ValueError, "z", "1.0", touching.replace, theta=0.5)
    assert_refused(ValueError, "z", "1.0", touching.replace, b=1.5)
    assert touching.replace(a=3.0).initial_state.z == 1.0
    struck = scene(impulse=Impulse.press(48.0, 1.5))
    assert_refused(ValueError, "impulse", "1.5", struck.replace, a=1.4)


@pytest.mark.parametrize(("slope", "asked"), [(30.0, True), (-90.0, True), (1000.0, False)])
def test_a_slope_in_degrees_is_asked_about(slope: float, asked: bool) -> None:
    with pytest.raises(ValueError, match=r"^slope must .*, got -?\d+\.0$") as caught:
        scene(slope=slope)
    assert ("degrees?" in str(caught.value)) == asked


@pytest.mark.parametrize("impulse", [None, Impulse()])
def test_infinite_friction_holds_whatever_can_be_held(impulse: Impulse | None) -> None:
    """Flat side forwards at 0.9 rad the ground would have to pull, and the limit of slides begins;
    with as little friction as 3 it is friction that ends rolling."""
    given: dict[str, Any] = {"theta": 0.9, "omega": 3.0, "impulse": impulse}
    limit = scene(**given).initial_state
    assert limit.mode is Mode.SLIDING
    assert "pull" in limit.reason and "cannot hold" not in limit.reason
    held = scene(**given, friction=0.01).initial_state
    assert held.mode is Mode.SLIDING and "friction 0.01 cannot hold" in held.reason


def test_gyration2() -> None:
    assert scene().gyration2 == 1.25  # uniform disc, report eq 12
    assert scene(mass=4.0).gyration2 == 1.25
    assert scene(mass=4.0, inertia=2.0).gyration2 == 0.5


def test_what_is_taken_as_inertia_is_taken_as_gyration2() -> None:
    """At the ends of the range, where the last bit of either decides."""
    random = np.random.default_rng(9)
    taken = 0
    for axis, mass, off in zip(
        random.uniform(0.1, 9, 400), random.uniform(0.1, 9, 400), range(-200, 200), strict=True
    ):
        inertia = mass * axis**2 * 1e-6 * (1 + off // 10 * 2.0**-52)
        try:
            body = scene(a=axis, b=axis, mass=mass, inertia=inertia)
        except ValueError as error:
            assert str(error).startswith("inertia must be between 1e-6 and 1e6 times mass")
        else:
            taken += 1
            flow(1.0, a=axis, b=axis, theta=0.1, omega=0.0, gyration2=body.gyration2)
            simulate(body, 1e-9)
    assert 100 < taken < 300


# ------------------------------------------------------------- touching, rolling, and neither

ANGLES = [0.0, 0.5, 1.2, 2.5, -4.0, 400.0]


def ulps_above(value: float, count: int) -> float:
    return value + count * math.ulp(value)


@pytest.mark.parametrize("theta", ANGLES)
def test_missing_values_are_those_of_rolling(theta: float) -> None:
    """h and the products h omega, h' omega: 2 ulp and 9 ulp with the errors of the geometry."""
    found = scene(theta=theta, omega=1.3).initial_state
    h, slope = (f(theta, a=2.0, b=1.0) for f in (geometry.support, geometry.support_slope))
    assert found.z == pytest.approx(h, rel=2 * 2.0**-52)
    assert found.x_dot == pytest.approx(1.3 * h, rel=4 * 2.0**-52)
    assert found.z_dot == pytest.approx(1.3 * slope, rel=9 * 2.0**-52)
    assert found.mode == Mode.ROLLING and found.x == 0 and found.theta == theta


@pytest.mark.parametrize("theta", ANGLES)
@pytest.mark.parametrize("count", [-6, -1, 1, 6])
def test_within_8_ulp_is_touching_and_rolling_exactly(theta: float, count: int) -> None:
    exact = scene(theta=theta, omega=1.3)
    state = exact.initial_state
    for name in ("z", "x_dot", "z_dot"):
        if getattr(state, name) == 0.0:
            continue  # an ulp of 0 is no length
        given = ulps_above(getattr(state, name), count)
        near = scene(theta=theta, omega=1.3, **{name: given})
        assert near.initial_state == state, name


@pytest.mark.parametrize("theta", ANGLES)
def test_beyond_8_ulp_it_is_in_the_air(theta: float) -> None:
    h = geometry.support(theta, a=2.0, b=1.0)
    for z in (ulps_above(h, 20), h + 1.0):
        found = scene(theta=theta, omega=1.3, z=z).initial_state
        assert found.mode == Mode.FLIGHT and found.z == z
        assert found.x_dot == found.z_dot == 0
    given = scene(theta=theta, z=h + 1, x_dot=0.3, z_dot=-0.7).initial_state
    assert (given.x_dot, given.z_dot, given.mode) == (0.3, -0.7, Mode.FLIGHT)


@pytest.mark.parametrize("theta", ANGLES)
def test_under_the_ground_is_refused(theta: float) -> None:
    h = geometry.support(theta, a=2.0, b=1.0)
    for z in (ulps_above(h, -20), 0.5 * h, 0.0, -3.0):
        assert_refused(ValueError, "z", repr(z), scene, theta=theta, z=z)


@pytest.mark.parametrize("theta", ANGLES)
def test_moving_into_the_ground_is_refused(theta: float) -> None:
    along = scene(theta=theta, omega=1.3).initial_state.z_dot
    for z_dot in (along - 1e-9, along - 4.0):
        assert_refused(ValueError, "z_dot", repr(z_dot), scene, theta=theta, omega=1.3, z_dot=z_dot)
    leaving = scene(theta=theta, omega=1.3, z_dot=along + 1e-9).initial_state
    assert leaving.mode == Mode.FLIGHT and leaving.z_dot == along + 1e-9


@pytest.mark.parametrize("theta", ANGLES)
def test_a_given_slip_is_sliding(theta: float) -> None:
    along = scene(theta=theta, omega=1.3).initial_state.x_dot
    for x_dot in (along * (1 + 1e-9), along - 2.0):
        found = scene(theta=theta, omega=1.3, x_dot=x_dot, friction=0.9).initial_state
        assert found.mode == Mode.SLIDING and found.x_dot == x_dot


@pytest.mark.parametrize(
    ("theta", "mode"),
    [
        (0.0, Mode.REST),
        (math.pi / 2, Mode.REST),
        (-7 * math.pi / 2, Mode.REST),
        (2 * math.pi, Mode.REST),
        (1e-9, Mode.ROLLING),
        (0.3, Mode.ROLLING),
    ],
)
def test_rest_is_equilibrium(theta: float, mode: Mode) -> None:
    """|h'| within 8 ulp: the nearest doubles to the first multiples of pi/2."""
    assert scene(theta=theta).initial_state.mode == mode
    assert scene(theta=theta, omega=1e-9).initial_state.mode != Mode.REST


def test_modes_are_numbered() -> None:
    assert [mode.value for mode in Mode] == [0, 1, 2, 3]
    assert [mode.name for mode in Mode] == ["ROLLING", "SLIDING", "FLIGHT", "REST"]
    assert Mode.SLIDING == 1


# ------------------------------------------------------------------------------- simulate

WRONG_TIMES: list[tuple[type[Exception], object]] = [
    (ValueError, [[0.0, 1.0]]),
    (ValueError, [0.0, 0.0]),
    (ValueError, [0.0, 2.0, 1.0]),
    (ValueError, [-1.0, 0.0]),
    (ValueError, [0.0, NAN]),
    (ValueError, [0.0, INF]),
    (ValueError, []),
    (ValueError, -1.0),
    (ValueError, NAN),
    (ValueError, INF),
    (TypeError, "1.0"),
    (TypeError, None),
    (TypeError, [0.0, "1"]),
    (TypeError, 1j),
]


@pytest.mark.parametrize(("error", "t"), WRONG_TIMES, ids=str)
def test_simulate_refuses_wrong_times(error: type[Exception], t: object) -> None:
    assert_refused(error, "t", "got", simulate, scene=scene(omega=1.0), t=t)


@pytest.mark.parametrize("name", ["model", "method"])
@pytest.mark.parametrize("value", ["", "Auto", "no_such", "rk5"])
def test_simulate_refuses_unknown_names_and_lists_the_known(name: str, value: str) -> None:
    given: dict[str, Any] = {"scene": scene(omega=1.0), "t": 1.0, name: value}
    assert_refused(ValueError, name, repr(value), simulate, **given)
    known = {
        "model": ["auto", "rolling", "multipliers"],
        "method": ["auto", "exact", "dop853", "dopri5", "rk4", "gauss", "radau"],
    }[name]
    with pytest.raises(ValueError) as caught:
        simulate(**given)
    for word in known:
        assert re.search(rf"\b{word}\b", str(caught.value))


@pytest.mark.parametrize("method", ["exact", "dop853", "dopri5", "rk4", "gauss", "radau"])
def test_the_contact_model_chooses_its_methods(method: str) -> None:
    given: dict[str, Any] = {
        "scene": scene(omega=1.0),
        "t": 1.0,
        "model": "contact",
        "method": method,
    }
    assert_refused(ValueError, "method", repr(method), simulate, **given)


@pytest.mark.parametrize("name", ["model", "method"])
@pytest.mark.parametrize("value", [None, 1, ["auto"]], ids=str)
def test_simulate_refuses_names_that_are_no_text(name: str, value: object) -> None:
    given: dict[str, Any] = {"scene": scene(omega=1.0), "t": 1.0, name: value}
    with pytest.raises((TypeError, ValueError), match=rf"\b{name}\b.*{re.escape(repr(value))}"):
        simulate(**given)


@pytest.mark.parametrize("call", [lambda s: simulate(s, 1.0), certify, period])
@pytest.mark.parametrize("value", [None, 2.0, "report", (2.0, 1.0)], ids=str)
def test_a_scene_is_wanted(call: Callable[..., Any], value: object) -> None:
    with pytest.raises(TypeError, match=r"\b[Ss]cene\b"):
        call(value)


def test_what_is_no_scene_is_shown_briefly() -> None:
    for thing in (np.arange(1e5).tolist(), "x" * 10**5):
        with pytest.raises(TypeError, match=r"^scene must be a Scene, got ") as caught:
            certify(thing)  # type: ignore[arg-type]
        assert len(str(caught.value)) < 400
        with pytest.raises(TypeError, match=r"^impulse must be an Impulse or None") as caught:
            scene(impulse=thing)
        assert len(str(caught.value)) < 400


def test_simulate_leaves_the_times_alone() -> None:
    t = np.array([0.5, 1.0, 3.0])
    t.flags.writeable = False
    trajectory = simulate(scene(omega=3.2), t)
    assert np.array_equal(trajectory.t, [0.5, 1.0, 3.0])
    assert not np.shares_memory(trajectory.t, t)


def test_period_is_for_level_ground() -> None:
    assert_refused(ValueError, "slope", "0.1", period, scene=scene(omega=3.0, slope=0.1))


# ------------------------------------------------------- flow, thresholds, constraints, kinematics


@pytest.mark.parametrize("name", ["a", "b", "gravity", "gyration2"])
@pytest.mark.parametrize("value", POSITIVE)
def test_flow_refuses_what_is_not_positive(name: str, value: float) -> None:
    assert_refused(ValueError, name, repr(value), flow, **{**FLOW, name: value})
    assert_refused(ValueError, name, repr(value), flow, **{**FLOW, name: np.array([1.0, value])})


@pytest.mark.parametrize("name", ["t", "theta", "omega"])
@pytest.mark.parametrize("value", FINITE)
def test_flow_refuses_what_is_not_finite(name: str, value: float) -> None:
    assert_refused(ValueError, name, repr(value), flow, **{**FLOW, name: value})
    assert_refused(ValueError, name, repr(value), flow, **{**FLOW, name: np.array([1.0, value])})


@pytest.mark.parametrize("name", ["t", "a", "b", "theta", "omega", "gravity"])
@pytest.mark.parametrize("value", ["1", None, 1j], ids=str)
def test_flow_refuses_what_is_no_number(name: str, value: object) -> None:
    assert_refused(TypeError, name, "got", flow, **{**FLOW, name: value})


@pytest.mark.parametrize("workers", [0, -2])
def test_flow_refuses_an_impossible_number_of_workers(workers: int) -> None:
    assert_refused(ValueError, "workers", str(workers), flow, **FLOW, workers=workers)


def test_flow_refuses_needles_and_shapes_that_do_not_broadcast() -> None:
    assert_refused(ValueError, "a/b", "got", flow, **{**FLOW, "a": 1001.0})
    with pytest.raises(ValueError, match=r"\bomega\b"):
        flow(np.zeros(3), a=2.0, b=1.0, theta=0.0, omega=np.ones(4))


def test_flow_leaves_its_inputs_alone() -> None:
    t, omega = np.linspace(0.0, 2.0, 5), np.full(5, 3.2)
    before = t.copy(), omega.copy()
    flow(t, a=2.0, b=1.0, theta=0.2, omega=omega)
    assert np.array_equal(t, before[0]) and np.array_equal(omega, before[1])


THRESHOLDS: dict[str, Any] = {"a": 2.0, "b": 1.0}


@pytest.mark.parametrize("name", ["a", "b", "gravity", "gyration2"])
@pytest.mark.parametrize("value", POSITIVE)
def test_thresholds_refuse_what_is_not_positive(name: str, value: float) -> None:
    assert_refused(ValueError, name, repr(value), thresholds, **{**THRESHOLDS, name: value})


@pytest.mark.parametrize("value", [-0.1, -INF, NAN])
def test_thresholds_refuse_wrong_friction(value: float) -> None:
    assert_refused(ValueError, "friction", repr(value), thresholds, **THRESHOLDS, friction=value)


@pytest.mark.parametrize("name", ["a", "b", "gravity", "friction"])
@pytest.mark.parametrize("value", ["1", None, [2.0]], ids=str)
def test_thresholds_refuse_what_is_no_number(name: str, value: object) -> None:
    assert_refused(TypeError, name, "got", thresholds, **{**THRESHOLDS, name: value})


def test_thresholds_refuse_needles() -> None:
    assert_refused(ValueError, "a/b", "got", thresholds, a=1001.0, b=1.0)


@pytest.mark.parametrize("name", ["a", "b"])
def test_constraints_and_kinematics_refuse_wrong_axes(name: str) -> None:
    states: dict[Callable[..., Any], dict[str, Any]] = {
        constraints: {"q": np.zeros(5), "q_dot": np.zeros(5)},
        kinematics: {"theta": 0.3, "omega": 1.0},
    }
    for call, state in states.items():
        for value in POSITIVE:
            axes: dict[str, Any] = {"a": 2.0, "b": 1.0, name: value}
            assert_refused(ValueError, name, repr(value), call, **state, **axes)
        for nothing in ("1", None):
            axes = {"a": 2.0, "b": 1.0, name: nothing}
            assert_refused(TypeError, name, "got", call, **state, **axes)


@pytest.mark.parametrize("name", ["q", "q_dot"])
@pytest.mark.parametrize("value", ["state", None, ["a"] * 5, [1j] * 5], ids=str)
def test_constraints_refuse_what_is_no_number(name: str, value: object) -> None:
    state = {"q": np.zeros(5), "q_dot": np.zeros(5), name: value}
    assert_refused(TypeError, name, "got", constraints, **state, a=2.0, b=1.0)


@pytest.mark.parametrize("name", ["theta", "omega"])
@pytest.mark.parametrize("value", ["1", None, 1j], ids=str)
def test_kinematics_refuses_what_is_no_number(name: str, value: object) -> None:
    state = {"theta": 0.3, "omega": 1.0, name: value}
    assert_refused(TypeError, name, "got", kinematics, **state, a=2.0, b=1.0)
