"""Pages in a real Chromium, opened from files with the network off."""

import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")


@pytest.fixture(scope="module")
def chromium() -> Iterator[Any]:
    """A browser for a single test file, because the event loop of its driver would disturb the
    notebook kernels of other files.
    """
    if CHROMIUM is None:
        pytest.skip("there is no chromium (apt-get install chromium)")
    driver = pytest.importorskip("playwright.sync_api", reason="there is no playwright")
    with driver.sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM)
        yield browser
        browser.close()


@pytest.fixture(scope="module")
def blank(chromium: Any) -> Callable[..., Any]:
    """An offline page with the given options. Tests share pages, because opening one is slow."""
    pages: dict[str, Any] = {}

    def page_for(**options: Any) -> Any:
        if (key := repr(options)) not in pages:
            context = chromium.new_context(**options)
            context.set_offline(True)
            pages[key] = context.new_page()
        return pages[key]

    return page_for


@pytest.fixture
def opened(blank: Callable[..., Any], tmp_path: Path) -> Iterator[Callable[..., Any]]:
    """Open HTML as a file; no page may request a network address or report an error.

    A page replaces an earlier one of the same test if their options are equal.
    """
    used: list[tuple[Any, dict[str, Any]]] = []
    complaints: list[str] = []

    def show(html: str, *, strict: bool = True, **options: Any) -> Any:
        path = tmp_path / f"page{len(used)}.html"
        path.write_text(html, encoding="utf-8")
        size = options.setdefault("viewport", {"width": 1000, "height": 800})
        page = blank(**options)
        page.set_viewport_size(size)
        page.mouse.move(0, 0)
        listeners: dict[str, Callable[[Any], None]] = {
            "pageerror": lambda error: complaints.append(f"error: {error}")
        }
        if strict:
            listeners["console"] = lambda message: complaints.append(f"console: {message.text}")
            listeners["request"] = lambda request: (
                complaints.append(request.url)
                if not request.url.startswith(("file:", "data:"))
                else None
            )
        for event, listener in listeners.items():
            page.on(event, listener)
        used.append((page, listeners))
        page.goto(path.as_uri())
        if options.get("java_script_enabled", True):  # pages unzip their data before they start
            for host in page.locator(".rolling-ellipse").all():  # without eval, for strict policies
                host.locator(".player").wait_for(state="attached")
        return page

    yield show
    for page, listeners in used:
        page.goto("about:blank")  # stops the player
        for event, listener in listeners.items():
            page.remove_listener(event, listener)
    assert complaints == []
