"""A technician walks the five steps on the real service, with every hand on every screen."""

from collections.abc import Callable

import pytest
from playwright.sync_api import Page, expect

from tests.browser.conftest import SIZES
from tests.browser.hands import Finger, Hands, Keyboard, Mouse
from tests.browser.walking import Picture, Walker, commission, rooms, service, walker

__all__ = ["rooms", "service", "walker"]
HANDS: dict[str, Callable[[Page], Hands]] = {"mouse": Mouse, "finger": Finger, "keyboard": Keyboard}


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("hand", HANDS)
def test_five_steps(hand: str, size: str, walker: Walker, service: str, picture: Picture) -> None:
    page = walker(size, hand)
    commission(page, HANDS[hand](page), service, f"{hand}-{size}")
    picture(page, f"walk-{hand}-{size}")
    HANDS[hand](page).press(page.locator("#stop-key"))
    expect(page.locator(".strip-activity")).to_contain_text("Holding")
