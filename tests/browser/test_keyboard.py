"""The keyboard alone: it reaches everything in the order of the page, is always seen, and is never caught.

`make test` walks through every eighth page, `make soak` through all of them at two sizes.
"""

from collections.abc import Iterator
from contextlib import ExitStack
from itertools import pairwise
from typing import Any

import pytest
from playwright.sync_api import Browser, Page, expect

from tests.browser.conftest import SIZES, Opened
from tests.browser.every_page import EVERY_PAGE, T1
from tests.browser.layout import LOOKS
from tests.browser.panels import Panels
from tests.e2e.chromium import PAGE_READY
from tests.soak import amount

# pvlib 0.16 asks pandas 3.1 for a name that pandas will drop.
pytestmark = pytest.mark.filterwarnings("ignore:DatetimeIndex.dayofyear is deprecated")

STOPS = (LOOKS / "stops.js").read_text()
EVERY = amount(8, 1)
WALKED = list(EVERY_PAGE)[::EVERY]
MOST_STOPS = 400
POINTED = """() => {
  const kinds = ['click', 'mousedown', 'pointerdown', 'touchstart', 'mouseup', 'pointerup'];
  window.pointed = [];
  const add = EventTarget.prototype.addEventListener;
  EventTarget.prototype.addEventListener = function (kind, ...rest) {
    if (kinds.includes(kind) && this instanceof Element) window.pointed.push(this);
    return add.call(this, kind, ...rest);
  };
}"""
ONLY_POINTED = """() => [...new Set(window.pointed)]
  .filter((e) => e.isConnected && e !== document.body && e !== document.documentElement)
  .filter((e) => getComputedStyle(e).pointerEvents !== 'none')
  .filter((e) => !e.closest('a[href], button, input, select, textarea, summary, label, form'))
  .map((e) => `${e.tagName.toLowerCase()}#${e.id}.${e.className}`)"""
TO_THE_TOP = """() => {
  const first = document.createElement('span');
  first.tabIndex = -1;
  document.body.prepend(first);
  first.focus();
  first.remove();
  scrollTo(0, 0);
}"""
"""As on a page that was just opened, whatever it gave the focus to."""
DRAWN = ("u-over", "u-wrap", "uplot", "scene", "sign-pad")
"""Where a pointer draws or turns; beside each stand keys or fields that do the same."""


@pytest.fixture(scope="module")
def panels(browser: Browser) -> Iterator[Panels]:
    with ExitStack() as stack:
        yield Panels(browser, stack)


def walk(page: Page, key: str = "Tab") -> list[dict[str, Any]]:
    """Press a key until the focus has gone round, and return where it rested."""
    for _ in range(MOST_STOPS):
        page.keyboard.press(key)
        if page.evaluate("document.activeElement === document.body"):
            break
    stops: list[dict[str, Any]] = page.evaluate("walk.stops.splice(0)")
    return stops


def disordered(stops: list[dict[str, Any]]) -> list[str]:
    """Return where the focus goes up the page without going to the next column."""
    found = []
    for before, after in pairwise(stops):
        if before["inFooter"] or after["inFooter"]:
            continue
        if after["bottom"] <= before["top"] and after["left"] < before["right"] - 1:
            found.append(f"{before['text']} goes up to {after['text']}")
    return found


@pytest.mark.parametrize("size", amount(["tablet"], ["tablet", "phone"]))
@pytest.mark.parametrize("name", WALKED)
def test_the_keyboard_reaches_everything_and_shows_where_it_is(name: str, size: str, panels: Panels) -> None:
    width, height = SIZES[size]
    with panels.shown(EVERY_PAGE[name], width=width, height=height) as page:
        page.evaluate(STOPS)
        page.evaluate(TO_THE_TOP)
        wanted = {one["key"]: one["text"] for one in page.evaluate("walk.reachable()")}
        stops = walk(page)
        missed = [text for key, text in wanted.items() if key not in {stop["key"] for stop in stops}]
        assert missed == [], "never reached"
        assert 'class="skip"' in stops[0]["text"]
        assert [stop["text"] for stop in stops if not stop["marked"]] == [], "not seen to have the focus"
        assert [(stop["text"], stop["hidden"]) for stop in stops if stop["hidden"]] == [], "behind something"
        assert disordered(stops) == []
        # What closes when the focus leaves it is not there on the way back.
        left = {one["key"] for one in page.evaluate("walk.reachable()")}
        assert {stop["key"] for stop in walk(page, "Shift+Tab")} >= left, "not reached backwards"


@pytest.mark.parametrize("name", ["live", "journal", "trouble-homing"])
def test_the_first_key_leads_past_the_frame(name: str, panels: Panels) -> None:
    with panels.shown(EVERY_PAGE[name]) as page:
        page.evaluate(TO_THE_TOP)
        page.keyboard.press("Tab")
        box = page.locator(".skip").bounding_box()
        assert box is not None
        assert (box["x"] >= 0, box["y"] >= 0, box["height"] >= 64) == (True, True, True)
        page.keyboard.press("Enter")
        assert page.evaluate("document.activeElement.id") == "heading"
        page.keyboard.press("Tab")
        assert page.evaluate("document.activeElement.closest('main, footer') !== null")


def test_arrows_choose_and_space_and_enter_press(opened: Opened) -> None:
    page = opened(f"{T1}/commissioning/mode")
    first = page.locator('main input[type="radio"]:checked')
    before = first.input_value()
    first.focus()
    page.keyboard.press("ArrowUp")
    expect(page.locator('main input[type="radio"]:checked')).not_to_have_value(before)
    page.locator("#help summary").focus()
    for key, is_open in ((" ", True), ("Enter", False)):
        page.keyboard.press(key)
        assert page.locator("#help").evaluate("one => one.open") is is_open
    page.locator("#theme-form .theme-key").focus()
    page.keyboard.press("Enter")
    expect(page.locator("html")).to_have_attribute("data-theme", "sun")


@pytest.mark.parametrize("name", ["live", "player", "record", "trends", "overview", "homing", "location"])
def test_nothing_is_for_a_pointer_alone(name: str, panels: Panels) -> None:
    leaf = EVERY_PAGE[name]
    context = panels.browser.new_context()
    context.add_init_script(f"({POINTED})()")
    page = context.new_page()
    page.goto(panels.at(leaf.where).url + leaf.path)
    page.wait_for_selector(PAGE_READY)
    found = page.evaluate(ONLY_POINTED)
    context.close()
    assert [one for one in found if not any(word in one for word in DRAWN)] == []
