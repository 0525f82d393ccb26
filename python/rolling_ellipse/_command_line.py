"""The command line: its options, the scene that they describe, and the summary of a motion."""

from __future__ import annotations

import argparse
import json
import math
import re
import sys
import traceback
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import asdict
from importlib import import_module
from importlib.metadata import version
from pathlib import Path
from typing import Any, NoReturn

import numpy as np

from . import _core, benchmark, scenes
from ._ask.printing import text_table
from ._ask.scene import Impulse, Scene
from ._ask.settings import METHODS, MODELS
from ._ask.texts import LINKS
from ._ask.words import LANGUAGES
from ._core import Mode, Validity
from ._motion.trajectory import Trajectory
from ._verbs.certify import certify
from ._verbs.flow import period
from .benchmark._run import require_simulator
from .benchmark.adapters import ENGINES

SCENE_OPTIONS = {
    "a": "semi-axis parallel to the ground at theta = 0 [m]",
    "b": "the other semi-axis [m]",
    "mass": "mass [kg]",
    "theta": "angle at the start, clockwise [rad]",
    "omega": "angular velocity at the start [rad/s]; without --press there is then no blow",
    "friction": "coefficient of friction",
    "restitution": "coefficient of restitution",
    "rolling_resistance": "lever of the rolling resistance [m]",
    "slope": "angle of the ground [rad]",
    "gravity": "acceleration of gravity [m/s^2]",
    "inertia": "moment of inertia about the centre [kg m^2] (default: a uniform disc)",
}
_BASE = (
    "The scene is that of --scene or, by default, that of the report: a = 2 m, b = 1 m, 10 kg, "
    "pressed down by 48 N s at 1.5 m from its centre. The other options change it."
)
_ABOUT = str(benchmark.__doc__).partition("\n\nExamples")[0].replace("``", "")
_SCRIPT = "rolling-ellipse"
# argparse would treat -1e-3, -inf and -nan as unknown options
_NEGATIVE = re.compile(r"-(\d[\d_]*\.?[\d_]*|\.[\d_]+)(e[-+]?\d+)?$|-inf(inity)?$|-nan$", re.I)
_SHOWN_EVENTS = 10
_REPEATS = {"rocks": "full swing", "rolls_over": "full turn"}
PROGRAM = _SCRIPT if Path(sys.argv[0]).stem == _SCRIPT else "python -m rolling_ellipse"


class OneLineParser(argparse.ArgumentParser):
    """A parser that reports an error in one line."""

    def error(self, message: str) -> NoReturn:
        self.exit(2, f"{self.prog}: {' '.join(message.split())}\n")

    def print_help(self, file: Any = None) -> None:
        """Print with `print`, which raises if writing fails; argparse ignores such failures."""
        print(self.format_help(), end="", file=file)


def _scene_parser(prog: str, description: str, epilog: str | None = None) -> OneLineParser:
    parser = OneLineParser(
        prog=prog, description=f"{description} {_BASE}", epilog=epilog, allow_abbrev=False
    )
    parser._negative_number_matcher = _NEGATIVE
    parser.add_argument(
        "--scene", metavar="FILE|LINK|-",
        help="file with the JSON of Scene.to_json (- is standard input), or a link of the live "
        "page, whose time and blows are ignored",
    )  # fmt: skip
    for name, meaning in SCENE_OPTIONS.items():
        option = "--" + name.replace("_", "-")
        parser.add_argument(option, type=float, metavar="NUMBER", help=meaning)
    parser.add_argument(
        "--press", type=float, nargs=2, metavar=("F", "D"),
        help="replace the blow: press down by F [N s] at D [m] from the centre",
    )  # fmt: skip
    return parser


def motion_parser() -> OneLineParser:
    parser = _scene_parser(
        PROGRAM,
        "Simulate an ellipse on the ground and report what happens.",
        f"{PROGRAM} explore [options] writes a page to play with the scene in a browser; "
        f"{PROGRAM} benchmark tests other simulators; {PROGRAM} examples DIR writes notebooks.",
    )
    parser.add_argument("--time", type=float, default=6.0, metavar="S", help="end time (default 6)")
    for name, known, meaning in (
        ("model", MODELS, "model of motion"), ("method", METHODS, "numerical method")
    ):  # fmt: skip
        parser.add_argument(
            f"--{name}", type=str.casefold, choices=known, default="auto", help=meaning
        )
    parser.add_argument("--step", type=float, metavar="S", help="size of fixed steps [s]")
    parser.add_argument("--save", metavar="FILE", help="write an animation (.gif, .mp4, .html)")
    parser.add_argument("--plot", metavar="FILE", help="write the overview figure")
    parser.add_argument("--version", action="version", version=f"{_SCRIPT} {version(_SCRIPT)}")
    parser.add_argument("--json", action="store_true", help="print the summary as JSON")
    return parser


def explore_parser() -> OneLineParser:
    parser = _scene_parser(f"{PROGRAM} explore", "Play with a scene in a browser.")
    parser.add_argument("--time", type=float, metavar="S", help="time to follow motions for")
    parser.add_argument(
        "--language", type=str.casefold, choices=LANGUAGES, default="en", help="language"
    )
    parser.add_argument("--save", metavar="FILE", help="page to write (default: a temporary file)")
    parser.add_argument("--no-open", action="store_true", help="do not open the page in a browser")
    return parser


def examples_parser() -> OneLineParser:
    about = "Write the notebooks, without outputs, and the tables of reference states."
    parser = OneLineParser(prog=f"{PROGRAM} examples", description=about)
    parser.add_argument("folder", metavar="DIR", help="folder, created if it does not exist")
    return parser


def require_file(option: str, path: str) -> None:
    """Raise ValueError unless the path can be a file in an existing folder."""
    if Path(path).is_dir() or not Path(path).parent.is_dir():
        raise ValueError(f"{option} must name a file in an existing folder, got {path!r}")


def chosen_scene(options: argparse.Namespace) -> Scene:
    """Return the scene of --scene, or by default the report's, changed by the other options.

    The scene keeps its blow unless --press replaces it or --omega removes it.

    Raises
    ------
    ValueError
        If a number is out of its range, or the blow misses the body.
    """
    scene = _read_scene(options.scene) if options.scene is not None else scenes.report
    given: dict[str, Any] = {
        name: value for name in SCENE_OPTIONS if (value := getattr(options, name)) is not None
    }
    if options.press is not None:
        if options.press[0] < 0:
            raise ValueError(f"--press must have F >= 0, got {options.press[0]!r}: it would pull")
        given["impulse"] = Impulse.press(*options.press)
    elif options.omega is not None:
        given["impulse"] = None
    try:
        return scene.replace(**given) if given else scene
    except ValueError as error:
        if str(error).startswith("impulse") and options.press is None:
            raise ValueError(f"{error}: give --press F D, or --omega for no blow") from None
        raise


def _read_scene(given: str) -> Scene:
    """Return the scene of a link, of a file, or of standard input if the name is "-"."""
    if given == "-":
        return Scene.from_json(sys.stdin.read() if sys.stdin else "")
    return Scene.from_json(given if given.startswith(LINKS) else Path(given))


def benchmark_parser() -> OneLineParser:
    parser = OneLineParser(prog=f"{PROGRAM} benchmark", description=_ABOUT)
    actions = parser.add_subparsers(dest="action", required=True, parser_class=OneLineParser)
    actions.add_parser("list", help="print the problems and the abilities that they need")
    export = actions.add_parser("export", help="write problems and empty tables for results")
    export.add_argument("folder", metavar="DIR")
    score = actions.add_parser("score", help="score the tables of results in a folder")
    score.add_argument("folder", metavar="DIR")
    run = actions.add_parser("run", help="run an engine or your mine(problem, times, setting)")
    run.add_argument("mine", metavar="|".join((*ENGINES, "module:function")))
    run.add_argument(
        "--ladder", type=float, nargs="+", default=[None], metavar="SETTING",
        help="settings, such as steps [s], from coarse to fine (default: only None)",
    )  # fmt: skip
    for each in (score, run):
        each.add_argument("--json", action="store_true", help="print the scores as JSON")
        each.add_argument("--problem", nargs="+", metavar="ID", help="only these (default: all)")
        each.add_argument(
            "--tags", metavar="A,B", help="only problems that need no other abilities"
        )
    return parser


def act(options: argparse.Namespace) -> tuple[int, str]:
    """Run the requested action, and return the exit code (1 if an answer is wrong) and the text."""
    if options.action == "list":
        rows = [(one.id, one.question, ", ".join(one.tags)) for one in benchmark.problems()]
        return 0, text_table([("problem", "question", "needs"), *rows])
    if options.action == "export":
        return 0, f"written           {len(benchmark.export(options.folder))} files"
    chosen = {"problems": options.problem, "tags": options.tags}
    if options.action == "score":
        scores = benchmark.score(options.folder, **chosen)
    else:
        scores = _scores_of(options.mine, ladder=options.ladder, **chosen)
    text = repr(scores)
    if options.json:
        plain = json.dumps(scores.records())  # contains NaN, which JSON lacks
        text = json.dumps(json.loads(plain, parse_constant=lambda name: None), indent=2)
    return int(bool(scores.wrong)), text


def _scores_of(name: str, **chosen: Any) -> benchmark.Scores:
    """Score an engine or a user's function; an error is reported with the line that raised it."""
    mine = _function(name)

    def placed(problem: benchmark.Problem, times: Any, setting: Any) -> Any:
        try:
            return mine(problem, times, setting)
        except NotImplementedError:
            raise
        except Exception as error:
            hint = "" if setting is not None else ": without --ladder the setting is None"
            raise _failed(f"{name} on {problem.id}", error, hint) from error

    return benchmark.run(placed, **chosen)


def _function(name: str) -> Any:
    """Import an adapter, or a module:function, which may be in the current folder."""
    if name in ENGINES:
        try:
            return import_module(f"{benchmark.__name__}.adapters.{name}").simulate
        except ImportError as error:
            raise ImportError(f"{name} needs pip install {ENGINES[name]}: {error}") from error
    module, _, function = name.partition(":")
    if not (all(part.isidentifier() for part in module.split(".")) and function):
        raise ValueError(f"run must be {', '.join(ENGINES)} or module:function, got {name!r}")
    sys.path.insert(0, "")
    try:
        simulator = getattr(import_module(module), function, None)
    except ImportError:
        raise
    except Exception as error:
        raise _failed(module, error) from error
    if not callable(simulator):
        raise ValueError(f"run must name a function of {module}, got {function!r}")
    require_simulator("run", simulator)
    return simulator


def _failed(name: str, error: Exception, hint: str = "") -> RuntimeError:
    """Return an error whose one-sentence message gives the line that raised `error`."""
    last = traceback.extract_tb(error.__traceback__)[-1]
    place = f"line {last.lineno} of {Path(last.filename).name}"
    return RuntimeError(f"{name} raised {type(error).__name__} in {place}: {error}{hint}")


def summary(trajectory: Trajectory, files: Sequence[str]) -> dict[str, Any]:
    """Return named facts about a motion and the files written; a missing value is None."""
    scene = trajectory.scene
    certificate, start = certify(scene), scene.initial_state
    # the numbers of the certificate describe rolling and are omitted for other motions
    rolls = trajectory.model != "contact" or certificate.validity is Validity.VALID
    facts: dict[str, Any] = {
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
        resisted = scene.rolling_resistance > 0
        facts |= {
            "outcome": None if resisted else _core.outcome(scene.core).name.lower(),
            "period": _period(scene) if rolls else None,
            "distance": float(trajectory.x[-1] - trajectory.x[0]),
            "turns": float(trajectory.turns[-1]),
            "largest_position_residual": _largest(residuals.position[touching]),
            "largest_velocity_residual": _largest(residuals.velocity[rolling]),
            "largest_gap": _largest(residuals.gap[touching]),
            "largest_slip": _largest(residuals.slip[rolling]),
        }
    return facts


def _scene_facts(scene: Scene) -> dict[str, Any]:
    """Return the impulse and the fields that differ from the defaults.

    Infinite friction, which JSON lacks, is a default and is therefore left out.
    """
    facts = {name: value for name, value in asdict(scene).items() if name in scene._changed()}
    return facts | {"impulse": facts.get("impulse")}


def _largest(values: np.ndarray[Any, Any]) -> float:
    return float(np.max(np.abs(values), initial=0.0))


def _period(scene: Scene) -> float | None:
    with suppress(ValueError):  # a body that rolls downhill forever has no period
        return _finite(period(scene))
    return None


def _finite(value: float | None) -> float | None:
    return value if value is not None and math.isfinite(value) else None


def as_text(facts: dict[str, Any], trajectory: Trajectory) -> str:
    """Return the result of `summary` as a table of names and values."""
    scene = {name: value for name, value in trajectory.scene._rows()}
    start, blow = scene.pop("start"), scene.pop("impulse", "none")
    rows = [
        ("scene", ", ".join(f"{name} = {value}" for name, value in scene.items())),
        ("blow", blow),
        ("start", start),
        ("reason", facts["reason"]),
        ("status", f"{facts['status']}: {facts['message']}"),
    ]
    if "distance" in facts:
        rows += _motion_rows(facts, trajectory)
    rows += [("written", name) for name in facts["files"]]
    return "\n".join(f"{name:<17} {value}" for name, value in rows)


def _motion_rows(facts: dict[str, Any], trajectory: Trajectory) -> list[tuple[str, str]]:
    end = f"{trajectory.t[-1]:g} s, {facts['turns']:.6g} turns"
    rows = [_repeat(facts, trajectory), ("distance", f"{facts['distance']:.12g} m in {end}")]
    if facts["smallest_normal_force"] is not None:
        needed = facts["largest_friction_needed"]
        rows += [
            ("smallest N", f"{facts['smallest_normal_force']:.6g} N"),
            ("largest |F|/N", "unbounded" if needed is None else f"{needed:.6g}"),
        ]
    rows += [(kind, f"at {t:.9g} s") for t, kind in facts["events"][:_SHOWN_EVENTS]]
    if len(facts["events"]) > _SHOWN_EVENTS:
        rows.append(("…", f"and {len(facts['events']) - _SHOWN_EVENTS} more events"))
    residuals = (
        f"position {facts['largest_position_residual']:.2g}, velocity "
        f"{facts['largest_velocity_residual']:.2g}, gap {facts['largest_gap']:.2g} m, "
        f"slip {facts['largest_slip']:.2g} m/s"
    )
    return [*rows, ("residuals", residuals)]


def _repeat(facts: dict[str, Any], trajectory: Trajectory) -> tuple[str, str]:
    """Return the table row with the period of a motion, or with the reason why it has none."""
    if facts["period"] is not None:
        return _REPEATS.get(facts["outcome"], "swing or turn"), f"{facts['period']:.12g} s"
    name = "swing or turn"
    if trajectory.scene.rolling_resistance > 0:
        return name, "none: rolling resistance brings it to rest"
    if trajectory.model == "contact":
        return name, "none: it slides, leaves the ground or hits it"
    if facts["outcome"] == "rests":
        return name, "none: it rests"
    if trajectory.scene.slope != 0:
        return name, "none: it runs downhill for ever"
    return name, "none: it reaches the tip in infinite time"
