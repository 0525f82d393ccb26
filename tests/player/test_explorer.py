"""The table of blows agrees with the motions of `simulate`."""

import json
import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import rolling_ellipse as rl
from oracles.paths import ROOT
from rolling_ellipse import Outcome
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
def test_the_blows_are_on_the_body_and_carry_it_well_past_its_tip(name: str) -> None:
    scene = SCENES[name]
    explorer = rl.explore(scene)
    d, F = explorer.distances, explorer.strengths
    reach = rl.geometry.support(scene.theta + math.pi / 2, a=scene.a, b=scene.b)
    assert d.shape == (25,) and F.shape == (16,)
    assert (d[0], d[12], d[-1]) == pytest.approx((-reach, 0.0, reach), abs=1e-15 * reach)
    assert np.all(np.diff(F) > 0) and F[0] == pytest.approx(F[-1] / 16, rel=1e-2)


def test_the_strongest_blow_on_the_report_goes_three_times_beyond() -> None:
    F = rl.explore(rl.scenes.report).strengths[-1]
    speed = replace(rl.scenes.report, impulse=rl.Impulse.press(F, 2.0)).initial_state.omega
    # F is rounded to three digits
    assert speed == pytest.approx(3 * rl.thresholds(2.0, 1.0).roll_over_speed, rel=1e-2)


@pytest.mark.parametrize("slope", [0.0, 0.05])
def test_the_table_says_what_comes_first(slope: float) -> None:
    scene, d, F = rl.Scene(2.0, 1.0, slope=slope, friction=0.5), [-1.0, 0.5, 1.9], [2.0, 6.0]
    found = blows.table(scene, 1.0, np.array(d), np.array(F))["outcomes"]
    struck = [scene.replace(impulse=rl.Impulse.press(force, place)) for place in d for force in F]
    assert found == [rl.outcome(each) for each in struck]
    assert len(set(found)) > 1


def test_a_body_in_the_air_has_the_outcome_after_its_flight() -> None:
    two, bounce = np.array([-1.36, 1.36]), rl.scenes.bounce
    found = blows.table(rl.scenes.drop, 5.4, two, np.array([6.17, 11.0]))
    assert found["outcomes"] == [Outcome.ROCKS] * 3 + [Outcome.ROLLS_OVER]
    struck = replace(rl.scenes.drop, impulse=rl.Impulse.press(11.0, 1.36))
    lands = float(f"{rl.simulate(struck, 5.4).events[0].t:.4g}")
    assert found["headlines"][3] == [["lands", {"t": lands}], ["ROLLS_OVER_now"]]
    assert blows.table(bounce, 5.4, two[:1], two[1:])["headlines"] == [[["bounces"]]]


def test_pages(tmp_path: Path) -> None:
    explorer = rl.explore(rl.scenes.report, t_end=1.0)
    explorer.to_html(tmp_path / "one.html")
    text = (tmp_path / "one.html").read_text(encoding="utf-8")
    assert text.startswith("<!DOCTYPE html>") and explorer._repr_html_() in text
    assert len(text) < 400_000 and explorer.to_html() == text


def test_a_language_is_a_whole_table() -> None:
    german = rl.explore(rl.scenes.drop, language="de").words
    assert rl.explore(rl.scenes.drop, language=german).words == german
    assert {each.name for each in Outcome} < german.keys()
    for folder in ("python/rolling_ellipse/_ask", "docs/live"):
        english, german = (
            json.loads((ROOT / folder / f"words_{each}.json").read_text("utf-8"))
            for each in ("en", "de")
        )
        assert list(english) == list(german)
        for key, text in english.items():  # both say the same numbers
            assert sorted(BRACES.findall(text)) == sorted(BRACES.findall(german[key])), key
