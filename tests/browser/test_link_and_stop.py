"""Stop is one touch; a page without a connection says so within two seconds and sends nothing late."""

import pytest
from playwright.sync_api import Page, expect

from tests.browser.conftest import Opened, Plant
from tests.browser.hands import until
from tests.e2e.chromium import PAGE_READY
from tests.fault_result import REAL, FaultResult

LIVE = "/trackers/T1"
T2 = "/trackers/T2"
LINK_ERRORS = ("WebSocket connection", "Failed to load resource", "ERR_CONNECTION")


def test_stop_goes_by_socket_and_by_post(opened: Opened, plant: Plant) -> None:
    page = opened(T2)
    page.locator("#stop-key").click()
    expect(page.locator("#stopped-words")).to_have_text("Stopped.")
    until(page, lambda: len(plant.orders("stop")) >= 2)
    assert len(plant.orders("stop")) == 2
    assert plant.machine.trackers["T2"].memory.tracking_on is False


def test_stop_of_the_site_stops_all(opened: Opened, plant: Plant) -> None:
    page = opened("/")
    page.locator("#stop-key").click()
    expect(page.locator("#stopped-words")).to_have_text("Stopped.")
    assert plant.orders("stop_all")


def test_stop_works_without_javascript(plant: Plant, opened: Opened) -> None:
    watching = opened(T2)
    browser = watching.context.browser
    assert browser is not None
    plain = browser.new_context(java_script_enabled=False)
    page = plain.new_page()
    page.goto(plant.url + T2)
    page.locator("#stop-key").click()
    page.wait_for_load_state()
    assert page.url == plant.url + T2
    assert len(plant.orders("stop")) == 1
    plain.close()


@pytest.mark.fault(62)
def test_stop_on_eight_tabs_is_still_at_once(opened: Opened, plant: Plant, fault: FaultResult) -> None:
    pages = [opened(T2) for _ in range(8)]
    took_ms = pages[-1].evaluate(
        """async () => { const begun = performance.now();
        const press = new PointerEvent('pointerdown', {cancelable: true});
        document.getElementById('stop-key').dispatchEvent(press);
        const words = document.getElementById('stopped-words');
        while (!words.textContent) await new Promise(requestAnimationFrame);
        return performance.now() - begun; }"""
    )
    assert plant.orders("stop")
    assert took_ms < 1000
    fault.noticed(took_ms / 1000.0, REAL)
    fault.shows(pages[-1].locator("#stopped-words").inner_text())
    fault.recovers("nothing was lost")


def lose_machine(plant: Plant) -> None:
    plant.do(plant.machine.cut)


def test_lost_machine_is_seen_within_two_seconds(opened: Opened, plant: Plant) -> None:
    page = opened(LIVE)
    lose_machine(plant)
    expect(page.locator("#link-banner")).to_be_visible(timeout=2000)
    expect(page.locator("#link-banner")).to_contain_text("controller service does not answer")
    expect(page.locator("#link-banner-advice")).to_contain_text("tracking and stowing may have stopped")
    expect(page.locator('[data-action="track"]')).to_be_disabled()
    value = page.locator('[data-live="measured.azimuth_deg"]').first
    assert value.evaluate("e => getComputedStyle(e).fontStyle") == "italic"


def freeze(page: Page) -> None:
    """Let the socket fall silent without closing it, as a tablet that leaves the Wi-Fi."""
    page.route_web_socket("**/live*", lambda route: None)


def test_silent_socket_is_seen_within_two_seconds(opened: Opened, plant: Plant) -> None:
    page = opened(LIVE, allow=LINK_ERRORS)
    freeze(page)
    page.reload()
    expect(page.locator("#link-banner")).to_be_visible(timeout=2500)
    expect(page.locator("#link-banner-advice")).to_contain_text("do not need this connection")
    expect(page.locator('[data-action="track"]')).to_be_disabled()


def test_nothing_is_sent_late_after_the_connection_returns(opened: Opened, plant: Plant) -> None:
    page = opened("/trackers/T1/commissioning/homing", allow=LINK_ERRORS)
    lose_machine(plant)
    expect(page.locator("#link-banner")).to_be_visible(timeout=2000)
    before = len(plant.machine.orders)
    touched = {"pointerId": 1, "isPrimary": True}
    page.locator('[data-jog="azimuth"][data-direction="1"]').dispatch_event("pointerdown", touched)
    page.evaluate("document.querySelector('form[action$=\"/zero\"]').requestSubmit()")
    page.wait_for_timeout(300)
    plant.do(lambda: setattr(plant.machine, "reachable", True))
    page.wait_for_selector(PAGE_READY)
    page.wait_for_timeout(500)
    assert [order.command.kind for order in plant.machine.orders[before:]] == []
    expect(page.locator("#link-banner")).to_be_hidden()


def test_values_follow_the_machine(opened: Opened) -> None:
    page = opened(T2)
    clock = page.locator('.header-clock [data-live="site.at"]')
    before = clock.inner_text()
    page.wait_for_timeout(1300)
    assert clock.inner_text() != before


def test_refused_key_says_every_reason(opened: Opened, plant: Plant) -> None:
    page = opened(LIVE, allow=("409",))
    page.locator('form[action$="/park"]').evaluate("form => form.querySelector('button').disabled = false")
    from_machine = plant.machine.trackers["T1"]
    plant.machine.rejects["park"] = (
        from_machine.snapshot(plant.machine.clock.now(), 0).actions["pause_show"][0],
    )
    page.locator('form[action$="/park"] button').click()
    expect(page.locator('form[action$="/park"] .outcome')).to_contain_text("Not done.")
    expect(page.locator('form[action$="/park"] .outcome')).to_contain_text("Plan a show")
