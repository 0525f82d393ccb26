"""Write the live page, which contains the core: python docs/makers/live.py [page.html]

It is the page of `explore(scenes.report)` with sliders for the scene, the blow and the end time, a
map of half turns, and the energies; docs/live has the sources of these parts. The page needs no
other file and no network.
"""

import json
import math
import sys
from pathlib import Path
from typing import Any

from rolling_ellipse import Explorer, Scene, explore, geometry, scenes
from rolling_ellipse._ask.words import LANGUAGES
from rolling_ellipse._player.blows import axes
from rolling_ellipse._player.page import document, escaped, with_player, words

FOLDER = Path(__file__).resolve().parents[1] / "live"


def write(target: Path) -> None:
    target.write_text(page(explore(scenes.report)), encoding="utf-8")


def page(explorer: Explorer) -> str:
    """Return the page for the scene of an explorer, including its blow."""
    given = numbers(explorer)
    languages = {name: language(name) for name in LANGUAGES}
    usual = Scene(given["a"], given["b"])
    data = {
        "given": given,
        "inputs": inputs(explorer, given),
        "size": max(given["a"], given["b"]),
        "languages": languages,
        "usual": {name: getattr(usual, name) for name in ("mass", "gravity", "slope",
                  "restitution", "rolling_resistance", "theta", "omega", "x")},
    }  # fmt: skip
    style = (FOLDER / "page.css").read_text(encoding="utf-8")
    module = (FOLDER / "page.js").read_text(encoding="utf-8")
    content = explorer._fragment("Workbench", module, page=data, style=style)
    return document(languages["en"]["words"]["live_title"], content)


def numbers(explorer: Explorer) -> dict[str, Any]:
    """Return the numbers that a user can change or a link can contain; inf is None."""
    scene, start = explorer.scene, explorer.scene.replace(impulse=None).initial_state
    height = geometry.support(scene.theta, a=scene.a, b=scene.b)
    flies = start.z > height
    rolling = 0.0 if flies else height * start.omega
    blow = scene.impulse
    given = {name: getattr(blow, name) if blow else 0.0 for name in ("jx", "jz", "dx", "dz")}
    given |= {name: getattr(scene, name) for name in (
        "a", "b", "mass", "gravity", "slope", "restitution", "rolling_resistance", "theta",
        "omega", "x")}  # fmt: skip
    return given | {
        "friction": scene.friction if scene.friction < math.inf else None,
        "k": 4 * scene.gyration2 / (scene.a**2 + scene.b**2) if scene.inertia else 1.0,
        "height": start.z - height if flies else 0.0,
        "slip": 0.0 if scene.x_dot is None else start.x_dot - rolling,
        "z_dot": scene.z_dot if flies else None,
        "t": explorer.t_end,
    }


def inputs(explorer: Explorer, given: dict[str, Any]) -> list[dict[str, Any]]:
    """Return group, name, unit, range and step of each slider, scaled to the body's size."""
    size = max(given["a"], given["b"])
    rate = math.sqrt(given["gravity"] / size)
    _, strength = axes(explorer.scene)
    blow = strength["most"]
    rows = [
        ("body", "a", "m", 0.1 * size, 1.5 * size), ("body", "b", "m", 0.1 * size, 1.5 * size),
        ("body", "k", "", 0.1, 2.0), ("ground", "slope", "rad", -0.6, 0.6),
        ("ground", "friction", "", 0.0, 2.0), ("ground", "restitution", "", 0.0, 1.0),
        ("ground", "rolling_resistance", "m", 0.0, 0.1 * size),
        ("start", "theta", "rad", -3.2, 3.2), ("start", "omega", "rad/s", -4 * rate, 4 * rate),
        ("start", "height", "m", 0.0, 2 * size),
        ("start", "slip", "m/s", -2 * rate * size, 2 * rate * size),
        ("blow", "jx", "N s", -blow, blow), ("blow", "jz", "N s", -blow, blow),
        ("blow", "dx", "m", -size, size), ("blow", "dz", "m", -size, size),
        ("film", "t", "s", 1 / rate, 40 / rate),
    ]  # fmt: skip
    return [row(*each) for each in rows]


def row(group: str, name: str, unit: str, least: float, most: float) -> dict[str, Any]:
    """Return a slider of about 100 steps; the step is 1, 2 or 5 times a power of ten."""
    rough = (most - least) / 100
    power = 10.0 ** math.floor(math.log10(rough))
    step = power * min((1, 2, 5), key=lambda n: abs(n * power - rough))
    ends = [float(f"{step * round(end / step):.6g}") for end in (least, most)]
    return {"group": group, "name": name, "unit": unit, "least": max(ends[0], -abs(ends[0])),
            "most": ends[1], "step": float(f"{step:.6g}")}  # fmt: skip


def language(name: str) -> dict[str, Any]:
    """Return the words and the markup of the page in a language."""
    own = json.loads((FOLDER / f"words_{name}.json").read_text(encoding="utf-8"))
    known = words(name) | own
    html = (FOLDER / "page.html").read_text(encoding="utf-8")
    kept = escaped(known) | {"player": "{player}"}
    return {"words": known, "markup": with_player(html.format_map(kept), known)}


if __name__ == "__main__":
    write(Path(sys.argv[1]) if len(sys.argv) > 1 else FOLDER / "index.html")
