"""Pages in a real Chromium, opened from files with the network off."""

import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")


@pytest.fixture(scope="module")
def chromium() -> Iterator[Any]:
    """A browser for one file of tests: the event loop of its driver would disturb the kernels of
    notebooks in other files.
    """
    if CHROMIUM is None:
        pytest.skip("there is no chromium (apt-get install chromium)")
    driver = pytest.importorskip("playwright.sync_api", reason="there is no playwright")
    with driver.sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM)
        yield browser
        browser.close()


@pytest.fixture
def opened(chromium: Any, tmp_path: Path) -> Iterator[Callable[..., Any]]:
    """Open HTML as a file; no page may ask for a network address or report an error."""
    contexts: list[Any] = []
    complaints: list[str] = []

    def show(html: str, *, strict: bool = True, **options: Any) -> Any:
        path = tmp_path / f"page{len(contexts)}.html"
        path.write_text(html, encoding="utf-8")
        context = chromium.new_context(**({"viewport": {"width": 1000, "height": 800}} | options))
        context.set_offline(True)
        contexts.append(context)
        page = context.new_page()
        page.on("pageerror", lambda error: complaints.append(f"error: {error}"))
        if strict:
            page.on("console", lambda message: complaints.append(f"console: {message.text}"))
            page.on("request", lambda request: complaints.append(request.url)
                    if not request.url.startswith(("file:", "data:")) else None)  # fmt: skip
        page.goto(path.as_uri())
        if options.get("java_script_enabled", True):  # pages unzip their data before they start
            for host in page.locator(".rolling-ellipse").all():  # without eval, for strict policies
                host.locator(".player").wait_for(state="attached")
        return page

    yield show
    for context in contexts:
        context.close()
    assert complaints == []
