"""A key that is held stays under the finger, whatever appears or goes above it."""

from collections.abc import Callable
from dataclasses import replace
from datetime import datetime

import pytest
from playwright.sync_api import Browser, Page, expect

from app.tracker.state.snapshot import Snapshot
from app.web.languages.known import LANGUAGES
from tests.browser.conftest import SIZES, Opened, Plant
from tests.browser.hands import LINK_MEASURED, until
from tests.browser.layout import page_end
from tests.browser.walking import service

__all__ = ["service"]
KEY = '[data-jog="azimuth"][data-direction="1"]'
HELD = f"{KEY}[data-held]"
HOMING = "/trackers/T1/commissioning/homing"
PROOFS = "/trackers/T1/drive-tests"
NOTICE = "#step-reasons"
WATCH = """(key) => {
  const [button, content] = [document.querySelector(key), document.getElementById("content")];
  const above = () => button.closest(".columns").getBoundingClientRect().top + scrollY
    - parseFloat(getComputedStyle(content).marginTop);
  window.seen = { tops: [], above: [above()] };
  const look = () => {
    seen.tops.push(button.getBoundingClientRect().top);
    seen.above.push(above());
    requestAnimationFrame(look);
  };
  // Begun after the page's own watch, so that it looks at what is painted.
  button.addEventListener("pointerdown", () => requestAnimationFrame(look), { once: true });
}"""
ADD_NOTICE = """document.getElementById("steps").insertAdjacentHTML(
  "beforeend", '<div class="step-open" id="step-reasons"><p>A doubt that the movement settles.</p></div>')"""
"""The steps are asked for again as soon as the axis moves, and this is not among what comes."""
Meanwhile = Callable[[Page], None]


def held_still(page: Page, meanwhile: Meanwhile, after: Meanwhile) -> tuple[float, float]:
    """Hold a key and return how far it moved on the screen and how far on the page, pixels."""
    page.wait_for_selector(LINK_MEASURED)
    key = page.locator(KEY)
    key.scroll_into_view_if_needed()
    box = key.bounding_box()
    assert box is not None
    page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    page.evaluate(WATCH, KEY)
    page.mouse.down()
    page.wait_for_selector(HELD)
    meanwhile(page)
    page.mouse.up()
    after(page)
    seen = page.evaluate("seen")
    on_screen = max(abs(top - box["y"]) for top in seen["tops"])
    return on_screen, max(seen["above"]) - min(seen["above"])


@pytest.mark.parametrize("size", ["tablet", "phone"])
def test_a_notice_that_goes_does_not_move_the_key(size: str, opened: Opened) -> None:
    page = opened(HOMING, size)
    page.evaluate(ADD_NOTICE)

    def gone(page: Page) -> None:
        page.wait_for_selector(NOTICE, state="detached")

    def rest(page: Page) -> None:
        page.wait_for_selector(HELD, state="detached")

    on_screen, on_page = held_still(page, gone, rest)
    assert on_page > 20
    assert on_screen < 1


@pytest.mark.parametrize("size", ["tablet", "phone"])
def test_reasons_that_come_above_the_keys_do_not_move_them(size: str, browser: Browser, service: str) -> None:
    width, height = SIZES[size]
    page = browser.new_page(viewport={"width": width, "height": height})
    page.goto(service + PROOFS)
    reasons = page.locator('[data-reasons="test_stop"] li')

    def moving(page: Page) -> None:
        until(page, lambda: page.locator(".strip-activity", has_text="Jogging").count())
        until(page, lambda: reasons.count() > 0)

    def resting(page: Page) -> None:
        until(page, lambda: page.locator(".strip-activity", has_text="Holding").count())

    on_screen, on_page = held_still(page, moving, resting)
    page.close()
    assert on_page > 20
    assert on_screen < 1


SEEN_AT_ONCE = {
    NOTICE: 1,
    "[data-jog]": 4,
    ".speed .key": 2,
    '[data-action="set_home"]': 1,
    '[data-action="home"]': 1,
    ".jog-state": 1,
    "#link-quality": 1,
}
BELOW = """([names, end]) => {
  return names.flatMap((name) => [...document.querySelectorAll(name)])
    .filter((one) => one.getBoundingClientRect().bottom > end).map((one) => one.textContent.trim());
}"""
SMALLEST_JOG_KEY = """Math.min(...[...document.querySelectorAll("[data-jog]")]
  .map((one) => one.getBoundingClientRect()).flatMap((box) => [box.width, box.height]))"""


def test_on_a_tablet_step_three_is_worked_without_scrolling_in_every_language(
    browser: Browser, service: str
) -> None:
    width, height = SIZES["tablet"]
    context = browser.new_context(viewport={"width": width, "height": height})
    page = context.new_page()
    for language in LANGUAGES:
        context.add_cookies([{"name": "language", "value": language, "url": service}])
        page.goto(service + HOMING)
        page.wait_for_selector(LINK_MEASURED)
        assert {name: page.locator(name).count() for name in SEEN_AT_ONCE} == SEEN_AT_ONCE
        assert page.evaluate(BELOW, [list(SEEN_AT_ONCE), page_end(page)]) == [], language
        assert page.evaluate(SMALLEST_JOG_KEY) >= 112, language
    context.close()


KEYS = """async () => {
  const keys = () => [...document.querySelectorAll("main :is([data-jog], [data-action], .speed .key)")]
    .filter((one) => one.checkVisibility())
    .map((one) => one.getBoundingClientRect())
    .map((box) => [box.x, box.y + scrollY, box.width, box.height]);
  await document.fonts.ready;
  for (let seen = "", at = 0; ; await new Promise(requestAnimationFrame)) {
    if (seen === JSON.stringify(keys())) { if (performance.now() - at > 300) return keys(); }
    else { seen = JSON.stringify(keys()); at = performance.now(); }
  }
}"""
"""Where the keys of a page are once it is laid out: its letters come after its text."""
SPILLED = """() => {
  const note = document.querySelector("[data-stale-note]");
  const [box, place] = [note.getBoundingClientRect(), note.parentElement.getBoundingClientRect()];
  return box.top < place.top - 1 || box.bottom > place.bottom + 1 || note.scrollWidth > note.clientWidth;
}"""


def lost(plant: Plant) -> None:
    """Have T1 read no position from now on."""
    tracker = plant.machine.trackers["T1"]
    heard = tracker.snapshot

    def unheard(at: datetime, tick: int) -> Snapshot:
        return replace(heard(at, tick), measured=None, position_age_s=75.4)

    plant.do(lambda: setattr(tracker, "snapshot", unheard))


SLOW_PING = """(() => {
  const send = WebSocket.prototype.send;
  WebSocket.prototype.send = function (data) {
    const late = window.slowBy && String(data).includes('"ping"');
    if (late) setTimeout(() => send.call(this, data), window.slowBy);
    else send.call(this, data);
  };
})()"""


@pytest.mark.parametrize("size", ["tablet", "phone"])
def test_a_connection_that_becomes_slow_moves_no_key(size: str, opened: Opened) -> None:
    for language in LANGUAGES:
        page = opened(HOMING, size, language=language)
        assert page.evaluate("document.documentElement.lang") == LANGUAGES[language].tag
        page.evaluate(SLOW_PING)
        page.wait_for_selector(LINK_MEASURED)
        before = page.evaluate(KEYS)
        page.evaluate("window.slowBy = 1300")
        page.wait_for_selector('#link-quality[data-level="3"]')
        expect(page.locator("#link-verdict")).not_to_be_empty()
        after = page.evaluate(KEYS)
        moved = max(abs(x - y) for a, b in zip(before, after, strict=True) for x, y in zip(a, b, strict=True))
        assert moved <= 1, language
        page.close()


@pytest.mark.parametrize("path", [HOMING, "/trackers/T1"])
@pytest.mark.parametrize("size", ["tablet", "phone"])
def test_the_last_reading_has_its_room_and_moves_no_key(
    size: str, path: str, opened: Opened, plant: Plant
) -> None:
    pages = {}
    for language in LANGUAGES:
        page = pages[language] = opened(path, size, language=language)
        assert page.evaluate("document.documentElement.lang") == LANGUAGES[language].tag
        if path == HOMING:
            page.wait_for_selector(LINK_MEASURED)
    page.context.clear_cookies(name="language")
    before = {language: page.evaluate(KEYS) for language, page in pages.items()}
    lost(plant)
    for language, page in pages.items():
        expect(page.locator("[data-stale-note]")).to_contain_text("180")
        after = page.evaluate(KEYS)
        moved = [
            abs(x - y)
            for a, b in zip(before[language], after, strict=True)
            for x, y in zip(a, b, strict=True)
        ]
        assert max(moved) <= 1, language
        assert not page.evaluate(SPILLED), language
