"""Touching, rolling and resting starts; Scene and Impulse as values."""

import dataclasses
import math
import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from rolling_ellipse import Impulse, Mode, Scene, flow, geometry, simulate

INF, NAN = math.inf, math.nan


def assert_refused(name: str, got: float, call: Callable[..., Any], **given: Any) -> None:
    with pytest.raises(ValueError, match=rf"^{name} must .* got {re.escape(repr(got))}"):
        call(**given)


def scene(**changes: Any) -> Scene:
    return Scene(**{"a": 2.0, "b": 1.0, **changes})


@pytest.mark.parametrize("name", ["jx", "jz", "dx", "dz"])
@pytest.mark.parametrize("value", [INF, -INF, NAN])
def test_the_error_for_an_impulse_names_the_index_of_a_wrong_value(name: str, value: float) -> None:
    with pytest.raises(ValueError, match=rf"^{name} must be .*, got {value} at index 2$"):
        Impulse(**{name: [1.0, -2.0, value]})
    with pytest.raises(ValueError, match=rf"^{name} must be .*, got {value} at index \(1, 0\)$"):
        Impulse(**{name: [[1.0], [value]]})


def test_an_impulse_broadcasts_its_arrays() -> None:
    jx = np.array([[1.0], [2.0]])
    many = Impulse(jx=jx, jz=-3, dx=[0.0, 0.5, 1.0])
    jx[:] = 7.0
    assert many.shape == (2, 3) and many.jz == -3.0 and type(many.jz) is float
    assert np.array_equal(many.jx, [[1.0], [2.0]])
    assert not many.jx.flags.writeable and not many.dx.flags.writeable
    assert [Impulse(jx=jx).shape for jx in (1.0, [1.0], [])] == [(), (1,), (0,)]
    assert type(Impulse(jx=np.array(1.0)).jx) is float
    with pytest.raises(ValueError, match=r"broadcast.*jx \(2,\), dz \(3,\)"):
        Impulse(jx=[1.0, 2.0], dz=[1.0, 2.0, 3.0])
    with pytest.raises(ValueError, match=r"one blow, got an Impulse of shape \(2, 3\): use out"):
        scene(impulse=many)


@pytest.mark.parametrize("bare", [(48.0, 1.5), (0.0, -1.0), (3,), ([1.0, 2.0], 1.0)])
def test_unnamed_components_give_a_warning(bare: tuple[Any, ...]) -> None:
    with pytest.warns(
        DeprecationWarning, match=r"components jx, jz .* Impulse\.press\(F, d\)"
    ) as seen:
        blow = Impulse(*bare)
    assert seen[0].filename == __file__
    assert blow == Impulse(**dict(zip(("jx", "jz"), bare, strict=False)))


@pytest.mark.parametrize(
    ("angle", "doubted"),
    [({"theta": 90}, True), ({"omega": 180.0}, True), ({"theta": -45.0}, True),
     ({"x": 90.0}, False), ({"theta": 1.5}, False), ({"omega": 20.0}, False)],
)  # fmt: skip
def test_str_questions_an_angle_that_looks_like_degrees(
    angle: dict[str, float], doubted: bool
) -> None:
    body = scene(**angle)
    assert ("(degrees? times pi/180)" in str(body)) == doubted and "degrees" not in repr(body)


def test_impulses_of_arrays_are_equal_by_value() -> None:
    one, other = Impulse(jx=[1.0, 0.0], dx=2.0), Impulse(jx=np.array([1.0, -0.0]), dx=2.0)
    assert one == other and hash(one) == hash(other) and one != "one"
    for jx in ([1.0, 2.0], [[1.0, 0.0]], 1.0):
        assert one != Impulse(jx=jx, dx=2.0)
    assert Impulse(jx=1.0) != Impulse(jx=[1.0])
    assert Impulse(jx=1.0, jz=2.0, dx=3.0) == Impulse(jx=1, jz=2, dx=3, dz=0.0)
    assert hash(Impulse(jx=1.0, jz=2.0)) == hash(Impulse(jx=1.0, jz=2.0))


def test_presses_broadcast_their_arrays() -> None:
    found = Impulse.press([[1.0], [2.0]], [0.5, -0.5])
    assert found == Impulse(jx=0.0, jz=[[-1.0], [-2.0]], dx=[0.5, -0.5]) and found.shape == (2, 2)
    for name, given in (("F", ([1.0, NAN], 0.5)), ("d", (1.0, [0.5, INF]))):
        with pytest.raises(ValueError, match=rf"^{name} must be .*, got (nan|inf) at index 1$"):
            Impulse.press(*given)


@pytest.mark.parametrize(("one", "name"), [(scene(), "a"), (scene(), "core"), (Impulse(), "jx")])
def test_scenes_and_impulses_are_immutable(one: Any, name: str) -> None:
    with pytest.raises(dataclasses.FrozenInstanceError):
        setattr(one, name, 3.0)


def test_equal_scenes_have_equal_hashes() -> None:
    assert scene(omega=3.0) == scene(omega=3.0) and hash(scene(omega=3.0)) == hash(scene(omega=3.0))
    assert len({scene(), scene(), scene(omega=1.0)}) == 2
    changes: dict[str, Any] = {
        **{name: 1.5 for name in ("a", "b", "mass", "gravity", "inertia", "z", "x_dot", "z_dot")},
        **{name: 0.25 for name in ("slope", "friction", "restitution", "theta", "omega", "x")},
        "impulse": Impulse(jx=1.0),
    }
    for name, value in changes.items():
        assert scene() != scene(**{name: value}), name
    assert scene() != "a scene"


@pytest.mark.parametrize("name", ["initial_state", "core", "gyration2"])
def test_scenes_with_equal_values_are_equal_whatever_they_cache(name: str) -> None:
    """The sign of zero does not matter, as for numbers; an omitted value differs from its default.

    A hash inconsistent with `==` would lose scenes in sets.
    """
    one, other = scene(omega=3.0, x=0.0), scene(omega=3.0, x=-0.0)
    getattr(one, name)
    assert one == other and hash(one) == hash(other)
    assert scene(inertia=1.25) != scene() and scene(z=1.0) != scene()
    assert one.initial_state == other.initial_state


def test_replace_changes_only_the_given_fields() -> None:
    struck = scene(omega=1.0, friction=0.3, impulse=Impulse.press(48.0, 1.5))
    changed = struck.replace(omega=2.0, impulse=None)
    assert changed == scene(omega=2.0, friction=0.3) and struck.omega == 1.0
    assert struck.replace() == struck and scene(z=1.0).replace(a=3.0).initial_state.z == 1.0


@pytest.mark.parametrize(("slope", "asked"), [(30.0, True), (-90.0, True), (1000.0, False)])
def test_a_slope_that_looks_like_degrees_is_questioned(slope: float, asked: bool) -> None:
    with pytest.raises(ValueError, match=r"^slope must .*, got -?\d+\.0$") as caught:
        scene(slope=slope)
    assert ("degrees?" in str(caught.value)) == asked


@pytest.mark.parametrize("impulse", [None, Impulse()])
def test_a_body_with_infinite_friction_slides_if_the_ground_would_have_to_pull(
    impulse: Impulse | None,
) -> None:
    """At 0.9 rad and 3 rad/s the ground would have to pull, so the body slides, as in the limit of
    large friction. With a friction of 0.01 the reason states that friction is too small."""
    given: dict[str, Any] = {"theta": 0.9, "omega": 3.0, "impulse": impulse}
    limit = scene(**given).initial_state
    assert limit.mode is Mode.SLIDING
    assert "pull" in limit.reason and "cannot hold" not in limit.reason
    held = scene(**given, friction=0.01).initial_state
    assert held.mode is Mode.SLIDING and "Friction 0.01 cannot hold" in held.reason


def test_gyration2_is_that_of_a_uniform_disc_by_default() -> None:
    assert scene().gyration2 == 1.25  # a uniform disc, eq 12 of the report
    assert scene(mass=4.0).gyration2 == 1.25
    assert scene(mass=4.0, inertia=2.0).gyration2 == 0.5
    steel = Scene.from_density(0.2, 0.1, density=7850.0, thickness=0.05, omega=2.0)
    assert steel == Scene(0.2, 0.1, mass=steel.mass, omega=2.0)
    assert steel.mass == pytest.approx(7850.0 * 1e-3 * math.pi, rel=1e-15)


def test_an_accepted_inertia_gives_an_accepted_gyration2() -> None:
    """This holds even at the lower limit, where the last bit decides."""
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


ANGLES = [0.0, 0.5, 1.2, 2.5, -4.0, 400.0]


def ulps_above(value: float, count: int) -> float:
    return value + count * math.ulp(value)


@pytest.mark.parametrize("theta", ANGLES)
def test_omitted_values_default_to_those_of_rolling(theta: float) -> None:
    """h errs by up to 2 ulp, h omega by up to 4 ulp and h' omega by up to 9 ulp."""
    found = scene(theta=theta, omega=1.3).initial_state
    h, slope = (f(theta, a=2.0, b=1.0) for f in (geometry.support, geometry.support_slope))
    assert found.z == pytest.approx(h, rel=2 * 2.0**-52)
    assert found.x_dot == pytest.approx(1.3 * h, rel=4 * 2.0**-52)
    assert found.z_dot == pytest.approx(1.3 * slope, rel=9 * 2.0**-52)
    assert found.mode == Mode.ROLLING and found.x == 0 and found.theta == theta


@pytest.mark.parametrize("theta", ANGLES)
@pytest.mark.parametrize("count", [-6, -1, 1, 6])
def test_a_start_within_6_ulp_of_rolling_rolls_exactly(theta: float, count: int) -> None:
    exact = scene(theta=theta, omega=1.3)
    state = exact.initial_state
    for name in ("z", "x_dot", "z_dot"):
        if getattr(state, name) == 0.0:
            continue  # an ulp of 0 is too small
        given = ulps_above(getattr(state, name), count)
        near = scene(theta=theta, omega=1.3, **{name: given})
        assert near.initial_state == state, name


@pytest.mark.parametrize("theta", ANGLES)
def test_a_start_20_ulp_or_more_above_the_ground_is_in_the_air(theta: float) -> None:
    h = geometry.support(theta, a=2.0, b=1.0)
    for z in (ulps_above(h, 20), h + 1.0):
        found = scene(theta=theta, omega=1.3, z=z).initial_state
        assert found.mode == Mode.FLIGHT and found.z == z
        assert found.x_dot == found.z_dot == 0
    given = scene(theta=theta, z=h + 1, x_dot=0.3, z_dot=-0.7).initial_state
    assert (given.x_dot, given.z_dot, given.mode) == (0.3, -0.7, Mode.FLIGHT)


@pytest.mark.parametrize("theta", ANGLES)
def test_a_start_below_the_ground_is_rejected(theta: float) -> None:
    h = geometry.support(theta, a=2.0, b=1.0)
    for z in (ulps_above(h, -20), 0.5 * h, 0.0, -3.0):
        assert_refused("z", z, scene, theta=theta, z=z)


@pytest.mark.parametrize("theta", ANGLES)
def test_a_start_moving_into_the_ground_is_rejected(theta: float) -> None:
    along = scene(theta=theta, omega=1.3).initial_state.z_dot
    for z_dot in (along - 1e-9, along - 4.0):
        assert_refused("z_dot", z_dot, scene, theta=theta, omega=1.3, z_dot=z_dot)
    leaving = scene(theta=theta, omega=1.3, z_dot=along + 1e-9).initial_state
    assert leaving.mode == Mode.FLIGHT and leaving.z_dot == along + 1e-9


@pytest.mark.parametrize("theta", ANGLES)
def test_a_start_with_slip_slides(theta: float) -> None:
    along = scene(theta=theta, omega=1.3).initial_state.x_dot
    for x_dot in (along * (1 + 1e-9), along - 2.0):
        found = scene(theta=theta, omega=1.3, x_dot=x_dot, friction=0.9).initial_state
        assert found.mode == Mode.SLIDING and found.x_dot == x_dot


@pytest.mark.parametrize(
    ("theta", "mode"),
    [*((angle, Mode.REST) for angle in (0.0, math.pi / 2, -7 * math.pi / 2, 2 * math.pi)),
     (1e-9, Mode.ROLLING), (0.3, Mode.ROLLING)],
)  # fmt: skip
def test_a_body_rests_only_in_equilibrium(theta: float, mode: Mode) -> None:
    """Rest requires |h'| of at most 8 ulp, as at the doubles nearest to small multiples of pi/2."""
    assert scene(theta=theta).initial_state.mode == mode
    assert scene(theta=theta, omega=1e-9).initial_state.mode != Mode.REST
