"""The site is built without a network and without a warning, and its pages work from files."""

import importlib
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
import rolling_ellipse
from oracles.paths import ROOT

PACKAGE = Path(rolling_ellipse.__file__).parent
NOWHERE = dict.fromkeys(("http_proxy", "https_proxy", "all_proxy"), "http://127.0.0.1:9")
WORKS = """() => [...document.querySelectorAll('.rolling-ellipse')].every(host => host.player) &&
  document.querySelectorAll('.math').length == document.querySelectorAll('mjx-container').length"""


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    pytest.importorskip("sphinx", reason="there is no sphinx (pip install '.[docs]')")
    folder = tmp_path_factory.mktemp("site")
    command = [sys.executable, "-m", "sphinx", "-W", "--keep-going", "-q", "-b", "html"]
    done = subprocess.run(
        [*command, ROOT / "docs", folder],
        env=os.environ | NOWHERE, capture_output=True, text=True, timeout=300,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return folder


def test_every_public_name_has_its_place_in_the_api(site: Path) -> None:
    from sphinx.util.inventory import InventoryFile

    known = InventoryFile.loads((site / "objects.inv").read_bytes(), uri="").data
    places = {name: known[kind][name].uri for kind in known for name in known[kind]}
    modules = {path.stem for path in PACKAGE.glob("[!_]*.py")}
    modules |= {path.parent.name for path in PACKAGE.glob("[!_]*/__init__.py")}
    names = {*modules, *rolling_ellipse.__all__} - {"__version__"}
    for module in modules:
        public = vars(importlib.import_module(f"rolling_ellipse.{module}"))
        names |= {f"{module}.{n}" for n in public.get("__all__", ()) if callable(public[n])}
    assert len(names) > 100
    missing = {n for n in names if not places.get(f"rolling_ellipse.{n}", "").startswith("api/")}
    assert missing == set()


def test_no_page_asks_for_another_address(site: Path) -> None:
    asked = r"<(?:script|img|link|iframe|source)\b[^>]*?(?:src|href)=\"(?:https?:)?//[^\"]+"
    pages = {path: path.read_text(encoding="utf-8") for path in site.rglob("*.html")}
    assert len(pages) > 50
    assert {
        path.name: found for path, text in pages.items() if (found := re.findall(asked, text))
    } == {}


def test_formulas_films_and_search_work_from_files(site: Path, chromium: Any) -> None:
    context, complaints = chromium.new_context(), []
    context.set_offline(True)
    page = context.new_page()
    page.on("console", lambda message: complaints.append(message.text))
    page.on("pageerror", lambda error: complaints.append(str(error)))
    for name, formulas in {"02_physics": 300, "01_first_roll": 0, "08_explore": 0}.items():
        page.goto((site / "notebooks" / f"{name}.html").as_uri())
        page.wait_for_function(WORKS, timeout=60_000)
        assert page.locator("mjx-container").count() >= formulas
        assert page.locator("mjx-merror").count() == 0
    page.goto((site / "search.html").as_uri() + "?q=restitution")
    page.wait_for_selector("#search-results li a")
    context.close()
    assert complaints == []
