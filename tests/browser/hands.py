"""The three ways to use a page: mouse, finger and keyboard, behind one small set of words."""

import re
from collections.abc import Callable
from dataclasses import dataclass

from playwright.sync_api import CDPSession, Locator, Page

from tests.e2e.chromium import PAGE_READY

HOLD_MS = 700
CONFIRM_MS = 2300
"""Longer than what counts only when it is held for 2 s."""
MARGIN_PX = 6
"""Beside everything that can be touched."""
STAYS = """one => {
  for (let up = one; up; up = up.parentElement) if (getComputedStyle(up).position === "fixed") return true;
  return false;
}"""
"""Whether something stands on the screen, wherever the page is scrolled to."""
LINK_MEASURED = '#link-quality:is([data-level="1"], [data-level="2"])'
"""Before a page has measured its link, and while it is too slow, a held key begins nothing."""


def arrive(page: Page, to: str) -> None:
    """Return once the page's address ends like this and its values are live."""
    page.wait_for_url(re.compile(f"{to}$"))
    page.wait_for_selector(PAGE_READY)


def middle(thing: Locator) -> tuple[float, float]:
    thing.scroll_into_view_if_needed()
    box = thing.bounding_box()
    assert box is not None
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2


def confirm(page: Page, key: Locator, passes: Callable[[int], object]) -> None:
    """Hold a key that asks for 2 s, on a page that moves nothing, as long as it takes."""
    page.mouse.move(*middle(key))
    page.mouse.down()
    passes(CONFIRM_MS)
    page.mouse.up()


@dataclass
class Mouse:
    """What a technician does with a page; `passes` lets so many milliseconds pass: `Stage.advance`."""

    page: Page
    passes: Callable[[int], object]

    def press(self, key: Locator) -> None:
        key.click()

    def write(self, field: Locator, text: str) -> None:
        field.fill(text)

    def hold(self, key: Locator, for_ms: int = HOLD_MS) -> None:
        self.page.wait_for_selector(LINK_MEASURED)
        self.page.mouse.move(*middle(key))
        self.page.mouse.down()
        self.passes(for_ms)
        self.page.mouse.up()


Hands = Mouse


class Finger(Mouse):
    def press(self, key: Locator) -> None:
        key.tap()

    def hold(self, key: Locator, for_ms: int = HOLD_MS) -> None:
        self.page.wait_for_selector(LINK_MEASURED)
        session = self.page.context.new_cdp_session(self.page)
        self._swipe_to(key, session)
        x, y = middle(key)
        point = {"x": x, "y": y, "id": 0}
        session.send("Input.dispatchTouchEvent", {"type": "touchStart", "touchPoints": [point]})
        self.passes(for_ms)
        session.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})

    def _swipe_to(self, key: Locator, session: CDPSession) -> None:
        """Bring a key to the middle of the screen as a hand does, by a swipe that the page knows."""
        box, size = key.bounding_box(), self.page.viewport_size
        assert box is not None
        assert size is not None
        away = size["height"] / 2 - box["y"] - box["height"] / 2
        if abs(away) > size["height"] / 4 and not key.evaluate(STAYS):
            swipe = {"x": MARGIN_PX, "y": size["height"] / 2, "yDistance": away, "speed": 4000}
            session.send(
                "Input.synthesizeScrollGesture",
                {**swipe, "gestureSourceType": "touch", "preventFling": True},
            )


class Keyboard(Mouse):
    def press(self, key: Locator) -> None:
        key.focus()
        self.page.keyboard.press("Enter")

    def hold(self, key: Locator, for_ms: int = HOLD_MS) -> None:
        self.page.wait_for_selector(LINK_MEASURED)
        key.focus()
        self.page.keyboard.down(" ")
        self.passes(for_ms)
        self.page.keyboard.up(" ")


def signed(page: Page) -> str:
    """Draw a line as the technician's signature and return what the form keeps of it."""
    pad = page.locator('[data-sign-pad="technician"]')
    pad.scroll_into_view_if_needed()
    box = pad.bounding_box()
    assert box is not None
    page.mouse.move(box["x"] + 20, box["y"] + 20)
    page.mouse.down()
    page.mouse.move(box["x"] + 120, box["y"] + 60, steps=5)
    page.mouse.up()
    return page.locator('[name="technician_drawn"]').input_value()
