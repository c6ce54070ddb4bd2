"""What the homing page says of the home position and of the drive is so, and ends when it ends."""

import re
from collections.abc import Iterator

import pytest
from playwright.sync_api import Browser, Page

from app.simulation.faults import Fault, FaultKind
from app.tracker.state.snapshot import ActivityName
from tests.browser.hands import Mouse, middle
from tests.browser.page_clock import BEAT_MS
from tests.browser.site_stage import SiteStage, staged_site
from tests.browser.test_set_home import COARSE_MS, COUNTS_MS, SET, UNDO

HOMING = "/trackers/T1/commissioning/homing"
SEARCH = 'form[action$="/home"]:not([hidden]) button'
SEARCHING = "The drive is searching for its home switches."
UNFINISHED = "not finished"
KEY = '[data-jog="azimuth"][data-direction="1"]'
LONG_MS = 240_000
AWAY_MS = 8000
"""Held for so long, an axis is some degrees away, and the search takes a while."""


@pytest.fixture
def site(browser: Browser) -> Iterator[SiteStage]:
    with staged_site(browser) as found:
        found.beat_ms = COARSE_MS
        yield found


def word(page: Page) -> str:
    return page.locator(".says-state").inner_text()


def search(site: SiteStage, page: Page) -> None:
    """Search the home switches; while it runs, it is said, and nothing else of the home position."""
    site.until(page.locator(SEARCH).is_enabled)
    Mouse(page, site.advance).hold(page.locator(SEARCH), COUNTS_MS + COARSE_MS)
    site.until(lambda: word(page) == "Homing")
    site.advance(1000)
    assert UNFINISHED not in page.locator("body").inner_text()
    site.until(lambda: site.tracker.homed, within_ms=LONG_MS)
    site.until(lambda: word(page) == "At standstill")


def test_after_an_undo_and_a_search_only_what_is_so_is_said(site: SiteStage) -> None:
    page = site.open(HOMING, "tablet", allow=("422",))
    happened = page.locator(".says-messages .message[data-code^=hom]")
    search(site, page)
    Mouse(page, site.advance).hold(page.locator(SET), COUNTS_MS + COARSE_MS)
    site.until(lambda: site.tracker.can_undo_home)
    site.until(page.locator(UNDO).is_enabled)
    page.locator(UNDO).click()
    site.until(page.locator('.message[data-code="home_position_undone"]').count)
    site.beat_ms = BEAT_MS
    assert "key-primary" not in str(page.locator(SET).get_attribute("class"))
    Mouse(page, site.advance).hold(page.locator(KEY), AWAY_MS)
    assert "key-primary" in str(page.locator(SET).get_attribute("class")), "it was moved by hand"
    site.until(lambda: site.tracker.activity is ActivityName.HOLDING)
    site.beat_ms = COARSE_MS
    site.until(lambda: happened.count() == 0)
    search(site, page)
    codes = happened.evaluate_all("all => all.map((one) => one.dataset.code)")
    assert codes == ["homing_ended"], "the last thing that happened, and nothing before it"
    assert page.locator("#home-place .outcome-ok").count() == 0


def test_service_says_that_the_search_runs_and_then_that_it_was_not_finished(site: SiteStage) -> None:
    page = site.open("/trackers/T1/service", "tablet")
    zero, homing = page.locator("#zero"), site.open(HOMING, "tablet")
    homing.locator(SEARCH).click()
    site.until(lambda: SEARCHING in zero.inner_text())
    assert UNFINISHED not in zero.inner_text()
    homing.locator("#stop-key").click()
    site.until(lambda: UNFINISHED in zero.inner_text())
    assert SEARCHING not in zero.inner_text()


def test_of_a_silent_drive_is_said_that_it_does_not_answer_and_since_when(site: SiteStage) -> None:
    page = site.open(HOMING, "tablet")
    site.until(lambda: word(page) == "Not homed")
    site.do(lambda: site.served.drives["T1"].inject(Fault(FaultKind.SILENCE)))
    site.until(lambda: site.tracker.unreachable is not None)
    page.locator("#stop-key").click()
    site.advance(77_000)
    assert site.tracker.activity is ActivityName.STOPPING
    assert word(page) == "No connection"
    first = page.locator(".says-first").inner_text()
    assert re.fullmatch(r"Drive does not answer · since \d\d:\d\d:\d\d", first)
    assert page.locator(".says-text").text_content() == "No connection to the drive"
    page.mouse.click(*middle(page.locator(KEY)))
    said = page.locator("main").inner_text()
    assert "The drive of Tracker 1 does not answer." in said
    assert "Last reading" in said
    assert "standstill" not in said
    site.do(site.served.drives["T1"].end_injected_faults)
    site.until(lambda: word(page) == "Not homed")
