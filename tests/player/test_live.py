"""The WebAssembly core agrees with the extension, in node and in the pages that use it."""

import gzip
import json
import math
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any
from urllib.parse import parse_qsl

import numpy as np
import pytest
import rolling_ellipse as rl
from oracles.contact import random_scenes
from oracles.paths import ROOT, TESTS, made_by
from rolling_ellipse import _core
from rolling_ellipse._ask.settings import DEFAULTS
from rolling_ellipse._player import blows, explorer
from rolling_ellipse._player.page import packaged

Opened = Callable[..., Any]
WASM = Path(blows.__file__).with_name("live.wasm.gz")
NODE, EMCC = shutil.which("node"), shutil.which("em++")
PLAYER = "document.querySelector('.rolling-ellipse').player"
ENERGIES = {"kinetic": "kinetic_energy", "potential": "potential_energy"}
DRIVER = """
import { readFileSync } from "node:fs";
import { gunzipSync } from "node:zlib";
const core = await Core.of(gunzipSync(readFileSync(process.argv[2])));
console.log(JSON.stringify(JSON.parse(readFileSync(0, "utf8")).map(({ scene, times }) => {
  scene.friction ??= Infinity;
  const found = core.ask(scene, times.at(-1));
  let alone;
  try { alone = core.first(scene, times.at(-1)); } catch ({ message }) { alone = message; }
  return { ...found, alone, columns: core.samples(times) };
})));
"""


def in_node(motions: list[rl.Trajectory], folder: Path) -> list[dict[str, Any]]:
    """Answers of the WebAssembly core for the scenes, blows and times of the motions."""
    if NODE is None:
        pytest.skip("there is no node (apt-get install nodejs)")
    (folder / "core.mjs").write_text(packaged("core.js") + DRIVER, encoding="utf-8")
    asked = [
        {
            "scene": blows.numbers(motion.scene)
            | {"blows": [[t, *vars(blow).values()] for t, blow in motion.blows]},
            "times": motion.t.tolist(),
        }
        for motion in motions
    ]
    command = [NODE, str(folder / "core.mjs"), str(WASM)]
    printed = subprocess.check_output(command, input=json.dumps(asked), text=True)
    found: list[dict[str, Any]] = json.loads(printed)
    return found


def require_equal(motion: rl.Trajectory, found: dict[str, Any]) -> None:
    """Check samples and events of the WebAssembly core against those of a motion."""
    for name, values in found["columns"].items():
        true = getattr(motion, ENERGIES.get(name, name))
        size = max(float(np.abs(true).max()), 1e-3)
        worst = np.abs(np.array([*values.values()]) - true).max()
        assert worst <= 1e-10 * size, (motion.scene, name)
    kinds = [event.kind.name.lower().replace("_", " ") for event in motion.events]
    assert [kind for _, kind, _ in found["events"]] == kinds
    times = [event.t for event in motion.events]
    assert [t for t, *_ in found["events"]] == pytest.approx(times, rel=1e-10)


def test_webassembly_agrees_with_python_on_300_scenes(tmp_path: Path) -> None:
    """The bounds allow for the rounding errors of another C library, which bounces magnify."""
    how, times = replace(DEFAULTS, max_steps=20_000, max_events=200), np.linspace(0.0, 1.5, 31)
    scenes = [*random_scenes(220, 35), *random_scenes(60, 36, struck=1.0)]
    scenes += [
        each.replace(rolling_resistance=min(each.a, each.b) / 5) for each in random_scenes(20, 37)
    ]
    motions = [rl.Trajectory.computed(scene, how, times) for scene in scenes]
    kinds, keys = set(), set()
    for motion, found in zip(motions, in_node(motions, tmp_path), strict=True):
        require_equal(motion, found)
        kinds |= {kind for _, kind, _ in found["events"]}
        first, headline, reasons = _core.describe(motion.scene.core, motion._solution)
        assert found["first"] == ("IN_THE_AIR" if first is None else first.name)
        refused = "rolling_resistance must be 0 for an outcome"
        alone = found["first"] if not motion.scene.rolling_resistance else ("IN_THE_AIR", refused)
        assert found["alone"].partition(" (")[0] in alone, motion.scene
        sentences = headline + reasons
        keys |= {key for key, _ in sentences}
        for (key, numbers), (said, given) in zip(
            sentences, found["headline"] + found["reasons"], strict=True
        ):
            assert (key, *dict(numbers)) == (said, *given), motion.scene
            for name, true in numbers:
                assert given[name] == pytest.approx(true, rel=1e-6, abs=1e-9), motion.scene
    assert kinds >= {"slip", "stick", "reverse", "lift off", "impact"}
    assert keys >= {"lands", "SLIPS_then", "SLIPS_at", "proved", "ends_grip", "unlimited",
                    "friction", "blow_needs", "stopped", "thrown", "slides_off"}, keys  # fmt: skip


def test_webassembly_agrees_with_python_on_motions_with_later_blows(tmp_path: Path) -> None:
    """Every other body is struck 1 ns after its first event, because the rounding of another C
    library may delay the event.
    """
    how = replace(DEFAULTS, model="contact", max_steps=20_000, max_events=200)
    end, rng, motions, struck = 1.5, np.random.default_rng(39), [], []
    for k, scene in enumerate([*random_scenes(150, 38), *random_scenes(50, 40, struck=1.0)]):
        motion = rl.Trajectory.computed(scene, how, np.linspace(0.0, end, 31))
        first = [event.t + 1e-9 for event in motion.events if 0 < event.t < 0.9][: k % 2]
        strength = scene.mass * math.sqrt(scene.gravity * max(scene.a, scene.b))
        for t in (*(first or [rng.uniform(0.0, 1.0)]), rng.uniform(1.0, end)):
            if motion.t_end < end:
                break
            at = motion.scene_at(t)
            reach = float(rl.geometry.support(at.theta + math.pi / 2, a=scene.a, b=scene.b))
            blow = rl.Impulse.press(rng.uniform(0.05, 1.5) * strength, rng.uniform(-1, 1) * reach)
            given = replace(how, blows=(*motion.blows, (t, blow)))
            motion = rl.Trajectory.computed(scene, given, motion.t)
        if motion.t_end == end:
            motions.append(motion)
            after = np.array([0.0, end - t])
            struck.append(rl.Trajectory.computed(at.replace(impulse=blow), how, after))
    for motion, alone, found in zip(motions, struck, in_node(motions, tmp_path), strict=True):
        require_equal(motion, found)
        t, _ = motion.blows[-1]
        first_outcome, headline, reasons = _core.describe(alone.scene.core, alone._solution)
        assert found["first"] == ("IN_THE_AIR" if first_outcome is None else first_outcome.name)
        assert found["alone"] == found["first"]
        assert found["headline"].pop(0) == ["after_the_blow", {"t": t}]
        for (key, numbers), (said, given) in zip(
            headline + reasons, found["headline"] + found["reasons"], strict=True
        ):
            assert (key, *dict(numbers)) == (said, *given), motion.scene
            for name, true in numbers:
                later = t if name == "t" else 0.0
                assert given[name] == pytest.approx(true + later, rel=1e-6, abs=1e-9), motion.scene
    assert len(motions) > 150


def test_the_wasm_file_is_small_and_matches_its_script(tmp_path: Path) -> None:
    known = gzip.decompress(WASM.read_bytes())
    assert len(known) <= 0.86e6 and WASM.stat().st_size <= 0.33e6
    if EMCC is None or b" 3.1.6 " not in subprocess.check_output([EMCC, "--version"]):
        pytest.skip(
            "there is no emscripten 3.1.6, which made the file (apt-get install emscripten)"
        )
    script, made = ROOT / "tools" / "live" / "build.sh", tmp_path / "live.wasm.gz"
    subprocess.run([script, made], check=True, env=os.environ | {"PYTHON": sys.executable})
    assert gzip.decompress(made.read_bytes()) == known, "run tools/live/build.sh"


def repeated(page: Any) -> float:
    """Largest relative difference between a page's final state and that of its Python code."""
    ends = f"Object.entries({PLAYER}.columns).map(([name, values]) => [name, values.at(-1)])"
    made: dict[str, Any] = {}
    exec(page.evaluate(f"{PLAYER}.code()"), made)
    motion, errors = made.get("motion", made.get("trajectory")), []
    for name, value in page.evaluate(ends):
        true = getattr(motion, ENERGIES.get(name, name))
        errors.append(abs(value - true[-1]) / (np.abs(true).max() or 1))
    return max(errors)


def test_a_blow_chosen_with_a_slider_is_computed_in_the_page(opened: Opened) -> None:
    page = opened(rl.explore(rl.scenes.slope).to_html(), reduced_motion="reduce")
    page.locator(".where").fill("203")
    page.wait_for_function(f"!{PLAYER}.stale")
    assert "exactly this blow" in page.locator(".said").inner_text() and repeated(page) < 1e-10


def test_the_map_shows_the_first_outcome_of_each_blow(opened: Opened) -> None:
    scene = rl.Scene(2.0, 1.0, slope=0.05, friction=0.5)
    page = opened(rl.explore(scene, t_end=1.0).to_html(), reduced_motion="reduce")
    colours, met = page.evaluate(f"{PLAYER}.film.outcomes"), set()
    for d, force in ((-1.0, 2.0), (0.5, 6.0), (1.9, 2.0), (1.9, 6.0)):
        first = rl.outcome(scene.replace(impulse=rl.Impulse.press(force, d))).name
        cell = page.evaluate(f"{PLAYER}.colourOf({{ d: {d}, F: {force} }})")
        assert cell == [colours[first], 1]
        met.add(first)
    shown = page.locator("[data-outcome]:not([hidden])")
    names = shown.evaluate_all("all => all.map(({ dataset }) => dataset.outcome)")
    assert len(met) > 1 and met <= {*names}


def test_the_map_is_computed_only_when_in_view(opened: Opened) -> None:
    html = rl.explore(rl.scenes.report, t_end=1.0).to_html()
    page = opened(html, reduced_motion="reduce", viewport={"width": 1000, "height": 300})
    page.wait_for_function(f"{PLAYER}.fills === false && {PLAYER}.host.dataset.time")
    assert page.evaluate(f"{PLAYER}.mapped") is None
    page.locator(".map").scroll_into_view_if_needed()
    page.wait_for_function(f"{PLAYER}.mapped && !{PLAYER}.filling && {PLAYER}.cells.next().done")


def test_sliders_change_the_motion_which_code_and_link_reproduce(opened: Opened) -> None:
    write = made_by("live")["page"]
    page = opened(write(rl.explore(rl.scenes.jump)), reduced_motion="reduce")
    for name in page.evaluate(f"{PLAYER}.rows.map(({{ name }}) => name)"):
        before = page.evaluate(f"{PLAYER}.found")
        page.locator(f"#in-{name}").press("ArrowLeft" if name == "friction" else "ArrowRight")
        page.wait_for_function(f"!{PLAYER}.stale")
        assert page.evaluate(f"{PLAYER}.found") != before and repeated(page) < 1e-10, name
    field = page.get_by_label("angle θ [rad]")
    for typed, angle in {"10°": 10 * math.pi / 180, "-pi/6": -math.pi / 6, "3π/4": 0.75 * math.pi,
                         "0,25": 0.25, "2 deg": math.pi / 90}.items():  # fmt: skip
        field.fill(typed)
        field.press("Enter")
        page.wait_for_function(f"!{PLAYER}.stale")
        assert page.evaluate(f"{PLAYER}.given.theta") == pytest.approx(angle, rel=1e-15)
    field.fill("steep")
    field.press("Enter")
    assert "“steep” is not a number" in page.locator(".refused").inner_text()
    assert page.evaluate(f"{PLAYER}.given.theta") == math.pi / 90
    page.wait_for_function("location.hash.includes('x_dot=')")
    page.get_by_role("button", name="Deutsch").click()
    given = page.evaluate(f"{PLAYER}.given")
    page.reload()
    page.wait_for_function(f"{PLAYER} && document.title.includes('Bewegung')")
    again = page.evaluate(f"{PLAYER}.given")  # k, height and slip are rounded a few times
    assert again.pop("z_dot") == given.pop("z_dot") is None
    assert again == pytest.approx(given, rel=1e-14, abs=1e-15) and repeated(page) < 1e-10
    page.evaluate(f"{PLAYER}.change({{ b: -1 }})")
    page.wait_for_function(f"{PLAYER}.refusal")
    assert "b must be a positive" in page.locator(".refused").inner_text()


def test_an_old_link_without_rolling_resistance_opens_its_scene(opened: Opened) -> None:
    write = made_by("live")["page"]
    page = opened(write(rl.explore(rl.scenes.report)), reduced_motion="reduce")
    link = (TESTS / "export" / "old_files" / "link.txt").read_text(encoding="utf-8").strip()
    page.evaluate("(link) => { location.hash = link; location.reload(); }", link)
    page.wait_for_function(f"{PLAYER} && document.title.includes('Bewegung')")
    linked: dict[str, Any] = {
        name: float(text) for name, text in parse_qsl(link[1:]) if name != "lang"
    }
    linked |= {"rolling_resistance": 0.0, "z_dot": None}
    assert page.evaluate(f"{PLAYER}.given") == linked and page.evaluate(f"{PLAYER}.found")


@pytest.mark.parametrize(
    "link", ["#a=1e309&b=1", "#a=NaN&b=1", "#a=2&b=1&mass=heavy", "#a=2&b=1&blows=abc,0,-10,0.5,0",
             "#a=2&b=1&blows=-1,0,-10,0.5,0"],
)  # fmt: skip
def test_an_impossible_link_opens_the_scene_of_the_page_and_says_why(
    opened: Opened, link: str
) -> None:
    page = opened(made_by("live")["page"](rl.explore(rl.scenes.report)), reduced_motion="reduce")
    own = page.evaluate(f"{PLAYER}.given")
    page.evaluate("(link) => { location.hash = link; location.reload(); }", link)
    page.wait_for_function(f"{PLAYER} && {PLAYER}.refusal")
    assert page.evaluate(f"{PLAYER}.given") == own
    assert page.locator(".refused").inner_text().startswith("Not possible: ")


HEIGHT = float(rl.geometry.support(1.1, a=2.0, b=1.0))
LINKED = {
    "blow": rl.scenes.report,
    "rolls": rl.Scene(0.7, 0.5, theta=0.3, omega=2.0, inertia=0.09, slope=0.02),
    "touches": rl.Scene(2.0, 1.0, theta=1.1, omega=2.0, z=HEIGHT),
    "slides": rl.scenes.slip.replace(x=-0.75, gravity=1.62, rolling_resistance=0.01),
    "flies": rl.scenes.drop.replace(x_dot=1.5, z_dot=-0.5, restitution=0.5, omega=-1.0),
    "falls": rl.scenes.bounce,
}  # fmt: skip


def test_links_carry_scenes_to_the_page_and_back(opened: Opened) -> None:
    """The page rounds heights, inertias and slips, so motions agree only before many impacts."""
    write = made_by("live")["page"]
    page = opened(write(rl.explore(rl.scenes.report)), reduced_motion="reduce")
    times = [0.0, 0.5, 1.0]
    for name, scene in LINKED.items():
        page.evaluate("(link) => { location.hash = link; }", scene.to_link(t=1.0))
        page.wait_for_function(f"{PLAYER}.address === location.hash && !{PLAYER}.stale")
        again = rl.Scene.from_json(page.evaluate("location.href"))
        assert again.impulse == scene.impulse
        motion, linked = rl.simulate(scene, times), rl.simulate(again, times)
        for quantity, shown in page.evaluate(f"{PLAYER}.film.core.samples({times})").items():
            true = getattr(motion, ENERGIES.get(quantity, quantity))
            size = max(float(np.abs(true).max()), 1e-3)
            for there in (shown, getattr(linked, ENERGIES.get(quantity, quantity))):
                assert there == pytest.approx(true, rel=0, abs=1e-10 * size), (name, quantity)


@pytest.mark.parametrize("policy", [
    "<meta http-equiv=Content-Security-Policy content=\"script-src 'unsafe-inline'\">", "",
], ids=["forbidden", "missing"])  # fmt: skip
def test_the_film_of_the_first_blow_plays_without_webassembly(
    opened: Opened, monkeypatch: pytest.MonkeyPatch, policy: str
) -> None:
    if not policy:
        monkeypatch.setattr(explorer, "core", lambda: "")
    html = rl.explore(rl.scenes.report, t_end=1.0).to_html()
    page = opened(html.replace("<head>", f"<head>{policy}"), strict=not policy)
    assert "only plays the film of one blow" in page.locator(".card").inner_text()
    assert page.locator(".said").inner_text().strip().startswith("It rolls over.")
    assert not [part for part in (".hands", ".map", ".copy") if page.locator(part).is_visible()]
    moving = ".rolling-ellipse[data-time]:not([data-time='0'])"  # waits without eval
    page.locator(moving).wait_for(state="attached")
    motion = rl.simulate(rl.scenes.report, 1.0)
    drawn = page.evaluate(f"[0, 0.3, 1].map((t) => {PLAYER}.film.strips[0].motion.at(t).theta)")
    assert drawn == pytest.approx(motion.sol([0, 0.3, 1]).theta, abs=5e-3)
