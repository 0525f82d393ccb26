"""A user's strokes on a moving body give the motion that `simulate` computes with `blows`."""

import html
import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import rolling_ellipse as rl
from oracles.paths import made_by

Opened = Callable[..., Any]
PLAYER = "document.querySelector('.rolling-ellipse').player"
BLOW = ("jx", "jz", "dx", "dz")
ENERGIES = {"kinetic": "kinetic_energy", "potential": "potential_energy"}
MAP = f"""new Promise(done => {{
  const player = {PLAYER}, look = () => (
    player.mapped && !player.filling && player.cells.next().done
      ? done(player.image.toDataURL()) : setTimeout(look, 50));
  look();
}})"""  # the picture of the map, once all of its cells are computed
SLIDES = rl.Scene(
    2.0, 1.0, mass=10.0, friction=0.1, x_dot=3.0, x=-4.0, impulse=rl.Impulse.press(8.0, 0.2)
)
FLIES = rl.Scene(1.0, 0.6, friction=0.5, restitution=0.9, z=4.0, omega=1.0)
JAMS = rl.Scene(2.0, 1.0, theta=0.9, x_dot=5.0, friction=3.0)


def explored(opened: Opened, scene: rl.Scene = rl.scenes.report, **options: Any) -> Any:
    return opened(rl.explore(scene).to_html(), **{"reduced_motion": "reduce"} | options)


def live(opened: Opened) -> Any:
    write = made_by("live")["page"]
    return opened(write(rl.explore(rl.scenes.report)), reduced_motion="reduce")


def seek(page: Any, t: float) -> None:
    """Set the clock and wait for the picture of that time."""
    page.evaluate(f"{PLAYER}.seek({t})")
    page.evaluate("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")


def place(page: Any, where: str) -> tuple[float, float]:
    """Pixel position of the "top" of the hand, or of a point of the "body" left of its centre."""
    x, y = page.evaluate(
        f"""(where) => {{
          const player = {PLAYER}, [view] = player.views;
          const box = player.canvas.getBoundingClientRect();
          const {{ x, z }} = player.strip.motion.at(player.now), {{ b }} = player.strip;
          const [u, v] = where === "body" ? view.at(x - b / 2, z) : player.hand(view).top;
          return [box.x + u, box.y + v];
        }}""",
        where,
    )
    return x, y


def drag(page: Any, where: str, by: tuple[float, float] = (0.0, 0.0)) -> None:
    """Press at a place, move the pointer by some pixels, release it, and wait for the motion."""
    x, y = place(page, where)
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + by[0], y + by[1], steps=4)
    page.mouse.up()
    page.wait_for_function(f"!{PLAYER}.stale")


def strike(page: Any, *times: float) -> None:
    for t in times:
        seek(page, t)
        page.get_by_role("button", name="strike now").click()
        page.wait_for_function(f"!{PLAYER}.stale")


def blows(page: Any) -> list[tuple[float, rl.Impulse]]:
    """The blows of the page's motion with their times."""
    rows = page.evaluate(f"{PLAYER}.blows()")
    return [(t, rl.Impulse(**dict(zip(BLOW, row, strict=True)))) for t, *row in rows]


def times(page: Any) -> list[float]:
    return [t for t, _ in blows(page)]


def deviation(page: Any, motion: rl.Trajectory) -> float:
    """Largest relative difference of event times and samples between a page and a motion.

    The kinds of events must agree.
    """
    rows, columns = page.evaluate(
        f"""(times) => {{
          const player = {PLAYER}, {{ core, end }} = player.film;
          const {{ events }} = core.ask(player.sceneOf(player.given), end);
          const columns = Object.entries(core.samples(times));
          return [events, columns.map(([name, values]) => [name, [...values]])];
        }}""",
        (t := np.linspace(0.0, motion.t_end, 101)).tolist(),
    )
    kinds = [each.kind.name.lower().replace("_", " ") for each in motion.events]
    assert [kind for _, kind, _ in rows] == kinds and len(columns) == 11
    errors = [abs(row[0] - each.t) / each.t for row, each in zip(rows, motion.events, strict=True)]
    for name, values in columns:
        true = np.asarray(getattr(motion.sol(t), ENERGIES.get(name, name)), float)
        errors.append(np.abs(np.array(values) - true).max() / (np.abs(true).max() or 1))
    return float(max(errors))


def simulated(page: Any, scene: rl.Scene) -> rl.Trajectory:
    """The motion that Python computes for a scene with the page's blows."""
    (_, first), *later = blows(page)
    end = page.evaluate(f"{PLAYER}.film.end")
    return rl.simulate(scene.replace(impulse=first), end, blows=later)


def copied(page: Any) -> rl.Trajectory:
    """The motion that the page's Python code computes."""
    made: dict[str, Any] = {}
    exec(page.evaluate(f"{PLAYER}.code()"), made)
    motion: rl.Trajectory = made["motion" if "motion" in made else "trajectory"]
    return motion


@pytest.mark.parametrize(
    ("scene", "mode"),
    [(rl.scenes.report, rl.Mode.ROLLING), (SLIDES, rl.Mode.SLIDING), (FLIES, rl.Mode.FLIGHT),
     (rl.scenes.report.replace(slope=0.05, friction=0.7), rl.Mode.ROLLING),
     (rl.scenes.report.replace(rolling_resistance=0.3, friction=1.0), rl.Mode.ROLLING)],
    ids=["rolls", "slides", "flies", "slope", "resistance"],
)  # fmt: skip
def test_two_strokes_give_the_motion_of_simulate(
    opened: Opened, scene: rl.Scene, mode: rl.Mode
) -> None:
    page = explored(opened, scene)
    seek(page, 0.4)
    before = simulated(page, scene)
    drag(page, "top", (-20, 10))
    assert times(page) == [0, 0.4] and before.at(0.4).mode == mode
    motion = simulated(page, scene)
    assert deviation(page, motion) < 1e-10 > deviation(page, copied(page))
    assert motion.at(0.3).theta == pytest.approx(before.at(0.3).theta, rel=1e-12)
    assert abs(motion.at(0.5).omega - before.at(0.5).omega) > 1e-3
    said = page.locator(".said").inner_text()
    assert said.startswith("After the blow at t = 0.4 s:") and "blow at 0.4 s" in said
    assert page.locator(".mark[title='blow at 0.4000 s']").count() == 1


def test_a_press_on_the_playing_body_strikes_it_and_playback_continues(opened: Opened) -> None:
    page = explored(opened, reduced_motion="no-preference")
    page.evaluate(f"{PLAYER}.play()")
    page.wait_for_function(f"{PLAYER}.now > 0.6")
    x, y = place(page, "body")  # before the press the body moves by less than its width
    page.mouse.move(x, y)
    page.mouse.down()
    pressed = page.evaluate(f"{PLAYER}.now")
    page.mouse.up()
    page.wait_for_function(f"{PLAYER}.playing && {PLAYER}.now > {pressed} + 0.2")
    page.evaluate(f"{PLAYER}.pause()")
    (_, first), (t, second) = blows(page)
    assert (t, second.jz) == (pressed, first.jz) and second.dx != first.dx
    assert deviation(page, simulated(page, rl.scenes.report)) < 1e-10
    page.evaluate(f"{PLAYER}.play()")
    page.get_by_role("button", name="strike now").click()
    third = times(page)[2]
    page.wait_for_function(f"{PLAYER}.playing && {PLAYER}.now > {third} + 0.1")


def test_a_stroke_replaces_all_later_ones(opened: Opened) -> None:
    page = explored(opened)
    strike(page, 1.0, 2.0, 3.0)
    drag(page, "top", (10, 0))
    assert times(page) == [0, 1, 2, 3]
    strike(page, 1.5)
    assert times(page) == [0, 1, 1.5]
    seek(page, 0.0)
    drag(page, "top", (-40, 0))
    ((t, first),) = blows(page)
    assert t == 0 and first.dx < 1 and not simulated(page, rl.scenes.report).events


def test_undo_returns_to_the_first_blow(opened: Opened) -> None:
    page = explored(opened)
    undo = page.get_by_role("button", name="undo blow")
    first = blows(page), page.evaluate(f"{PLAYER}.found")
    assert undo.get_attribute("aria-disabled") == "true"
    strike(page, 0.7, 1.4)
    page.locator(".where").press("ArrowLeft")
    page.locator(".where").press("Escape")
    assert times(page) == [0, 0.7] and page.evaluate(f"{PLAYER}.t") == 0.7
    assert undo.get_attribute("aria-disabled") == "false"
    for _ in range(2):
        undo.click(force=True)
        page.wait_for_function(f"!{PLAYER}.stale")
        assert (blows(page), page.evaluate(f"{PLAYER}.found")) == first
    assert undo.get_attribute("aria-disabled") == "true"


def test_a_drag_moves_no_blow_after_an_undo_or_a_change_of_the_scene(opened: Opened) -> None:
    page = live(opened)
    strike(page, 1.0)
    for key, part, left in (("Escape", ".player", [0, 1]), ("ArrowRight", "#in-b", [0, 1, 2])):
        known = blows(page)
        seek(page, 2.0)
        x, y = place(page, "body")
        page.mouse.move(x, y)
        page.mouse.down()
        page.locator(part).focus()
        page.keyboard.press(key)
        page.mouse.move(x + 9, y + 9, steps=3)
        page.mouse.up()
        assert times(page) == left and blows(page)[:2] == known


def test_twenty_strokes_give_the_motion_of_simulate(opened: Opened) -> None:
    """The points and strengths of the strokes cover the ranges of the sliders."""
    page = explored(opened)
    for k in range(20):
        strike(page, 0.25 * (k + 1))
        parts = f"{{ 0: {k * 7 % 20 / 19}, 1: {k * 3 % 20 / 19} }}"
        page.evaluate(f"{PLAYER}.changeParts({parts})")
        page.wait_for_function(f"!{PLAYER}.stale")
    motion = simulated(page, rl.scenes.report)
    assert len(times(page)) == 21 and sum(e.kind == "BLOW" for e in motion.events) == 20
    assert deviation(page, motion) < 1e-10


def test_a_click_after_the_end_of_a_motion_does_not_strike(opened: Opened) -> None:
    page = explored(opened)
    seek(page, 5.4)
    x, y = place(page, "body")
    page.mouse.click(x, y)
    assert times(page) == [0]
    page = live(opened)
    page.evaluate("(link) => { location.hash = link; }", JAMS.to_link(t=2.0))
    page.wait_for_function(f"{PLAYER}.strip.motion.end === 0 && !{PLAYER}.stale")
    seek(page, 1.0)
    x, y = place(page, "body")
    page.mouse.click(x, y)
    assert times(page) == [0]


def test_the_map_shows_the_outcomes_of_blows_on_the_moving_body(opened: Opened) -> None:
    page = explored(opened)
    scene = simulated(page, rl.scenes.report).scene_at(2.0)
    page.locator(".map").scroll_into_view_if_needed()
    before = page.evaluate(MAP)
    strike(page, 2.0)
    assert page.evaluate(MAP) != before
    colours, met = page.evaluate(f"{PLAYER}.film.outcomes"), set()
    for d, force in ((-1.6, 20.0), (-0.5, 30.0), (0.3, 80.0), (1.6, 50.0)):
        first = rl.outcome(scene.replace(impulse=rl.Impulse.press(force, d))).name
        assert page.evaluate(f"{PLAYER}.colourOf({{ d: {d}, F: {force} }})") == [colours[first], 1]
        met.add(first)
    assert len(met) == 4


def test_a_finger_strikes_the_body_without_scrolling(opened: Opened) -> None:
    size = {"width": 390, "height": 500}
    page = explored(opened, has_touch=True, viewport=size)
    seek(page, 1.0)
    x, y = place(page, "body")
    touch = page.context.new_cdp_session(page)
    for k in range(12):
        kind = "touchStart" if k == 0 else "touchMove" if k < 11 else "touchEnd"
        at = [{"x": x, "y": y - 9 * k}] if k < 11 else []
        touch.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": at})
        page.evaluate("new Promise(requestAnimationFrame)")
    assert times(page) == [0, 1] and page.evaluate("scrollY") == 0


def test_strokes_work_in_a_sandboxed_frame(opened: Opened) -> None:
    text = html.escape(rl.explore(rl.scenes.report).to_html())
    page = opened(f'<iframe sandbox="allow-scripts" srcdoc="{text}"></iframe>')
    frame = page.frames[1]
    frame.wait_for_function(f"{PLAYER}?.views")
    frame.evaluate(f"{PLAYER}.seek(1)")
    frame.get_by_role("button", name="strike now").click()
    frame.wait_for_function(f"{PLAYER}.found.events.length === 1")
    assert times(frame) == [0, 1]


def test_the_link_of_the_live_page_contains_its_blows(opened: Opened) -> None:
    """The blows remain after a change of the body, a change of the language and a reload."""
    page = live(opened)
    strike(page, 1.0)
    page.evaluate(f"{PLAYER}.change({{ jx: 5, jz: -30, dx: 0.5, dz: 0.25 }})")
    strike(page, 2.5)
    seek(page, 2.0)
    page.locator("#in-b").press("ArrowRight")
    page.wait_for_function(f"!{PLAYER}.stale && location.hash.includes(',2.5,')")
    assert page.evaluate(f"{PLAYER}.t") == 0
    found = blows(page)
    second = rl.Impulse(jx=5, jz=-30, dx=0.5, dz=0.25)
    assert found == [(0, rl.scenes.report.impulse), (1, second), (2.5, second)]
    link = page.evaluate("location.href")
    assert link.endswith("&blows=1,5,-30,0.5,0.25,2.5,5,-30,0.5,0.25")
    with pytest.warns(UserWarning, match="a scene has no blows"):
        scene = rl.Scene.from_json(link)
    assert scene == rl.scenes.report.replace(b=1.02)
    assert deviation(page, simulated(page, scene)) < 1e-10 > deviation(page, copied(page))
    page.get_by_role("button", name="Deutsch").click()
    assert blows(page) == found
    page.reload()
    page.wait_for_function(f"{PLAYER} && document.title.includes('Bewegung')")
    assert blows(page) == found
    page.get_by_role("button", name="zurücksetzen").click()
    assert blows(page) == [(0, rl.scenes.report.impulse)]


@pytest.mark.parametrize(
    "text", ["x", "1,2,3", "2,0,-5,0,0,1,0,-5,0,0", "1,0,-5,99,0", "1,0,up,0,0", "99,0,-5,0,0"]
)
def test_a_link_with_impossible_blows_is_refused_and_opens_the_page_without_them(
    opened: Opened, text: str
) -> None:
    page = live(opened)
    page.evaluate("(link) => { location.hash = link; }", f"#a=2&b=1&jz=-48&dx=1.5&blows={text}")
    page.reload()
    page.wait_for_function(f"{PLAYER}?.found")
    assert times(page) == [0] and page.evaluate(f"{PLAYER}.refusal")


def test_a_stroke_on_the_live_page_hits_the_body_and_is_not_zero(opened: Opened) -> None:
    page = live(opened)
    half = page.evaluate(f"{PLAYER}.film.strongest") / 2
    upright = simulated(page, rl.scenes.report).when(theta=math.pi / 2)[0]
    strike(page, upright)
    assert not page.evaluate(f"{PLAYER}.refusal")
    assert blows(page)[1][1].dx == pytest.approx(0.99, rel=1e-2)  # b = 1; the first blow is at 1.5
    rolls = rl.Scene(2.0, 1.0, omega=3.0)
    page.evaluate("(link) => { location.hash = link; }", rolls.to_link(t=2.0))
    page.wait_for_function(f"{PLAYER}.film.end === 2 && !{PLAYER}.stale")
    strike(page, 1.0)
    (_, none), (t, press) = blows(page)
    assert none == rl.Impulse() and t == 1 and press.jz == pytest.approx(-half, rel=1e-3)
