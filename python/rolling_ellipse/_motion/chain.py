"""Derivatives of a motion with many events, computed part by part with the chain rule.

A part has a few events and starts in the middle of an arc, in the state of the motion at that time.
Let M be the derivatives of its final state with respect to its initial state, and P those with
respect to the parameters of the body. If S are the derivatives of the initial state, those of the
final state are M S + P. A small change at the start of a part must not alter the events of that
part, but may alter those of later parts. Hence derivatives exist even where changes grow by up to
1e13 over the whole motion.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from .._ask.check import FloatArray
from .._ask.scene import Scene
from .._core import EventKind, Mode
from .differences import at_shares, kinds_of, knots_of, neighbours, settings_of, size
from .inputs import BODY, STATE, size_of, units_of
from .samples import FREE, Pair
from .trajectory import Trajectory

EVENTS = 3  # number of events per part
# Shortest flight in which a part may end, in units of sqrt(L/g), with L = max(a, b). It rises to
# L/800, about a hundred times the steps that give differences with ten digits. A lower hop would
# need smaller steps.
_HOP = 0.1
# Bound on the relative difference between the derivatives along the computed arcs and the exact
# ones, in roundings times the growth of the motion. The largest difference in 120 motions with a
# growth of up to 4e12 was 42.
_ROUNDINGS = 64


class Chained(NamedTuple):
    """Derivatives with respect to k inputs, arranged as in `neighbours`, and their errors.

    `error` is the error of the derivatives along the computed arcs; `parted` estimates how far
    these are from the derivatives of the exact motion.
    """

    value: FloatArray  # (6, n + m, k)
    error: FloatArray  # (n + m, k)
    parted: FloatArray  # (n + m, k)


class Part(NamedTuple):
    motion: Trajectory  # sampled like the whole motion, and at its own end
    rows: FloatArray  # indices of the part's samples and events in the whole motion
    end: float  # time at which the part ends in the whole motion


def chained(motion: Trajectory, names: tuple[str, ...], side: int) -> Chained | None:
    """Return the derivatives with respect to several inputs, or None if some part has none."""
    rows = len(motion.t) + len(motion.events)
    whole = Chained(np.zeros((len(STATE), rows, len(names))), *np.zeros((2, rows, len(names))))
    start = np.zeros((len(STATE), len(names)))
    scales = [size_of(motion.scene, name) for name in names]
    growth = 1.0  # largest growth of a change of an input, or of the state after the first part
    # For each earlier part: the derivatives of the current state with respect to the final state
    # of that part, and the errors made in it
    since: list[tuple[FloatArray, FloatArray]] = []
    for index, (part, own, _) in enumerate(parts_of(motion, EVENTS)):
        last = len(part.t) - 1
        inputs = [name if index == 0 or name in BODY else None for name in names]
        try:
            value, error = _derivatives(part, inputs, side)
            step, step_error = by_state(part, free_of(part.scene) if index else ())
        except ValueError:
            return None
        value = value + np.einsum("crs,sk->crk", step, start)
        error = error + step_error @ np.abs(start)
        sizes = [size(value) * scales, *(np.abs(step @ change) for change, _ in since[:1])]
        growth = max(growth, *(float(each.max()) for each in sizes))
        passed = error.copy()
        for change, made in since:
            passed += size(np.abs(step @ change).sum(axis=-1))[:, None] * made
        kept = np.arange(len(error)) != last
        whole.value[:, own], whole.error[own] = value[:, kept], passed[kept]
        whole.parted[own] = _ROUNDINGS * np.finfo(float).eps * growth * size(whole.value[:, own])
        start = value[:, last]
        since = [(step[:, last] @ change, made) for change, made in since]
        since.append((np.eye(len(STATE)), error[last]))
    return whole


def free_of(scene: Scene) -> tuple[str, ...]:
    """Return the initial coordinates of a scene that its contact does not determine."""
    mode = (scene if scene.impulse is None else scene.replace(impulse=None)).initial_state.mode
    in_air = scene.z is not None
    return tuple(name for name in FREE[mode] if in_air or getattr(scene, name) is not None)


def by_state(part: Trajectory, free: Iterable[str]) -> Pair:
    """Return derivatives with respect to the initial state, (6, r, 6), and errors, (r, 6).

    Entries are 0 for coordinates that are not in `free`. All states are in natural units.
    """
    # The shape of an arc does not depend on x
    names = [name if name in free and name != "x" else None for name in STATE]
    value, error = _derivatives(part, names, 0)
    units = units_of(part.scene)
    value[0, : len(part.t), 0] = ("x" in free) / units[0]  # all x shift with the first one
    return value * units, error * units


def _derivatives(part: Trajectory, names: list[str | None], side: int) -> Pair:
    """Return derivatives with respect to k inputs, (6, r, k), and errors, (r, k).

    Both are 0 for an input of None. A ValueError gives the reason if a derivative does not exist.
    """
    rows = len(part.t) + len(part.events)
    value, error = np.zeros((len(STATE), rows, len(names))), np.zeros((rows, len(names)))
    for k, name in enumerate(names):
        if name is not None:
            best, problem = neighbours(part, name, side)
            if problem:
                raise ValueError(f"with respect to {name}, {problem}") from problem
            value[..., k], error[:, k] = best.value, best.error
    return value, error


def parts_of(motion: Trajectory, events: int) -> list[Part]:
    """Split a motion into parts of `events` events, or more if an arc cannot be cut.

    A part that does not reproduce its events is merged with a neighbouring part.
    """
    cuts = _cuts(motion, events)
    while True:
        parts = [_part(motion, *pair) for pair in pairwise(cuts)]
        known = [part for part in parts if part is not None]
        if len(known) == len(parts):
            return known
        del cuts[max(parts.index(None), 1)]


def _cuts(motion: Trajectory, events: int) -> list[int]:
    """Return the number of events before each cut: 0 for the start, and all for the end.

    The other cuts are in the middle of arcs.
    """
    cuts, spin = [0], float(units_of(motion.scene)[-1])
    for count, (before, after) in enumerate(pairwise(motion.events), 1):
        mode = before.state_after.mode
        # A flight that does not end with an impact stands for a sum of many bounces
        plain = mode is not Mode.REST and (
            mode is not Mode.FLIGHT
            or (after.kind is EventKind.IMPACT and (after.t - before.t) * spin > _HOP)
        )
        if plain and count - cuts[-1] >= events:
            cuts.append(count)
    return [*cuts, len(motion.events)]


def _part(motion: Trajectory, first: int, last: int) -> Part | None:
    """Return the part between two cuts, given as event counts, or None if its events differ from
    those of the motion."""
    knots, whole = knots_of(motion), last == len(motion.events)
    start = float(knots[first : first + 2].mean()) if first else 0.0
    end = motion.t_end if whole else float(knots[last : last + 2].mean())
    inside = (motion.t >= start) & ((motion.t < end) | whole)
    scene = motion.scene_at(start) if first else motion.scene
    blows = tuple((t - start, blow) for t, blow in motion.blows if start <= t <= end)
    how = replace(settings_of(motion), blows=blows)
    part = Trajectory.computed(scene, how, np.array([end - start]))
    if kinds_of(part.events) != kinds_of(motion.events[first:last]):
        return None
    between = np.array([start, *knots[first + 1 : last + 1], end])
    times = at_shares(motion.t[inside], between, knots_of(part))
    rows = [*np.flatnonzero(inside), *(len(motion.t) + np.arange(first, last))]
    return Part(part.sol(np.append(times, part.t_end)), np.array(rows), end)
