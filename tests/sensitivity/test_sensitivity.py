"""Derivatives through events agree with equations of their own, and say how good they are."""

import math
import re
from contextlib import suppress
from typing import Any

import numpy as np
import pytest
from oracles import table
from oracles.paths import ROOT
from rolling_ellipse import Scene, Trajectory, flow, flow_jacobian, scenes, simulate
from rolling_ellipse._motion.sensitivity import STATE, size_of
from sensitivity.chain import chain

DROP = Scene(2.0, 1.0, theta=0.5, z=2.5, friction=0.3, restitution=0.5)


def units(scene: Scene) -> Any:
    length = max(scene.a, scene.b)
    speed = math.sqrt(scene.gravity * length)
    return np.array([length, length, 1, speed, speed, speed / length])


def sizes(scene: Scene, true: Any, wrt: list[str]) -> Any:
    """Largest entries of columns (…, 6, k), or a unit of the state for the size of the input."""
    largest = np.abs(true / units(scene)[:, None]).reshape(-1, len(wrt)).max(axis=0)
    return np.maximum(largest, [1 / size_of(scene, name) for name in wrt])


def off(scene: Scene, found: Any, true: Any, wrt: list[str]) -> Any:
    """Errors of columns, as `Sensitivity.error` is measured."""
    errors = np.abs((found - true) / units(scene)[:, None]).reshape(-1, len(wrt))
    return errors.max(axis=0) / sizes(scene, true, wrt)


def drawn(rng: np.random.Generator) -> tuple[Trajectory, list[str]]:
    """A motion with 1 to 6 events, a millisecond apart at least, and its inputs."""
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
def test_drawn_scenes_agree_with_the_chain(seed: int) -> None:
    """The chain integrates with tolerances of 1e-12 and 1e-13, which a few events magnify."""
    motion, wrt = drawn(np.random.default_rng(seed))
    found = motion.sensitivity(wrt)
    true, times = chain(motion, wrt)
    assert off(motion.scene, found.state, true, wrt).max() < 1e-8
    rate = units(motion.scene)[5] / sizes(motion.scene, true, wrt)
    assert (np.abs(found.event_times - times) * rate).max() < 1e-8


def test_motions_of_the_reference() -> None:
    """94 of 106 motions are within 1e-10; the others magnify roundings, as `error` says.

    An estimate is of the order of the error, so that it bounds it up to a factor of 10. Derivatives
    at bounds have one side. A flat drop has none by what tilts it, and a table on one side only.
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
        assert error < max(1e-10, 10 * found.error[0]) < 1e-5, row
        ratios.append(error / found.error[0])
        good -= {row["name"]} if error > 1e-10 else set()
    assert len(good) >= 94 and np.mean(np.array(ratios) > 1) < 0.1
    assert {name for name, _ in refused} == {"rest-4", "hops-1"} and len(refused) == 5


def by_any_side(motion: Trajectory, name: str) -> Any:
    for side in (0, 1, -1):
        with suppress(ValueError):
            return motion.sensitivity(name, side=side)
    return None


@pytest.mark.filterwarnings("ignore::rolling_ellipse.ValidityWarning")
def test_rolling_keeps_areas() -> None:
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
    # the same by `sensitivity`, for scalars, and in the same bits by any workers
    assert np.array_equal(found, flow_jacobian(t, **given, workers=2))
    for k in range(5):
        one: dict[str, Any] = {name: float(values[k]) for name, values in given.items()}
        assert np.array_equal(found[k], flow_jacobian(t[k], **one))
        scene = Scene(**one)
        state = simulate(scene, [t[k]], model="rolling").sensitivity(("theta", "omega")).state[0]
        assert np.abs(state[[2, 5, 0]] - found[k]).max() < 1e-10 * np.abs(found[k]).max()
    wide = flow_jacobian([[1.0], [2.0]], a=2.0, b=[1.0, 1.5, 2.0], theta=0.3, omega=1.0, wrt="t")
    assert wide.shape == (2, 3, 3, 1)
    swings = flow([[1.0], [2.0]], a=2.0, b=[1.0, 1.5, 2.0], theta=0.3, omega=1.0)
    assert np.abs(wide[..., 0, 0] - swings[1]).max() < 1e-11


def test_a_forecast_is_true_to_second_order() -> None:
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
        near, far = (
            [kinds(name, sign * distance * share) for sign in (1, -1)] for share in (0.999, 1.001)
        )
        assert near == [kinds(name, 0)] * 2 and far != near


def test_one_side_other_times_and_methods_with_steps() -> None:
    """At a bound there is one side; a method's error counts; x moves with x, and t by the rates."""
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


@pytest.mark.parametrize("package", ["numpy", "jax", "torch"])
def test_the_page_runs(package: str) -> None:
    """Its recipes have the gradient of `sensitivity`."""
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
