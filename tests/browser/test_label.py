"""The label for the cabinet: title, label, and the button that prints it, in one look."""

import pytest
from playwright.sync_api import expect

from tests.browser.conftest import SIZES, Opened
from tests.browser.layout import page_end

EDGE_PX = 12
LABEL = "/trackers/T1/label"


@pytest.mark.parametrize("size", ["tablet", "phone"])
def test_the_label_is_printed_in_one_look(opened: Opened, size: str) -> None:
    page = opened(LABEL, size)
    expect(page.get_by_text("on the controller's computer only")).to_be_attached()
    for part in ("#heading", ".cabinet-label", "[data-print]"):
        expect(page.locator(part)).to_be_visible()
        box = page.locator(part).bounding_box()
        assert box is not None
        assert box["y"] >= 0
        assert box["x"] + box["width"] <= SIZES[size][0] - EDGE_PX, part
        assert box["y"] + box["height"] <= page_end(page), part
