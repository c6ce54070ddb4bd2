"""*Set as zero* is held for 2 s, asks where the drive reads another angle, and is undone."""

from dataclasses import replace

import pytest
from playwright.sync_api import Page, expect

from app.tracker.commands.commands import SetHome, UndoHome
from tests.browser.conftest import Opened, Plant
from tests.browser.hands import CONFIRM_MS, LINK_MEASURED, Finger, Hands, Keyboard, Mouse

HOMING = "/trackers/T1/commissioning/homing"
SET = '[data-action="set_home"][data-after-jog]'
SURE = '[name="confirmed"]'
HANDS: dict[str, type[Hands]] = {"mouse": Mouse, "finger": Finger, "keyboard": Keyboard}


def zeros(plant: Plant) -> int:
    return len([order for order in plant.machine.orders if isinstance(order.command, SetHome)])


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
    page.wait_for_timeout(300)
    assert plant.orders("undo_home") == [], "letting go pressed the key that came under the finger"
    Keyboard(page).press(undo)
    expect(page.locator('[data-live="measured.azimuth_deg"]').first).to_have_text("180.00°")


LAMPS = '[data-lamp$=".homed"]'
TOLD = "The command to set home was sent to the drive."


@pytest.mark.parametrize("size", ["tablet", "phone"])
@pytest.mark.parametrize("elsewhere", [False, True], ids=["here", "elsewhere"])
def test_message_and_lamps_follow_when_it_is_undone(
    size: str, elsewhere: bool, opened: Opened, plant: Plant
) -> None:
    tracker = plant.machine.trackers["T1"]
    plant.do(lambda: setattr(tracker, "memory", replace(tracker.memory, home=None)))
    page = opened(HOMING, size, allow=("422",))
    hands = Mouse(page)
    expect(page.locator(f'{LAMPS}[data-on="true"]')).to_have_count(0)
    hands.hold(page.locator(SET), CONFIRM_MS)
    hands.hold(page.locator(SURE), CONFIRM_MS)
    expect(page.locator("#zero-outcome")).to_have_text(TOLD)
    expect(page.locator(f'{LAMPS}[data-on="true"]')).to_have_count(2)
    undo = page.locator('form[action$="/zero/undo"] button')
    expect(undo).to_be_visible()
    if elsewhere:
        now = plant.machine.clock.now()
        plant.do(lambda: tracker.handle(UndoHome(), now, "somebody else"))
        expect(page.locator("#zero-outcome")).to_have_text("")
    else:
        undo.click()
        expect(page.locator("#zero-outcome")).to_have_text("The previous home position is restored.")
        expect(page.locator("#zero-outcome")).to_be_visible()
    expect(page.get_by_text(TOLD)).to_have_count(0)
    expect(page.locator(f'{LAMPS}[data-on="true"]')).to_have_count(0)
    expect(undo).to_be_hidden()


def test_it_is_blue_only_after_a_movement_by_hand(opened: Opened) -> None:
    page = opened(HOMING, "tablet")
    page.wait_for_selector(LINK_MEASURED)
    assert not is_blue(page)
    Mouse(page).hold(page.locator('[data-jog="azimuth"][data-direction="1"]'))
    expect(page.locator(f"{SET}.key-primary")).to_be_visible()
    assert is_blue(page)


def is_blue(page: Page) -> bool:
    return bool(page.locator(SET).evaluate("e => e.classList.contains('key-primary')"))
