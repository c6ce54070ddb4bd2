"""Every page at every size and in every theme: nothing beside the screen, nothing too small, light enough."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache

import httpx
import pytest
from playwright.sync_api import Browser, BrowserContext, Page, expect

from tests.browser.conftest import PATIENCE_MS, SIZES, Opened, Plant, listen, running

T1 = "/trackers/T1"
SHOW = f"{T1}/show?date=2026-06-21&start=05:07&end=20:19&minutes=3"
PAGES = {
    "overview": "/",
    "live": T1,
    "location": f"{T1}/commissioning/location",
    "clock": f"{T1}/commissioning/clock",
    "homing": f"{T1}/commissioning/homing",
    "mode": f"{T1}/commissioning/mode",
    "orientation": f"{T1}/commissioning/mode/orientation",
    "run": f"{T1}/commissioning/run",
    "sun-check": f"{T1}/sun-check",
    "record": f"{T1}/record",
    "settings": f"{T1}/settings",
    "drive": f"{T1}/drive",
    "proofs": f"{T1}/proofs",
    "protections": f"{T1}/protections",
    "service": f"{T1}/service",
    "machine": f"{T1}/machine",
    "training": f"{T1}/training",
    "show": SHOW,
    "recordings": "/recordings",
    "player": "/recordings/show-1",
    "compare": "/recordings/show-1?with=day-1",
    "simulate": "/simulate",
    "studies": "/studies",
    "step-program": "/studies/program?date=2026-06-21",
    "journal": "/journal",
    "site": "/site",
    "alarms": "/alarms",
    "notifications": "/site/notifications",
    "network": "/network",
}
LEAST_TARGET_PX = 60
MOST_BYTES = 150_000
TOO_SMALL = """least => [...document.querySelectorAll('a, button, input:not([type=hidden]), select, summary')]
  .filter(e => !e.closest('p, h2, h3, .reasons, .skip') && !e.classList.contains('skip'))
  .map(e => [e, (e.closest('label') ?? e).getBoundingClientRect()])
  .filter(([e, box]) => box.width > 0 && (box.width < least || box.height < least))
  .map(([e, box]) => `${e.tagName} ${e.className} ${e.textContent.trim()} ${box.width}x${box.height}`)"""


@dataclass
class Shown:
    """A page that is open, and what it asked for until it was whole."""

    name: str
    page: Page
    asked: list[str]


@pytest.fixture(scope="module")
def plant() -> Iterator[Plant]:
    """One panel for all: nothing here changes it."""
    with running() as served:
        yield served


@pytest.fixture(scope="module")
def visitor(browser: Browser) -> Iterator[BrowserContext]:
    """One visitor to all pages, whose browser keeps what they share."""
    context = browser.new_context(locale="en-GB", timezone_id="Europe/Istanbul")
    context.set_default_timeout(PATIENCE_MS)
    yield context
    context.close()


@contextmanager
def visit(visitor: BrowserContext, plant: Plant, name: str, size: str, theme: str = "day") -> Iterator[Shown]:
    """Show a page until the block ends; nothing may be complained of in its console."""
    visitor.add_cookies([{"name": "theme", "value": theme, "url": plant.url}])
    complaints: list[str] = []
    seen = Shown(name, visitor.new_page(), [])
    seen.page.on("request", lambda request: seen.asked.append(request.url))
    listen(seen.page, complaints)
    resize(seen.page, size)
    seen.page.goto(plant.url + PAGES[name])
    seen.page.wait_for_selector('html[data-link="live"]')
    whole(seen.page)
    yield seen
    seen.page.close()
    assert complaints == []


def resize(page: Page, size: str) -> None:
    """Give a page another size, and its scripts two frames to follow."""
    width, height = SIZES[size]
    page.set_viewport_size({"width": width, "height": height})
    page.evaluate("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")


@pytest.fixture(scope="module", params=PAGES)
def shown(request: pytest.FixtureRequest, visitor: BrowserContext, plant: Plant) -> Iterator[Shown]:
    """Every page, opened on the narrowest screen and made wider: narrow is where a page has no room."""
    with visit(visitor, plant, request.param, "phone") as seen:
        yield seen


def whole(page: Page) -> None:
    """Wait until what the page asks for by itself has come."""
    expect(page.locator('[hx-trigger="load"]')).to_have_count(0, timeout=60_000)


@pytest.mark.parametrize("size", ["phone", "tablet", "desk"])
def test_page_fits(shown: Shown, size: str, picture: Callable[[Page, str], None]) -> None:
    page = shown.page
    resize(page, size)
    picture(page, f"{shown.name}-{size}")
    assert page.evaluate("document.documentElement.scrollWidth - innerWidth") <= 0
    assert page.evaluate(TOO_SMALL, LEAST_TARGET_PX) == []
    stop = page.locator("#stop-key").bounding_box()
    assert stop is not None
    assert abs(stop["x"] + stop["width"] / 2 - SIZES[size][0] / 2) < 3
    assert page.locator("h1").count() == 1


@cache
def weight(url: str) -> int:
    """Return how many bytes an answer has on its way."""
    with httpx.Client(headers={"accept-encoding": "gzip"}) as client:
        return client.get(url).num_bytes_downloaded


def test_no_page_is_heavier_than_150_kilobytes(shown: Shown, plant: Plant) -> None:
    assert all(url.startswith((plant.url, "ws://127.0.0.1")) for url in shown.asked), shown.asked
    parts = [url for url in shown.asked if url.startswith(plant.url) and "/api/" not in url]
    assert any("frame.css" in url for url in parts), "what the browser remembers counts, too"
    assert sum(weight(url) for url in parts) < MOST_BYTES


@pytest.mark.parametrize("theme", ["sun", "night"])
@pytest.mark.parametrize("name", ["overview", "live", "homing", "show", "player"])
def test_page_in_other_themes(
    name: str, theme: str, visitor: BrowserContext, plant: Plant, picture: Callable[[Page, str], None]
) -> None:
    with visit(visitor, plant, name, "tablet", theme) as seen:
        picture(seen.page, f"{name}-{theme}")
        assert seen.page.evaluate("document.documentElement.dataset.theme") == theme


def test_theme_changes_at_one_tap_and_stays(opened: Opened) -> None:
    page = opened("/")
    page.locator("#theme-form .theme-key").click()
    expect(page.locator("html")).to_have_attribute("data-theme", "sun")
    page.reload()
    expect(page.locator("html")).to_have_attribute("data-theme", "sun")
