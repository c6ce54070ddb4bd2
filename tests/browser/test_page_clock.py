"""The clock of pages: panel and page share each instant, and what one sends the other has at that instant."""

from datetime import timedelta

from tests.browser.page_clock import BEAT_MS, NOON, Stage

HOMING = "/trackers/T1/commissioning/homing"


def test_panel_and_page_show_the_same_instant_always(stage: Stage) -> None:
    page = stage.open(HOMING)
    for ms in (50, 120, 1000):
        stage.advance(ms)
        assert page.evaluate("Date.now()") == round(stage.clock.now().timestamp() * 1000)
    assert stage.clock.now() - NOON == timedelta(milliseconds=BEAT_MS + 50 + 120 + 1000)
    page.reload()
    stage.live(page)
    assert page.evaluate("Date.now()") == round(stage.clock.now().timestamp() * 1000)


def test_what_is_sent_takes_no_time_and_what_is_delayed_takes_that(stage: Stage) -> None:
    page = stage.open(HOMING)
    trip = page.locator("#round-trip")
    assert trip.inner_text() == "1 ms round trip", "no less is ever said"
    page.evaluate("tap.delay(100)")
    stage.advance(1100)
    assert trip.inner_text() == "1 ms round trip", "a ping is on its way"
    stage.advance(BEAT_MS)
    assert trip.inner_text() == "200 ms round trip"
