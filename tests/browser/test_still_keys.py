"""A key that is held stays under the finger, whatever appears or goes above it."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from datetime import datetime

import pytest
from playwright.sync_api import Browser, Page

from app.tracker.state.snapshot import Snapshot
from app.web.languages.catalogue import catalogue_of
from app.web.languages.known import LANGUAGES
from tests.browser.hands import LINK_MEASURED, middle
from tests.browser.layout import page_end
from tests.browser.page_clock import Stage
from tests.browser.site_stage import SiteStage, staged_site

KEY = '[data-jog="azimuth"][data-direction="1"]'
HELD = f"{KEY}[data-held]"
HOMING = "/trackers/T1/commissioning/homing"
PROOFS = "/trackers/T1/drive-tests"
NOTICE = "#step-reasons"
FRAMES_MS = 100
TOO_SLOW = "Connection too slow for hold-to-run: use incremental jog."
LAST_READING = "Last reading {age} ago: azimuth {azimuth}, elevation {elevation}."


def longest(text: str) -> str:
    """Return the language that needs the most room to say this."""
    return max(LANGUAGES, key=lambda code: len(catalogue_of(code).gettext(text)))


WATCH = """(key) => {
  const [button, content] = [document.querySelector(key), document.getElementById("content")];
  const above = () => button.closest(".columns, .homing").getBoundingClientRect().top + scrollY
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
  "beforeend", '<div class="question" id="step-reasons"><p>A doubt that the movement settles.</p></div>')"""
"""The steps are asked for again as soon as the axis moves, and this is not among what comes."""


@pytest.fixture
def site(browser: Browser) -> Iterator[SiteStage]:
    with staged_site(browser) as found:
        yield found


def held_still(
    stage: Stage, page: Page, moving: Callable[[], object], resting: Callable[[], object]
) -> float:
    """Hold a key, which stays on the screen, until something is so; return how far it moved on the page."""
    stage.until(lambda: page.locator(LINK_MEASURED).count() and page.locator(KEY).is_enabled())
    at = middle(page.locator(KEY))
    before = page.locator(KEY).bounding_box()
    assert before is not None
    page.mouse.move(*at)
    page.evaluate(WATCH, KEY)
    page.mouse.down()
    page.wait_for_selector(HELD)
    stage.until(moving)
    stage.advance(FRAMES_MS)
    page.mouse.up()
    stage.until(resting)
    stage.advance(FRAMES_MS)
    seen = page.evaluate("seen")
    assert max(abs(top - before["y"]) for top in seen["tops"]) < 1
    return float(max(seen["above"]) - min(seen["above"]))


def test_a_notice_that_goes_does_not_move_the_key(stage: Stage) -> None:
    page = stage.open(HOMING, "phone")
    page.evaluate(ADD_NOTICE)
    moved_px = held_still(
        stage, page, lambda: page.locator(NOTICE).count() == 0, lambda: page.locator(HELD).count() == 0
    )
    assert moved_px == 0, "the notice has its room beforehand"


def test_reasons_that_come_above_the_keys_do_not_move_them(site: SiteStage) -> None:
    page = site.open(PROOFS, "tablet")
    reasons, activity = page.locator('[data-reasons="test_stop"] li'), page.locator(".says-state")
    moved_px = held_still(
        site,
        page,
        lambda: "Jogging" in activity.inner_text() and reasons.count() > 0,
        lambda: "Jogging" not in activity.inner_text(),
    )
    assert moved_px > 20


SEEN_AT_ONCE = {
    "[data-jog]": 4,
    ".speed .key": 2,
    '[data-action="set_home"]': 1,
    'form:not([hidden]) > [data-action="home"]': 1,
    ".jog-says": 1,
    "#link-quality": 1,
}
BELOW = """([names, end]) => {
  return names.flatMap((name) => [...document.querySelectorAll(name)])
    .filter((one) => one.getBoundingClientRect().bottom > end).map((one) => one.textContent.trim());
}"""
SMALLEST_JOG_KEY = """Math.min(...[...document.querySelectorAll("[data-jog]")]
  .map((one) => one.getBoundingClientRect()).flatMap((box) => [box.width, box.height]))"""


def test_on_a_tablet_step_three_is_worked_without_scrolling(site: SiteStage) -> None:
    page = site.open(HOMING, "tablet")
    for language in ("en", longest(TOO_SLOW)):
        page.context.add_cookies([{"name": "language", "value": language, "url": site.plant.url}])
        page.reload()
        page.wait_for_selector(LINK_MEASURED)
        assert {name: page.locator(name).count() for name in SEEN_AT_ONCE} == SEEN_AT_ONCE
        assert page.evaluate(BELOW, [list(SEEN_AT_ONCE), page_end(page)]) == [], language
        assert page.evaluate(SMALLEST_JOG_KEY) >= 112, language


KEYS = """() => document.fonts.ready.then(() =>
  [...document.querySelectorAll("main :is([data-jog], [data-action], .speed .key)")]
    .filter((one) => one.checkVisibility())
    .map((one) => one.getBoundingClientRect())
    .flatMap((box) => [box.x, box.y + scrollY, box.width, box.height]))"""
"""Where the keys of a page are once its letters have come."""
SPILLED = """() => {
  const note = document.querySelector("[data-stale-note]");
  const [box, place] = [note.getBoundingClientRect(), note.parentElement.getBoundingClientRect()];
  return box.top < place.top - 1 || box.bottom > place.bottom + 1 || note.scrollWidth > note.clientWidth;
}"""


def lose(stage: Stage) -> None:
    """Have T1 read no position from now on."""
    tracker = stage.plant.machine.trackers["T1"]
    heard = tracker.snapshot

    def unheard(at: datetime, tick: int) -> Snapshot:
        return replace(heard(at, tick), measured=None, position_age_s=75.4)

    stage.do(lambda: setattr(tracker, "snapshot", unheard))


def moved(page: Page, before: list[float]) -> float:
    return max(abs(one - other) for one, other in zip(before, page.evaluate(KEYS), strict=True))


def test_a_connection_that_becomes_slow_moves_no_key(stage: Stage) -> None:
    language = longest(TOO_SLOW)
    page = stage.open(HOMING, "phone", language=language)
    page.wait_for_selector(LINK_MEASURED)
    before = page.evaluate(KEYS)
    page.evaluate("tap.delay(150)")
    stage.until(page.locator('#link-quality[data-level="3"]').count)
    assert page.locator("#link-verdict").inner_text() == catalogue_of(language).gettext(TOO_SLOW)
    assert moved(page, before) <= 1


def test_the_last_reading_has_its_room_and_moves_no_key(stage: Stage) -> None:
    page = stage.open(HOMING, "phone", language=longest(LAST_READING))
    stage.until(lambda: page.locator("[data-action]:not([disabled])").count())
    before = page.evaluate(KEYS)
    lose(stage)
    note = page.locator("[data-stale-note]")
    stage.until(lambda: "180" in note.inner_text())
    assert moved(page, before) <= 1
    assert not page.evaluate(SPILLED)
