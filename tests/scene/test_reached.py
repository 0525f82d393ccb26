"""States beyond the limits of input, which motions can reach, can be continued, saved and read."""

import copy
import math
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import mpmath as mp
import numpy as np
import pytest
import rolling_ellipse as rl
from oracles.incline import rolled
from oracles.numbers import EPS
from rolling_ellipse import Impulse, Scene
from rolling_ellipse.geometry import support, support_slope

MOST = 1e12  # limit of v^2/(g L) and height/L, with L = max(a, b), and of J^2/(2 m^2 g L)
DOWNHILL = Scene(2.0, 1.0, slope=0.1, omega=3.0)
LEVEL = Scene(2.0, 1.0, omega=3.2)


def inertial_time(scene: Scene, turned: float) -> float:
    """Time in which the body turns by an angle at constant D omega^2, by the midpoint rule [s]."""
    with mp.workdps(40):
        first = float(mp.fmod(scene.theta, mp.pi))
    inertia = []
    for angle in (first, first + turned * (np.arange(1000) + 0.5) / 1000):
        h = support(angle, a=scene.a, b=scene.b)
        h1 = support_slope(angle, a=scene.a, b=scene.b)
        inertia.append(scene.gyration2 + h**2 + h1**2)
    return float(turned / scene.omega * np.mean(np.sqrt(inertia[1] / inertia[0])))


@pytest.mark.filterwarnings("ignore::rolling_ellipse.ValidityWarning")
@pytest.mark.parametrize(
    ("scene", "t"),
    [(DOWNHILL, 1e8), (LEVEL, 1e14 * rl.period(LEVEL) / 2)],
    ids=["downhill", "level"],
)
def test_a_state_after_1e14_half_turns_can_be_continued(
    scene: Scene, t: float, tmp_path: Path
) -> None:
    """The bits agree whether the state comes from memory, a file, a table of scenes or a folder."""
    motion = rolled(scene, [0.0, t / 2, t])
    assert motion.theta[-1] > 0.99e14 * math.pi
    reached = motion.scene_at(motion.t_end)
    assert reached.theta == motion.theta[-1] and reached.omega == motion.omega[-1]
    times = np.linspace(0.0, 1e-7, 5)
    on = rl.simulate(reached, times, model="rolling")
    assert on.theta[0] == reached.theta and np.all(np.isfinite(on.x))
    # theta changes by whole ulps. In so short a time gravity has no effect.
    turned, ulp = on.theta[-1] - on.theta[0], np.spacing(reached.theta)
    lasts = [inertial_time(reached, turned + off) for off in (-ulp, ulp)]
    assert lasts[0] <= times[-1] <= lasts[1]
    for same in (pickle.loads(pickle.dumps(reached)), copy.deepcopy(reached)):
        assert same == reached and rl.simulate(same, times, model="rolling") == on
    for each in (motion, on):
        each.save(tmp_path / "motion.npz")
        again = rl.load(tmp_path / "motion.npz")
        assert again == each and again.scene_at(each.t_end) == each.scene_at(each.t_end)
    asked: dict[str, Any] = {"model": "rolling"}
    assert rl.simulate_many([reached], times, **asked) == [on]
    for _ in range(2):  # the second call finds the folder complete
        rl.simulate_many([reached], times, out=tmp_path / "many", **asked)
    assert list(rl.load_many(tmp_path / "many")) == [on]


def test_energy_gained_downhill_may_exceed_the_input_limit() -> None:
    motion = rolled(DOWNHILL, [1e8])
    reached = motion.scene_at(motion.t_end)
    energy = reached.omega**2 * (reached.gyration2 + 4.0) / (reached.gravity * 2.0)
    assert energy > MOST
    for change in ({"omega": reached.omega}, {"impulse": Impulse(jx=1.0)}):
        with pytest.raises(ValueError, match=r"^omega must be at most .* for this body, got"):
            reached.replace(**change)
    # The body cannot roll: it slips, or it leaves the ground if c = g cos(alpha) + h'' omega^2 is
    # negative, which depends on the last bit of theta, a quarter of a radian.
    h = math.hypot(2.0 * math.sin(reached.theta), math.cos(reached.theta))
    c = reached.gravity * math.cos(reached.slope) + (4.0 / h**3 - h) * reached.omega**2
    first = rl.Outcome.LOSES_CONTACT if c < 0 else rl.Outcome.SLIPS
    assert rl.outcome(reached) is first
    assert math.isinf(rl.required_friction(reached))


def body(a: float, b: float, gravity: float) -> dict[str, Any]:
    return {"a": a, "b": b, "gravity": gravity}


def omega(scene: dict[str, Any]) -> float:
    """Largest omega of a scene: omega^2 (k^2 + L^2) = 1e12 g L."""
    length = max(scene["a"], scene["b"])
    gyration2 = (scene["a"] ** 2 + scene["b"] ** 2) / 4
    return math.sqrt(MOST * scene["gravity"] * length / (gyration2 + length**2))


def speed(scene: dict[str, Any]) -> float:
    return math.sqrt(MOST * scene["gravity"] * max(scene["a"], scene["b"]))


def height(scene: dict[str, Any]) -> float:
    return MOST * max(scene["a"], scene["b"])


LIMITS: dict[str, Callable[[dict[str, Any]], float]] = {
    "omega": omega, "x_dot": speed, "z_dot": speed, "z": height,
    "inertia": lambda of: 1e6 * max(of["a"], of["b"]) ** 2,
    "friction": lambda _: 1e6, "slope": lambda _: 1.5,
}  # fmt: skip


@pytest.mark.parametrize(
    "of", [body(2.0, 1.0, 9.81), body(1e-9, 1e-6, 1e-3), body(3e20, 3e20, 1e9)]
)
@pytest.mark.parametrize("name", LIMITS)
def test_input_is_accepted_up_to_its_limit(name: str, of: dict[str, Any]) -> None:
    """A value 64 roundings below its limit is accepted; a value 64 roundings above is refused by
    name."""
    limit = LIMITS[name](of)
    above: dict[str, Any] = {"z": height(of) / 2} if name == "z_dot" else {}
    of = {**of, **above}
    Scene(**{**of, name: limit * (1 - 64 * EPS)})
    with pytest.raises(ValueError, match=rf"^{name} must be .*, got "):
        Scene(**{**of, name: limit * (1 + 64 * EPS)})


def test_a_blow_brings_no_more_energy_than_the_input_limit() -> None:
    """The largest impulse through the centre of a body at rest has J^2/2m = 1e12 m g L."""
    scene = Scene(2.0, 1.0, mass=3.0)
    most = 3.0 * math.sqrt(2 * MOST * 9.81 * 2.0)
    scene.replace(impulse=Impulse(jx=0.0, jz=-most * (1 - 64 * EPS)))
    with pytest.raises(ValueError, match=r"^impulse must be weak enough .*, got 10000000000"):
        scene.replace(impulse=Impulse(jx=0.0, jz=-most * (1 + 64 * EPS)))
