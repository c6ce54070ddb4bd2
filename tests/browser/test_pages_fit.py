"""Every page at every size and in every theme: nothing beside the screen, nothing too small, light enough."""

from collections.abc import Callable, Iterator
from functools import cache

import httpx
import pytest
from playwright.sync_api import Page, expect

from tests.browser.conftest import Opened, Plant, running

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
}
LEAST_TARGET_PX = 60
MOST_BYTES = 150_000
TOO_SMALL = """least => [...document.querySelectorAll('a, button, input:not([type=hidden]), select, summary')]
  .filter(e => !e.closest('p, h2, h3, .reasons, .skip') && !e.classList.contains('skip'))
  .map(e => [e, (e.closest('label') ?? e).getBoundingClientRect()])
  .filter(([e, box]) => box.width > 0 && (box.width < least || box.height < least))
  .map(([e, box]) => `${e.tagName} ${e.className} ${e.textContent.trim()} ${box.width}x${box.height}`)"""


@pytest.fixture(scope="module")
def plant() -> Iterator[Plant]:
    """One panel for all: nothing here changes it."""
    with running() as served:
        yield served


def whole(page: Page) -> None:
    """Wait until what the page asks for by itself has come."""
    expect(page.locator('[hx-trigger="load"]')).to_have_count(0, timeout=60_000)


@pytest.mark.parametrize("size", ["desk", "tablet", "phone"])
@pytest.mark.parametrize("name", PAGES)
def test_page_fits(name: str, size: str, opened: Opened, picture: Callable[[Page, str], None]) -> None:
    page = opened(PAGES[name], size)
    whole(page)
    picture(page, f"{name}-{size}")
    assert page.evaluate("document.documentElement.scrollWidth - innerWidth") <= 0
    assert page.evaluate(TOO_SMALL, LEAST_TARGET_PX) == []
    stop = page.locator("#stop-key").bounding_box()
    width = page.viewport_size["width"] if page.viewport_size else 0
    assert stop is not None
    assert abs(stop["x"] + stop["width"] / 2 - width / 2) < 3
    assert page.locator("h1").count() == 1


@pytest.mark.parametrize("theme", ["sun", "night"])
@pytest.mark.parametrize("name", ["overview", "live", "homing", "show", "player"])
def test_page_in_other_themes(
    name: str, theme: str, opened: Opened, picture: Callable[[Page, str], None]
) -> None:
    page = opened(PAGES[name], "tablet", theme=theme)
    picture(page, f"{name}-{theme}")
    assert page.evaluate("document.documentElement.dataset.theme") == theme


def test_theme_changes_at_one_tap_and_stays(opened: Opened) -> None:
    page = opened("/")
    page.locator("#theme-form .theme-key").click()
    expect(page.locator("html")).to_have_attribute("data-theme", "sun")
    page.reload()
    expect(page.locator("html")).to_have_attribute("data-theme", "sun")


def test_no_page_is_heavier_than_150_kilobytes(plant: Plant, opened: Opened) -> None:
    page = opened("/")
    asked: list[str] = []
    page.on("request", lambda request: asked.append(request.url))
    with httpx.Client(headers={"accept-encoding": "gzip"}) as client:
        weigh = cache(lambda url: client.get(url).num_bytes_downloaded)
        for path in PAGES.values():
            asked.clear()
            page.goto(plant.url + path)
            page.wait_for_selector('html[data-link="live"]')
            whole(page)
            assert all(url.startswith((plant.url, "ws://127.0.0.1")) for url in asked), asked
            parts = [url for url in asked if url.startswith(plant.url) and "/api/" not in url]
            assert any("frame.css" in url for url in parts), "what the browser remembers counts, too"
            weight = sum(weigh(url) for url in parts)
            assert weight < MOST_BYTES, (path, weight)
