"""Events detected in the states of a motion by one rule, for simulators that report none.

With L = max(a, b), a row (a state) flies if the gap is above L/500, slips if it does not fly and
the magnitude of the slip is above sqrt(g L)/100, and rolls otherwise. Consecutive rows of the same
kind form a run. A run is also divided where the velocity of the centre is pushed up by more than
sqrt(g L)/10 between two rows while the gap changes from closing to opening. Runs on the ground that
are shorter than sqrt(L/g)/10 belong to the run before, as do rolling runs up to twice as long
between opposite slips.

A run in flight ends with an IMPACT, when the free flight from its last row reaches the ground. All
other events are located where the gap or the slip passes its limit, by linear interpolation between
two rows: LIFT_OFF if the second run flies, STICK if it rolls, SLIP if the first run rolls, and
REVERSE, at zero slip, if both slip.

With rolling resistance the last event is REST if no velocity exceeds its limit in the last
sqrt(L/g)/10 or longer; the limits are sqrt(g L)/500, and sqrt(g/L)/500 for the rotation. REST is
located where the last velocity falls below its limit. A half swing ends where the rotation
reverses, with speeds above the limit on both sides.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np

from .._ask.check import FloatArray
from ..geometry import support, support_slope
from ._problem import Problem

_LEAST_GAP, _LEAST_SLIP, _LEAST_PUSH, _SHORTEST = 0.002, 0.01, 0.1, 0.1
_LEAST_SPEED = 0.002
_ROLLS, _FLIES = 0, 2  # codes of rows; 1 and -1 mean slip


def read_off(problem: Problem, t: FloatArray, states: FloatArray) -> list[tuple[str, float]]:
    """Return the kinds and times of the events that the rows of states show."""
    scene, length, speed = problem.scene, float(problem.scales[0]), float(problem.scales[3])
    gap, slip = gap_and_slip(problem, states)
    least_gap, least_slip = _LEAST_GAP * length, _LEAST_SLIP * speed
    slips = np.where(np.abs(slip) > least_slip, np.sign(slip), _ROLLS)
    kinds = np.where(gap > least_gap, _FLIES, slips).astype(int)
    starts = _starts(problem, t, states, kinds)
    shortest = _SHORTEST * math.sqrt(length / scene.gravity)
    events: list[tuple[str, float]] = []
    before = kinds[0]
    rebounds = False  # whether the body keeps flying after an impact and a run too short to count
    for start, end in pairwise(starts):
        kind = kinds[start]
        lasts = t[end] - t[start] if end < len(t) else math.inf
        if before == _FLIES and not rebounds:
            events.append(("IMPACT", _touch(problem, t[start - 1], states[start - 1])))
        turns = kind == _ROLLS and before != _FLIES and end < len(t) and kinds[end] == -before
        if kind != _FLIES and lasts < shortest * (2 if turns and before else 1):
            rebounds = before == _FLIES
            continue
        if before != _FLIES and kind == _FLIES:
            events.append(("LIFT_OFF", _passing(t, gap, least_gap, start)))
        elif before != _FLIES and kind != before:
            if kind and before:
                events.append(("REVERSE", _passing(t, slip * kind, 0.0, start)))
            else:
                passed = _passing(t, np.abs(slip), least_slip, start)
                events.append(("STICK" if kind == _ROLLS else "SLIP", passed))
        before, rebounds = kind, False
    if scene.rolling_resistance and before != _FLIES:
        speeds = np.abs(states[:, 3:] / problem.scales[3:]).max(axis=1)
        rests = _passing(t, speeds, _LEAST_SPEED, len(t) - 1)
        if speeds[-1] < _LEAST_SPEED and t[0] < rests < t[-1] - shortest:
            events.append(("REST", rests))
    return events


def half_swings(problem: Problem, states: FloatArray) -> int:
    """Return the number of swings of a body from one side to the other."""
    omega = states[:, 5][np.abs(states[:, 5]) > _LEAST_SPEED * problem.scales[5]]
    return int(np.count_nonzero(np.diff(np.sign(omega)))) + bool(omega.size)


def _starts(problem: Problem, t: FloatArray, states: FloatArray, kinds: Any) -> list[int]:
    """Return the first row of each run except the first run, and the number of rows."""
    scene, (_, _, theta, _, z_dot, omega) = problem.scene, states.T
    opening = z_dot - support_slope(theta, a=scene.a, b=scene.b) * omega
    pull = scene.gravity * math.cos(scene.slope)
    pushed = np.diff(z_dot) + pull * np.diff(t) > _LEAST_PUSH * problem.scales[3]
    divided = (np.diff(kinds) != 0) | (pushed & (opening[:-1] < 0) & (opening[1:] > 0))
    return [*(np.nonzero(divided)[0] + 1).tolist(), len(t)]


def _passing(t: FloatArray, values: FloatArray, level: float, start: int) -> float:
    """Return the last time at which values pass a level, up to row `start`."""
    sides = np.sign(values[: start + 1] - level)
    changes = np.nonzero(sides[1:] != sides[:-1])[0]
    if not changes.size:
        return float(t[start])
    k = changes[-1]
    share = (level - values[k]) / (values[k + 1] - values[k])
    return float(t[k] + share * (t[k + 1] - t[k]))


def gap_and_slip(problem: Problem, states: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the gap to the ground, and the slip that the body would have if it touched it."""
    _, z, theta, x_dot, _, omega = states.T
    height = support(theta, a=problem.scene.a, b=problem.scene.b)
    return z - height, x_dot - height * omega


def _touch(problem: Problem, t: float, state: FloatArray) -> float:
    """Return the time at which a free flight from a state close to the ground ends on it."""
    scene = problem.scene
    since = np.linspace(0.0, _SHORTEST * math.sqrt(problem.scales[0] / scene.gravity), 2001)
    height = state[1] + (state[4] - scene.gravity * math.cos(scene.slope) * since / 2) * since
    gap = height - support(state[2] + state[5] * since, a=scene.a, b=scene.b)
    return float(t + since[np.argmax(gap <= 0)])
