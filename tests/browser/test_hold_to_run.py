"""Hold-to-run: the axis moves while the key is held, and every way of letting go ends it.

The pages are before the controller itself, all on one clock: a heartbeat every 50 ms, rest after the ramp.
"""

from collections.abc import Callable, Iterator
from datetime import timedelta
from functools import partial
from math import ceil

import pytest
from playwright.sync_api import Browser, CDPSession, Page, expect

from app.tracker.settings.axes import Axis, JogSpeed
from app.tracker.state.snapshot import ActivityName, EventKind
from tests.browser.hands import LINK_MEASURED, middle
from tests.browser.page_clock import BEAT_MS
from tests.browser.site_stage import SiteStage, staged_site
from tests.fault_result import VIRTUAL, FaultResult
from tests.site.plant import FIRST

HOMING = "/trackers/T1/commissioning/homing"
KEY = '[data-jog="azimuth"][data-direction="1"]'
OTHER_KEY = '[data-jog="elevation"][data-direction="1"]'
HELD_MS = 400
LEASE = timedelta(milliseconds=240)
RAMP_MS = 1000 * FIRST.config.azimuth.jog_slow_dps / FIRST.config.azimuth.acceleration_dps2
RAMP_IN_BEATS_MS = BEAT_MS * ceil(RAMP_MS / BEAT_MS)
STILL_MS = 500


@pytest.fixture
def site(browser: Browser) -> Iterator[SiteStage]:
    with staged_site(browser) as found:
        yield found


def opened(site: SiteStage, path: str = HOMING, size: str = "desk", *, touch: bool = False) -> Page:
    """Open a page whose keys may be held: it knows its link, and what the controller allows."""
    page = site.open(path, size, touch=touch)
    site.until(lambda: page.locator(LINK_MEASURED).count() and page.locator(KEY).is_enabled())
    return page


def held(site: SiteStage, page: Page, begin: Callable[[], object]) -> str:
    """Hold a key: a heartbeat every 50 ms, and the axis turns. Return the name of the press."""
    before = len(site.plant.orders("jog"))
    begin()
    page.wait_for_selector(f"{KEY}[data-held]")
    site.advance(HELD_MS)
    beats = site.plant.orders("jog")[before:]
    assert [one.sequence for one in beats] == list(range(1 + HELD_MS // BEAT_MS))
    assert len({one.press_id for one in beats}) == 1
    assert site.tracker.activity is ActivityName.JOGGING
    assert site.speed_dps == pytest.approx(FIRST.config.azimuth.jog_slow_dps)
    return str(beats[-1].press_id)


def let_go(page: Page, way: Callable[[], object]) -> None:
    """Do something that ends a press, and return once the page knows it."""
    way()
    page.wait_for_selector(f"{KEY}:not([data-held])")


def rests(site: SiteStage, press: str, way: str, outcome: str = "released") -> None:
    """The press ended at this instant: not one heartbeat more, the axis ramps down, and stands."""
    site.settle()
    assert site.happened(EventKind.JOG_ENDED)[-1].data["outcome"] == outcome, way
    assert site.happened(EventKind.JOG_ENDED)[-1].at == site.clock.now(), way
    assert press in {order.press_id for order in site.plant.orders("end_jog")}, way
    sent = len(site.plant.orders("jog"))
    assert site.until(lambda: site.speed_dps == 0.0) == RAMP_IN_BEATS_MS, way
    site.advance(STILL_MS)
    assert site.tracker.activity is ActivityName.HOLDING, way
    assert (site.speed_dps, len(site.plant.orders("jog"))) == (0.0, sent), way


def press_mouse(page: Page) -> None:
    page.mouse.move(*middle(page.locator(KEY)))
    page.mouse.down()


HIDE = (
    "Object.defineProperty(document, 'hidden', {value: true}); "
    "document.dispatchEvent(new Event('visibilitychange'))"
)
GOES_AWAY = (
    "dispatchEvent(new Event('blur'))",
    "dispatchEvent(new Event('orientationchange'))",
    HIDE,
    "dispatchEvent(new Event('pagehide'))",
)


@pytest.mark.fault(58)
def test_window_that_goes_away_ends_it(site: SiteStage, fault: FaultResult) -> None:
    page = opened(site)
    press = held(site, page, lambda: press_mouse(page))
    let_go(page, page.mouse.up)
    rests(site, press, "mouse up")
    orders = site.plant.orders("jog")
    assert {(one.axis, one.direction, one.speed) for one in orders} == {(Axis.AZIMUTH, 1, JogSpeed.SLOW)}
    for event in GOES_AWAY:
        press = held(site, page, lambda: press_mouse(page))
        let_go(page, lambda event=event: page.evaluate(f"() => {{ {event} }}"))
        rests(site, press, event)
        page.mouse.up()
    fault.prevented("the page ends the jog; without a word of it the lease does")
    fault.shows_nothing("the button is not held any more")


def test_keyboard_holds_and_lets_go(site: SiteStage) -> None:
    page = opened(site)
    keys = page.keyboard
    for key, way in ((" ", keys.up), ("Enter", keys.up), (" ", lambda _: keys.press("Tab"))):
        page.locator(KEY).focus()
        press = held(site, page, partial(keys.down, key))
        let_go(page, partial(way, key))
        rests(site, press, f"{key!r} {way}")
        keys.up(key)
    page.locator(KEY).focus()
    press = held(site, page, partial(keys.down, " "))
    let_go(page, partial(keys.press, "Escape"))
    rests(site, press, "STOP", "interrupted")
    assert site.plant.orders("stop")


def touch(session: CDPSession, kind: str, *points: tuple[float, float]) -> None:
    fingers = [{"x": x, "y": y, "id": number} for number, (x, y) in enumerate(points)]
    session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": fingers})


@pytest.mark.fault(58)
def test_small_drift_keeps_the_hold_and_sliding_off_ends_it(site: SiteStage, fault: FaultResult) -> None:
    page = opened(site, "/trackers/T1/mast", "tablet", touch=True)
    session, (x, y) = page.context.new_cdp_session(page), middle(page.locator(KEY))

    def put_down() -> None:
        touch(session, "touchStart", (x, y))

    press = held(site, page, put_down)
    touch(session, "touchMove", (x + 20, y + 20))
    before = len(site.plant.orders("jog"))
    site.advance(300)
    assert len(site.plant.orders("jog")) == before + 300 // BEAT_MS
    let_go(page, partial(touch, session, "touchMove", (x, y - 220)))
    rests(site, press, "slid off")
    expect(page.locator("#jog-words")).to_have_text("The finger slid off the button.")
    touch(session, "touchEnd")
    press = held(site, page, put_down)
    fault.recovers("the button is pressed again")
    let_go(page, partial(touch, session, "touchStart", (x, y), middle(page.locator(OTHER_KEY))))
    rests(site, press, "second finger")
    expect(page.locator("#jog-words")).to_have_text("A second finger touched the screen.")
    touch(session, "touchEnd")
    for way in ("touchEnd", "touchCancel"):
        press = held(site, page, put_down)
        let_go(page, partial(touch, session, way))
        rests(site, press, way)


@pytest.mark.fault(57)
def test_closed_tab_ends_it(site: SiteStage) -> None:
    page = opened(site)
    press = held(site, page, lambda: press_mouse(page))
    page.route("**/end-jog", lambda route: route.abort())
    page.evaluate("tap.freeze()")
    site.leave(page)
    rests(site, press, "closed without a word")


@pytest.mark.fault(57)
@pytest.mark.parametrize("why", ["blocked", "silent"])
def test_blocked_page_sends_nothing_late(why: str, site: SiteStage, fault: FaultResult) -> None:
    """A page whose scripts stand, or whose network is gone: the lease ends, and nothing counts afterwards."""
    page = opened(site)
    held(site, page, lambda: press_mouse(page))
    begun, sent = site.clock.now(), len(site.plant.orders("jog"))
    if why == "blocked":
        site.block(page, 800)
    else:
        page.evaluate("tap.freeze()")
        site.advance(800)
        page.evaluate("tap.thaw()")
        site.settle()
    (ended,) = site.happened(EventKind.JOG_ENDED)
    assert (ended.at - begun, ended.data["outcome"]) == (LEASE, "expired")
    fault.noticed((ended.at - begun).total_seconds(), VIRTUAL)
    fault.prevented("the lease ends without a renewal; benchmarks say when the axis was told")
    page.mouse.up()
    site.advance(STILL_MS)
    expect(page.locator("#jog-words")).to_contain_text("was not renewed in time")
    assert (site.speed_dps, len(site.plant.orders("jog"))) == (0.0, sent)
    assert len(site.happened(EventKind.JOG_STARTED)) == 1
    site.until(lambda: page.locator(LINK_MEASURED).count())
    press = held(site, page, lambda: press_mouse(page))
    fault.recovers("the button is pressed again")
    let_go(page, page.mouse.up)
    rests(site, press, "pressed again")


def test_a_link_that_is_too_slow_begins_nothing(site: SiteStage) -> None:
    page = opened(site)
    page.evaluate("tap.delay(150)")
    site.until(lambda: page.locator('#link-quality[data-level="3"]').count())
    expect(page.locator("#round-trip")).to_have_text("300 ms")
    expect(page.locator("#link-verdict")).to_contain_text("Connection too slow for hold-to-run")
    press_mouse(page)
    site.advance(HELD_MS)
    assert site.plant.orders("jog") == []
    expect(page.locator("#jog-words")).to_contain_text("The connection is too slow for hold-to-run.")
    page.mouse.up()
