"""Simulate one scene and say what happens: python -m rolling_ellipse --help."""

from __future__ import annotations

import argparse
import json
import logging
import math
import os
import re
import sys
import warnings
from contextlib import suppress
from pathlib import Path
from typing import Any, NoReturn

import numpy as np
from matplotlib import rcParams

from . import Mode, Scene, Status, Trajectory, certify, period, scenes, simulate
from ._export.atomic import replacing
from ._pictures.animation import animate
from ._pictures.animation.movies import movie_writer

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
_FPS = 25.0  # of the animation
_FOLLOWED = (Status.COMPLETED, Status.JAMMED, Status.VALIDITY_LOST)
_INTERRUPTED, _BROKEN_PIPE = 130, 141  # as shells say it of programs ended by SIGINT and SIGPIPE


class OneLineParser(argparse.ArgumentParser):
    """Says what is wrong in one line; --help has the rest."""

    def error(self, message: str) -> NoReturn:
        self.exit(2, f"{self.prog}: {message}\n")

    def print_help(self, file: Any = None) -> None:
        """Without argparse's silence where nothing can be written."""
        print(self.format_help(), end="", file=file)


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


def joined(arguments: list[str]) -> list[str]:
    """Join an option and its negative number by "=": argparse takes -1e-3 for another option."""
    found: list[str] = []
    for argument in arguments:
        last = found[-1] if found else ""
        if argument.startswith("-") and _is_number(argument) and re.match("--[a-z]+$", last):
            found[-1] += f"={argument}"
        else:
            found.append(argument)
    return found


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


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


def _lines(found: dict[str, Any], trajectory: Trajectory) -> list[str]:
    lines = [found["reason"], f"status            {found['status']}: {found['message']}"]
    if "distance" in found:
        swing = "never" if found["period"] is None else f"{found['period']:.12g} s"
        lines += [
            f"swing or turn     {swing}",
            f"distance          {found['distance']:.12g} m in {trajectory.t[-1]:g} s, "
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


def _check_options(options: argparse.Namespace) -> None:
    if not 0 <= options.time < math.inf:
        raise ValueError(f"--time must be a finite time >= 0 [s], got {options.time!r}")
    for name in ("save", "plot"):
        path = getattr(options, name)
        if path is not None and (Path(path).is_dir() or not Path(path).parent.is_dir()):
            raise ValueError(f"--{name} must name a file in an existing folder, got {path!r}")
    if options.save is not None:
        movie_writer(options.save, _FPS, "--save")  # a wrong one is refused before any work


def _write_figure(trajectory: Trajectory, path: str) -> None:
    if not Path(path).suffix:
        path += "." + rcParams["savefig.format"]  # as matplotlib does
    with replacing(path) as new:
        trajectory.plot().figure.savefig(new, format=Path(path).suffix[1:])


def main(arguments: list[str] | None = None) -> int:
    """Run the command line.

    Returns
    -------
    int
        0 on success; 1 if the motion could not be followed to its end, the summary is of what
        there is; 2 (and one line) on bad input, or where a file cannot be written.
    """
    options = parser().parse_args(joined(sys.argv[1:] if arguments is None else arguments))
    try:
        _check_options(options)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # the summary says it
            trajectory = simulate(chosen_scene(options), options.time, raise_on_failure=False)
            found = summary(trajectory)
            if options.plot is not None:
                _write_figure(trajectory, options.plot)
            if options.save is not None:
                animate(trajectory, options.save, fps=_FPS)
    except (ValueError, OSError, ImportError, RuntimeError) as error:
        _complain(error)
        return 2
    lines = [json.dumps(found, indent=2)] if options.json else _lines(found, trajectory)
    print("\n".join(lines))
    return 0 if trajectory.status in _FOLLOWED else 1


def _complain(error: Exception) -> None:
    if sys.stderr is not None:  # print would take stdout
        print(f"{parser().prog}: {' '.join(str(error).split())}", file=sys.stderr)


def run() -> int:
    """Run the command line for a shell, where readers leave, disks are full and Ctrl-C is typed."""
    logging.getLogger("matplotlib").setLevel(logging.ERROR)  # errors are told in one line
    try:
        try:
            return main()
        finally:  # argparse leaves by SystemExit
            if sys.stdout is not None:
                sys.stdout.flush()
    except KeyboardInterrupt:
        code = _INTERRUPTED
    except BrokenPipeError:
        code = _BROKEN_PIPE
    except OSError as error:
        code = 2
        with suppress(OSError):
            _complain(error)
    nowhere = os.open(os.devnull, os.O_WRONLY)
    for stream in (sys.stdout, sys.stderr):
        if stream is not None:  # Python flushes once more at its end, and would complain
            os.dup2(nowhere, stream.fileno())
    return code


if __name__ == "__main__":
    sys.exit(run())
