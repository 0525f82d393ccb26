"""The package reproduces the known answers of reference/make_benchmark.py, with which it shares no
code.

Error bound: the inputs and the numbers in the files are doubles, each off by up to half an ulp
(relative 1.1e-16). The condition number is the change of an answer, relative to its scale, divided
by the relative change of all inputs. A backward stable method is off by (condition + 1)/2 ulps.
`ULPS` also allows for rounding errors of the method and for forces, which change by up to three
weights if the state changes by its scale.
"""

import json
import random
from functools import cache
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from oracles.paths import ROOT
from oracles.simulators import STATE, states_of
from rolling_ellipse import Scene, Status, Trajectory, impacts, simulate

FOLDER = ROOT / "python" / "rolling_ellipse" / "benchmark" / "problems"
PROBLEMS: dict[str, Any] = {
    path.stem: json.loads(path.read_text(encoding="utf-8")) for path in FOLDER.glob("*.json")
}
COLUMNS = [*STATE, "normal_force", "friction_force"]
ULP, ULPS = 2.2e-16, 4
each_problem = pytest.mark.parametrize("name", sorted(PROBLEMS))


@cache
def motion(name: str) -> Trajectory:
    """The motion computed by the package. If the body jams at the start, the motion ends there."""
    data = PROBLEMS[name]
    return simulate(Scene(**data["scene"]), data["t_end"] or 1.0, model="contact")


def errors(data: Any, found: Any, exact: Any) -> NDArray[np.float64]:
    """The largest error of each row of states, with or without forces, in ulps of the scales."""
    weight = data["scene"]["mass"] * data["scene"]["gravity"]
    scales = np.array([*data["scales"], weight, weight])[: np.shape(exact)[1]]
    largest: NDArray[np.float64] = np.max(np.abs(np.asarray(found) - exact) / scales, axis=1)
    return largest / ULP


@each_problem
def test_states_forces_and_events_match_the_known_answers(name: str) -> None:
    """Even if the condition number is large, states and forces agree to twelve digits."""
    data, of = PROBLEMS[name], motion(name)
    rows, condition = np.array(data["states"]), np.array(data["condition"])
    samples = of.sol(rows[:, 0])
    mine = np.column_stack([states_of(samples), samples.normal_force, samples.friction_force])
    error = errors(data, mine, rows[:, 1:])
    assert np.all(error <= ULPS * (condition + 1)) and error.max() * ULP < 1e-12
    assert (of.status is Status.JAMMED) == (data["answer"] == {"status": "JAMMED"})
    assert [event.kind.name for event in of.events] == [event["kind"] for event in data["events"]]
    for event, known in zip(of.events, data["events"], strict=True):
        most = ULPS * (known["condition"] + 1)
        assert abs(event.t - known["t"]) * data["scales"][5] <= most * ULP
        near = of.sol(np.array([np.nextafter(event.t, 0), event.t]))
        states = [
            [getattr(each, column) for column in STATE]
            for each in (event.state_before, event.state_after)
        ]
        mine = np.column_stack([states, near.normal_force, near.friction_force])
        assert errors(data, mine, [known["before"], known["after"]]).max() <= most


def test_other_laws_of_restitution_match_the_known_answers() -> None:
    data = PROBLEMS["law.which"]
    body = {key: data["scene"][key] for key in ("a", "b", "friction", "restitution")}
    (hit,), g = data["events"], data["scene"]["gravity"]
    x, z, theta, *velocity = hit["before"][:6]
    for law, rows in data["laws"].items():
        x_dot, z_dot, omega = impacts.collide(theta, *velocity, **body, law=law)
        for (t, *exact), condition in zip(rows, data["condition"], strict=True):
            if (after := t - hit["t"]) > 0:
                rise = z_dot - g * after / 2
                place = x + x_dot * after, z + rise * after, theta + omega * after
                state = [*place, x_dot, z_dot - g * after, omega]
                assert errors(data, [state], [exact[:6]]) <= ULPS * (condition + 1)
        assert not np.allclose(rows, data["states"], rtol=0.05)


@each_problem
def test_slightly_changed_problems_have_the_same_events(name: str) -> None:
    """Each input changes by 1e-12 of its size, and a state that is 0 by 1e-12 of its scale."""
    data, rng = PROBLEMS[name], random.Random(33)
    scene, sizes = data["scene"], dict(zip(STATE, data["scales"], strict=True))
    follow = ["z", "z_dot"] * (Scene(**scene).initial_state.mode.name != "FLIGHT")
    if follow and abs(scene["x_dot"] - scene["z"] * scene["omega"]) < 1e-12:
        follow.append("x_dot")
    for _ in range(64):
        size = {key: 1e-12 * (abs(old) or sizes.get(key, 0)) for key, old in scene.items()}
        changed = {key: old + rng.choice([-1, 1]) * size[key] for key, old in scene.items()}
        changed["restitution"] = min(changed["restitution"], 2 - changed["restitution"])
        beside = Scene(**changed | dict.fromkeys(follow))
        twin = simulate(beside, data["t_end"] or 1.0, model="contact")
        assert [each.kind for each in twin.events] == [each.kind for each in motion(name).events]


def test_the_files_are_small_and_share_one_format() -> None:
    assert len(PROBLEMS) == 22 and sum(data["scored"] for data in PROBLEMS.values()) == 20
    assert sum(path.stat().st_size for path in FOLDER.glob("*.json")) <= 200_000
    for name, data in PROBLEMS.items():
        assert (data["id"], data["format"]) == (name, "rolling_ellipse.benchmark/1")
        assert data["columns"] == ["t", *COLUMNS] and data["tags"] == sorted(data["tags"])
        rows = list(zip(data["states"], data["condition"], strict=True))
        assert all(len(row) == 9 and condition >= 1 for row, condition in rows)
        wild = [row[0] for row, condition in rows if condition > 1000]
        assert data["horizon"] == min([*wild, data["t_end"]])


def test_answers_follow_from_the_known_motions() -> None:
    """An impact counts if the body has risen by more than 0.002 L since the previous impact.
    The bounces end at the last event."""
    for name, data in PROBLEMS.items():
        answer, rows = data["answer"], np.array(data["states"])
        values = {column: rows[:, k] for k, column in enumerate(data["columns"])}
        if "over" in answer:
            assert answer["over"] == (np.abs(values["theta"]).max() > np.pi / 2), name
        for column, value in answer.get("last", {}).items():
            assert values[column][-1] == value and rows[-1, 0] == data["t_end"]
        for column, value in answer.get("always", {}).items():
            assert np.all(values[column] == value)
        if "half_swings" in answer:
            assert answer["events"][-1] == "REST" and not np.any(rows[-3:, 4:7])
        if "end" in answer:
            high = [e["after"][4] ** 2 > 0.004 * data["scene"]["gravity"] for e in data["events"]]
            assert len(answer["events"]) == sum(high) + 1 == 5 and high == sorted(high)[::-1]
            assert answer["end"] == data["events"][-1]["t"]
        kinds = [event["kind"] for event in data["events"]]
        assert answer.get("events", kinds) == kinds[: len(answer.get("events", kinds))]
