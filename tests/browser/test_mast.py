"""The page behind the label: all of it on one screen of a phone, large for gloves."""

import pytest
from playwright.sync_api import Page

from tests.browser.conftest import Opened, Plant, resize
from tests.browser.troubles import trouble

MAST = "/trackers/T1/mast"
LEAST_PX = 112
BETWEEN_BARS = """(names) => {
  const top = document.querySelector(".header").getBoundingClientRect().bottom;
  const below = document.querySelector(".footer").getBoundingClientRect().top;
  const bottom = innerWidth < 900 ? below : innerHeight;
  return [...document.querySelectorAll(names)].map((one) => one.getBoundingClientRect())
    .map((box) => [box.width, box.height, box.top >= top && box.bottom <= bottom]);
}"""


def boxes(page: Page, names: str) -> list[tuple[float, float, bool]]:
    return [tuple(one) for one in page.evaluate(BETWEEN_BARS, names)]


@pytest.mark.parametrize("language", ["en", "de"])
def test_four_buttons_and_two_angles_are_on_one_screen(language: str, opened: Opened) -> None:
    page = opened(MAST, "phone", language=language)
    for size in ("phone", "tablet"):
        resize(page, size)
        buttons, angles = boxes(page, "[data-jog]"), boxes(page, ".mast .value-main")
        assert len(buttons) == 4
        assert len(angles) == 2
        assert all(width >= LEAST_PX and height >= LEAST_PX for width, height, _ in buttons), size
        assert all(inside for _, _, inside in (*buttons, *angles)), size
    page.set_viewport_size({"width": 320, "height": 640})
    assert all(width >= LEAST_PX and height >= LEAST_PX for width, height, _ in boxes(page, "[data-jog]"))


def test_a_button_that_may_not_move_says_why_and_where_it_is_read(plant: Plant, opened: Opened) -> None:
    plant.do(lambda: trouble(plant.machine))
    page = opened("/trackers/T3/mast", "phone")
    page.wait_for_selector("[data-jog]:disabled")
    reasons = page.locator('[data-reasons="jog"]')
    assert reasons.inner_text().strip()
    assert reasons.bounding_box()["y"] < page.locator("[data-jog]").first.bounding_box()["y"]  # type: ignore[index]
