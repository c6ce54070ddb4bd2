"""Every page: it fits, it is light, a screen reader finds its way, nothing moves, nothing vanishes.

Each page is opened once, on the narrowest screen, and made wider: narrow is where a page has no room.
`make test` looks at every page and at every second of the states that pages can be in, `make soak` at all.
"""

from collections.abc import Callable, Iterator
from contextlib import ExitStack
from dataclasses import dataclass
from functools import cache
from typing import Any

import httpx
import pytest
from playwright.sync_api import Browser, Page

from tests.browser.axe_rules import looked_at
from tests.browser.conftest import SIZES
from tests.browser.every_page import EVERY_PAGE, LOOKED_AT, NO_PAGES, STUDY_ID, Leaf, Where, unvisited
from tests.browser.layout import LOOKS, faults, unfold
from tests.browser.letters import foreign
from tests.browser.panels import Panels, resize
from tests.browser.reading import tree_faults
from tests.web.route_table import ROUTES

MOST_BYTES = 150_000
SCREEN_SIZES = SIZES | {"wall": (1920, 1080)}
STILL = (LOOKS / "still.js").read_text()
BARE = (LOOKS / "forced.js").read_text()
PARTS = """() => {
  const later = new Set([...document.querySelectorAll('img[loading=lazy]')].map((one) => one.src));
  return performance.getEntriesByType('resource').map((one) => one.name).filter((one) => !later.has(one));
}"""
"""What a page is made of; pictures that come when somebody scrolls to them are not of it."""

# pvlib 0.16 asks pandas 3.1 for a name that pandas will drop.
pytestmark = pytest.mark.filterwarnings("ignore:DatetimeIndex.dayofyear is deprecated")


@dataclass
class Shown:
    """A page that is open."""

    name: str
    leaf: Leaf
    page: Page


@pytest.fixture(scope="module")
def panels(browser: Browser) -> Iterator[Panels]:
    with ExitStack() as stack:
        yield Panels(browser, stack)


@pytest.fixture(scope="module", params=LOOKED_AT)
def shown(request: pytest.FixtureRequest, panels: Panels) -> Iterator[Shown]:
    leaf = EVERY_PAGE[request.param]
    with panels.shown(leaf) as page:
        yield Shown(request.param, leaf, page)


def test_a_page_fits_every_screen(shown: Shown, picture: Callable[[Page, str], None]) -> None:
    page, wrong = shown.page, {}
    for size in SCREEN_SIZES:
        resize(page, *SCREEN_SIZES[size])
        picture(page, f"{shown.name}-{size}")
        if found := faults(page) + displaced(page):
            wrong[size] = found
    assert wrong == {}


def test_a_page_is_written_in_letters_of_its_own(shown: Shown) -> None:
    assert foreign(shown.page) == []


def displaced(page: Page) -> list[str]:
    """Return that Stop, where it is, is not where the thumb is, or not large enough."""
    box = page.locator("#stop-key").bounding_box() if page.locator("#stop-key").count() else None
    width, height = page.evaluate("[document.documentElement.clientWidth, innerHeight]")
    if box is None:
        return []
    if width >= 900:
        placed = box == {"x": width - 130, "y": height - 168, "width": 120, "height": 120}
    else:
        placed = box["x"] == 80 and box["y"] + box["height"] >= height - 8 and box["height"] >= 64
    return [] if placed and box["width"] >= 120 else [f"Stop is out of its place: {box}"]


@pytest.fixture(scope="module")
def weight() -> Iterator[Callable[[str], int]]:
    """Return how many bytes the answer of an address has on its way."""
    with httpx.Client(headers={"accept-encoding": "gzip"}, timeout=60) as client:
        yield cache(lambda url: client.get(url).num_bytes_downloaded)


def test_no_page_is_heavier_than_150_kilobytes(
    shown: Shown, panels: Panels, weight: Callable[[str], int]
) -> None:
    if shown.leaf.where is not Where.CALM or shown.leaf.sends:
        return
    parts = shown.page.evaluate(PARTS)
    url = panels.at(Where.CALM).url
    assert [one for one in parts if not one.startswith((url, "data:"))] == []
    assert any("frame.css" in one for one in parts), "what the browser remembers counts, too"
    sent = {one for one in parts if one.startswith(url) and "/api/" not in one} | {
        shown.page.url.split("#")[0]
    }
    assert sum(weight(one) for one in sent) < MOST_BYTES


def test_a_page_fits_with_everything_open(shown: Shown) -> None:
    page, wrong = shown.page, {}
    unfold(page)
    for size in ("phone", "tablet"):
        resize(page, *SCREEN_SIZES[size])
        if found := faults(page):
            wrong[size] = found
    assert wrong == {}


def test_a_screen_reader_finds_its_way(shown: Shown) -> None:
    assert tree_faults(shown.page) == []


def test_axe_finds_nothing(shown: Shown) -> None:
    assert looked_at(shown.page, shown.name, "en") == []


def test_nothing_moves_by_itself_for_who_wants_it_still(shown: Shown) -> None:
    shown.page.emulate_media(reduced_motion="reduce")
    found = shown.page.evaluate(STILL)
    shown.page.emulate_media(reduced_motion="no-preference")
    assert found == []


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_nothing_vanishes_in_the_systems_own_colours(
    shown: Shown, scheme: Any, picture: Callable[[Page, str], None]
) -> None:
    shown.page.emulate_media(forced_colors="active", color_scheme=scheme)
    found = shown.page.evaluate(BARE)
    if shown.name in ("live", "homing", "settings", "alarms"):
        picture(shown.page, f"{shown.name}-forced-{scheme}")
    shown.page.emulate_media(forced_colors="none", color_scheme="light")
    assert found == []


def test_no_page_is_left_out() -> None:
    assert unvisited() == []


def test_what_is_said_to_be_no_page_is_a_route_and_answers_with_none(panels: Panels) -> None:
    assert [route for route in NO_PAGES if f"GET {route}" not in ROUTES] == []
    given = {"{study_id}": STUDY_ID, "{tracker_id}": "T1", "{step}": "location", "{name}": "homing-1024.png"}
    asked = [route for route, what in NO_PAGES.items() if what != "a file" and "{number}" not in route]
    with httpx.Client(
        base_url=panels.at(Where.CALM).url, headers={"hx-request": "true"}, timeout=60
    ) as client:
        for route in asked:
            for name, value in given.items():
                route = route.replace(name, value)
            answer = client.get(route)
            assert answer.status_code in (200, 303), route
            assert not answer.text.lstrip().lower().startswith("<!doctype html"), route
