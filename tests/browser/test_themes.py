"""The three themes: one tap changes them, every page keeps what was chosen."""

from collections.abc import Callable

import pytest
from playwright.sync_api import Page, expect

from tests.browser.conftest import Opened
from tests.browser.every_page import PAGES

Picture = Callable[[Page, str], None]


@pytest.mark.parametrize("theme", ["sun", "night"])
@pytest.mark.parametrize("name", ["overview", "live", "homing", "show", "player"])
def test_page_in_other_themes(name: str, theme: str, opened: Opened, picture: Picture) -> None:
    page = opened(PAGES[name].path, "tablet", theme=theme)
    picture(page, f"{name}-{theme}")
    assert page.evaluate("document.documentElement.dataset.theme") == theme


def test_theme_changes_at_one_tap_and_stays(opened: Opened) -> None:
    page = opened("/")
    page.locator("#theme-form .theme-key").click()
    expect(page.locator("html")).to_have_attribute("data-theme", "sun")
    page.reload()
    expect(page.locator("html")).to_have_attribute("data-theme", "sun")
