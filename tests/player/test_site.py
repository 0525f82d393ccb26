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


def test_every_public_name_has_its_place_in_the_api(site: Path) -> None:
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


def test_no_page_asks_for_another_address(site: Path) -> None:
    pages = {path.name: path.read_text(encoding="utf-8") for path in site.rglob("*.html")}
    assert len(pages) > 50 and not [name for name, text in pages.items() if ADDRESS.search(text)]


def test_formulas_films_and_search_work_from_files(site: Path, chromium: Any) -> None:
    context, complaints = chromium.new_context(), []
    context.set_offline(True)
    page = context.new_page()
    page.on("console", lambda message: complaints.append(message.text))
    page.on("pageerror", lambda error: complaints.append(str(error)))
    page.goto((site / "notebooks" / "02_physics.html").as_uri())
    page.wait_for_function("document.querySelectorAll('mjx-container').length >= 300")
    assert page.locator(".math:not(:has(mjx-container))").count() == 0
    assert page.locator("mjx-merror").count() == 0
    page.goto((site / "notebooks" / "01_first_roll.html").as_uri())
    page.locator(".rolling-ellipse").scroll_into_view_if_needed()
    page.wait_for_function("document.querySelector('.rolling-ellipse').player?.t > 0.2")
    page.goto((site / "notebooks" / "08_explore.html").as_uri())
    blow = "document.querySelector('.rolling-ellipse').dataset.blow"
    page.wait_for_function(blow)
    before = page.evaluate(blow)
    page.locator(".hard").press("ArrowDown")
    assert page.evaluate(blow) != before
    page.goto((site / "search.html").as_uri() + "?q=restitution")
    page.wait_for_selector("#search-results li a")
    context.close()
    assert complaints == []
