"""Derivatives through events agree with independent equations and state their accuracy."""

import math
import re
import warnings
from contextlib import suppress
from typing import Any

import numpy as np
import pytest
from oracles import table
from oracles.paths import ROOT
from rolling_ellipse import (
    ExtrapolationWarning,
    Mode,
    Scene,
    Trajectory,
    flow,
    flow_jacobian,
    scenes,
    simulate,
)
from rolling_ellipse._motion import chain as chain_of_parts
from rolling_ellipse._motion.differences import RULES, differenced, neighbours
from rolling_ellipse._motion.inputs import STATE, size_of
from sensitivity import bounces
from sensitivity.chain import chain

DROP = Scene(2.0, 1.0, theta=0.5, z=2.5, friction=0.3, restitution=0.5)


def units(scene: Scene) -> Any:
    length = max(scene.a, scene.b)
    speed = math.sqrt(scene.gravity * length)
    return np.array([length, length, 1, speed, speed, speed / length])


def sizes(scene: Scene, true: Any, wrt: list[str]) -> Any:
    """Largest entries of columns (…, 6, k), at least a unit of the state per size of the input."""
    largest = np.abs(true / units(scene)[:, None]).reshape(-1, len(wrt)).max(axis=0)
    return np.maximum(largest, [1 / size_of(scene, name) for name in wrt])


def off(scene: Scene, found: Any, true: Any, wrt: list[str]) -> Any:
    """Errors of columns, relative as in `Sensitivity.error`."""
    errors = np.abs((found - true) / units(scene)[:, None]).reshape(-1, len(wrt))
    return errors.max(axis=0) / sizes(scene, true, wrt)


def drawn(rng: np.random.Generator) -> tuple[Trajectory, list[str]]:
    """A motion with 1 to 6 events, at least a millisecond apart, and its inputs."""
    while True:
        a, b = rng.uniform(0.5, 2, 2)
        given: dict[str, Any] = {
            "slope": rng.choice([0, rng.uniform(-0.4, 0.4)]), "friction": rng.uniform(0.05, 1.2),
            "restitution": rng.choice([0, rng.uniform(0.1, 0.9)]), "theta": rng.uniform(-1.5, 1.5),
            "omega": rng.uniform(-5, 5), "inertia": rng.uniform(0.5, 2) * (a * a + b * b) / 4,
        }  # fmt: skip
        kind = rng.integers(4)
        given |= {"x_dot": rng.uniform(-4, 4)} if kind != 1 else {}
        given |= {"z": max(a, b) + rng.uniform(0.05, 1.5), "z_dot": 0.3} if kind > 1 else {}
        try:
            scene = Scene(a, b, **given)
        except ValueError:
            continue
        motion = simulate(scene, np.linspace(0, rng.uniform(0.5, 2.5), 9), raise_on_failure=False)
        times = [0, *(event.t for event in motion.events), motion.t_end]
        done = motion.status.name == "COMPLETED" and motion.events[-1:] != ()
        if done and len(times) < 9 and np.diff(times).min() > 1e-3:
            wrt = ["a", "b", "mass", "gravity", *given]
            return motion, [name for name in wrt if name != "restitution" or given[name] > 0]


@pytest.mark.parametrize("seed", range(40))
def test_random_scenes_agree_with_the_variational_chain(seed: int) -> None:
    """The chain integrates with tolerances of 1e-12 and 1e-13, which a few events magnify."""
    motion, wrt = drawn(np.random.default_rng(seed))
    found = motion.sensitivity(wrt)
    true, times = chain(motion, wrt)
    assert off(motion.scene, found.state, true, wrt).max() < 1e-8
    rate = units(motion.scene)[5] / sizes(motion.scene, true, wrt)
    assert (np.abs(found.event_times - times) * rate).max() < 1e-8


def test_reference_motions_have_accurate_derivatives() -> None:
    """95 of 106 motions are within 1e-10; the others magnify roundings, as `error` reports.

    In 99 of 100 columns the stated error is at least the true one, and in most it is less than 100
    times the true one. It is the larger distance to the results of the two neighbouring steps, one
    of which errs by 4 to 64 times as much, plus a rounding of eight units per value. Derivatives at
    bounds are one-sided. A scene exactly at a limit has no derivative.
    """
    last = {row["name"]: row for row in table.rows("contact_reference")}
    good, refused, ratios = {name for name in last if name[:3] != "jam"}, [], []
    for row in table.rows("sensitivity_reference"):
        start, name = last[row["name"]], row["wrt"]
        given: dict[str, Any] = {key.removesuffix("0"): start[key] for key in list(start)[1:15]}
        numbers: dict[str, Any] = {key: float(text) for key, text in given.items() if text}
        scene = Scene(**numbers)
        motion = simulate(scene, [float(start["t"])], model="contact")
        true = np.array([float(row[key]) for key in STATE])[:, None]
        found = by_any_side(motion, name)
        if found is None:
            refused.append((row["name"], name))
            continue
        (error,) = off(scene, found.state[0], true, [name])
        assert error < 3 * found.error[0] < 1e-5, row
        ratios.append(error / found.error[0])
        good -= {row["name"]} if error > 1e-10 else set()
    assert len(good) >= 95 and np.mean(np.array(ratios) > 1) < 0.01
    assert np.median(ratios) > 0.01
    assert {name for name, _ in refused} == {"rest-4"} and len(refused) == 4


def by_any_side(motion: Trajectory, name: str) -> Any:
    for side in (0, 1, -1):
        with suppress(ValueError):
            return motion.sensitivity(name, side=side)
    return None


@pytest.mark.filterwarnings("ignore::rolling_ellipse.ValidityWarning")
def test_rolling_conserves_phase_space_areas() -> None:
    """det d(theta, D omega)/d(theta0, D0 omega0) = 1 with D = k^2 + h^2 + h'^2.

    The determinant is a difference of two products of derivatives, each with an error of 1e-12.
    """
    rng = np.random.default_rng(3)
    a, b = np.exp(rng.uniform(-1, 1, (2, 200)))
    theta, omega, t = rng.uniform(-3, 3, 200), rng.uniform(-8, 8, 200), rng.uniform(0, 5, 200)
    given = {"a": a, "b": b, "theta": theta, "omega": omega}
    found = flow_jacobian(t, **given)

    def weight(theta: Any) -> Any:
        h2 = (a * np.sin(theta)) ** 2 + (b * np.cos(theta)) ** 2
        return (a * a + b * b) / 4 + h2 + ((a * a - b * b) * np.sin(2 * theta) / 2) ** 2 / h2

    det = np.linalg.det(found[:, :2]) * weight(flow(t, **given)[0]) / weight(theta)
    size = 1 + (found[:, :2] ** 2).sum(axis=(1, 2))
    assert (np.abs(det - 1) / size).max() < 1e-11
    # workers and single calls give the same bits, and `sensitivity` agrees
    assert np.array_equal(found, flow_jacobian(t, **given, workers=2))
    for k in range(5):
        one: dict[str, Any] = {name: float(values[k]) for name, values in given.items()}
        assert np.array_equal(found[k], flow_jacobian(t[k], **one))
        scene = Scene(**one)
        state = simulate(scene, [t[k]], model="rolling").sensitivity(("theta", "omega")).state[0]
        assert np.abs(state[[2, 5, 0]] - found[k]).max() < 1e-10 * np.abs(found[k]).max()
    wide = flow_jacobian([[1.0], [2.0]], a=2.0, b=[1.0, 1.5, 2.0], theta=0.3, omega=1.0, wrt="t")
    tilted = flow_jacobian([1.0, 2.0], a=2.0, b=1.0, theta=[[0.3], [0.4]], omega=0.5, wrt="theta")
    assert tilted.shape == (2, 2, 3, 1)
    assert wide.shape == (2, 3, 3, 1)
    swings = flow([[1.0], [2.0]], a=2.0, b=[1.0, 1.5, 2.0], theta=0.3, omega=1.0)
    assert np.abs(wide[..., 0, 0] - swings[1]).max() < 1e-11


@pytest.mark.filterwarnings("ignore::rolling_ellipse.ValidityWarning")
def test_rolling_on_slopes_agrees_with_the_chain() -> None:
    """The slope is one of the inputs, even where it is 0."""
    rng = np.random.default_rng(8)
    wrt = ["a", "b", "gravity", "slope", "theta", "omega"]
    a, b = rng.uniform(0.5, 2, (2, 20))
    theta, omega, t = rng.uniform(-1.5, 1.5, 20), rng.uniform(-1, 1, 20), rng.uniform(0.2, 2, 20)
    slope = rng.uniform(-0.4, 0.4, 20) * (rng.random(20) < 0.8)
    given = {"a": a, "b": b, "theta": theta, "omega": omega, "slope": slope}
    found = flow_jacobian(t, **given, wrt=wrt)
    for k in range(20):
        one: dict[str, Any] = {name: float(values[k]) for name, values in given.items()}
        assert np.array_equal(found[k], flow_jacobian(t[k], **one, wrt=wrt))
        motion = simulate(Scene(**one), [t[k]], model="rolling")
        true = chain(motion, wrt)[0][0]
        mine = true.copy()
        mine[[2, 5, 0]] = found[k]  # theta, omega, x
        assert off(motion.scene, mine, true, wrt).max() < 1e-8


# --------------------------------------------------------------------- motions of many events

CHAOS = Scene(1.0, 0.7, theta=0.7, z=2.0, omega=0.3, friction=0.0, restitution=1.0)
OF_BOUNCES = [STATE.index(name) for name in bounces.STATE]


def relative(scene: Scene, found: Any, true: Any, wrt: list[str]) -> Any:
    """Errors of the last state, relative to its largest entry."""
    unit = units(scene)[OF_BOUNCES, None]
    size = np.fmax(np.abs(true / unit).max(axis=0), [1 / size_of(scene, name) for name in wrt])
    return np.abs((found - true) / unit).max(axis=0) / size


def test_derivatives_chained_over_parts_agree_with_the_whole() -> None:
    """Both agree within the sum of their errors, for all inputs. Parts start rolling or sliding."""
    modes, seen = set(), 0
    for seed in range(40):
        motion, wrt = drawn(np.random.default_rng(seed))
        if len(motion.events) <= chain_of_parts.EVENTS:
            continue
        parts = chain_of_parts.chained(motion, tuple(wrt), 0)
        assert parts is not None
        later = chain_of_parts.parts_of(motion, chain_of_parts.EVENTS)[1:]
        starts = [part.motion.scene.initial_state.mode for part in later]
        modes |= set(starts)
        for k, name in enumerate(wrt):
            whole, _ = neighbours(motion, name, 0)
            apart = np.abs(whole.value - parts.value[..., k]).max(axis=0)
            assert (apart <= whole.error + parts.error[:, k]).all()
            seen += bool(starts)
    assert {Mode.ROLLING, Mode.SLIDING} <= modes and seen > 40


def test_growing_derivatives_are_accurate_until_they_are_rejected() -> None:
    """Derivatives agree with the motion's own arcs in 60 digits up to a growth of 1e12, and are
    refused beyond 1e13. The exact motion differs by growing roundings, which the error covers.

    At 14 s the exact motion has dtheta/dtheta0 = -8.851e8. The product of six parts, each with
    an error of some 1e-12, is within 1e-10.
    """
    wrt = ["theta", "a"]
    for t, true in ((14.0, -8.851e8), (18.0, -8.763e11)):
        motion = simulate(CHAOS, [1.0, t])
        known = motion.sensitivity(wrt)
        assert known.state[1, 2, 0] == pytest.approx(true, rel=1e-3)
        last = known.state[1][OF_BOUNCES]
        own, own_times = bounces.bounces(motion, wrt, own=True)
        exact, times = bounces.bounces(motion, wrt, own=False)
        assert relative(CHAOS, last, own, wrt).max() < 1e-10
        assert (relative(CHAOS, last, exact, wrt) < known.error).all()
        largest = np.abs(times).max(axis=0)
        assert (np.abs(known.event_times - own_times).max(axis=0) < 1e-10 * largest).all()
        off_by = np.abs(known.event_times - times).max(axis=0) / largest
        assert (off_by < known.event_times_error).all()
        assert known.error.max() < 1e-13 * abs(true)
    with pytest.raises(ValueError, match=r"'theta': changes grow by .*; beyond 1e\+13 \(from t"):
        simulate(CHAOS, [20.0]).sensitivity("theta")
    early = simulate(CHAOS, [20.0]).sol(14.0).sensitivity("theta")
    assert early.state[0, 2, 0] == pytest.approx(-8.851e8, rel=1e-3)


def test_stated_errors_of_bounces_are_rarely_below_the_true_errors() -> None:
    """Less than 3 % of the true errors, from 60 digits, exceed the stated ones, by at most half."""
    rng = np.random.default_rng(6)
    shares: list[float] = []
    while len(shares) < 40:
        scene, t = bounces.scene_of(rng), float(rng.uniform(2, 8))
        motion = simulate(scene, [t])
        gaps = np.diff([0, *(event.t for event in motion.events), t])
        if not 4 <= len(motion.events) <= 12 or gaps.min() < 1e-3:
            continue
        wrt = ["theta", "gravity"]
        known = motion.sensitivity(wrt)
        true, times = bounces.bounces(motion, wrt, own=False)
        shares += [*(relative(scene, known.state[0][OF_BOUNCES], true, wrt) / known.error)]
        unit = units(scene)[0] / units(scene)[3]
        least = [1 / size_of(scene, name) for name in wrt]
        largest = np.fmax(np.abs(times / unit).max(axis=0), least)
        off_by = np.abs((known.event_times - times) / unit).max(axis=0) / largest
        shares += [*(off_by / known.event_times_error)]
    assert np.max(shares) < 1.5 and np.mean(np.array(shares) > 1) < 0.03
    assert np.median(shares) > 1e-3


def test_rounding_errors_of_rising_and_falling_values_are_equal() -> None:
    """An input of magnitude 1e6 is the main source of error of values near 0."""
    moved = 1e-3 * RULES[0][0]
    rising, falling = (differenced(sign * moved, moved, scale=1e6) for sign in (1, -1))
    assert rising[0] == -falling[0] and rising[1] == falling[1] > 1e-8


def test_derivatives_of_event_times_do_not_depend_on_the_samples() -> None:
    """The first body slides almost without friction. In 40 digits its first REVERSE moves by
    -0.00998485024303 s per radian of slope."""
    ice = Scene(
        5.588108666592639, 1.0, inertia=8.05673961741194, friction=5.463150523067873e-09,
        theta=-2.847479703823904, omega=-3.5083007800939634,
    )  # fmt: skip
    few, many = (simulate(ice, t).sensitivity("slope") for t in ([1.25], np.linspace(0, 1.25, 101)))
    assert np.array_equal(few.event_times, many.event_times)
    assert abs(few.event_times[0, 0] + 0.00998485024303) < 1e-14 + few.event_times_error[0] / 30
    assert few.event_times_error[0] < 1e-10
    motions = [drawn(np.random.default_rng(seed)) for seed in range(5)]
    for motion, wrt in [*motions, (simulate(CHAOS, [0.1, 9.0]), ["theta"])]:
        alone = motion.sol(motion.t_end).sensitivity(wrt)
        assert np.array_equal(alone.event_times, motion.sensitivity(wrt).event_times)


def test_a_message_names_the_events_in_which_a_neighbour_differs() -> None:
    """The end of a neighbour that stops early is not reported as an event."""
    landing = simulate(DROP, 1.0).events[0].t
    with pytest.raises(ValueError, match=r"there is no IMPACT to \w+ at t = 0\.\d+ s$"):
        simulate(DROP, landing).sensitivity("theta")
    said = r"there is one more event, IMPACT to \w+, by t = 0\.\d+ s$"
    with pytest.raises(ValueError, match=said):
        simulate(DROP, np.nextafter(landing, 0)).sensitivity("theta")


def test_a_forecast_beyond_its_stated_distance_warns() -> None:
    motion = simulate(DROP, [0.3, 1.0])
    known = motion.sensitivity(("theta", "friction", "t"))
    for name, distance in zip(known.wrt, known.distance.tolist(), strict=True):
        for sign in (1, -1):
            known.forecast(**{name: 0.999 * sign * distance})  # a warning would be an error
            with pytest.warns(ExtrapolationWarning, match=f"{name} changes by .* beyond"):
                known.forecast(**{name: 1.001 * sign * distance})
    upwards = motion.sensitivity("theta", side=1)
    upwards.forecast(theta=1e-3)
    with pytest.warns(ExtrapolationWarning, match="whose sign is not that of side 1"):
        upwards.forecast(theta=-1e-3)


def test_a_forecast_for_changes_too_large_in_combination_warns() -> None:
    """Theta and omega both change the angle at landing, together by twice as much."""
    known = simulate(DROP, [0.3, 1.0]).sensitivity(("theta", "omega"))
    theta, omega = (0.9 * known.distance).tolist()
    together = []
    for signs in ((1, 1), (1, -1), (-1, 1), (-1, -1)):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            known.forecast(theta=signs[0] * theta, omega=signs[1] * omega)
        together += [str(each.message) for each in caught]
    assert together and all("the changes of theta, omega together" in text for text in together)


def test_the_error_of_a_forecast_is_of_second_order() -> None:
    """Half the change leaves a quarter of the error; events keep their order within `distance`."""
    motion = simulate(DROP, [0.3, 1.0])
    known = motion.sensitivity(("theta", "friction"))
    left = []
    for change in (2e-3, 1e-3):
        moved = simulate(DROP.replace(theta=0.5 + change, friction=0.3 + change), motion.t)
        true = np.stack([getattr(moved, name) for name in STATE], axis=1)
        left.append(np.abs(known.forecast(theta=change, friction=change) - true).max())
    assert left[0] / left[1] == pytest.approx(4, rel=0.05)

    def kinds(name: str, change: float) -> list[str]:
        moved = simulate(DROP.replace(**{name: getattr(DROP, name) + change}), motion.t)
        return [repr((e.kind, e.state_after.mode)) for e in moved.events]

    for name, distance in zip(known.wrt, known.distance, strict=True):
        near, far = ([kinds(name, side * share * distance) for side in (1, -1)]
                     for share in (0.999, 1.001))  # fmt: skip
        assert near == [kinds(name, 0)] * 2 and far != near


def test_derivatives_are_right_at_events_and_bounds_and_in_stepped_motions() -> None:
    """Derivatives at bounds are one-sided, the error includes that of the method, dx/dx is 1, and
    d/dt gives the rates."""
    motion = simulate(DROP, np.sort([0.0, 1.0, *(e.t for e in simulate(DROP, 1.0).events)]))
    known = motion.sensitivity(("x", "t", "theta"))
    assert np.abs(known.state[:, :, 0] - [1, 0, 0, 0, 0, 0]).max() < 1e-12
    assert np.array_equal(known.state[:, 2, 1], motion.omega)
    for k, t in enumerate(motion.t):
        assert np.abs(known.at(t) - known.state[k]).max() < 1e-9
    for side in (1, -1):
        sided = motion.sensitivity("theta", side=side)
        assert np.abs(sided.state[:, :, 0] - known.state[:, :, 2]).max() < 1e-8
    ice = simulate(DROP.replace(friction=0.0, restitution=1.0), 1.0)
    assert ice.sensitivity("friction", side=1).error < 1e-9
    assert ice.sensitivity("restitution", side=-1).error < 1e-9
    exact = simulate(scenes.rolling, 3.0).sensitivity("omega")
    for method, model, step in (("dop853", "rolling", None), ("rk4", "multipliers", 0.02)):
        options: Any = {"model": model, "method": method, "step": step}
        found = simulate(scenes.rolling, 3.0, **options)
        rough = found.sensitivity("omega")
        true = off(scenes.rolling, rough.state, exact.state, ["omega"])[0]
        assert 1e-10 < true < 10 * rough.error[0]


RESISTED = Scene(2.0, 1.0, theta=0.4, friction=1.0, rolling_resistance=0.02)


@pytest.mark.parametrize(
    ("scene", "kinds"),
    [
        (RESISTED, []),
        (RESISTED.replace(omega=-2.0, x_dot=2.0, friction=0.6), ["STICK"]),
        (RESISTED.replace(rolling_resistance=0.2), ["REST"]),
        (RESISTED.replace(rolling_resistance=0.0), []),
        (RESISTED.replace(slope=0.1, rolling_resistance=0.0), []),
    ],
)
def test_resistance_derivatives_agree_with_differences(scene: Scene, kinds: list[str]) -> None:
    """The reference is a difference of second order; steps of 1e-6 leave errors of about 1e-9."""
    motion = simulate(scene, [1.1, 4.5])
    assert [event.kind.name for event in motion.events] == kinds
    found = motion.sensitivity(["rolling_resistance", "theta"], side=1)
    for column, name in enumerate(found.wrt):
        start = getattr(scene, name)
        beside = (scene.replace(**{name: start + step}) for step in (0.0, 1e-6, 2e-6))
        moved = [simulate(each, [1.1, 4.5]) for each in beside]
        states = np.array([[each.x, each.theta, each.omega] for each in moved])
        slopes = np.array([-3, 4, -1]) @ states.reshape(3, -1) / 2e-6
        exact = found.state[:, [0, 2, 5], column].T.ravel()
        assert exact == pytest.approx(slopes, abs=1e-7 * np.abs(slopes).max())
        for row, event in enumerate(motion.events):
            times = [each.events[row].t for each in moved]
            rate = np.array([-3, 4, -1]) @ times / 2e-6
            assert found.event_times[row, column] == pytest.approx(rate, rel=1e-6), event


@pytest.mark.parametrize("package", ["numpy", "jax", "torch"])
def test_the_code_on_the_page_gives_the_gradient_of_sensitivity(package: str) -> None:
    pytest.importorskip(package)
    page = (ROOT / "docs" / "sensitivity.md").read_text(encoding="utf-8")
    names: dict[str, Any] = {}
    for name, block in re.findall(r"(?:<!-- (\w+) -->\n)?```python\n(.*?)```", page, re.DOTALL):
        if name in ("", package):
            exec(block, names)
    true = names["known"].state[1, 0]
    if package == "torch":
        assert np.allclose(names["values"].grad, true, rtol=1e-12)
    if package == "jax":
        first = names["jax"].grad(lambda values: names["motion"](values)[1, 0])
        assert np.allclose(first(np.array([0.5, 0.3])), true, rtol=1e-12)
