"""Simulate one scene and say what happens: python -m rolling_ellipse --help."""

from __future__ import annotations

import argparse
import json
import math
import sys
import warnings
from pathlib import Path
from typing import Any, NoReturn

import numpy as np

from . import Mode, Scene, Trajectory, certify, period, scenes, simulate
from ._atomic import replacing
from .animation import animate

_SCENE_OPTIONS = {
    "a": "semi-axis parallel to the ground at theta = 0 [m]",
    "b": "the other semi-axis [m]",
    "mass": "mass [kg]",
    "theta": "angle at the start, clockwise [rad]",
    "omega": "angular velocity at the start [rad/s]",
    "friction": "coefficient of friction",
    "restitution": "coefficient of restitution",
    "slope": "angle of the ground [rad]",
}

_SHOWN_EVENTS = 10


class OneLineParser(argparse.ArgumentParser):
    """Says what is wrong in one line; --help has the rest."""

    def error(self, message: str) -> NoReturn:
        self.exit(2, f"{self.prog}: {message}\n")


def parser() -> argparse.ArgumentParser:
    """Return the command line."""
    found = OneLineParser(
        prog="python -m rolling_ellipse",
        description="An ellipse rolling on the ground. Without scene options: the report's scene, "
        "a = 2 m, b = 1 m, 10 kg, pressed down by 48 N s at 1.5 m from its centre.",
    )
    for name, meaning in _SCENE_OPTIONS.items():
        found.add_argument(f"--{name}", type=float, metavar="NUMBER", help=meaning)
    found.add_argument("--time", type=float, default=6.0, metavar="S", help="end time (default 6)")
    found.add_argument("--save", metavar="FILE", help="write an animation (.gif, .mp4, .html)")
    found.add_argument("--plot", metavar="FILE", help="write the overview figure")
    found.add_argument("--json", action="store_true", help="print the summary as JSON")
    return found


def chosen_scene(options: argparse.Namespace) -> Scene:
    """Return the report's scene, or the one that the options make (without an impulse)."""
    given = {
        name: value for name in _SCENE_OPTIONS if (value := getattr(options, name)) is not None
    }
    if not given:
        return scenes.report
    return Scene(given.pop("a", scenes.report.a), given.pop("b", scenes.report.b), **given)


def summary(trajectory: Trajectory) -> dict[str, Any]:
    """Return what a reader wants to know first; None for what does not exist."""
    scene = trajectory.scene
    certificate = certify(scene)
    proved = trajectory.model != "contact"  # what the certificate says is said of rolling
    found: dict[str, Any] = {
        "status": trajectory.status.name,
        "message": trajectory.message,
        "reason": trajectory.reason,
        "valid_until": _finite(trajectory.valid_until),
        "smallest_normal_force": certificate.smallest_normal_force if proved else None,
        "largest_friction_needed": _finite(certificate.largest_friction_needed if proved else None),
        "events": [[event.t, event.kind.name.lower()] for event in trajectory.events],
    }
    if trajectory.t.size:
        residuals = trajectory.constraint_residuals()
        touching, rolling = trajectory.mode != Mode.FLIGHT, trajectory.mode == Mode.ROLLING
        found |= {
            "period": _finite(period(scene)) if proved and scene.slope == 0 else None,
            "distance": float(trajectory.x[-1] - trajectory.x[0]),
            "turns": float(trajectory.turns[-1]),
            "largest_position_residual": _largest(residuals.position[touching]),
            "largest_velocity_residual": _largest(residuals.velocity[rolling]),
            "largest_gap": _largest(residuals.gap[touching]),
            "largest_slip": _largest(residuals.slip[rolling]),
        }
    return found


def _largest(values: np.ndarray[Any, Any]) -> float:
    return float(np.max(np.abs(values), initial=0.0))


def _finite(value: float | None) -> float | None:
    return value if value is not None and math.isfinite(value) else None


def _lines(found: dict[str, Any], t_end: float) -> list[str]:
    lines = [found["reason"], f"status            {found['status']}: {found['message']}"]
    if "distance" in found:
        swing = "never" if found["period"] is None else f"{found['period']:.12g} s"
        lines += [
            f"swing or turn     {swing}",
            f"distance          {found['distance']:.12g} m in {t_end:g} s, "
            f"{found['turns']:.6g} turns",
        ]
        if found["smallest_normal_force"] is not None:
            needed = found["largest_friction_needed"]
            lines += [
                f"smallest N        {found['smallest_normal_force']:.6g} N",
                f"largest |F|/N     {'unbounded' if needed is None else format(needed, '.6g')}",
            ]
        lines += [f"{kind:<17} at {t:.9g} s" for t, kind in found["events"][:_SHOWN_EVENTS]]
        if len(found["events"]) > _SHOWN_EVENTS:
            lines.append(f"… and {len(found['events']) - _SHOWN_EVENTS} events more")
        lines += [
            f"residuals         position {found['largest_position_residual']:.2g}, velocity "
            f"{found['largest_velocity_residual']:.2g}, gap {found['largest_gap']:.2g} m, "
            f"slip {found['largest_slip']:.2g} m/s",
        ]
    return lines


def _draw(trajectory: Trajectory, path: str) -> None:
    kind = Path(path).suffix[1:]
    with replacing(path if kind else f"{path}.png") as new:
        trajectory.plot().figure.savefig(new, format=kind or "png")


def _check_options(options: argparse.Namespace) -> None:
    if not 0 <= options.time < math.inf:
        raise ValueError(f"--time must be a finite time >= 0 [s], got {options.time!r}")
    for name in ("save", "plot"):
        path = getattr(options, name)
        if path is not None and not Path(path).parent.is_dir():
            raise ValueError(f"--{name} must name a file in an existing folder, got {path!r}")


def main(arguments: list[str] | None = None) -> int:
    """Run the command line; 0 on success, 2 (and one line) on bad input."""
    options = parser().parse_args(arguments)
    try:
        _check_options(options)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # the summary says it
            trajectory = simulate(chosen_scene(options), options.time)
            found = summary(trajectory)
            if options.plot:
                _draw(trajectory, options.plot)
            if options.save:
                animate(trajectory, options.save)
    except (ValueError, OSError) as error:
        print(f"{parser().prog}: {error}", file=sys.stderr)
        return 2
    print(json.dumps(found, indent=2) if options.json else "\n".join(_lines(found, options.time)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
