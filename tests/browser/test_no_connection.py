"""Without a connection: STOP says in red that it was not sent, nothing held moves, nothing says "good"."""

import pytest
from playwright.sync_api import Locator, Page, Route, WebSocketRoute, expect

from app.tracker.state.snapshot import Event, EventKind
from app.web.languages.catalogue import catalogue_of
from app.web.languages.known import LANGUAGES
from tests.browser.conftest import SIZES, Opened, Plant
from tests.browser.hands import LINK_MEASURED, until
from tests.browser.layout import page_end
from tests.e2e.chromium import PAGE_READY
from tests.fake_alarms import alarm

HOMING = "/trackers/T1/commissioning/homing"
LINK_ERRORS = ("WebSocket connection", "Failed to load resource", "ERR_")
NOT_SENT = "STOP was not sent: no connection. Use the emergency stop at the cabinet."
NOT_CONFIRMED = "STOP was not confirmed. Use the emergency stop at the cabinet."
NOT_POSSIBLE = "Stop not possible: use the emergency stop"
JOG = '[data-jog="azimuth"][data-direction="1"]'
RED = "rgb(200, 16, 46)"
SEEN = "all => all.map((e) => e.checkVisibility())"
STYLE = "(e, name) => getComputedStyle(e)[name]"


def lose(page: Page, plant: Plant) -> None:
    plant.do(plant.machine.cut)
    page.wait_for_selector('html[data-link="lost"]')


def cut_network(page: Page) -> None:
    """Take the network from a page that is open: its socket closes, what it sends does not leave."""
    page.context.set_offline(True)
    page.wait_for_selector('html[data-link="stale"]', timeout=10_000)


def box(thing: Locator) -> dict[str, float]:
    found = thing.bounding_box()
    assert found is not None
    return dict(found)


def touch(key: Locator) -> None:
    """Press a key where it is; Playwright's own click may scroll the page first."""
    where = box(key)
    key.page.mouse.click(where["x"] + where["width"] / 2, where["y"] + where["height"] / 2)


@pytest.mark.parametrize("theme", ["day", "sun", "night"])
@pytest.mark.parametrize("size", ["tablet", "phone"])
def test_stop_without_a_controller_is_told_in_red_at_the_button(
    size: str, theme: str, opened: Opened, plant: Plant
) -> None:
    page = opened(HOMING, size, theme=theme, allow=LINK_ERRORS)
    page.wait_for_selector(LINK_MEASURED)
    stop, before = page.locator("#stop-key"), box(page.locator("#stop-key"))
    black = stop.evaluate(STYLE, "backgroundColor")
    lose(page, plant)
    expect(stop.get_by_text(NOT_POSSIBLE)).to_be_visible()
    expect(stop.get_by_text("STOP motion")).to_be_hidden()
    assert stop.evaluate(STYLE, "backgroundColor") != black
    jog = box(page.locator(JOG))
    touch(stop)
    told = page.locator("#stop-answer")
    expect(told).to_be_visible()
    expect(page.locator("#stop-failed")).to_have_text(NOT_SENT)
    assert told.evaluate(STYLE, "backgroundColor") == RED
    shown, beside = box(told), 84 + 140 if size == "tablet" else 0
    assert (shown["x"], shown["width"]) == (84 if size == "tablet" else 0, SIZES[size][0] - beside)
    assert abs(shown["y"] + shown["height"] - page_end(page)) <= 4
    assert (box(stop), box(page.locator(JOG))) == (before, jog)
    page.locator("#stop-answer-close").click()
    expect(told).to_be_hidden()


def test_what_was_closed_is_not_told_again_when_the_other_way_fails_too(opened: Opened, plant: Plant) -> None:
    page = opened("/trackers/T2", "tablet", allow=LINK_ERRORS)
    waiting: list[Route] = []
    page.route("**/stop?*", lambda route: waiting.append(route))
    lose(page, plant)
    touch(page.locator("#stop-key"))
    expect(page.locator("#stop-answer")).to_be_visible()
    page.locator("#stop-answer-close").click()
    with page.expect_event("requestfailed"):
        waiting[0].abort()
    page.evaluate("new Promise((done) => setTimeout(done))")
    expect(page.locator("#stop-answer")).to_be_hidden()
    page.wait_for_selector("#stop-key:not([data-pressed])")
    touch(page.locator("#stop-key"))
    expect(page.locator("#stop-answer")).to_be_visible()


def test_stop_without_a_network_is_told_at_once(opened: Opened) -> None:
    page = opened("/trackers/T2", "tablet", allow=LINK_ERRORS)
    cut_network(page)
    page.locator("#stop-key").click()
    expect(page.locator("#stop-failed")).to_have_text(NOT_SENT, timeout=500)
    expect(page.locator("#stopped-words")).to_have_text(NOT_SENT)
    page.context.set_offline(False)


def test_stop_that_nobody_confirms_in_time_is_told_until_it_is_confirmed(opened: Opened) -> None:
    page = opened("/trackers/T2", "tablet")
    waiting: list[Route] = []

    def silent(socket: WebSocketRoute) -> None:
        server = socket.connect_to_server()
        socket.on_message(lambda text: None if '"stop"' in str(text) else server.send(text))

    page.route_web_socket("**/live*", silent)
    page.reload()
    page.wait_for_selector(PAGE_READY)
    page.route("**/stop?*", lambda route: waiting.append(route))
    page.locator("#stop-key").click()
    expect(page.locator("#stop-failed")).to_have_text(NOT_CONFIRMED, timeout=2500)
    expect(page.locator("#stop-answer")).to_be_visible()
    waiting[0].continue_()
    expect(page.locator("#stopped-words")).to_have_text("Stopped.")
    expect(page.locator("#stop-answer")).to_be_hidden()


def test_losing_the_connection_moves_nothing_in_any_language(opened: Opened, plant: Plant) -> None:
    for size in ("tablet", "phone"):
        page = opened(HOMING, size, theme="sun", allow=LINK_ERRORS)
        for code in LANGUAGES:
            page.context.add_cookies([{"name": "language", "value": code, "url": plant.url}])
            page.reload()
            page.wait_for_selector(LINK_MEASURED)
            where = [box(key) for key in page.locator("[data-jog]").all()]
            lose(page, plant)
            expect(page.locator("#link-banner")).to_be_visible()
            assert [box(key) for key in page.locator("[data-jog]").all()] == where, (size, code)
            touch(page.locator("#stop-key"))
            expect(page.locator("#stop-failed")).to_have_text(catalogue_of(code).gettext(NOT_SENT))
            assert [box(key) for key in page.locator("[data-jog]").all()] == where, (size, code)
            plant.do(lambda: setattr(plant.machine, "reachable", True))
            page.wait_for_selector(PAGE_READY)
        page.context.clear_cookies(name="language")


@pytest.mark.parametrize("size", ["tablet", "phone"])
def test_no_connection_and_alarms_stay_in_sight_below(size: str, opened: Opened, plant: Plant) -> None:
    page = opened("/trackers/T1/settings", size, allow=LINK_ERRORS)
    plant.machine.alarms = (alarm("store_damaged", plant.machine.clock.now(), None),)
    page.wait_for_selector("#alarm-new:not([hidden])")
    page.evaluate("scrollTo(0, 1500)")
    assert box(page.locator("#alarm-strip"))["y"] == 0
    expect(page.locator("#alarm-new")).to_be_in_viewport(ratio=0.9)
    lose(page, plant)
    assert box(page.locator("#link-banner"))["y"] == 0
    expect(page.locator("#link-banner")).to_be_in_viewport(ratio=0.9)
    assert box(page.locator(".header"))["height"] <= 48


def test_nothing_says_that_the_link_is_good_while_there_is_none(opened: Opened, plant: Plant) -> None:
    page = opened(HOMING, "tablet", allow=LINK_ERRORS)
    page.wait_for_selector(LINK_MEASURED)
    arcs = page.locator(".header-link svg")
    assert arcs.evaluate_all(SEEN) == [True, False]
    lose(page, plant)
    expect(page.locator("#link-words-jog")).to_have_text("no connection")
    expect(page.locator("#link-quality")).to_have_attribute("data-level", "0")
    expect(page.locator("#round-trip")).to_have_text("")
    expect(page.locator("#lost-beats")).to_have_text("")
    assert arcs.evaluate_all(SEEN) == [False, True]


def test_what_a_red_banner_says_stays_white_while_it_is_old(opened: Opened, plant: Plant) -> None:
    page = opened("/trackers/T1", "tablet", allow=LINK_ERRORS)
    lose(page, plant)
    words = page.locator("#fault-banner [data-live]").first
    assert words.evaluate(STYLE, "color") == "rgb(255, 255, 255)"


def test_a_jog_that_the_controller_ended_says_why(opened: Opened, plant: Plant) -> None:
    page = opened(HOMING, "tablet")
    page.wait_for_selector(LINK_MEASURED)
    key = page.locator(JOG)
    key.focus()
    page.keyboard.down(" ")
    until(page, lambda: plant.orders("jog"))
    say = "The jog of azimuth ended: the jog command was not renewed in time."
    ended = Event(plant.machine.clock.now(), EventKind.JOG_ENDED, "T1", say, data={"outcome": "expired"})
    plant.do(lambda: plant.machine.emit(ended))
    expect(page.locator("#jog-words")).to_have_text(say)
    page.keyboard.up(" ")
    expect(page.locator("#jog-words")).to_have_text(say)
