"""Hold-to-run: the axis moves while the key is held, and every way of letting go ends it."""

from collections.abc import Callable, Iterator

import pytest
from playwright.sync_api import CDPSession, Page

from app.tracker.settings.axes import Axis, JogSpeed
from app.tracker.state.snapshot import ActivityName
from tests.browser.conftest import Opened, Plant, running
from tests.browser.hands import LINK_MEASURED
from tests.fault_result import FaultResult

HOMING = "/trackers/T1/commissioning/homing"
KEY = '[data-jog="azimuth"][data-direction="1"]'
JOGGING = ActivityName.JOGGING
HOLD_MS = 1500
TRIES = 4
SETTLE_MS = 400


@pytest.fixture(scope="module")
def panel() -> Iterator[Plant]:
    """One panel for all: after each test its axes rest."""
    with running() as served:
        yield served


@pytest.fixture
def plant(panel: Plant) -> Plant:
    """The panel as if nothing had been asked of it yet."""
    panel.machine.orders.clear()
    return panel


def middle(page: Page, selector: str = KEY) -> tuple[float, float]:
    page.locator(selector).scroll_into_view_if_needed()
    box = page.locator(selector).bounding_box()
    assert box is not None
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2


def is_at_rest(plant: Plant, page: Page) -> bool:
    page.wait_for_timeout(SETTLE_MS)
    sent = len(plant.orders("jog"))
    page.wait_for_timeout(SETTLE_MS)
    return len(plant.orders("jog")) == sent and plant.machine.trackers["T1"].activity is ActivityName.HOLDING


def hold(page: Page, plant: Plant, begin: Callable[[], None], release: Callable[[], None]) -> None:
    """Press until the axis moves; a busy computer ends a hold, as it must, and one presses again."""
    page.wait_for_selector(LINK_MEASURED)
    for _ in range(TRIES):
        sent = len(plant.orders("jog"))
        begin()
        for _ in range(HOLD_MS // 50):
            page.wait_for_timeout(50)
            if len(plant.orders("jog")) >= sent + 4 and plant.machine.trackers["T1"].activity is JOGGING:
                return
        release()
        page.wait_for_timeout(SETTLE_MS)
    pytest.fail("The axis never moved while the key was held.")


def hold_with_mouse(page: Page, plant: Plant) -> None:
    page.mouse.move(*middle(page))
    hold(page, plant, page.mouse.down, page.mouse.up)


def hold_with_key(page: Page, plant: Plant, key: str) -> None:
    page.locator(KEY).focus()
    hold(page, plant, lambda: page.keyboard.down(key), lambda: page.keyboard.up(key))


def hold_with_finger(page: Page, plant: Plant) -> tuple[CDPSession, tuple[float, float]]:
    at, session = middle(page), page.context.new_cdp_session(page)
    hold(page, plant, lambda: touch(session, "touchStart", at), lambda: touch(session, "touchEnd"))
    return session, at


@pytest.mark.parametrize("size", ["desk", "tablet", "phone"])
def test_mouse_holds_and_lets_go(size: str, opened: Opened, plant: Plant) -> None:
    page = opened(HOMING, size)
    hold_with_mouse(page, plant)
    page.mouse.up()
    assert is_at_rest(plant, page)
    assert plant.orders("jog")[-1].press_id in {order.press_id for order in plant.orders("end_jog")}


def test_the_page_behind_the_label_holds_and_lets_go(opened: Opened, plant: Plant) -> None:
    page = opened("/trackers/T1/mast", "phone")
    session, _ = hold_with_finger(page, plant)
    touch(session, "touchEnd")
    assert is_at_rest(plant, page)
    assert {(order.axis, order.direction, order.speed) for order in plant.orders("jog")} == {
        (Axis.AZIMUTH, 1, JogSpeed.SLOW)
    }


def test_sequence_grows_with_every_heartbeat(opened: Opened, plant: Plant) -> None:
    page = opened(HOMING)
    hold_with_mouse(page, plant)
    page.mouse.up()
    last = plant.orders("jog")[-1].press_id
    sequences = [order.sequence for order in plant.orders("jog") if order.press_id == last]
    assert sequences == sorted(set(sequences))


def touch(session: CDPSession, kind: str, *points: tuple[float, float]) -> None:
    session.send(
        "Input.dispatchTouchEvent",
        {
            "type": kind,
            "touchPoints": [{"x": x, "y": y, "id": number} for number, (x, y) in enumerate(points)],
        },
    )


@pytest.mark.parametrize("size", ["tablet", "phone"])
@pytest.mark.parametrize("release", ["touchEnd", "touchCancel"])
def test_finger_holds_and_lets_go(size: str, release: str, opened: Opened, plant: Plant) -> None:
    page = opened(HOMING, size, touch=True)
    session, _ = hold_with_finger(page, plant)
    touch(session, release)
    assert is_at_rest(plant, page)


@pytest.mark.fault(58)
def test_small_drift_keeps_the_hold_and_sliding_off_ends_it(
    opened: Opened, plant: Plant, fault: FaultResult
) -> None:
    page = opened(HOMING, "tablet", touch=True)
    session, (x, y) = hold_with_finger(page, plant)
    touch(session, "touchMove", (x + 20, y + 20))
    before = len(plant.orders("jog"))
    page.wait_for_timeout(300)
    assert len(plant.orders("jog")) > before
    touch(session, "touchMove", (x, y - 220))
    assert is_at_rest(plant, page)
    touch(session, "touchEnd")
    hold_with_finger(page, plant)
    fault.recovers("the button is pressed again")


def test_second_finger_ends_it(opened: Opened, plant: Plant) -> None:
    page = opened(HOMING, "tablet", touch=True)
    session, at = hold_with_finger(page, plant)
    touch(session, "touchStart", at, middle(page, '[data-jog="elevation"][data-direction="1"]'))
    assert is_at_rest(plant, page)


@pytest.mark.parametrize("key", [" ", "Enter"])
def test_keyboard_holds_and_lets_go(key: str, opened: Opened, plant: Plant) -> None:
    page = opened(HOMING)
    hold_with_key(page, plant, key)
    page.keyboard.up(key)
    assert is_at_rest(plant, page)


def test_leaving_the_key_by_keyboard_ends_it(opened: Opened, plant: Plant) -> None:
    page = opened(HOMING)
    hold_with_key(page, plant, " ")
    page.keyboard.press("Tab")
    assert is_at_rest(plant, page)


HIDE = (
    "Object.defineProperty(document, 'hidden', {value: true}); "
    "document.dispatchEvent(new Event('visibilitychange'))"
)


@pytest.mark.parametrize(
    "event",
    [
        "dispatchEvent(new Event('blur'))",
        "dispatchEvent(new Event('pagehide'))",
        "dispatchEvent(new Event('orientationchange'))",
        HIDE,
    ],
)
@pytest.mark.fault(58)
def test_window_that_goes_away_ends_it(event: str, opened: Opened, plant: Plant, fault: FaultResult) -> None:
    page = opened(HOMING)
    hold_with_mouse(page, plant)
    page.evaluate(f"() => {{ {event} }}")
    assert is_at_rest(plant, page)
    fault.prevented("the page ends the jog; without a word of it the lease does")
    fault.shows_nothing("the button is not held any more")


@pytest.mark.fault(57)
def test_closed_tab_ends_it(opened: Opened, plant: Plant) -> None:
    watching = opened(HOMING)
    page = opened(HOMING)
    hold_with_mouse(page, plant)
    page.close()
    assert is_at_rest(plant, watching)


@pytest.mark.fault(57)
def test_blocked_page_sends_nothing_late(opened: Opened, plant: Plant, fault: FaultResult) -> None:
    page = opened(HOMING)
    hold_with_mouse(page, plant)
    page.evaluate("() => { const until = performance.now() + 800; while (performance.now() < until); }")
    page.mouse.up()
    assert is_at_rest(plant, page)
    fault.prevented("the lease ends without a renewal; benchmarks say when the axis was told")
    hold_with_mouse(page, plant)
    fault.recovers("the button is pressed again")
    page.mouse.up()


def test_stop_ends_the_press_of_a_held_key(opened: Opened, plant: Plant) -> None:
    page = opened(HOMING)
    hold_with_key(page, plant, " ")
    page.keyboard.press("Escape")
    assert is_at_rest(plant, page)
    assert plant.orders("stop")
    page.keyboard.up(" ")


def test_key_that_may_not_move_says_why(opened: Opened) -> None:
    page = opened("/trackers/T2/commissioning/homing")
    assert page.locator(KEY).is_disabled()
    assert "Stop it first" in page.locator('[data-reasons="jog"]').inner_text()
