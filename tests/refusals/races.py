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


def damaged(road: str, value: Any) -> Callable[[Path], Any]:
    """Load a race from a file with one value of its text replaced."""

    def change(text: str) -> str:
        known = part = json.loads(text)
        *steps, last = (int(step) if step.isdigit() else step for step in road.split("."))
        for step in steps:
            part = part[step]
        part[last] = value
        return json.dumps(known)

    return changed(change)


def changed(change: Callable[..., str]) -> Callable[[Path], Any]:
    """Load a race from a file whose text is changed."""

    def call(folder: Path) -> Any:
        path = folder / "race.json"
        race()(folder).save(path)
        path.write_text(change(path.read_text(encoding="utf-8")), encoding="utf-8")
        return WorkPrecision.load(path)

    return call


DAMAGED: list[tuple[str, Any]] = [
    ("schema", 1), ("schema", 99), ("runs", []), ("runs", {}), ("references", []),
    ("references.0.floor", -1.0), *(("runs.0.time", wrong) for wrong in ("soon", 1, "1.0")),
    ("runs.0.steps", -1), ("runs.0.steps", 1.5), ("runs.0.name", 3), ("runs.0.tags", "own"),
    ("runs.0.status", 1), ("runs.0.errors", None), ("runs.0.errors.median", 1.0),
    ("runs.0.colour", "red"), ("runs.0.t_end", 3.0), ("scene", None),
    *(("scene.a", wrong) for wrong in (-1.0, "2.0", 2)), ("machine", []), ("machine", 1),
    ("machine.rounds", 20), ("more", 1),
]  # fmt: skip

TEXTS = ("", "{", "[]", "3", '"race"', "{}", "\ufeff{}", '{"a":1,"a":2}')

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
    *(("path", damaged(*each)) for each in DAMAGED),
    *(("path", changed(lambda _, text=text: text)) for text in TEXTS),
    *(("path", changed(lambda text, k=k: text[: k * len(text) // 20])) for k in range(20)),
]  # fmt: skip
