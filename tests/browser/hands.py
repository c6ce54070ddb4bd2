"""The three ways to use a page: mouse, finger and keyboard, behind one small set of words."""

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from playwright.sync_api import CDPSession, Locator, Page, TimeoutError

from tests.e2e.chromium import PAGE_READY

HOLD_MS = 700
CONFIRM_MS = 2300
"""Longer than what counts only when it is held for 2 s."""
LOOK_EVERY_MS = 50
MARGIN_PX = 6
"""Beside everything that can be touched."""
LINK_MEASURED = '#link-quality:is([data-level="1"], [data-level="2"])'
"""Before a page has measured its link, and while it is too slow, a held key begins nothing."""
TOLD = '[role="alert"], .reasons, .field-error, .outcome, .kept-note, #link-words, #place-doubts, h1'
"""Where a page says how things stand, and why something is refused."""


Passes = Callable[[int], object]
"""Lets so many milliseconds pass while a key is held: `Stage.advance`; without one the computer's does."""


class Hands(Protocol):
    """What a technician does with a page."""

    def press(self, key: Locator) -> None: ...
    def choose(self, radio: Locator) -> None: ...
    def write(self, field: Locator, text: str) -> None: ...
    def hold(self, key: Locator, for_ms: int = HOLD_MS) -> None: ...


def shown(page: Page) -> str:
    """Return what a page says now: its address, what has the focus, every refusal that is seen."""
    said = [
        text for one in page.locator(TOLD).all() if one.is_visible() and (text := one.inner_text().strip())
    ]
    focus = page.evaluate("document.activeElement?.outerHTML.slice(0, 160)")
    return f"{page.url} shows {[text for text in said if text]}; the focus is on {focus}"


def arrive(page: Page, to: str) -> None:
    """Return once the page's address ends like this and its values are live, or fail with what it shows."""
    try:
        page.wait_for_url(re.compile(f"{to}$"))
        page.wait_for_selector(PAGE_READY)
    except TimeoutError as error:
        raise AssertionError(f"The page did not come to {to}: {shown(page)}.") from error


def until(page: Page, reached: Callable[[], object], *, within_ms: int = 12_000) -> None:
    """Return once something is so, or fail; the page goes on meanwhile."""
    for _ in range(within_ms // LOOK_EVERY_MS):
        if reached():
            return
        page.wait_for_timeout(LOOK_EVERY_MS)
    raise AssertionError("It did not become so in time.")


def middle(thing: Locator) -> tuple[float, float]:
    thing.scroll_into_view_if_needed()
    box = thing.bounding_box()
    assert box is not None
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2


@dataclass
class Mouse:
    page: Page
    passes: Passes | None = None

    def press(self, key: Locator) -> None:
        key.click()

    def choose(self, radio: Locator) -> None:
        radio.check()

    def write(self, field: Locator, text: str) -> None:
        field.click()
        field.fill(text)

    def hold(self, key: Locator, for_ms: int = HOLD_MS) -> None:
        self.page.wait_for_selector(LINK_MEASURED)
        self.page.mouse.move(*middle(key))
        self.page.mouse.down()
        (self.passes or self.page.wait_for_timeout)(for_ms)
        self.page.mouse.up()


@dataclass
class Finger:
    page: Page
    passes: Passes | None = None

    def press(self, key: Locator) -> None:
        key.tap()

    def choose(self, radio: Locator) -> None:
        radio.tap()

    def write(self, field: Locator, text: str) -> None:
        field.tap()
        field.fill(text)

    def hold(self, key: Locator, for_ms: int = HOLD_MS) -> None:
        self.page.wait_for_selector(LINK_MEASURED)
        session = self.page.context.new_cdp_session(self.page)
        self._swipe_to(key, session)
        x, y = middle(key)
        point = {"x": x, "y": y, "id": 0}
        session.send("Input.dispatchTouchEvent", {"type": "touchStart", "touchPoints": [point]})
        (self.passes or self.page.wait_for_timeout)(for_ms)
        session.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})

    def _swipe_to(self, key: Locator, session: CDPSession) -> None:
        """Bring a key to the middle of the screen as a hand does, by a swipe that the page knows."""
        box, size = key.bounding_box(), self.page.viewport_size
        assert box is not None
        assert size is not None
        away = size["height"] / 2 - box["y"] - box["height"] / 2
        if abs(away) > size["height"] / 4:
            swipe = {"x": MARGIN_PX, "y": size["height"] / 2, "yDistance": away, "speed": 4000}
            session.send(
                "Input.synthesizeScrollGesture",
                {**swipe, "gestureSourceType": "touch", "preventFling": True},
            )


@dataclass
class Keyboard:
    page: Page
    passes: Passes | None = None

    def press(self, key: Locator) -> None:
        key.focus()
        self.page.keyboard.press("Enter")

    def choose(self, radio: Locator) -> None:
        radio.focus()
        self.page.keyboard.press(" ")

    def write(self, field: Locator, text: str) -> None:
        field.focus()
        self.page.keyboard.press("Control+A")
        self.page.keyboard.type(text)

    def hold(self, key: Locator, for_ms: int = HOLD_MS) -> None:
        self.page.wait_for_selector(LINK_MEASURED)
        key.focus()
        self.page.keyboard.down(" ")
        (self.passes or self.page.wait_for_timeout)(for_ms)
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
