"""The player and the explorer in a real browser: what they draw and how they react."""

import base64
import html
import io
import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import rolling_ellipse as rl
from PIL import Image
from rolling_ellipse._player import film_page
from rolling_ellipse._player.page import DARK, LIGHT, document

Page = Any
Opened = Callable[..., Page]

HOST = "document.querySelector('.rolling-ellipse')"
SCENES = {
    "report": rl.scenes.report,
    "drop": rl.scenes.drop,
    "jump": rl.scenes.jump,
    "slip": rl.scenes.slip,
    "slope": rl.scenes.slope,
    "standing": rl.Scene(0.7, 1.9, omega=2.0),
    "followed": rl.Scene(2.0, 1.0, omega=4.0, x=1e7),
}


def film(*scenes: rl.Scene, seconds: float = 4.0, **options: Any) -> str:
    motions = [rl.simulate(scene, seconds) for scene in scenes]
    return film_page(rl.animate(motions, width=64, **options))


def told(page: Page, words: str) -> Any:
    """The value of a function of the first film's player, after the next drawing."""
    return page.evaluate(
        f"new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() =>"
        f" done(({words})({HOST}.player)))))"
    )


def given(page: Page, words: str) -> Any:
    """The value of a function of the first film's player, without waiting for a drawing."""
    return page.evaluate(f"({words})({HOST}.player)")


def drawn(page: Page) -> np.ndarray:
    """Pixels of the canvas, (height, width, 3)."""
    data = told(page, "player => player.canvas.toDataURL()").partition(",")[2]
    with Image.open(io.BytesIO(base64.b64decode(data))) as picture:
        return np.asarray(picture.convert("RGB"), float)


def expected_centre(page: Page, motion: rl.Trajectory, t: float) -> tuple[float, float]:
    """Pixel position of the exact centre of the body."""
    (left, right, _, top), width = given(
        page, "player => [player.film.strips[0].window, player.box.clientWidth]"
    )
    at, slope = motion.sol(t), motion.scene.slope
    x, z = float(at.x[0]), float(at.z[0])
    across = x * math.cos(slope) + z * math.sin(slope)
    up = -x * math.sin(slope) + z * math.cos(slope)
    scale = width / (right - left)
    if given(page, "player => player.film.follows") == "middle":
        across -= x * math.cos(slope)
        up += x * math.sin(slope)
    return scale * (across - left), scale * (top - up)


def seen_centre(page: Page, near: tuple[float, float]) -> tuple[float, float]:
    """Centre of the drawn body, from the distances between a point and the edge in many directions.

    The marks of the tip and the contact on the edge spoil few of the directions.
    """
    picture, ink = drawn(page), LIGHT["ink"]
    reach = given(page, "p => 1.05 * p.views[0].scale * Math.max(p.film.strips[0].a, "
                  "p.film.strips[0].b) + 4")  # fmt: skip
    colour = np.array([int(ink[i : i + 2], 16) for i in (1, 3, 5)])
    dark = np.abs(picture - colour).sum(axis=2) < 120
    offsets, directions = [], []
    for angle in np.linspace(0.0, math.pi, 180, endpoint=False):
        way = np.array([math.cos(angle), math.sin(angle)])
        ends = [edge_distance(dark, near, side * way, reach) for side in (1, -1)]
        if None not in ends:
            offsets.append((ends[0] - ends[1]) / 2)  # type: ignore[operator]
            directions.append(way)
    # each offset is about the component of the centre's shift along its direction; find the shift
    # by least squares, and twice more without the worst tenth of the remaining directions
    offsets_, ways = np.array(offsets), np.array(directions)
    for _ in range(3):
        shift, *_ = np.linalg.lstsq(ways, offsets_, rcond=None)
        missed = np.abs(ways @ shift - offsets_)
        keep = missed <= np.quantile(missed, 0.9)
        offsets_, ways = offsets_[keep], ways[keep]
    assert len(offsets_) > 60
    return near[0] + float(shift[0]), near[1] + float(shift[1])


def edge_distance(
    dark: np.ndarray, near: tuple[float, float], way: np.ndarray, reach: float
) -> float | None:
    """Distance to the outermost dark pixel along a direction, within reach."""
    steps = np.arange(0.0, reach, 0.5)
    columns, rows = (near[i] + steps * way[i] - 0.5 for i in (0, 1))
    columns, rows = np.round(columns).astype(int), np.round(rows).astype(int)
    inside = (columns >= 0) & (rows >= 24) & (columns < dark.shape[1]) & (rows < dark.shape[0])
    met = np.flatnonzero(dark[rows[inside], columns[inside]])
    return float(steps[inside][met[-1]]) if met.size else None


# -------------------------------------------------------------------------------------- films


def test_a_film_opened_from_a_file_plays_by_itself(opened: Opened) -> None:
    page = opened(film(rl.scenes.report))
    page.wait_for_function(f"{HOST}.player.t > 0.3")
    told(page, "player => player.pause()")
    before = told(page, "player => player.t")
    assert told(page, "player => player.t") == before
    page.get_by_role("button", name="Play").click()
    page.wait_for_function(f"{HOST}.player.t > {before} + 0.1")
    page.get_by_role("button", name="Pause").click()


def test_a_film_waits_if_reduced_motion_is_preferred(opened: Opened) -> None:
    page = opened(film(rl.scenes.report), reduced_motion="reduce")
    page.wait_for_function(f"{HOST}.dataset.time === '0'")
    assert told(page, "player => [player.playing, player.t]") == [False, 0]


@pytest.mark.parametrize("name", SCENES)
def test_the_body_is_drawn_where_the_motion_puts_it(opened: Opened, name: str) -> None:
    motion = rl.simulate(SCENES[name], 4.0)
    page = opened(film(SCENES[name]), reduced_motion="reduce")
    times = [0.0, 0.123, 1.0, 2.345, 4.0]
    times += [event.t + 0.01 for event in motion.events if event.t < 3.9][:4]
    for t in times:
        given(page, f"player => player.seek({t})")
        body = told(page, "player => player.state().bodies[0]")
        where = expected_centre(page, motion, t)
        assert math.dist((body["px"], body["py"]), where) < 0.5
        assert body["theta"] == pytest.approx(float(motion.sol(t).theta[0]), abs=2e-3)
        seen = seen_centre(page, where)
        assert math.dist(seen, where) < 1, f"{t} s: {seen}, not {where}"


def test_the_pixel_check_detects_a_shift_of_two_pixels(opened: Opened) -> None:
    motion = rl.simulate(rl.scenes.report, 4.0)
    page = opened(film(rl.scenes.report), reduced_motion="reduce")
    told(page, "player => player.seek(1.0)")
    x, y = expected_centre(page, motion, 1.0)
    seen = seen_centre(page, (x + 2, y))
    assert seen[0] - (x + 2) == pytest.approx(-2, abs=1)


@pytest.mark.parametrize(("layout", "along"), [("over", "py"), ("side by side", "px")])
def test_several_motions_run_on_one_clock(opened: Opened, layout: str, along: str) -> None:
    page = opened(film(rl.scenes.report, rl.scenes.rocking, rl.scenes.drop, layout=layout))
    page.wait_for_function(f"{HOST}.player.t > 0.1")
    told(page, "player => player.stepTo(2.5)")
    bodies = told(page, "player => player.state().bodies")
    for body, scene in zip(bodies, (rl.scenes.report, rl.scenes.rocking, rl.scenes.drop),
                           strict=True):  # fmt: skip
        at = rl.simulate(scene, 4.0).sol(2.5)
        assert (body["t"], body["x"]) == pytest.approx((2.5, float(at.x[0])), abs=3e-3)
    places = [body[along] for body in bodies]
    assert places == sorted(places)


def test_players_on_one_page_do_not_interfere(opened: Opened) -> None:
    fragment = rl.animate(rl.simulate(rl.scenes.report, 4.0))._repr_html_()
    other = rl.explore(rl.scenes.report, t_end=2.0)._repr_html_()
    page = opened(document("three", fragment + fragment + other), reduced_motion="reduce")
    page.wait_for_function("document.querySelectorAll('[data-ready]').length === 3")
    times = page.evaluate(
        "(() => { const all = [...document.querySelectorAll('.rolling-ellipse')];"
        "all[1].player.seek(1.5); return all.map(each => each.player.t) })()"
    )
    assert times == [0, 1.5, 0]


def test_keys_work_only_while_the_player_has_the_focus(opened: Opened) -> None:
    page = opened(film(rl.scenes.report), reduced_motion="reduce")
    page.wait_for_function(f"{HOST}.dataset.time === '0'")
    page.keyboard.press("End")
    assert told(page, "player => player.t") == 0
    page.locator(".player").focus()
    page.evaluate("void (document.onkeydown = ({ key }) => document.title += key)")
    frame = 1 / 50
    for key, t in (("End", 4.0), ("ArrowLeft", 4 - frame), ("Home", 0.0), ("ArrowRight", frame),
                   ("ArrowUp", 11 * frame), ("ArrowDown", frame)):  # fmt: skip
        page.keyboard.press(key)
        assert told(page, "player => player.t") == pytest.approx(t, abs=1e-12)
    page.keyboard.press("+")
    page.keyboard.press("+")
    page.keyboard.press("-")
    assert told(page, "player => player.rate") == 2
    page.keyboard.press("Space")
    page.wait_for_function(f"{HOST}.player.t > 0.1")
    page.keyboard.press("Space")
    assert not told(page, "player => player.playing")
    page.keyboard.press("d")
    assert page.title() == "An ellipse in motion"  # keys must not reach a surrounding notebook
    assert page.locator("[data-lm-suppress-shortcuts]").count() == 1
    page.keyboard.press("Home")
    assert told(page, "p => p.canvas.getAttribute('aria-label')") == (
        "Ellipse on the ground, t = 0.000 s: θ = 0 rad, x = 0 m"
    )


def test_the_slider_seeks_and_marks_the_events(opened: Opened) -> None:
    page = opened(film(rl.scenes.drop), reduced_motion="reduce")
    page.locator("input[type=range]").fill("0.5")
    assert told(page, "player => player.t") == pytest.approx(2.0)
    titles = page.locator(".mark").evaluate_all("marks => marks.map(mark => mark.title)")
    assert titles[0] == "impact at 0.4515 s"  # sqrt(2 · 1 m / 9.81 m/s²)


def test_forces_are_shown_on_request(opened: Opened) -> None:
    page = opened(film(rl.scenes.report), reduced_motion="reduce")
    told(page, "player => player.seek(2.0)")
    without = drawn(page)
    page.get_by_role("button", name="N, F").click()
    assert page.get_by_role("button", name="N, F").get_attribute("aria-pressed") == "true"
    plum = np.array([int(LIGHT["plum"][i : i + 2], 16) for i in (1, 3, 5)])
    shafts = [int((np.abs(p - plum).sum(axis=2) < 12).sum()) for p in (without, drawn(page))]
    assert shafts[0] < 20 and shafts[1] > 100


@pytest.mark.parametrize(
    ("options", "dark"),
    [({}, False), ({"color_scheme": "dark"}, True), ({"class": "dark"}, True),
     ({"color_scheme": "dark", "class": "light"}, False)],
    ids=["light", "dark system", "dark page", "light page"],
)  # fmt: skip
def test_the_canvas_is_as_dark_as_the_page(
    opened: Opened, options: dict[str, Any], dark: bool
) -> None:
    marked = options.pop("class", "")
    page = opened(film(rl.scenes.report).replace("<body>", f'<body class="{marked}">'), **options)
    page.wait_for_function(f"{HOST}.player.t > 0.1")
    paper = (DARK if dark else LIGHT)["paper"]
    corner = drawn(page)[2, 2]
    assert corner.tolist() == [int(paper[i : i + 2], 16) for i in (1, 3, 5)]
    page.evaluate(f"document.body.className = '{'light' if dark else 'dark'}'")
    assert (drawn(page)[2, 2].sum() < 200) == (not dark)


@pytest.mark.parametrize("dots", [1, 2, 3])
def test_a_film_is_sharp_and_as_wide_as_its_page(opened: Opened, dots: int) -> None:
    page = opened(film(rl.scenes.report), device_scale_factor=dots, reduced_motion="reduce")
    widths = []
    for width in (1000, 500):
        page.set_viewport_size({"width": width, "height": 700})
        page.wait_for_function(f"{HOST}.player.canvas.width === {dots} * {HOST}.clientWidth")
        widths.append(told(page, "player => player.box.clientWidth"))
    assert widths == [968, 468]


def test_a_picture_is_shown_if_scripts_are_disabled(opened: Opened) -> None:
    page = opened(film(rl.scenes.report), java_script_enabled=False)
    image = page.locator("img")
    assert image.is_visible() and image.bounding_box()["width"] > 900
    assert "ellipse" in image.get_attribute("alt")
    picture = np.asarray(Image.open(io.BytesIO(image.screenshot())).convert("RGB"), float)
    orange = np.array([int(LIGHT["orange"][i : i + 2], 16) for i in (1, 3, 5)])
    assert (np.abs(picture - orange).sum(axis=2) < 30).sum() > 100  # path of the centre


# ----------------------------------------------------------------------------------- explorer


def hand(page: Page) -> tuple[float, float]:
    """Position of the hand on the page [pixels]."""
    x, y = told(
        page,
        "player => { const box = player.canvas.getBoundingClientRect();"
        "const { top } = player.hand(player.views[0]); return [box.x + top[0], box.y + top[1]] }",
    )
    return x, y


def blow(page: Page) -> tuple[float, float]:
    d, F = told(page, "player => player.host.dataset.blow").split()
    return float(d), float(F)


def drag(page: Page, by: tuple[float, float], steps: int) -> None:
    x, y = hand(page)
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + by[0], y + by[1], steps=steps)


@pytest.mark.parametrize("name", ["report", "slope", "drop", "jump"])
def test_a_drag_moves_the_blow_and_shows_its_effect(opened: Opened, name: str) -> None:
    """Positions, angles and forces are accurate to a pixel; a plot has 540 by 168 pixels."""
    scene = SCENES[name]
    explorer = rl.explore(scene)
    page = opened(document("", explorer._repr_html_()), reduced_motion="reduce")
    before, picture = blow(page), drawn(page)
    drag(page, (-90, 25), steps=6)
    page.mouse.up()
    d, F = blow(page)
    assert d < before[0] and before[1] > F
    assert np.abs(drawn(page) - picture).max() > 50
    motion = rl.simulate(replace(scene, impulse=rl.Impulse.press(F, d)), explorer.t_end)
    for t in (0.0, 0.7, 2.0, 5.0):
        given(page, f"player => player.seek({t})")
        body = told(page, "player => player.state().bodies[0]")
        scale = given(page, "player => player.views[0].scale")
        at = motion.sol(t)
        missed = math.dist((body["x"], body["z"]), (float(at.x[0]), float(at.z[0])))
        turned = abs(body["theta"] - float(at.theta[0])) * max(scene.a, scene.b)
        assert max(missed, turned) * scale < 1
    at, weight = motion.sol(np.linspace(0.0, explorer.t_end, 540 * 20)), scene.mass * scene.gravity
    curves = told(page, "player => player.curves.map(curve => curve.points)")
    for points, force in zip(curves, (at.normal_force, at.friction_force), strict=True):
        true, (t, seen) = np.clip(force / weight, -3, 5), np.array(points).T
        near = [np.roll(true, k)[20:-20] for k in range(-20, 21)]  # up to a pixel earlier or later
        seen = np.interp(at.t, t, np.clip(seen, -3, 5))[20:-20]
        over = np.maximum(seen - np.max(near, axis=0), np.min(near, axis=0) - seen)
        assert over.max() * 168 / np.ptp([-0.5, 1.5, *true]) < 1


def test_in_a_wide_cell_the_map_and_the_curves_are_beside_the_film(opened: Opened) -> None:
    """The explorer is no taller than a cell of marimo, 610 pixels, and its hand can be dragged."""
    fragment = rl.explore(rl.scenes.report, t_end=1.0)._repr_html_()
    size = {"width": 1132, "height": 800}  # 1100 without the margins of the page
    page = opened(document("", fragment), viewport=size, reduced_motion="reduce")
    stage, chart, field, whole = (
        page.locator(name).first.bounding_box()
        for name in (".player > canvas", ".map", ".plot", ".rolling-ellipse")
    )
    assert stage["x"] + stage["width"] <= chart["x"] == field["x"] < field["x"] + field["width"]
    assert abs(chart["y"] - stage["y"]) < 10 and whole["height"] <= 610
    before = blow(page)
    drag(page, (-60, 20), steps=4)
    page.mouse.up()
    assert blow(page)[0] < before[0] and blow(page)[1] < before[1]


def test_the_map_the_sliders_and_the_text_follow_the_blow(opened: Opened) -> None:
    page = opened(document("", rl.explore(rl.scenes.report)._repr_html_()))
    box = page.locator(".map canvas").bounding_box()
    page.mouse.click(box["x"] + 52 + 3, box["y"] + 10 + 3)  # leftmost and strongest
    page.wait_for_function(f"{HOST}.player.t > 0.1")  # it plays after the release
    d, F = blow(page)
    assert (d, F) == pytest.approx((-2.0, 99.7), rel=0.02)
    assert page.locator(".said").inner_text().startswith("It rolls, then it slips at t = ")
    page.locator(".where").fill("120")
    assert blow(page) == (0.0, F)
    assert "It rests." in page.locator(".said").inner_text()
    page.get_by_role("button", name="copy as code").click()
    page.wait_for_function(f"{HOST}.dataset.code")
    made: dict[str, Any] = {}
    exec(page.evaluate(f"{HOST}.dataset.code"), made)
    assert made["blow"] == rl.Impulse.press(F, 0.0)


def test_a_body_with_rolling_resistance_has_no_map_of_outcomes(opened: Opened) -> None:
    scene = rl.scenes.report.replace(rolling_resistance=0.3, friction=1.0)
    page = opened(document("", rl.explore(scene)._repr_html_()), reduced_motion="reduce")
    assert not page.locator(".map canvas").is_visible()
    assert page.locator(".map").inner_text().startswith("There is no map of first outcomes")
    motion = rl.simulate(scene.replace(impulse=rl.Impulse.press(*blow(page)[::-1])), 5.4)
    (rest,) = motion.events
    said = page.locator(".said").inner_text()
    assert said.startswith(f"It rolls. It comes to rest at t = {rest.t:.3g} s, ")
    assert "askew" in said


@pytest.mark.parametrize(
    ("part", "keys", "parts"),  # positions of both sliders in 240ths
    [
        (".where", "ArrowRight ArrowUp ArrowLeft", (211, 107)), (".where", "Home", (0, 107)),
        (".where", "End", (240, 107)), (".where", "PageDown", (186, 107)),
        (".hard", "ArrowUp", (210, 108)), (".hard", "End ArrowDown", (210, 239)),
        (".hard", "Home", (210, 0)), (".map canvas", "ArrowLeft ArrowUp", (205, 115)),
        (".map canvas", "Home PageUp", (0, 137)),
        (".player", "ArrowRight Space Space d d", (210, 107)),
    ],
)  # fmt: skip
def test_keys_move_the_blow_without_reaching_the_page(
    opened: Opened, part: str, keys: str, parts: tuple[int, int]
) -> None:
    page = opened(rl.explore(rl.scenes.report, t_end=1.0).to_html(), reduced_motion="reduce")
    page.evaluate("addEventListener('keydown', () => document.body.remove())")
    page.locator(part).focus()
    for key in [*keys.split(), "d", "d", "Control+x"]:
        page.keyboard.press(key)
    *moved, t = told(page, "player => [player.part(0), player.part(1), player.t]")
    assert [240 * each for each in moved] == pytest.approx(parts, abs=0.6)
    assert (t == 0) == (part != ".player")


def test_the_reason_is_announced_only_when_it_changes(opened: Opened) -> None:
    page = opened(rl.explore(rl.scenes.report, t_end=1.0, language="de").to_html())
    page.locator(".hard").press("End")
    blow(page)
    assert page.locator(".hard").get_attribute("aria-valuetext") == "99,7 Newtonsekunden"
    heard = page.locator(".spoken").inner_text()
    assert heard.startswith("Sie rollt, dann rutscht sie bei t = 0,112 s.") and "Rollen" in heard
    page.locator(".hard").press("ArrowDown")
    blow(page)
    assert page.locator(".spoken").inner_text() == heard


def test_the_script_in_the_docstring_fits_a_frame_to_its_page(opened: Opened) -> None:
    lines = str(rl.explore.__doc__).split("::\n\n")[1].split("</script>")[0] + "</script>"
    text = html.escape(rl.explore(rl.scenes.report, t_end=1.0).to_html())
    frame = opened(lines.replace('src="strike.html"', f'srcdoc="{text}"')).frames[1]
    frame.wait_for_function("innerHeight > 600 && document.body.offsetHeight === innerHeight")


def test_a_swipe_scrolls_the_page_unless_it_starts_on_the_hand(opened: Opened) -> None:
    page = opened(rl.explore(rl.scenes.report, t_end=1.0).to_html(), has_touch=True,
                  viewport={"width": 390, "height": 700}, reduced_motion="reduce")  # fmt: skip
    touch = page.context.new_cdp_session(page)
    boxes = [page.locator(part).first.bounding_box() for part in ("canvas", ".map canvas")]
    places = [hand(page), *((box["x"] + 60, box["y"] + 40) for box in boxes)]
    for (x, y), scrolls in zip(places, (False, True, True), strict=True):
        before = blow(page)
        for k in range(12):
            kind = "touchStart" if k == 0 else "touchMove" if k < 11 else "touchEnd"
            at = [{"x": x - 3 * k, "y": y - 9 * k}] if k < 11 else []
            touch.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": at})
            page.evaluate("new Promise(requestAnimationFrame)")
        assert (page.evaluate("scrollY") > 30, blow(page) == before) == (scrolls, scrolls)
        page.evaluate("scrollTo(0, 0)")
