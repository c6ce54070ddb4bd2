"""A key that is held stays under the finger, whatever appears or goes above it."""

from collections.abc import Callable

import pytest
from playwright.sync_api import Browser, Page

from tests.browser.conftest import SIZES, Opened
from tests.browser.hands import LINK_MEASURED, until
from tests.browser.walking import service

__all__ = ["service"]
KEY = '[data-jog="azimuth"][data-direction="1"]'
HELD = f"{KEY}[data-held]"
HOMING = "/trackers/T1/commissioning/homing"
PROOFS = "/trackers/T1/proofs"
NOTICE = "#step-reasons"
WATCH = """(key) => {
  const [button, content] = [document.querySelector(key), document.getElementById("content")];
  const above = () => button.closest(".columns").getBoundingClientRect().top + scrollY
    - parseFloat(getComputedStyle(content).marginTop);
  window.seen = { tops: [], above: [above()] };
  const look = () => {
    seen.tops.push(button.getBoundingClientRect().top);
    seen.above.push(above());
    requestAnimationFrame(look);
  };
  // Begun after the page's own watch, so that it looks at what is painted.
  button.addEventListener("pointerdown", () => requestAnimationFrame(look), { once: true });
}"""
ADD_NOTICE = """document.getElementById("steps").insertAdjacentHTML(
  "beforeend", '<div class="step-open" id="step-reasons"><p>A doubt that the movement settles.</p></div>')"""
"""The steps are asked for again as soon as the axis moves, and this is not among what comes."""
Meanwhile = Callable[[Page], None]


def held_still(page: Page, meanwhile: Meanwhile, after: Meanwhile) -> tuple[float, float]:
    """Hold a key and return how far it moved on the screen and how far on the page, pixels."""
    page.wait_for_selector(LINK_MEASURED)
    key = page.locator(KEY)
    key.scroll_into_view_if_needed()
    box = key.bounding_box()
    assert box is not None
    page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    page.evaluate(WATCH, KEY)
    page.mouse.down()
    page.wait_for_selector(HELD)
    meanwhile(page)
    page.mouse.up()
    after(page)
    seen = page.evaluate("seen")
    on_screen = max(abs(top - box["y"]) for top in seen["tops"])
    return on_screen, max(seen["above"]) - min(seen["above"])


@pytest.mark.parametrize("size", ["tablet", "phone"])
def test_a_notice_that_goes_does_not_move_the_key(size: str, opened: Opened) -> None:
    page = opened(HOMING, size)
    page.evaluate(ADD_NOTICE)

    def gone(page: Page) -> None:
        page.wait_for_selector(NOTICE, state="detached")

    def rest(page: Page) -> None:
        page.wait_for_selector(HELD, state="detached")

    on_screen, on_page = held_still(page, gone, rest)
    assert on_page > 20
    assert on_screen < 1


@pytest.mark.parametrize("size", ["tablet", "phone"])
def test_reasons_that_come_above_the_keys_do_not_move_them(size: str, browser: Browser, service: str) -> None:
    width, height = SIZES[size]
    page = browser.new_page(viewport={"width": width, "height": height})
    page.goto(service + PROOFS)
    reasons = page.locator('[data-reasons="measure_stop"] li')

    def moving(page: Page) -> None:
        until(page, lambda: page.locator(".strip-activity", has_text="Jogging").count())
        until(page, lambda: reasons.count() > 0)

    def resting(page: Page) -> None:
        until(page, lambda: page.locator(".strip-activity", has_text="Holding").count())

    on_screen, on_page = held_still(page, moving, resting)
    page.close()
    assert on_page > 20
    assert on_screen < 1


def test_on_a_tablet_all_keys_stand_above_the_footer_below_a_notice_too(opened: Opened) -> None:
    page = opened(HOMING, "tablet")
    page.evaluate(ADD_NOTICE)
    footer = page.locator(".footer").bounding_box()
    boxes = [key.bounding_box() for key in page.locator("[data-jog]").all()]
    assert footer is not None
    assert len(boxes) == 4
    assert all(box is not None and box["y"] + box["height"] <= footer["y"] for box in boxes)
