"""Every page, opened once on a phone: whole, where it must be, and without a word in the console.

`make looks` looks at every state of a page, other sizes, languages, and themes, with every rule of axe-core;
tests/web/test_looked_at.py tells whether it has.
"""

from collections.abc import Iterator
from contextlib import ExitStack

import pytest
from playwright.sync_api import Browser

from tests.browser.axe_rules import STRUCTURE, violations
from tests.browser.every_page import PAGES, STATES
from tests.browser.layout import displaced, faults, large_icons, step_faults
from tests.browser.panels import Panels

OPENED_STATES = (
    "account", "kiosk-live", "login", "lost-homing", "lost-live", "problem-409", "problem-503", "prove",
    "restore-damaged", "settings-wrong", "setup", "trial", "trouble-alarms", "trouble-homing", "trouble-live",
    "trouble-overview", "users", "viewer-homing",
)  # fmt: skip
"""States in which scripts do what they do on no other page; the others are opened by `make looks` alone."""

# pvlib 0.16 asks pandas 3.1 for a name that pandas will drop.
pytestmark = pytest.mark.filterwarnings("ignore:DatetimeIndex.dayofyear is deprecated")


@pytest.fixture(scope="module")
def panels(browser: Browser) -> Iterator[Panels]:
    with ExitStack() as stack:
        yield Panels(browser, stack)


@pytest.mark.parametrize("name", [*PAGES, *OPENED_STATES])
def test_a_page_is_whole(name: str, panels: Panels) -> None:
    with panels.shown((PAGES | STATES)[name]) as page:
        assert faults(page) + displaced(page) + large_icons(page) + step_faults(page) == []
        assert violations(page, STRUCTURE) == []
