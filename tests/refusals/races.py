"""Refusals of comparisons of work and precision, and of their files."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import rolling_ellipse as rl
from rolling_ellipse import Scene, WorkPrecision, scenes

from refusals import Row

SCENE = Scene(2.0, 1.0, omega=1.0)
WRONG: Any = 1
QUICK: dict[str, Any] = {"tolerances": [1e-3], "steps": [0.1], "samples": 2, "rounds": 1}


def race(scene: Scene = SCENE, t_end: Any = 0.5, **options: Any) -> Callable[[Path], Any]:
    return lambda _: rl.work_precision(scene, t_end, **{**QUICK, "methods": "exact", **options})


class Peer:
    name = "peer"

    def __init__(self, run: Any = WRONG) -> None:
        self.run = run

    def prepare(self, scene: Any, t_end: float, setting: float) -> Any:
        return self.run


def result(ask: Callable[[WorkPrecision], Any]) -> Callable[[Path], Any]:
    return lambda _: ask(race()(Path()))


def raced(change: Callable[[Any], Any]) -> Callable[[Path], Any]:
    """Load a file of a race that was changed."""

    def call(folder: Path) -> Any:
        path = folder / "race.json"
        race()(folder).save(path)
        known = json.loads(path.read_text())
        change(known)
        path.write_text(json.dumps(known))
        return WorkPrecision.load(path)

    return call


def of_run(**facts: Any) -> Callable[[Path], Any]:
    return raced(lambda known: known["runs"][0].update(facts))


REFUSALS: list[Row] = [
    # requests
    *(("methods", race(methods=methods))
      for methods in (1, [1], ["x"], [], ["exact", "exact"])),
    ("name of a method", race(methods=[{"model": "rolling", "name": 1}])),
    *(("peers", race(peers=peers)) for peers in ([1], 1)),
    *(("reference", race(reference=reference)) for reference in (1, lambda times: (1.0, 2.0))),
    *(("tolerances", race(tolerances=tolerances)) for tolerances in ([], [-1.0])),
    ("t_end", race(t_end=[1.0, 0.5])),
    ("t_end", race(scenes.slip.replace(friction=5.0, theta=1.0), 5.0)),
    ("margin", result(lambda found: found.unbeaten(0.5))),
    ("x", result(lambda found: found.best(1.0, x="time"))),
    ("y", result(lambda found: found.best(1.0, y="x"))),
    ("t_end", result(lambda found: found.best(1.0, t_end=9.0))),
    ("at", result(lambda found: found.best(-1.0))),
    ("tags", result(lambda found: found.plot(tags="x"))),
    ("highlight", result(lambda found: found.plot(highlight=[]))),
    ("highlight", result(lambda found: found.plot(highlight=3))),  # type: ignore[arg-type]
    ("ax", result(lambda found: found.plot(by="library", ax=WRONG))),
    (KeyError, result(lambda found: found.runs[0].errors["x"])),
    # files
    ("path", raced(lambda known: known.update(schema=99))),
    ("path", raced(lambda known: known.update(runs=[]))),
    ("path", raced(lambda known: known.update(machine=1))),
    ("path", raced(lambda known: known["scene"].update(a=2))),
    ("path", raced(lambda known: known["references"][0].update(floor=-1.0))),
    *(("path", of_run(**{name: value})) for name, value in {
        "t_end": 9.0, "tags": 1, "time": "x", "steps": -1, "status": 1}.items()),
]  # fmt: skip
