"""`simulate` and its Trajectory: sample times, ends, and parts."""

import dataclasses
import math
import pickle
from typing import Any

import numpy as np
import pytest
import rolling_ellipse as rl
from oracles.contact import random_scenes
from oracles.numbers import EPS
from oracles.trajectory import MATRICES, SCENES, VECTORS
from rolling_ellipse import Mode, Scene, Status, Trajectory, ValidityWarning, simulate
from rolling_ellipse._ask.printing import brief

each_scene = pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES)


def test_a_single_number_is_taken_as_the_end_time() -> None:
    trajectory = simulate(rl.scenes.rocking, 3)
    assert np.array_equal(trajectory.t, np.linspace(0, 3, 1001))
    assert trajectory.t_end == 3


def test_an_end_time_of_zero_gives_one_sample() -> None:
    trajectory = simulate(rl.scenes.report, 0)
    assert trajectory.t.tolist() == [0.0]
    start = rl.scenes.report.initial_state
    for name in ("theta", "omega", "x", "z", "x_dot", "z_dot"):
        assert getattr(trajectory, name)[0] == getattr(start, name)


@pytest.mark.parametrize(
    "times", [[0.5, 1.0, 7.0], (0.5, 2.0), [0.0, 2.0], np.array([3, 4]), [2.0]]
)
def test_an_array_of_times_is_used_unchanged(times: Any) -> None:
    trajectory = simulate(rl.scenes.rocking, times)
    assert np.array_equal(trajectory.t, np.asarray(times, float))
    assert not np.shares_memory(trajectory.t, np.asarray(times))
    assert not isinstance(times, np.ndarray) or times.flags.writeable


@each_scene
def test_valid_rolling_runs_to_completion(scene: Scene) -> None:
    ways: list[dict[str, Any]] = [{}, {"model": "rolling", "method": "exact"}]
    for way in ways:
        trajectory = simulate(scene, 4.0, **way)
        assert (trajectory.model, trajectory.method) == ("rolling", "exact")
        assert trajectory.status is Status.COMPLETED and trajectory.success
        assert trajectory.message == Status.COMPLETED.value
        assert trajectory.valid_until == math.inf and trajectory.events == ()
        over = rl.outcome(scene) == rl.Outcome.ROLLS_OVER
        does = "It rolls over." if over else "It rocks."
        proved = rl.certify(scene).reason
        assert trajectory.reason == f"{does} {proved}"
        assert proved.startswith("Proved: it rolls for ever")
        assert trajectory.scene is scene
        assert np.all(trajectory.mode == Mode.ROLLING) and trajectory.mode.dtype == np.int8
        assert np.all(trajectory.normal_force > 0)


ENDING = {
    "jump": rl.scenes.jump,
    "contact": Scene(2.0, 1.0, mass=3.0, omega=5.2),
    "little friction": Scene(2.0, 1.0, omega=3.2, friction=0.2),
    "rocking": Scene(2.0, 1.0, theta=0.1, omega=1.5, friction=0.2),
    "standing": Scene(0.7, 1.9, theta=1.5, omega=2.2, friction=0.3),
    "backwards": Scene(2.0, 1.0, mass=10.0, theta=-0.1, omega=-5.0, friction=0.7),
    "downhill": Scene(2.0, 1.0, theta=0.2, omega=3.0, slope=0.2, friction=0.5),
    "uphill": Scene(2.0, 1.0, theta=0.2, omega=-4.0, slope=0.2, friction=0.6),
}


def test_the_message_says_whether_rolling_fails_or_is_at_the_edge() -> None:
    scene = Scene(2.0, 1.0, theta=1.0, omega=2.2)
    enough = rl.required_friction(scene)
    for share, says in (
        (1 - 1e-9, "only; after it .* not the laws"),
        (1.0, "only to within round"),
    ):
        with pytest.warns(
            ValidityWarning, match=f"rolling is valid until t = .* s.*{says}"
        ) as told:
            motion = simulate(scene.replace(friction=share * enough), 6.0, model="rolling")
        assert motion.status is Status.VALIDITY_LOST and motion.message == str(told[0].message)
        assert ("laws of contact" in motion.message) == (share < 1)


@pytest.mark.parametrize("scene", ENDING.values(), ids=ENDING)
def test_rolling_is_valid_until_its_law_fails(scene: Scene) -> None:
    """At valid_until a law fails: |F| = friction N, or N = 0. Before this time the ground can hold
    the body. The bound is 1e-9 of the weight: time and angle are accurate to some 1e-15, and the
    forces change by at most some hundred weights per second."""
    with pytest.warns(ValidityWarning, match="rolling is valid until t = "):
        trajectory = simulate(scene, 10.0, model="rolling")
    assert trajectory.status is Status.VALIDITY_LOST and not trajectory.success
    assert trajectory.t.size == 1001 and trajectory.t[-1] == 10
    assert all(np.all(np.isfinite(getattr(trajectory, name))) for name in ("x", "omega", "psi"))
    end = trajectory.valid_until
    weight = scene.mass * scene.gravity * math.cos(scene.slope)
    assert 0 < end < 10

    def spare(times: Any) -> np.ndarray:
        at = trajectory.sol(times)
        if math.isinf(scene.friction):
            return at.normal_force / weight
        return (scene.friction * at.normal_force - np.abs(at.friction_force)) / weight

    assert abs(spare(end)[0]) <= 1e-9
    before = spare(end * (1 - np.geomspace(1e-6, 1, 3000)))
    assert np.all(before > 0)
    assert spare(end * (1 + 1e-6))[0] < 0
    ends_at = rl.certify(scene).ends_at
    assert trajectory.sol(end).theta[0] == pytest.approx(ends_at, rel=1e-13)
    assert ends_at is not None
    proved = f"Proved: rolling is valid up to theta = {math.degrees(ends_at):.6g} deg, where "
    assert rl.certify(scene).reason.startswith(proved)
    told = f"It rolls, then it slips at t = {end:.6g} s. {rl.certify(scene).reason}"
    assert trajectory.reason == told
    followed = simulate(scene, 10.0)
    assert followed.model == "contact" and followed.valid_until == math.inf
    assert followed.reason == told
    assert followed.events[0].kind is rl.EventKind.SLIP and followed.events[0].t == end
    short = simulate(scene, 0.99 * end, model="rolling")  # a warning would be an error here
    assert short.status is Status.COMPLETED and short.valid_until == end


def test_rolling_that_cannot_start_is_valid_until_zero() -> None:
    with pytest.warns(ValidityWarning):
        trajectory = simulate(Scene(2.0, 1.0, theta=0.5, friction=0.01), 2.0, model="rolling")
    assert trajectory.valid_until == 0 and trajectory.t.size == 1001
    assert trajectory.reason == "It slips at once. Friction 0.01 cannot hold the contact."


@pytest.mark.parametrize("theta", [0.0, math.pi / 2])
def test_a_body_at_rest_stays_at_rest(theta: float) -> None:
    scene = Scene(2.0, 1.0, mass=3.0, theta=theta, x=4.0, friction=0.0)
    trajectory = simulate(scene, 5.0)
    assert trajectory.status is Status.COMPLETED and np.all(trajectory.mode == Mode.REST)
    assert trajectory.reason.startswith("It rests. Proved: it stays at rest")
    for name in ("theta", "x", "z", "psi", "r"):
        assert np.all(getattr(trajectory, name) == getattr(trajectory, name)[0])
    for name in ("omega", "x_dot", "z_dot", "psi_dot", "r_dot", "turns"):
        assert np.all(getattr(trajectory, name) == 0)
    assert trajectory.theta[0] == theta and trajectory.x[0] == 4.0
    # theta on the tip is the nearest double, whose rounding leaves small forces
    assert np.all(np.abs(trajectory.normal_force - 3 * 9.81) <= 8 * EPS * 30)
    assert np.all(np.abs(trajectory.friction_force) <= 8 * EPS * 30)


def test_a_motion_may_end_before_the_first_sample() -> None:
    """A motion that jams at t = 0 has no samples at later times."""
    scene = Scene(2.0, 1.0, theta=0.9, omega=0.0, x_dot=5.0, friction=3.0)
    trajectory = simulate(scene, [0.5, 1.0])
    assert trajectory.status is Status.JAMMED and trajectory.t_end == 0
    for vector in VECTORS:
        assert getattr(trajectory, vector).shape == (0,)
    for matrix, columns in MATRICES.items():
        assert getattr(trajectory, matrix).shape == (0, columns)
    assert trajectory.constraint_residuals().position.shape == (0, 3)
    assert "no samples" in repr(trajectory)
    assert trajectory.sol(0.0).x_dot[0] == 5.0
    with pytest.raises(ValueError, match="must have samples"):
        trajectory.plot()


def test_the_repr_summarizes_the_motion() -> None:
    report = simulate(rl.scenes.report, 6.0)
    text = repr(report)
    assert text.startswith("<Trajectory rolling/exact: 1001 samples, t = 0 ... 6 s, ")
    assert f"{report.turns[-1]:.3g} turns" in text and "COMPLETED" in text
    assert len(text) < 120


def five_samples() -> Trajectory:
    return simulate(rl.scenes.bounce, np.linspace(0.0, 0.4, 5))


def test_numbers_of_any_type_become_float64() -> None:
    for x in ([0, 1, 2, 3, 4], range(5), np.arange(5, dtype=np.float32), np.arange(10.0)[::2] / 2):
        made = dataclasses.replace(five_samples(), x=x)  # type: ignore[arg-type]
        assert made.x.dtype == np.float64 and made.x.tolist() == [0, 1, 2, 3, 4]
        assert made.x.flags.c_contiguous and not made.x.flags.writeable
    contact = five_samples().contact
    assert contact is not None
    made = dataclasses.replace(five_samples(), contact=contact._replace(mode=[2, 2, 2, 1, 3]))  # type: ignore[arg-type]
    assert made.mode.dtype == np.int8 and made.mode.tolist() == [2, 2, 2, 1, 3]


def test_arrays_of_the_caller_are_left_alone() -> None:
    """Neither the caller's arrays nor read-only views of them are locked or shared."""
    mine, mode = np.arange(5.0), np.full(5, 2, np.int8)
    view = mine[:]
    view.flags.writeable = False
    contact = five_samples().contact
    assert contact is not None
    for x in (mine, view):
        made = dataclasses.replace(
            five_samples(), x=x, contact=contact._replace(z=x, mode=mode), start=(x, x)
        )
        assert made.contact is not None and made.start is not None
        for values in (made.x, made.contact.z, *made.start):
            assert not np.shares_memory(values, mine) and not values.flags.writeable
        _ = made.q, made.energy, made.mode
        assert not np.shares_memory(made.mode, mode)
        assert mine.flags.writeable and mode.flags.writeable
    again = dataclasses.replace(made)
    assert again.x is made.x and again.contact is not None and made.contact is not None
    assert again.contact.z is made.contact.z  # a read-only array need not be copied


@pytest.mark.parametrize("model", ["rolling", "multipliers", "contact"])
def test_no_array_of_a_motion_is_writable(model: Any) -> None:
    motion = simulate(rl.scenes.report, np.linspace(0.0, 1.0, 5), model=model)
    start = (motion.q[0], motion.q_dot[0])
    for one in (motion, motion.sol([0.5]), dataclasses.replace(motion, start=start)):
        pairs = *(one.coordinates or ()), *(one.start or ()), *(one.contact or ())
        for values in (*(getattr(one, n) for n in (*VECTORS, *MATRICES, "mode")), *pairs):
            assert not values.flags.writeable
            with pytest.raises(ValueError, match="read-only"):
                values[...] = 0


def test_the_default_settings_are_created_only_once() -> None:
    """Settings that are given but equal the defaults make no difference."""
    scene = Scene(2.0, 1.0, omega=3.2)
    motion = simulate(scene, [1.0])
    assert motion.settings is simulate(scene, [2.0]).settings
    said = simulate(scene, [1.0], rtol=1e-10, baumgarte=(10, 10), max_steps=int("1000000"))
    assert said.settings == motion.settings and said == motion


def test_reason_and_stats_are_computed_on_demand() -> None:
    motion = simulate(Scene(2.0, 1.0, omega=3.2), [1.0])
    assert not {"reason", "stats"} & (vars(motion).keys() | vars(motion.sol(0.5)).keys())
    assert motion.reason == f"It rolls over. {rl.certify(motion.scene).reason}"
    assert motion.stats == {"segments": 1, "steps": 0, "rejected_steps": 0, "evaluations": 0}
    assert motion.sol(0.5).reason is motion.reason


def test_names_of_any_text_type_become_plain_strings() -> None:
    """The process that reads a pickle may not know the original type."""

    class Mine(str):
        def __reduce__(self) -> Any:
            raise TypeError("cannot be pickled")

    how: dict[str, Any] = {"model": Mine("rolling"), "method": Mine("dop853")}
    stabilization: Any = Mine("projection")
    motion = simulate(rl.scenes.report, [0.0, 0.5], **how, stabilization=stabilization)
    told = dataclasses.replace(motion, message=Mine("message"), reason=Mine("reason"), **how)
    assert pickle.loads(pickle.dumps(told)) == told
    assert pickle.loads(pickle.dumps(motion)) == motion


def test_events_have_the_angle_and_position_that_they_print() -> None:
    """Angle and position are the same before and after an event: only velocities change."""
    seen = set()
    for scene in random_scenes(80, 5):
        for event in rl.simulate(scene, 3.0, raise_on_failure=False).events:
            seen.add(event.kind)
            assert (event.theta, event.x) == (event.state_before.theta, event.state_before.x)
            assert (event.theta, event.x) == (event.state_after.theta, event.state_after.x)
            assert f"theta = {brief(event.theta)} rad, x = {brief(event.x)} m" in repr(event)
    assert len(seen) >= 6
