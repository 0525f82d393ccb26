"""Scenes as JSON, in files and in links to the live page."""

import json
import math
from dataclasses import fields
from pathlib import Path

import pytest
import rolling_ellipse as rl
from oracles.contact import random_scenes
from oracles.paths import TESTS
from rolling_ellipse import Impulse, Scene

FULL = Scene(
    0.1, 2 / 3, mass=1e-7, gravity=1.62, inertia=3e-8, slope=-0.1, friction=1 / 3, theta=-0.0,
    restitution=0.7, rolling_resistance=1e-3, omega=1e-300, x=1e17 + 16, z=0.9, x_dot=math.pi,
    z_dot=-1e-9, impulse=Impulse(jx=1e-9, jz=-2e-9, dx=0.01, dz=-0.02),
)  # fmt: skip
#: Numbers of older links, in which the page's own quantities replace three arguments of Scene.
OLDER = "#jx=0&jz=0&dx=1.5&dz=0&a=2&b=1&mass=10&gravity=9.81&slope=0&restitution=0&x=0"
LINKS = [
    ("theta=0.5&omega=3&friction=Infinity&k=1&height=0&slip=0", {"theta": 0.5, "omega": 3.0}),
    ("theta=0&omega=3&friction=1&k=0.5&height=0&slip=2",  # inertia = k m (a^2 + b^2)/4, h(0) = 1
     {"omega": 3.0, "friction": 1.0, "inertia": 6.25, "x_dot": 5.0}),
    ("theta=0&omega=3&friction=1&k=1&height=0.5&slip=2&z_dot=-1",
     {"omega": 3.0, "friction": 1.0, "z": 1.5, "x_dot": 2.0, "z_dot": -1.0}),
    ("theta=0&omega=0&friction=1&k=1&height=0&slip=0&z_dot=-1", {"friction": 1.0}),
]  # fmt: skip


def bits(scene: Scene) -> str:
    """The arguments of a scene as text, which distinguishes -0.0 from 0.0."""
    return repr([getattr(scene, field.name) for field in fields(scene)])


def test_300_scenes_survive_json_and_links_bit_for_bit() -> None:
    scenes = [*random_scenes(200, 41), *random_scenes(98, 42, struck=1.0), FULL, rl.scenes.report]
    for scene in scenes:
        text = scene.to_json()
        again = Scene.from_json(text)
        assert again == scene and bits(again) == bits(scene) and again.to_json() == text
        link = scene.to_link("https://pages.example/live/#a=1", t=6.0)
        linked = Scene.from_json(link)
        assert linked == scene and bits(linked) == bits(scene)
        assert linked.to_link("https://pages.example/live/", t=6.0) == link
    assert len(scenes) == 300 and sum(scene.impulse is not None for scene in scenes) == 100
    assert sum(scene.friction == math.inf for scene in scenes) > 5
    assert sum(scene.z is not None for scene in scenes) > 50


def test_the_text_is_standard_json_with_the_names_of_scene() -> None:
    def refuse(constant: str) -> None:
        raise ValueError(constant)

    given = json.loads(rl.scenes.report.to_json(), parse_constant=refuse)
    assert given == {
        "version": 1, "a": 2.0, "b": 1.0, "mass": 10.0, "gravity": 9.81, "slope": 0.0,
        "friction": "inf", "restitution": 0.0, "rolling_resistance": 0.0, "theta": 0.0,
        "omega": 0.0, "x": 0.0, "impulse": {"jx": 0.0, "jz": -48.0, "dx": 1.5, "dz": 0.0},
    }  # fmt: skip
    assert Scene.from_json('{"version": 1, "a": 2, "b": 1, "z": null, "impulse": null}') == Scene(
        2.0, 1.0
    )


def test_a_state_that_only_a_motion_can_reach_survives_json() -> None:
    """Just before an impact a body touches the ground and moves into it; Scene() rejects this."""
    motion = rl.simulate(rl.scenes.drop, 1.0)
    (hit, *_) = motion.events
    reached = motion.scene_at(math.nextafter(hit.t, 0.0))
    with pytest.raises(ValueError, match="z_dot must"):
        eval(repr(reached), {"Scene": Scene})
    assert Scene.from_json(reached.to_json()) == reached


@pytest.mark.parametrize("prefix", [b"", b"\xef\xbb\xbf", b"\n  "])
def test_a_scene_is_read_from_a_file_with_json_or_a_link(prefix: bytes, tmp_path: Path) -> None:
    for text in (FULL.to_json(), "https://pages.example/live/#a=2&b=1&jz=-48&dx=1.5\n"):
        (tmp_path / "scene.json").write_bytes(prefix + text.encode())
        assert Scene.from_json(tmp_path / "scene.json") == Scene.from_json(text)
    with pytest.raises(FileNotFoundError):
        Scene.from_json(tmp_path / "none.json")


@pytest.mark.parametrize(("link", "given"), LINKS)
def test_an_older_link_gives_the_scene_of_the_page(link: str, given: dict[str, float]) -> None:
    scene = Scene(2.0, 1.0, mass=10.0, **given)  # type: ignore[arg-type]
    for page in ("", "https://pages.example/live/index.html", "file:///pages/live.html"):
        assert Scene.from_json(f"{page}{OLDER}&{link}&t=6&lang=de") == scene
    struck = OLDER.replace("jz=0", "jz=-48")
    assert Scene.from_json(f"{struck}&{link}").impulse == Impulse.press(48.0, 1.5)


def test_an_old_link_without_rolling_resistance_is_read() -> None:
    link = (TESTS / "export" / "old_files" / "link.txt").read_text(encoding="utf-8")
    assert Scene.from_json(link) == Scene(
        2.0, 1.0, slope=0.01, friction=1.0, restitution=0.01, theta=0.05, omega=5.2
    )


def test_a_link_may_use_the_argument_names_of_scene() -> None:
    link = "#a=2&b=1&inertia=6.25&z=1.5&x_dot=1e-7&friction=inf&jx=0&jz=0&t=6&lang=en"
    given = Scene(2.0, 1.0, inertia=6.25, z=1.5, x_dot=1e-7, impulse=Impulse())
    assert Scene.from_json(link) == given


def test_the_error_for_an_unknown_key_suggests_the_right_one() -> None:
    for text in ('{"version": 1, "a": 2, "b": 1, "mu": 1}', "#a=2&b=1&mu=1"):
        with pytest.raises(ValueError, match=r"got 'mu'; did you mean friction\?$"):
            Scene.from_json(text)


def test_a_warning_shows_the_blows_that_a_scene_cannot_take_from_a_link() -> None:
    with pytest.warns(UserWarning, match=r": pass 2,0,-1,0\.5,0 to simulate as blows=$"):
        scene = Scene.from_json("#a=2&b=1&t=5&blows=2,0,-1,0.5,0")
    assert scene == Scene(2.0, 1.0) == Scene.from_json("#a=2&b=1&t=5&blows=")
