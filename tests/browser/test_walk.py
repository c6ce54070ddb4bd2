"""A technician walks the five steps on the real service, with every hand."""

from collections.abc import Callable

import pytest
from playwright.sync_api import Page, expect

from tests.browser.conftest import SIZES
from tests.browser.hands import Finger, Hands, Keyboard, Mouse
from tests.browser.walking import Picture, Walker, commission, rooms, service, walker
from tests.soak import amount

__all__ = ["rooms", "service", "walker"]
EVERY = [(hand, size) for hand in ("mouse", "finger", "keyboard") for size in SIZES]
WALKED = amount([("mouse", "desk"), ("finger", "tablet"), ("finger", "phone"), ("keyboard", "desk")], EVERY)
"""What people have before them; `make soak` walks with every hand on every screen."""
HANDS: dict[str, Callable[[Page], Hands]] = {"mouse": Mouse, "finger": Finger, "keyboard": Keyboard}


@pytest.mark.parametrize(("hand", "size"), WALKED)
def test_five_steps(hand: str, size: str, walker: Walker, service: str, picture: Picture) -> None:
    page = walker(size, hand)
    commission(page, HANDS[hand](page), service, f"{hand}-{size}")
    picture(page, f"walk-{hand}-{size}")
    HANDS[hand](page).press(page.locator("#stop-key"))
    expect(page.locator(".strip-activity")).to_contain_text("Holding")
