"""The problems and known derivatives, read from the files in `problems/`, and their names."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from .._ask.check import FloatArray, array, choice, shown
from .._ask.scene import Scene
from .._core import EventKind
from ._problem import KnownEvent, Problem

TAGS = ("flight", "non-round", "restitution", "slope", "spin", "stiction")
FOLDER = Path(__file__).with_name("problems")


@dataclass(frozen=True, eq=False)
class Gradient:
    """The known derivative of a state with respect to one argument of the scene.

    The other arguments stay as they are typed: on the ground, z, x_dot and z_dot follow rolling.

    Attributes
    ----------
    problem, wrt : str
        Id of the problem, and name of the argument.
    t : float
        Time of the state [s].
    value : ndarray, shape (6,)
        Derivatives of x, z, theta, x_dot, z_dot, omega.
    """

    problem: str
    wrt: str
    t: float
    value: FloatArray

    def error(self, value: Any) -> float:
        """Return the error of a derivative over the known one, both by the scales of states.

        Parameters
        ----------
        value : array_like, shape (6,)

        Raises
        ------
        ValueError
            If it has another shape.
        """
        derivatives = array("value", value)
        if derivatives.shape != self.value.shape:
            raise ValueError(f"value must have shape (6,), got {derivatives.shape}")
        scales = problem(self.problem).scales
        largest = np.max(np.abs(self.value / scales))
        return float(np.max(np.abs((derivatives - self.value) / scales)) / largest)


@cache
def _read() -> dict[str, dict[str, Any]]:
    files = [json.loads(path.read_text(encoding="utf-8")) for path in sorted(FOLDER.glob("*.json"))]
    return {one["id"]: one for one in files}


@cache
def _made(name: str) -> Problem:
    data = _read()[name]
    rows = np.array(data["states"])
    given: dict[str, Any] = data["scene"]
    laws = {law: np.array(states)[:, 1:7] for law, states in data.get("laws", {}).items()}
    return Problem(
        **{key: data[key] for key in ("id", "title", "question", "scored", "answer")},
        tags=tuple(data["tags"]), scene=Scene(**given),
        t_end=float(data["t_end"]), horizon=float(data["horizon"]),
        scales=np.array(data["scales"], dtype=float), times=rows[:, 0], states=rows[:, 1:7],
        normal_force=rows[:, 7], friction_force=rows[:, 8], condition=np.array(data["condition"]),
        events=tuple(_event(one) for one in data["events"]), laws=laws,
    )  # fmt: skip


def _event(data: dict[str, Any]) -> KnownEvent:
    sides = np.array([data["before"], data["after"]], dtype=float)
    known = EventKind[data["kind"]], float(data["t"]), float(data["condition"])
    return KnownEvent(*known, sides[0, :6], sides[1, :6], sides[:, 6], sides[:, 7])


def problem(id: str | Problem) -> Problem:
    """Return a problem by its id.

    Parameters
    ----------
    id : str or Problem
        A problem is returned as it is.

    Raises
    ------
    ValueError
        If there is no such problem; the message lists all, and the nearest first.
    """
    return id if isinstance(id, Problem) else _made(choice("id", id, tuple(_read())))


def problems(tags: str | Iterable[str] | None = None) -> list[Problem]:
    """Return the scored problems.

    Parameters
    ----------
    tags : str or iterable of str, optional
        Abilities of a simulator, also as one text with commas; problems that need others are left
        out. Default: all.

    Raises
    ------
    ValueError
        If there is no such tag.
    """
    typed = [tag.strip() for tag in tags.split(",")] if isinstance(tags, str) else tags
    able = TAGS if typed is None else [choice("tags", tag, TAGS) for tag in typed]
    every = [problem(name) for name in _read()]
    return [one for one in every if one.scored and set(one.tags) <= set(able)]


def scored_ones(
    problems: str | Problem | Iterable[str | Problem] | None, name: str = "problems"
) -> list[Problem]:
    """Return scored problems, given as one or several ids or problems; by default all."""
    names = tuple(name for name, data in _read().items() if data["scored"])
    if problems is None:
        problems = names
    each = [problems] if isinstance(problems, str | Problem) else problems
    if not isinstance(each, Iterable):
        raise TypeError(f"{name} must be ids or problems, got {shown(each)}")
    ids = [one.id if isinstance(one, Problem) else one for one in each]
    return [_made(choice(name, one, names)) for one in ids]


def gradients() -> list[Gradient]:
    """Return the known derivatives."""
    return [
        Gradient(name, row["wrt"], float(row["t"]), np.array(row["value"], dtype=float))
        for name, data in _read().items()
        for row in data.get("gradients", [])
    ]
