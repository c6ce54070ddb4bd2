"""Stop is one touch; a page without a connection says so within two seconds and sends nothing late."""

import pytest
from playwright.sync_api import Page, expect

from tests.browser.page_clock import BEAT_MS, Stage
from tests.e2e.chromium import PAGE_READY
from tests.fault_result import VIRTUAL, FaultResult

LIVE = "/trackers/T1"
T2 = "/trackers/T2"
HOMING = "/trackers/T1/commissioning/homing"
LINK_ERRORS = ("WebSocket connection", "Failed to load resource", "ERR_CONNECTION")
OLD_MS, JUDGED_EVERY_MS = 1500, 250
TABS = 8
LIGHT = "/trackers/T2/commissioning/clock"
"""A page with little on it, and a live socket like any other."""


def stopped(stage: Stage, page: Page) -> None:
    """STOP is touched, and confirmed at the same instant of the page's time."""
    page.locator("#stop-key").click()
    stage.settle()
    assert page.locator("#stopped-words").inner_text() == "Stopped."


def test_stop_goes_by_socket_and_by_post(stage: Stage) -> None:
    page = stage.open(T2)
    stopped(stage, page)
    assert len(stage.plant.orders("stop")) == 2
    assert stage.plant.machine.trackers["T2"].memory.tracking_on is False
    page.goto(stage.plant.url)
    stage.live(page)
    stopped(stage, page)
    assert len(stage.plant.orders("stop_all")) == 2


def test_stop_works_without_javascript(stage: Stage) -> None:
    plain = stage.browser.new_context(java_script_enabled=False)
    page = plain.new_page()
    page.goto(stage.plant.url + T2)
    page.locator("#stop-key").click()
    page.wait_for_load_state()
    assert page.url == stage.plant.url + T2
    assert len(stage.plant.orders("stop")) == 1
    plain.close()


@pytest.mark.fault(62)
def test_stop_on_eight_tabs_is_still_at_once(stage: Stage, fault: FaultResult) -> None:
    """A browser opens six connections to a site: STOP needs none that the other tabs hold."""
    page = stage.open(T2)
    others = [page.context.new_page() for _ in range(TABS - 1)]
    for other in others:
        other.goto(stage.plant.url + LIGHT)
        other.wait_for_selector(PAGE_READY)
    before = stage.clock.now()
    stopped(stage, page)
    assert stage.plant.orders("stop")
    fault.noticed((stage.clock.now() - before).total_seconds(), VIRTUAL)
    fault.shows(page.locator("#stopped-words").inner_text())
    fault.recovers("nothing was lost")


def test_values_follow_the_machine_and_a_lost_one_is_seen_at_once(stage: Stage) -> None:
    page = stage.open(LIVE)
    stage.advance(3000)
    assert page.locator('.header-clock [data-live="site.at"]').inner_text().endswith("12:40:03")
    stage.do(stage.plant.machine.cut)
    assert page.locator("#link-banner").is_visible()
    expect(page.locator("#link-banner")).to_contain_text("controller service does not answer")
    expect(page.locator("#link-banner-advice")).to_contain_text("tracking and stowing may have stopped")
    expect(page.locator('[data-action="track"]')).to_be_disabled()
    value = page.locator('[data-live="measured.azimuth_deg"]').first
    assert value.evaluate("e => getComputedStyle(e).fontStyle") == "italic"


def test_silent_socket_is_seen_within_two_seconds(stage: Stage) -> None:
    """A tablet leaves the Wi-Fi: the socket stays open, nothing comes; so too before a first word."""
    page = stage.open(LIVE, allow=LINK_ERRORS)
    banner = page.locator("#link-banner")
    stage.advance(1150)
    page.evaluate("tap.silence(true)")
    assert stage.until(banner.is_visible) == OLD_MS + BEAT_MS, "judged 50 ms before the last word is too old"
    expect(page.locator("#link-banner-words")).to_contain_text("Values are 2 s old.")
    expect(page.locator("#link-banner-advice")).to_contain_text("do not need this connection")
    expect(page.locator('[data-action="track"]')).to_be_disabled()
    page.context.add_init_script("tap.silence(true)")
    page.reload()
    assert banner.is_hidden()
    told_ms = stage.until(banner.is_visible)
    assert OLD_MS < told_ms <= OLD_MS + JUDGED_EVERY_MS


def test_nothing_is_sent_late_after_the_connection_returns(stage: Stage) -> None:
    page = stage.open(HOMING, allow=LINK_ERRORS)
    stage.do(stage.plant.machine.cut)
    assert page.locator("#link-banner").is_visible()
    before, sent = len(stage.plant.machine.orders), list[str]()
    page.on("request", lambda request: sent.append(request.url))
    touched = {"pointerId": 1, "isPrimary": True}
    page.locator('[data-jog="azimuth"][data-direction="1"]').dispatch_event("pointerdown", touched)
    page.evaluate("document.querySelector('form[action$=\"/zero\"]').requestSubmit()")
    stage.advance(300)
    stage.do(stage.plant.machine.mend)
    stage.until(page.locator("#link-banner").is_hidden)
    stage.advance(1000)
    assert (stage.plant.machine.orders[before:], [url for url in sent if "zero" in url]) == ([], [])
