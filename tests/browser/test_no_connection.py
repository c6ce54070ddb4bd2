"""Without a connection: STOP says in red that it was not sent, nothing says "good"."""

import pytest
from playwright.sync_api import Locator, Page, Route, expect

from app.web.languages.catalogue import catalogue_of
from app.web.languages.known import LANGUAGES
from tests.browser.conftest import SIZES
from tests.browser.hands import LINK_MEASURED
from tests.browser.layout import page_end
from tests.browser.page_clock import BEAT_MS, Stage
from tests.fake_alarms import alarm

HOMING = "/trackers/T1/commissioning/homing"
LINK_ERRORS = ("WebSocket connection", "Failed to load resource", "ERR_")
NOT_SENT = "STOP was not sent: no connection. Use the emergency stop at the cabinet."
NOT_CONFIRMED = "STOP was not confirmed. Use the emergency stop at the cabinet."
NOT_POSSIBLE = "Stop not possible: use the emergency stop"
CONFIRMED_WITHIN_MS = 1500
LONGEST = max(LANGUAGES, key=lambda code: len(catalogue_of(code).gettext(NOT_SENT)))
RED = "rgb(200, 16, 46)"
SEEN = "all => all.map((e) => e.checkVisibility())"
STYLE = "(e, name) => getComputedStyle(e)[name]"
THEME = "theme => { document.documentElement.dataset.theme = theme; }"


def lose(stage: Stage) -> None:
    stage.do(stage.plant.machine.cut)


def box(thing: Locator) -> dict[str, float]:
    found = thing.bounding_box()
    assert found is not None
    return dict(found)


def boxes(page: Page, selector: str) -> list[dict[str, float]]:
    return [box(one) for one in page.locator(selector).all()]


def touch(stage: Stage, key: Locator) -> None:
    """Press a key where it is; Playwright's own click may scroll the page first."""
    where = box(key)
    key.page.mouse.click(where["x"] + where["width"] / 2, where["y"] + where["height"] / 2)
    stage.settle()


@pytest.mark.parametrize(("size", "language"), [("tablet", LONGEST), ("phone", LONGEST)])
def test_stop_without_a_controller_is_told_in_red_at_the_button_and_moves_nothing(
    size: str, language: str, stage: Stage
) -> None:
    page = stage.open(HOMING, size, language=language, allow=LINK_ERRORS)
    page.wait_for_selector(LINK_MEASURED)
    text = catalogue_of(language).gettext
    stop, told = page.locator("#stop-key"), page.locator("#stop-answer")
    before, keys = box(stop), boxes(page, "[data-jog]")
    black = stop.evaluate(STYLE, "backgroundColor")
    lose(stage)
    assert page.locator("#link-banner").is_visible()
    assert page.locator("#link-quality").get_attribute("data-level") == "0"
    assert page.locator("#round-trip").inner_text() == ""
    assert size == "phone" or page.locator(".header-link svg").evaluate_all(SEEN) == [False, True]
    assert stop.get_by_text(text(NOT_POSSIBLE)).is_visible()
    assert stop.get_by_text(text("STOP motion"), exact=True).is_hidden()
    assert boxes(page, "[data-jog]") == keys
    touch(stage, stop)
    assert page.locator("#stop-failed").inner_text() == text(NOT_SENT)
    for theme in ("day", "sun", "night"):
        page.evaluate(THEME, theme)
        assert stop.evaluate(STYLE, "backgroundColor") != black
        assert told.evaluate(STYLE, "backgroundColor") == RED
    shown, beside = box(told), 84 + 140 if size == "tablet" else 0
    assert (shown["x"], shown["width"]) == (84 if size == "tablet" else 0, SIZES[size][0] - beside)
    assert abs(shown["y"] + shown["height"] - page_end(page)) <= 4
    assert (box(stop), boxes(page, "[data-jog]")) == (before, keys)
    page.locator("#stop-answer-close").click()
    assert told.is_hidden()


def test_stop_without_a_network_is_told_at_once(stage: Stage) -> None:
    page = stage.open("/trackers/T2", "tablet", allow=LINK_ERRORS)
    page.evaluate("tap.silence(true)")
    page.context.set_offline(True)
    stage.until(page.locator('html[data-link="stale"]').count)
    page.locator("#stop-key").click()
    stage.settle()
    assert page.locator("#stop-failed").inner_text() == NOT_SENT
    assert page.locator("#stopped-words").inner_text() == NOT_SENT
    page.context.set_offline(False)


def test_stop_that_nobody_confirms_in_time_is_told_until_it_is_confirmed(stage: Stage) -> None:
    page = stage.open("/trackers/T2", "tablet")
    waiting: list[Route] = []
    page.evaluate("tap.swallow('\"stop\"'); tap.excuse('/stop')")
    page.route("**/stop?*", lambda route: waiting.append(route))
    page.locator("#stop-key").click()
    stage.advance(CONFIRMED_WITHIN_MS - BEAT_MS)
    assert page.locator("#stop-answer").is_hidden()
    stage.advance(BEAT_MS)
    assert page.locator("#stop-failed").inner_text() == NOT_CONFIRMED
    assert page.locator("#stop-answer").is_visible()
    waiting[0].continue_()
    expect(page.locator("#stopped-words")).to_have_text("Stopped.")
    assert page.locator("#stop-answer").is_hidden()


def test_no_connection_and_alarms_stay_in_sight_below(stage: Stage) -> None:
    page = stage.open("/trackers/T1/settings", "phone", allow=LINK_ERRORS)
    stage.plant.machine.alarms = (alarm("drive_lost", stage.clock.now()),)
    stage.until(page.locator('#says[data-priority="2"]').count)
    page.evaluate("scrollTo(0, 1500)")
    assert box(page.locator("#alarm-strip"))["y"] == 0
    expect(page.locator("#says > summary")).to_be_in_viewport(ratio=0.9)
    lose(stage)
    assert box(page.locator("#link-banner"))["y"] == 0
    expect(page.locator("#link-banner")).to_be_in_viewport(ratio=0.9)
    assert box(page.locator(".header"))["height"] <= 48
