"""Properties of every certificate: effects of more friction, other units and mirroring."""

import math
from typing import Any

import numpy as np
from hypothesis import assume, event, given
from hypothesis import strategies as st
from oracles.drawn import FRICTIONS, SLOPES, motions, powers
from oracles.units import scaled, scene_in_other_units
from rolling_ellipse import Scene, Validity, certify, classify, required_friction, thresholds


@st.composite
def rolling_scenes(draw: Any) -> Scene:
    of = draw(motions())
    slope = draw(st.one_of(st.just(0.0), SLOPES))
    inertia = of.pop("gyration2")
    return Scene(**of, inertia=inertia, slope=slope, friction=draw(FRICTIONS))


@given(st.data())
def test_more_friction_never_ends_rolling_sooner(data: Any) -> None:
    """The set of states in which the ground can hold the body only grows with mu: valid rolling
    stays valid, and on level ground rolling never ends sooner."""
    scene = data.draw(rolling_scenes())
    more = scene.friction * (1 + data.draw(powers(-16, 3))) + data.draw(powers(-16, 1))
    less, better = certify(scene), certify(scene.replace(friction=more))
    event(f"{less.validity.name}, {better.validity.name}")
    if less.validity is Validity.VALID:
        assert better.validity is Validity.VALID
    if better.validity is Validity.INVALID:
        assert less.validity in (Validity.INVALID, Validity.EDGE)
    if less.ends_at is not None and better.ends_at is not None:
        rounding = 1e-9 * max(1.0, abs(scene.theta), abs(less.ends_at))
        ends = [abs(each.ends_at - scene.theta) for each in (less, better)]
        if less.validity is better.validity is Validity.INVALID and scene.slope == 0:
            assert ends[1] >= ends[0] - rounding


@given(st.data())
def test_the_required_friction_is_just_enough(data: Any) -> None:
    scene = data.draw(rolling_scenes())
    needed = required_friction(scene)
    assume(1e-200 < needed < 1e5)  # a millionth of less than 1e-200 may be subnormal
    above = certify(scene.replace(friction=needed * (1 + 1e-6)))
    below = certify(scene.replace(friction=needed * (1 - 1e-6)))
    # The forces may be proportional to a - b, or be small because the weight nearly cancels; then a
    # millionth of them is close to rounding.
    pressed = above.smallest_normal_force
    lifts = pressed is not None and pressed < 0.01 * scene.mass * scene.gravity
    unsure = (Validity.EDGE,) if lifts or abs(scene.a / scene.b - 1) < 0.05 else ()
    event(f"{above.validity.name}, {below.validity.name}")
    assert above.validity in (Validity.VALID, *unsure)
    assert below.validity in (Validity.INVALID, Validity.NO_PROOF, *unsure)


@given(st.data())
def test_neither_units_nor_mirroring_changes_a_certificate(data: Any) -> None:
    scene = data.draw(rolling_scenes())
    units = (*(data.draw(st.integers(-12, 12)) for _ in range(3)),)
    mirror = scene.replace(theta=-scene.theta, omega=-scene.omega, slope=-scene.slope)
    one, other = certify(scene), certify(scene_in_other_units(mirror, units))
    assert one.validity is other.validity
    assert one.largest_friction_needed == other.largest_friction_needed
    if one.smallest_normal_force is not None:
        assert scaled(one.smallest_normal_force, "N", units) == other.smallest_normal_force
    assert one.ends_at is None or one.ends_at == -(other.ends_at or 0.0)


@given(st.data())
def test_an_outcome_depends_on_neither_units_nor_mirroring(data: Any) -> None:
    of = data.draw(motions())
    friction = data.draw(FRICTIONS)
    metre, second = (2.0 ** data.draw(st.integers(-12, 12)) for _ in range(2))
    image = {
        "a": of["a"] * metre, "b": of["b"] * metre, "gyration2": of["gyration2"] * metre**2,
        "gravity": of["gravity"] * metre / second**2, "theta": -of["theta"],
        "omega": -of["omega"] / second,
    }  # fmt: skip
    assert classify(**of, friction=friction) == classify(**image, friction=friction)


@given(st.data())
def test_more_friction_does_not_lower_the_slip_speed(data: Any) -> None:
    of = data.draw(motions())
    body = {name: of[name] for name in ("a", "b", "gravity", "gyration2")}
    friction = data.draw(FRICTIONS)
    more = friction + data.draw(powers(-16, 3))
    one, other = thresholds(**body, friction=friction), thresholds(**body, friction=more)
    # each speed is the root of a separate polynomial, to within roundings
    assert other.slip_speed >= one.slip_speed * (1 - 1e-12)
    assert other.slip_speed <= other.contact_loss_speed * (1 + 1e-12)
    assert (one.roll_over_speed, one.contact_loss_speed) == (
        other.roll_over_speed, other.contact_loss_speed
    )  # fmt: skip
    assert not math.isnan(other.slip_speed)
    assert np.isfinite(other.roll_over_speed)
