"""The player's data, once unpacked, agree with the motion to within their tolerance."""

import base64
import json
import math
import re
import warnings
from typing import Any

import numpy as np
import pytest
import rolling_ellipse as rl
from oracles.pages import carried
from oracles.pictures import ORDINARY_SCENES
from rolling_ellipse._player.film import packed, sample_times, track
from rolling_ellipse._player.page import fragment

SCENES = {
    **ORDINARY_SCENES,
    "bounce": rl.scenes.bounce,
    "drop": rl.scenes.drop,
    "jump": rl.scenes.jump,
    "slip": rl.scenes.slip,
    "slope": rl.scenes.slope,
    "flat limit": rl.Scene(1.0, 1e-3, theta=0.3, omega=2.0),
    "kilometres": rl.Scene(2.3e3, 1.1e3, omega=0.04, x=-500.0),
}


def unpacked(column: dict[str, Any]) -> np.ndarray:
    numbers = np.frombuffer(base64.b64decode(column["data"]), f"<{column['kind']}")
    return column["low"] + column["step"] * numbers.astype(float)


def read_back(found: dict[str, Any], times: np.ndarray) -> dict[str, np.ndarray]:
    """Hermite cubics evaluated at the given times from divided differences."""
    known = {name: unpacked(column) for name, column in found["columns"].items()}
    t, values = known["t"], {}
    i = np.clip(np.searchsorted(t, times, side="right") - 1, 0, t.size - 2)
    span = t[i + 1] - t[i]
    for name, rate in (("x", "x_dot"), ("z", "z_dot"), ("theta", "omega")):
        p, m = known[name], known[rate]
        slope = (p[i + 1] - p[i]) / span
        first, last = (slope - m[i]) / span, (m[i + 1] - slope) / span
        u, v = times - t[i], times - t[i + 1]
        values[name] = p[i] + u * (m[i] + u * (first + v * (last - first) / span))
    return values


@pytest.mark.parametrize("name", SCENES)
def test_the_motion_between_samples_stays_within_its_tolerance(name: str) -> None:
    scene = SCENES[name]
    motion = rl.simulate(scene, 4.0 if name != "kilometres" else 200.0)
    size, end = max(scene.a, scene.b), motion.t_end
    tolerance = 2e-3 * size
    found = track(motion, [(0.0, end)], tolerance)
    times = np.random.default_rng(1).uniform(0.0, end, 4000)
    # the packed time of an impact is rounded, so times this close to an impact are left out
    near = 4 * tolerance / max(1e-9, float(np.max(np.hypot(motion.x_dot, motion.z_dot))))
    for event in motion.events:
        times = times[np.abs(times - event.t) > near]
    at, drawn = motion.sol(np.sort(times)), read_back(found, np.sort(times))
    # one tolerance for the cubic, and three for packing x, z, theta, t and the rates
    for column, unit in (("x", 1.0), ("z", 1.0), ("theta", size)):
        missed = np.max(np.abs(drawn[column] - getattr(at, column))) * unit
        assert missed <= 4 * tolerance, column


def test_an_impact_remains_a_jump_of_the_velocity() -> None:
    motion = rl.simulate(rl.scenes.drop, 1.0)
    (impact,) = [event for event in motion.events if event.kind is rl.EventKind.IMPACT]
    times = sample_times(motion, 1.0, 1e-4)
    assert times is not None
    after = int(np.searchsorted(times, impact.t))
    assert times[after] == impact.t and times[after - 1] == np.nextafter(impact.t, 0)
    at = motion.sol(times[[after - 1, after]])
    # the fall ends at a speed of sqrt(2 g · 1 m); afterwards the centre sinks much more slowly
    assert at.z_dot[0] == pytest.approx(-math.sqrt(2 * 9.81), rel=1e-9)
    assert abs(at.z_dot[1]) < 0.5 * abs(at.z_dot[0])


def test_a_motion_whose_period_divides_the_sample_spacing_is_still_resolved() -> None:
    """At 17 or 34 evenly spaced times the angle is the same modulo half turns."""
    turn = rl.period(rl.scenes.rolling)
    motion = rl.simulate(rl.scenes.rolling, 34 * turn)
    found = track(motion, [(0.0, motion.t_end)], 1e-3)
    times = np.linspace(0.0, motion.t_end, 5001)[1:-1]
    assert np.max(np.abs(read_back(found, times)["z"] - motion.sol(times).z)) < 4e-3


def test_parts_of_a_long_motion_are_as_accurate_as_a_short_motion() -> None:
    motion = rl.simulate(rl.scenes.rolling, 1e5)
    parts = [(0.0, 9.0), (5e4, 50_009.0), (99_990.0, 1e5)]
    found = track(motion, parts, 1e-3)
    known = unpacked(found["columns"]["t"])
    assert known[found["starts"]] == pytest.approx([begin for begin, _ in parts], abs=1e-3)
    times = np.concatenate([np.linspace(*part, 501) for part in parts])
    assert np.max(np.abs(read_back(found, times)["x"] - motion.sol(times).x)) < 4e-3
    with pytest.raises(ValueError, match="a player needs at most 20000 samples"):
        track(motion, [(0.0, 1e5)], 1e-3)


@pytest.mark.parametrize("error", [0.0, 1e-12, 1e-6, 1e-3])
@pytest.mark.parametrize(
    "values", [[0.0], [3.0, 3.0], [-1e9, 1e9], [0.1, 0.2, 0.3], [1e-30, 2e-30], [0.0, 1.0, 3.0]]
)
def test_packing_stays_within_its_stated_error(values: list[float], error: float) -> None:
    column = packed(np.array(values), error)
    # the stated error, and two roundings of a double in unpacking
    allowed = error + 4e-16 * np.max(np.abs(values))
    assert np.max(np.abs(unpacked(column) - values)) <= allowed
    assert column == json.loads(json.dumps(column))


def test_packing_uses_no_more_bytes_than_needed() -> None:
    values = np.linspace(-3.0, 5.0, 100)
    sizes = [len(packed(values, error)["data"]) for error in (1e-3, 1e-6, 0.0)]
    assert sizes == [268, 536, 1068]  # two, four and eight bytes a value, times 4/3 for base64


def test_samples_that_are_not_finite_are_rejected() -> None:
    with pytest.raises(ValueError, match="trajectory must have finite samples"):
        packed(np.array([0.0, np.nan]), 1.0)


def test_no_text_can_end_the_script() -> None:
    motion, label = rl.simulate(rl.scenes.report, 1.0), "</script><b> & \u2028"
    html = fragment({"label": label}, [motion], 'a "quoted" <text>')
    assert html.count("</script>") == 1 and "</script></div>" in html
    assert carried(html)["label"] == label
    assert 'alt="a &quot;quoted&quot; &lt;text&gt;"' in html


def test_the_page_requests_no_other_file() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        html = rl.simulate(rl.scenes.report, 2.0).animate()._repr_html_()
    html += rl.explore(rl.scenes.report, t_end=1.0)._repr_html_()
    assert set(re.findall(r"https?://[^\"' )]+", html)) == set()
    assert not re.search(r"\bimport\s*[({\"']|\bfetch\(|XMLHttp|<link", html)


@pytest.mark.parametrize(
    ("scene", "seconds"),
    [
        (rl.scenes.report, 0.0),  # a single sample
        (rl.Scene(2.0, 1.0), 5.0),  # a body at rest
        (rl.scenes.rolling, 2e9),  # 1e9 turns
        (rl.Scene(1.0, 1e-3, theta=0.3, omega=20.0), 3.0),
        (rl.Scene(1e-3, 1.0, omega=20.0, friction=0.3), 1.0),
        (rl.Scene(2e-9, 1e-9, mass=1e-20, omega=1e3), 1e-2),
        (rl.Scene(2e9, 1e9, mass=1e30, gravity=1e-3, omega=1e-6), 1e7),
        (rl.scenes.bounce, 60.0),
    ],
    ids=["instant", "rest", "turns", "flat", "tall", "tiny", "huge", "bounces"],
)
def test_films_of_extreme_scenes_stay_small(scene: rl.Scene, seconds: float) -> None:
    html = rl.animate(rl.simulate(scene, seconds), width=64)._repr_html_()
    assert html.startswith('<div class="rolling-ellipse"') and len(html) < 1_500_000
    data = carried(html)
    (strip,) = data["strips"]
    assert strip["a"] == scene.a and data["end"] <= seconds
    for column in strip["track"]["columns"].values():
        assert np.all(np.isfinite(unpacked(column)))
