"""Properties of every scene and all its motions: symmetries, and energy that never grows."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, event, given
from hypothesis import strategies as st
from oracles.contact import energy
from oracles.drawn import clock, powers, scenes
from oracles.numbers import EPS
from oracles.spread import ROUNDINGS, Floats, roundings, spread
from oracles.units import assert_same_in_other_units, scaled, scene_in_other_units
from rolling_ellipse import (
    EventKind,
    Impulse,
    InitialState,
    Mode,
    Sample,
    Scene,
    geometry,
    simulate,
)

ODD = ("theta", "omega", "x", "x_dot", "friction_force")  # quantities odd under reflection
EVEN = ("z", "z_dot", "normal_force", "mode", "t")
ENOUGH: dict[str, Any] = {"max_events": 60, "max_steps": 3000, "raise_on_failure": False}
METHODS: list[dict[str, Any]] = [
    {},
    {"model": "contact"},
    {"model": "rolling", "method": "dop853"},
    {"model": "rolling", "method": "gauss"},
    {"model": "multipliers", "stabilization": "projection+energy"},
    {"model": "multipliers"},  # "radau" is left out: its matrices are one-sided differences
]


def mirrored(scene: Scene) -> Scene:
    changes: dict[str, Any] = {
        name: -getattr(scene, name) for name in ("theta", "omega", "x", "slope")
    }
    if scene.x_dot is not None:
        changes["x_dot"] = -scene.x_dot
    if (blow := scene.impulse) is not None:
        changes["impulse"] = Impulse(jx=-blow.jx, jz=blow.jz, dx=-blow.dx, dz=blow.dz)
    return scene.replace(**changes)


@pytest.mark.filterwarnings("ignore::rolling_ellipse.ValidityWarning")
@pytest.mark.filterwarnings("ignore::rolling_ellipse.StabilityWarning")
@given(st.data())
def test_the_mirror_image_agrees_bit_for_bit(data: Any) -> None:
    scene = data.draw(scenes())
    span = data.draw(powers(-2, 2)) * clock(scene)
    rolls = scene.initial_state.mode in (Mode.ROLLING, Mode.REST)
    how = data.draw(st.sampled_from(METHODS if rolls else METHODS[:2]))
    if how.get("method") == "gauss":
        how = {**how, "step": span / 50}
    times = np.linspace(0.0, span, 40)
    one = simulate(scene, times, **how, **ENOUGH)
    other = simulate(mirrored(scene), times, **how, **ENOUGH)
    event(f"{one.model}, {one.status.name}")
    mine, yours = scene.initial_state, mirrored(scene).initial_state
    assert (mine.reaction_x, mine.reaction_z) == (-yours.reaction_x, yours.reaction_z)
    assert mine.mode is yours.mode
    for name in EVEN:
        assert np.array_equal(getattr(one, name), getattr(other, name)), name
    for name in ODD:
        assert np.array_equal(-getattr(one, name), getattr(other, name)), name
    assert [(each.t, each.kind) for each in one.events] == [
        (each.t, each.kind) for each in other.events
    ]
    assert (one.status, one.valid_until) == (other.status, other.valid_until)


@given(st.data())
def test_scaling_units_by_powers_of_two_changes_no_bit(data: Any) -> None:
    scene = data.draw(scenes())
    span = data.draw(powers(-2, 2)) * clock(scene)
    units = (*(data.draw(st.integers(-12, 12)) for _ in range(3)),)
    times = np.linspace(0.0, span, 40)
    one = simulate(scene, times, **ENOUGH)
    event(f"{one.model}, {one.status.name}")
    other = simulate(scene_in_other_units(scene, units), scaled(times, "s", units), **ENOUGH)
    assert_same_in_other_units(one, other, units)


@given(st.data())
def test_a_shift_along_the_ground_changes_only_x(data: Any) -> None:
    scene = data.draw(scenes())
    span = data.draw(powers(-2, 2)) * clock(scene)
    away = data.draw(st.floats(-1e3, 1e3)) * max(scene.a, scene.b)
    times = np.linspace(0.0, span, 40)
    one = simulate(scene, times, **ENOUGH)
    other = simulate(scene.replace(x=away), times, **ENOUGH)
    for name in (*ODD, *EVEN):
        if name != "x":
            assert np.array_equal(getattr(one, name), getattr(other, name)), name
    # x is a sum with one rounding per event, and a few within an arc
    sums = 4 + 4 * len(one.events)
    size = abs(away) + np.max(np.abs(one.x), initial=0.0)
    subnormal = 5e-324 * max(1.0, scene.a, scene.b)  # smallest double, times the size of the body
    assert np.all(np.abs(one.x + away - other.x) <= sums * (EPS * size + subnormal))


def blur(scene: Scene, state: InitialState) -> float:
    """Change of the energy of a state by roundings of its numbers [J]."""
    lever = abs(scene.a - scene.b) + max(scene.a, scene.b)
    heights = state.z + abs(state.x) + lever * max(1.0, abs(state.theta))
    speeds = state.x_dot**2 + state.z_dot**2 + scene.gyration2 * state.omega**2
    return EPS * scene.mass * (scene.gravity * heights + speeds)


def surface_speed(scene: Scene, state: InitialState) -> float:
    """Sum of the magnitudes of the two terms of the slip [m/s]."""
    return abs(state.x_dot) + abs(state.omega) * max(scene.a, scene.b)


@given(st.data())
def test_energy_never_grows_in_contact(data: Any) -> None:
    """Energy grows neither at an event nor along an arc; the potential energy includes the slope.

    An event rounds each number of its state a few times, and a slip ends to within the rounding of
    its initial speeds. The energy of an arc is known to within the rounding of its largest terms:
    the energies at both ends and, in a flight, the height between them. Averaged bounces use their
    initial forces, so their relative error is the square of the ratio of their duration to the time
    in which the body falls, turns by b/a, or is turned by a force.
    """
    scene = data.draw(scenes())
    span = data.draw(powers(-2, 1.5)) * clock(scene)
    moving = simulate(scene, span, model="contact", **ENOUGH)
    event(f"{len(moving.events)} events, {moving.status.name}")
    before, begin = scene.initial_state, 0.0
    for each in moving.events:
        start, end = each.state_before, each.state_after
        allowed = blur(scene, start) + blur(scene, end)
        lost = energy(scene, start) - energy(scene, end)
        if start.mode is Mode.SLIDING and each.kind is not EventKind.LIFT_OFF:
            speeds = surface_speed(scene, before) * surface_speed(scene, start)
            allowed += EPS * scene.mass * speeds
        assert lost >= -8 * allowed, (each, lost / allowed)
        lost = energy(scene, before) - energy(scene, start)
        sizes = (blur(scene, before) + blur(scene, start)) / EPS
        allowed = 64 * EPS * sizes
        if before.mode is Mode.FLIGHT and each.kind is not EventKind.IMPACT:  # averaged bounces
            least, most = sorted((scene.a, scene.b))
            falls = math.sqrt(scene.gravity / least)
            turned = math.sqrt(scene.gravity * most / scene.gyration2)
            rate = max(falls, turned, abs(start.omega) * most / least)
            allowed += (rate * (each.t - begin)) ** 2 * sizes
        assert lost >= -allowed, (each, lost / allowed)
        before, begin = end, each.t


def turned_round(at: Sample) -> dict[str, float]:
    return {
        "theta": at.theta, "omega": -at.omega, "x": at.x, "z": at.z, "x_dot": -at.x_dot,
        "z_dot": -at.z_dot,
    }  # fmt: skip


@given(st.data())
def test_a_reversed_motion_without_friction_returns_to_its_start(data: Any) -> None:
    """A reversed motion with e = 1 and mu = 0 passes its events in the opposite order.

    The bound is the change of the start if the motion deviates by roundings at any of its times.
    """
    scene = data.draw(scenes(friction=0.0, restitution=1.0, slope=0.0)).replace(impulse=None)
    span = data.draw(powers(-2, 0.7)) * clock(scene)
    times = np.linspace(0.0, span, 100)
    there = simulate(scene, times, model="contact", **ENOUGH)
    assume(there.t.size == times.size and len(there.events) <= 3)
    # without LIFT_OFF, whose reverse would be an impact
    assume({each.kind for each in there.events} <= {EventKind.IMPACT})
    flying = there.at(span).mode is Mode.FLIGHT
    assume(flying == (scene.initial_state.mode is Mode.FLIGHT))
    length = max(scene.a, scene.b)
    turning = length * float(np.max(np.abs(there.omega)))  # size of the terms of x_dot and slip
    names = tuple(turned_round(there.at(0.0)))

    def way_back(after: float) -> Callable[..., Floats]:
        hits = sum(each.t < after for each in there.events)

        def end(**start: float) -> Floats:
            given = start if flying else {k: v for k, v in start.items() if k not in ("z", "z_dot")}
            back = simulate(scene.replace(**{"z": None, "z_dot": None, **given}), [after],
                            model="contact", **ENOUGH)  # fmt: skip
            assume([each.kind for each in back.events] == hits * [EventKind.IMPACT])
            assume(back.t.size == 1)
            return np.array([getattr(back, name)[0] for name in names])

        return end

    known = np.zeros(len(names))
    for share in (0.25, 0.5, 0.75, 1.0):
        at = there.at(share * span)
        # if reversed at a hit, or so near that roundings move it there, the body would enter the
        # ground
        gap = at.z - geometry.support(at.theta, a=scene.a, b=scene.b)
        assume(not flying or gap > 1e-9 * length)
        speed = math.sqrt(scene.gravity * length) + abs(at.x_dot) + abs(at.z_dot) + turning
        far = length + speed * span
        sizes = {"omega": speed / length, "x": far, "z": far, "x_dot": speed, "z_dot": speed}
        errors = roundings(turned_round(at))
        for name, size in sizes.items():
            errors[name] += ROUNDINGS * EPS * size
        known += spread(way_back(share * span), turned_round(at), errors)
    # near a tip the change is not proportional to the error: smaller errors may have larger effects
    assume(known[0] < 1e-3)
    grain = ROUNDINGS * EPS * max(1.0, abs(scene.theta), abs(at.theta))  # rounding of any angle
    own = grain * speed * np.array([1 / speed, 1 / length, span, span, 1, 1])
    start = np.array([getattr(there, name)[0] for name in names]) * [1, -1, 1, 1, -1, -1]
    off = np.abs(way_back(span)(**turned_round(at)) - start)
    allowed = (known + own) * (1 + len(there.events))
    assert np.all(off <= allowed), off / allowed
