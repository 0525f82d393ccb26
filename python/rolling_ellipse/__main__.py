"""The command line; see python -m rolling_ellipse --help."""

from __future__ import annotations

import argparse
import json
import logging
import os
import sys
import tempfile
import warnings
import webbrowser
from contextlib import suppress
from pathlib import Path

from . import StabilityWarning, Status, examples, simulate
from . import _command_line as shell
from ._ask.printing import printable
from ._pictures.animation.movies import film_suffix
from ._pictures.axes import save_figure
from ._player import animate, explore

_FPS = 25.0  # a frame rate that every film format supports
_FOLLOWED = (Status.COMPLETED, Status.JAMMED, Status.VALIDITY_LOST)
# Names of arguments with which error messages start, and the options that replace them
_OPTIONS = {"step": "--step", "t": "--time", "t_end": "--time", "source": "--scene",
            "path": "--save"}  # fmt: skip
_INTERRUPTED, _BROKEN_PIPE = 130, 141  # exit codes that shells report after SIGINT and SIGPIPE


def main(arguments: list[str] | None = None) -> int:
    """Run the command line.

    Returns
    -------
    int
        0 on success; 1 if the motion could not be followed to its end (the summary then covers the
        computed part), or `benchmark` finds a wrong answer; 2, with a one-line message, on bad
        input or if a file cannot be written. A StabilityWarning, or a warning that blows are
        omitted, is also printed as one line.
    """
    typed = sys.argv[1:] if arguments is None else arguments
    commands = {
        "explore": (shell.explore_parser, _page),
        "benchmark": (shell.benchmark_parser, shell.act),
        "examples": (shell.examples_parser, _examples),
    }
    command = typed[0] if typed and typed[0] in commands else ""
    parser, action = commands.get(command, (shell.motion_parser, _motion))
    options = parser().parse_args(typed[bool(command) :])
    try:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("ignore")  # the summary says how long the model is valid
            warnings.simplefilter("always", StabilityWarning)
            warnings.filterwarnings("always", "a scene has no blows")  # of links
            code, message = action(options)
    except (ValueError, TypeError, OSError, ImportError, RuntimeError, MemoryError) as error:
        _complain(error)
        return 2
    print(printable(message))
    for warning in caught:
        _complain(warning.message)
    return code


def _motion(options: argparse.Namespace) -> tuple[int, str]:
    """Simulate, write the files, and return the exit code and the summary."""
    for name in ("save", "plot"):
        if (path := getattr(options, name)) is not None:
            shell.require_file(f"--{name}", path)
    if options.save is not None:
        film_suffix(options.save, _FPS, "--save")  # reject a bad file name before simulating
    how = {name: getattr(options, name) for name in ("model", "method", "step")}
    trajectory = simulate(shell.chosen_scene(options), options.time, **how, raise_on_failure=False)
    files = []
    if options.plot is not None:
        files.append(save_figure(trajectory.plot().figure, options.plot))
    if options.save is not None:
        animate(trajectory, options.save)
        files.append(options.save)
    facts = shell.summary(trajectory, files)
    text = json.dumps(facts, indent=2) if options.json else shell.as_text(facts, trajectory)
    return 0 if trajectory.status in _FOLLOWED else 1, text


def _page(options: argparse.Namespace) -> tuple[int, str]:
    """Write the page of `explore` and open it unless --no-open is given; return 0 and a message."""
    explorer = explore(shell.chosen_scene(options), t_end=options.time, language=options.language)
    path = options.save
    if path is None:
        path = os.path.join(tempfile.mkdtemp(prefix="rolling_ellipse_"), "explore.html")
    shell.require_file("--save", path)
    explorer.save(path)
    message = f"written           {path}"
    if not options.no_open and not webbrowser.open(Path(path).resolve().as_uri()):
        message += "\nno browser was found: open the file in a browser"
    return 0, message


def _examples(options: argparse.Namespace) -> tuple[int, str]:
    """Write the notebooks and the tables, and return 0 and a message."""
    return 0, f"written           {len(examples(options.folder))} files"


def _complain(error: Exception | Warning | str) -> None:
    if sys.stderr is not None:  # print(file=None) would write to stdout
        first, *others = printable(str(error)).split() or [type(error).__name__]
        print(f"{shell.PROGRAM}:", _OPTIONS.get(first, first), *others, file=sys.stderr)


def run() -> int:
    """Run the command line for a shell, with exit codes for Ctrl-C, closed pipes and full disks."""
    logging.getLogger("matplotlib").setLevel(logging.ERROR)  # no warnings on stderr
    try:
        try:
            return main()
        finally:  # argparse exits through SystemExit
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
        if stream is not None:  # Python flushes the stream again at exit, which would fail
            os.dup2(nowhere, stream.fileno())
    return code


if __name__ == "__main__":
    sys.exit(run())
