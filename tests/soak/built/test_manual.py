"""The manual as it is built, in a browser that obeys the panel's security policy."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, expect

from tests.browser.conftest import Plant, Served, browser, listen, running
from tests.fakes import FakeMachine
from tests.web.test_manual import app_with
from tools.manual.site import build

__all__ = ["browser"]


@pytest.fixture(scope="module")
def manual(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Plant]:
    """Build the documents, strictly, and serve them."""
    folder: Path = tmp_path_factory.mktemp("manual") / "site"
    build(folder)
    with running(Served(FakeMachine(), app_with(folder))) as plant:
        yield plant


@pytest.mark.timeout(600)
def test_it_is_read_and_searched(manual: Plant, browser: Browser) -> None:
    complaints: list[str] = []
    page = browser.new_page(viewport={"width": 1280, "height": 800})
    listen(page, complaints)
    asked: list[str] = []
    page.on("request", lambda request: asked.append(request.url))
    with page.expect_event("worker"):
        page.goto(f"{manual.url}/manual/")
    expect(page.locator("h1#heliopanel")).to_be_visible()
    sections = page.locator(".md-tabs__link").all_inner_texts()
    assert [one.strip() for one in sections][1:] == [
        "Start", "Operate", "Install", "Connect a drive", "Integrate", "Reference", "Explain", "Develop",
    ]  # fmt: skip
    page.keyboard.press("/")
    expect(page.get_by_role("combobox", name="Search")).to_be_focused()
    page.keyboard.type("keyhole", delay=20)
    expect(page.get_by_role("status").filter(has_text="results")).to_be_visible()
    page.goto(f"{manual.url}/manual/explain/strategies.html")
    assert page.locator("td.number").first.evaluate("cell => getComputedStyle(cell).textAlign") == "right"
    page.goto(f"{manual.url}/manual/operate/operators-guide.html")
    page.close()
    assert complaints == []
    assert {url.startswith((manual.url, "blob:", "data:")) for url in asked} == {True}
