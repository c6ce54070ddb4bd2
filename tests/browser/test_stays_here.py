"""The browser that tests drive calls nobody but this computer."""

from contextlib import closing

import pytest
from playwright.sync_api import Browser, Error


@pytest.mark.parametrize("address", ["http://192.0.2.1/", "http://heliopanel.example/"])
def test_the_browser_calls_no_other_computer(browser: Browser, address: str) -> None:
    with closing(browser.new_page()) as page, pytest.raises(Error, match="ERR_NAME_NOT_RESOLVED"):
        page.goto(address)
