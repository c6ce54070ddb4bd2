"""*Set as zero* is held for 2 s, asks where the drive reads another angle, and is undone."""

import pytest
from playwright.sync_api import Page, expect

from app.tracker.commands import SetZero
from tests.browser.conftest import Opened, Plant
from tests.browser.hands import CONFIRM_MS, LINK_MEASURED, Finger, Hands, Keyboard, Mouse

HOMING = "/trackers/T1/commissioning/homing"
SET = '[data-action="zero"][data-after-jog]'
SURE = '[name="confirmed"]'
HANDS: dict[str, type[Hands]] = {"mouse": Mouse, "finger": Finger, "keyboard": Keyboard}


def zeros(plant: Plant) -> int:
    return len([order for order in plant.machine.orders if isinstance(order.command, SetZero)])


@pytest.mark.parametrize("hand", list(HANDS))
def test_it_is_held_asked_about_and_undone(hand: str, opened: Opened, plant: Plant) -> None:
    page = opened(HOMING, "phone" if hand == "finger" else "tablet", touch=hand == "finger", allow=("422",))
    hands = HANDS[hand](page)  # type: ignore[call-arg]
    page.wait_for_selector(LINK_MEASURED)
    hands.hold(page.locator(SET), 800)
    expect(page.locator(SURE)).to_have_count(0)
    hands.hold(page.locator(SET), CONFIRM_MS)
    expect(page.locator(".ask-zero")).to_contain_text("The measured azimuth is 180.0°")
    assert zeros(plant) == 0
    hands.hold(page.locator(SURE), 800)
    page.wait_for_timeout(300)
    assert zeros(plant) == 0
    hands.hold(page.locator(SURE), CONFIRM_MS)
    expect(page.locator('form[action$="/zero"] .outcome-ok')).to_be_visible()
    assert zeros(plant) == 1
    undo = page.locator('form[action$="/zero/undo"] button')
    expect(undo).to_be_visible()
    Keyboard(page).press(undo)
    expect(page.locator('[data-live="measured.azimuth_deg"]').first).to_have_text("180.00°")


def test_it_is_blue_only_after_a_movement_by_hand(opened: Opened) -> None:
    page = opened(HOMING, "tablet")
    page.wait_for_selector(LINK_MEASURED)
    assert not is_blue(page)
    Mouse(page).hold(page.locator('[data-jog="azimuth"][data-direction="1"]'))
    expect(page.locator(f"{SET}.key-primary")).to_be_visible()
    assert is_blue(page)


def is_blue(page: Page) -> bool:
    return bool(page.locator(SET).evaluate("e => e.classList.contains('key-primary')"))
