"""Summary of a motion, as numbers and in lines."""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import asdict
from typing import Any

import numpy as np

from ... import _core
from ..._ask.scene import Scene
from ..._core import Mode, Validity
from ..._motion.trajectory import Trajectory
from ..._verbs.certify import certify
from ..._verbs.flow import period

_SHOWN_EVENTS = 10
_REPEATS = {"rocks": "full swing", "rolls_over": "full turn"}


def summary(trajectory: Trajectory, files: Sequence[str]) -> dict[str, Any]:
    """Return the facts of a motion and the files written, by name; None for missing values."""
    scene = trajectory.scene
    certificate, start = certify(scene), scene.initial_state
    # the numbers of the certificate are about rolling: for other motions they are left out
    rolls = trajectory.model != "contact" or certificate.validity is Validity.VALID
    found: dict[str, Any] = {
        "scene": _scene_facts(scene),
        "start": {"mode": start.mode.name.lower(), "omega": start.omega, "reason": start.reason},
        "model": trajectory.model,
        "method": trajectory.method,
        "status": trajectory.status.name,
        "message": trajectory.message,
        "reason": trajectory.reason,
        "valid_until": _finite(trajectory.valid_until),
        "smallest_normal_force": certificate.smallest_normal_force if rolls else None,
        "largest_friction_needed": _finite(certificate.largest_friction_needed if rolls else None),
        "events": [[event.t, event.kind.name.lower()] for event in trajectory.events],
        "files": list(files),
    }
    if trajectory.t.size:
        residuals = trajectory.constraint_residuals()
        touching, rolling = trajectory.mode != Mode.FLIGHT, trajectory.mode == Mode.ROLLING
        found |= {
            "outcome": _core.outcome(scene.core).name.lower(),
            "period": _period(scene) if rolls else None,
            "distance": float(trajectory.x[-1] - trajectory.x[0]),
            "turns": float(trajectory.turns[-1]),
            "largest_position_residual": _largest(residuals.position[touching]),
            "largest_velocity_residual": _largest(residuals.velocity[rolling]),
            "largest_gap": _largest(residuals.gap[touching]),
            "largest_slip": _largest(residuals.slip[rolling]),
        }
    return found


def _scene_facts(scene: Scene) -> dict[str, Any]:
    """Return the changed fields of a scene: JSON has no infinite friction, which is the default."""
    facts = {name: value for name, value in asdict(scene).items() if name in scene._changed()}
    return facts | {"impulse": facts.get("impulse")}


def _largest(values: np.ndarray[Any, Any]) -> float:
    return float(np.max(np.abs(values), initial=0.0))


def _period(scene: Scene) -> float | None:
    with suppress(ValueError):  # a body that rolls downhill for ever has no period
        return _finite(period(scene))
    return None


def _finite(value: float | None) -> float | None:
    return value if value is not None and math.isfinite(value) else None


def lines(found: dict[str, Any], trajectory: Trajectory) -> list[str]:
    """Return the result of `summary` as lines of text."""
    scene = {name: value for name, value in trajectory.scene._rows()}
    start, blow = scene.pop("start"), scene.pop("impulse", "none")
    rows = [
        ("scene", ", ".join(f"{name} = {value}" for name, value in scene.items())),
        ("blow", blow),
        ("start", start),
        ("reason", found["reason"]),
        ("status", f"{found['status']}: {found['message']}"),
    ]
    if "distance" in found:
        rows += _motion_rows(found, trajectory)
    rows += [("written", name) for name in found["files"]]
    return [f"{name:<17} {value}" for name, value in rows]


def _motion_rows(found: dict[str, Any], trajectory: Trajectory) -> list[tuple[str, str]]:
    end = f"{trajectory.t[-1]:g} s, {found['turns']:.6g} turns"
    rows = [_repeat(found, trajectory), ("distance", f"{found['distance']:.12g} m in {end}")]
    if found["smallest_normal_force"] is not None:
        needed = found["largest_friction_needed"]
        rows += [
            ("smallest N", f"{found['smallest_normal_force']:.6g} N"),
            ("largest |F|/N", "unbounded" if needed is None else f"{needed:.6g}"),
        ]
    rows += [(kind, f"at {t:.9g} s") for t, kind in found["events"][:_SHOWN_EVENTS]]
    if len(found["events"]) > _SHOWN_EVENTS:
        rows.append(("…", f"and {len(found['events']) - _SHOWN_EVENTS} events more"))
    residuals = (
        f"position {found['largest_position_residual']:.2g}, velocity "
        f"{found['largest_velocity_residual']:.2g}, gap {found['largest_gap']:.2g} m, "
        f"slip {found['largest_slip']:.2g} m/s"
    )
    return [*rows, ("residuals", residuals)]


def _repeat(found: dict[str, Any], trajectory: Trajectory) -> tuple[str, str]:
    """Return the row with the time after which a motion repeats, or with why it never does."""
    if found["period"] is not None:
        return _REPEATS.get(found["outcome"], "swing or turn"), f"{found['period']:.12g} s"
    name = "swing or turn"
    if trajectory.model == "contact":
        return name, "none: it slides, leaves the ground or hits it"
    if found["outcome"] == "rests":
        return name, "none: it rests"
    if trajectory.scene.slope != 0:
        return name, "none: it runs downhill for ever"
    return name, "none: it reaches the tip in infinite time"
