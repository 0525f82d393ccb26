"""The site is built without a network and without a warning, and its pages work from files."""

import os
import re
import subprocess
import sys
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest
import rolling_ellipse
from oracles.paths import ROOT

NOWHERE = dict.fromkeys(("http_proxy", "https_proxy", "all_proxy"), "http://127.0.0.1:9")
ADDRESS = re.compile(r"<(?:script|img|link|iframe|source)\b[^>]*?(?:src|href)=\"(?:https?:)?//")
FORMULA = r"<(span|div) class=\"math\b.*?</\1>"
CODE = r"<(script|style|pre|code)\b.*?</\1>"
ASKED = {  # search terms, and the page that must be listed first
    "friction": "start", "default friction": "start", "restitution": "start",
    "degrees": "recipes", "csv": "recipes", "parquet": "recipes", "save": "recipes",
    "load": "recipes", "second blow": "recipes", "slow motion": "recipes", "jupyter": "recipes",
    "marimo": "recipes", "latex": "recipes", "cluster": "recipes", "own axes": "recipes",
    "export csv": "recipes", "default friction value": "start", "theta positive direction": "start",
    "insufficient friction": "recipes", "not enough friction": "recipes", "ipynb": "recipes",
    "when does it slip": "recipes", "slip time": "recipes", "compare my solver": "recipes",
    "ODE solver exact": "recipes", "simulate stop": "recipes", "homework": "course/class",
    "worksheet": "course/class", "grading answers": "course/class", "EventKind": "api/motion",
    "simulate": "api/motion", "plot_curves": "api/pictures",
}  # fmt: skip
WIDE = """[...document.querySelectorAll("mjx-container[display=true]")]
    .filter(box => box.scrollWidth > box.clientWidth + 1).map(box => box.textContent)"""


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    pytest.importorskip("sphinx", reason="there is no sphinx (pip install '.[docs]')")
    folder = tmp_path_factory.mktemp("site")
    done = subprocess.run(
        [sys.executable, "-m", "sphinx", "-W", "--keep-going", "-q", ROOT / "docs", folder],
        env=os.environ | NOWHERE, capture_output=True, text=True, timeout=300,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return folder


def test_every_public_name_is_on_an_api_page(site: Path) -> None:
    from sphinx.util.inventory import InventoryFile

    known = InventoryFile.loads((site / "objects.inv").read_bytes(), uri="").data
    places = {name: entry.uri for kind in known.values() for name, entry in kind.items()}
    names = {*rolling_ellipse.__all__} - {"__version__"}
    for path in Path(rolling_ellipse.__file__).parent.glob("[!_]*"):
        if path.suffix == ".py" or (path / "__init__.py").exists():
            public = vars(import_module(f"rolling_ellipse.{path.stem}"))
            called = [name for name in public.get("__all__", ()) if callable(public[name])]
            names |= {path.stem, *(f"{path.stem}.{name}" for name in called)}
    assert len(names) > 100
    assert not [n for n in names if not places.get(f"rolling_ellipse.{n}", "").startswith("api/")]


def test_the_page_of_an_enumeration_explains_every_member(site: Path) -> None:
    for page, names in {
        "motion": ("EventKind", "Mode", "Status"),
        "outcome": ("Validity",),
    }.items():
        html = (site / f"api/{page}.html").read_text(encoding="utf-8")
        for name in names:
            part = html.partition(f'id="rolling_ellipse.{name}"')[2].partition('<dl class="py')[0]
            told = re.findall(r"<dt><code.*?<span class=\"pre\">(\w+)</span>.*?<dd><p>.{15}", part)
            assert told == [each.name for each in getattr(rolling_ellipse, name)], name


def test_the_site_for_students_leaves_out_the_solutions(site: Path) -> None:
    assert (site / "course/class.html").exists()
    assert not [path for path in site.rglob("*") if path.name.startswith("teacher")]
    found = (site / "searchindex.js").read_text(encoding="utf-8")
    assert "course/class" in found and "course/teacher" not in found


@pytest.fixture(scope="module")
def pages(site: Path) -> dict[Path, str]:
    return {path: path.read_text(encoding="utf-8") for path in site.rglob("*.html")}


def test_no_page_requests_an_external_address(pages: dict[Path, str]) -> None:
    assert len(pages) > 50 and not [page for page, text in pages.items() if ADDRESS.search(text)]


def test_no_page_shows_the_source_of_a_formula(pages: dict[Path, str]) -> None:
    for page, html in pages.items():
        for hidden in (CODE, FORMULA, "<()[^>]*>"):
            html = re.sub(hidden, "", html, flags=re.DOTALL)
        assert re.findall(r".{,40}[$\\].{,40}", html) == [], page


def test_no_page_shows_a_path_on_the_build_machine(pages: dict[Path, str]) -> None:
    assert {page.name for page, html in pages.items() if "site-packages" in html} == set()


def test_wide_code_and_output_scrolls_and_is_neither_wrapped_nor_cut_off(
    site: Path, chromium: Any
) -> None:
    names = ("architecture", "api/benchmark", "api/pictures", "notebooks/06_speed_and_accuracy",
             "gallery", "recipes", "your_tests")  # fmt: skip
    fixed = """[...document.querySelectorAll('article pre')].filter(e => {
        const { whiteSpace, overflowX } = getComputedStyle(e);
        return whiteSpace !== 'pre' || overflowX !== 'auto'
            || (e.scrollWidth > e.clientWidth && e.tabIndex !== 0);
    }).map(e => e.textContent)"""
    for width in (390, 1280):
        page = chromium.new_page(viewport={"width": width, "height": 800})
        for name in names:
            page.goto((site / f"{name}.html").as_uri())
            assert page.locator("article pre").count()
            assert page.evaluate(fixed) == [], (name, width)
            assert page.evaluate("document.documentElement.scrollWidth") <= width, (name, width)
        page.close()


def test_no_page_offers_itself_as_previous_or_next(pages: dict[Path, str]) -> None:
    for page, html in pages.items():
        for title in re.findall(r'<div class="title">(.*?)</div>', html):
            assert f"<title>{title} - " not in html, page


def test_each_formula_is_in_one_chapter_and_set_up_code_is_hidden(pages: dict[Path, str]) -> None:
    chapters = {page.name: text for page, text in pages.items() if "02_physics_" in page.name}
    found = [int(n) for text in chapters.values() for n in re.findall(r"<h2>\((\d+)\)", text)]
    assert sorted(found) == list(range(1, 67)) and len(chapters) > 9
    assert all('hide above-input">' in text for text in chapters.values())


def test_the_search_lists_the_expected_page_first(site: Path, chromium: Any) -> None:
    page = chromium.new_page()
    first = "document.querySelector('#search-results li a')?.getAttribute('href')"
    for words, wanted in ASKED.items():
        page.goto((site / "search.html").as_uri() + f"?q={words.replace(' ', '+')}")
        page.get_by_text("Search finished").wait_for()
        page.wait_for_function(first)
        assert page.evaluate(first).partition(".html")[0] == wanted, words
    page.close()


@pytest.mark.parametrize("width", [390, 1280])
def test_a_live_frame_is_as_high_as_its_page(site: Path, chromium: Any, width: int) -> None:
    page = chromium.new_page(viewport={"width": width, "height": 800})
    page.goto((site / "explore.html").as_uri())
    inner = page.frames[1]
    inner.locator(".rolling-ellipse .map").wait_for(state="attached")
    needed = inner.evaluate("document.body.offsetHeight")
    page.wait_for_function(f"document.querySelector('iframe').clientHeight === {needed}")
    assert needed > 820 and inner.evaluate("document.documentElement.scrollHeight") == needed
    page.close()


def test_formulas_fit_and_films_and_search_work_from_files(
    site: Path, pages: dict[Path, str], chromium: Any
) -> None:
    context, complaints = chromium.new_context(), []
    context.set_offline(True)
    page = context.new_page()
    page.on("console", lambda message: complaints.append(message.text))
    page.on("pageerror", lambda error: complaints.append(str(error)))
    found = {each[0] for html in pages.values() for each in re.finditer(FORMULA, html, re.DOTALL)}
    assert len(found) > 400
    sheet = site / "course" / "02_energy_and_period.html"
    proofs = sheet.with_name("formulas.html")  # a page with the formulas of all pages
    proofs.write_text(pages[sheet].replace("</article>", f"{''.join(found)}</article>"), "utf-8")
    page.goto(proofs.as_uri(), wait_until="commit")  # a busy machine may need a minute for it
    drawn = "!document.querySelector('.math:not(:has(mjx-container))')"
    page.wait_for_function(f"document.querySelector('footer') && {drawn}", timeout=120_000)
    assert page.locator("mjx-container").count() >= len(found)
    assert page.locator("mjx-merror").count() == 0 and page.evaluate(WIDE) == []
    page.goto((site / "notebooks" / "01_first_roll.html").as_uri())
    page.locator(".rolling-ellipse").scroll_into_view_if_needed()
    page.wait_for_function("document.querySelector('.rolling-ellipse').player?.t > 0.2")
    page.goto((site / "notebooks" / "08_explore.html").as_uri())
    blow = "document.querySelector('.rolling-ellipse').dataset.blow"
    page.wait_for_function(blow)
    before = page.evaluate(blow)
    page.locator(".hard").press("ArrowDown")
    page.wait_for_function(f"{blow} !== '{before}'")
    page.goto((site / "search.html").as_uri() + "?q=restitution")
    page.wait_for_selector("#search-results li a")
    context.close()
    assert complaints == []
