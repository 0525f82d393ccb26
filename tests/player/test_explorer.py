"""An explorer's blows hit the body, its texts are complete, and its page is a single file."""

import json
import math
import re
from dataclasses import replace
from pathlib import Path

import pytest
import rolling_ellipse as rl
from oracles.paths import ROOT
from rolling_ellipse import Outcome
from rolling_ellipse._ask.words import LANGUAGES
from rolling_ellipse._player import blows

BRACES = re.compile(r"\{\w+\}")
SCENES = {
    "report": rl.scenes.report,
    "slope": rl.scenes.slope,
    "drop": rl.scenes.drop,
    "rocking": rl.scenes.rocking,
    "tall": rl.Scene(1.0, 2.0, friction=0.4),
    "flat limit": rl.Scene(1.0, 1e-3, friction=0.3),
    "tiny": rl.Scene(2e-9, 1e-9, mass=1e-20),
    "huge": rl.Scene(2e9, 1e9, mass=1e30, gravity=1e-3),
}


@pytest.mark.parametrize("name", SCENES)
def test_blows_hit_the_body_and_the_blow_of_the_scene_comes_first(name: str) -> None:
    scene = SCENES[name]
    place, strength = blows.axes(scene)
    reach = rl.geometry.support(scene.theta + math.pi / 2, a=scene.a, b=scene.b)
    assert (place["least"], place["most"]) == (-reach, reach)
    assert 0 < strength["least"] == pytest.approx(strength["most"] / 16, rel=1e-2)
    own = rl.Impulse.press(strength["most"] / 3, -0.3 * reach)
    assert blows.first_blow(scene.replace(impulse=own), place, strength) == own
    assert blows.first_blow(scene.replace(impulse=None), place, strength).dx == 0.75 * reach


def test_the_strongest_blow_reaches_three_times_the_roll_over_speed() -> None:
    F = blows.axes(rl.scenes.report)[1]["most"]
    speed = replace(rl.scenes.report, impulse=rl.Impulse.press(F, 2.0)).initial_state.omega
    # F is rounded to three digits
    assert speed == pytest.approx(3 * rl.thresholds(2.0, 1.0).roll_over_speed, rel=1e-2)


def test_an_explorer_is_one_small_page(tmp_path: Path) -> None:
    explorer = rl.explore(rl.scenes.report, t_end=1.0)
    explorer.to_html(tmp_path / "one.html")
    text = (tmp_path / "one.html").read_text(encoding="utf-8")
    assert text.startswith("<!DOCTYPE html>") and explorer._repr_html_() in text
    assert len(text) < 510_000 and explorer.to_html() == text
    assert "class Explorer" in text and "/**" not in text  # comments stay in the sources
    with pytest.warns(DeprecationWarning, match="live has no effect"):
        assert rl.explore(rl.scenes.report, t_end=1.0, live=False) == explorer


def test_each_language_has_a_complete_table_of_texts() -> None:
    german = rl.explore(rl.scenes.drop, language="de").words
    assert rl.explore(rl.scenes.drop, language=german).words == german
    assert {each.name for each in Outcome} < german.keys()
    for folder in ("python/rolling_ellipse/_ask", "docs/live"):
        english, *others = (
            json.loads((ROOT / folder / f"words_{each}.json").read_text("utf-8"))
            for each in LANGUAGES
        )
        for other in others:
            assert list(english) == list(other)
            for key, text in english.items():  # both have the same placeholders
                assert sorted(BRACES.findall(text)) == sorted(BRACES.findall(other[key])), key


def test_every_sentence_of_the_core_has_a_text() -> None:
    source = (ROOT / "src" / "describe.cpp").read_text(encoding="utf-8")
    words = rl.explore(rl.scenes.report).words
    numbers = {name[1:-1] for text in words.values() for name in BRACES.findall(text)}
    keys = {*re.findall(r'[{?:] ?"([a-zA-Z]\w*)"', source)}
    assert len(keys) > 25 and keys <= words.keys() | numbers
