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
from tests.browser.layout import displaced, faults
from tests.browser.panels import Panels

LOOKED_AT_ALONE = {
    "kiosk", "login-wrong", "users-wrong", "tokens", "kiosk-account", "viewer-settings",
    "problem-403", "problem-404", "problem-422", "trial-over", "languages",
    "location-wrong", "orientation-wrong", "protections-wrong", "horizon-wrong", "network-wrong",
    "trouble-settings", "trouble-protections", "trouble-service", "trouble-training", "trouble-site",
    "trouble-shelved", "lost-overview",
}  # fmt: skip
"""States in which the scripts do nothing that they do not in another one: opened by `make looks`."""
BY_SCRIPTS = {
    "overview", "live", "homing", "settings", "trends", "player", "show-run", "mast",
    "trouble-overview", "trouble-live", "trouble-homing", "trouble-alarms", "lost-live", "settings-wrong",
}  # fmt: skip
"""What scripts go on writing: the stamp of `make looks` says least of these."""

# pvlib 0.16 asks pandas 3.1 for a name that pandas will drop.
pytestmark = pytest.mark.filterwarnings("ignore:DatetimeIndex.dayofyear is deprecated")


@pytest.fixture(scope="module")
def panels(browser: Browser) -> Iterator[Panels]:
    with ExitStack() as stack:
        yield Panels(browser, stack)


@pytest.mark.parametrize("name", [name for name in PAGES | STATES if name not in LOOKED_AT_ALONE])
def test_a_page_is_whole(name: str, panels: Panels) -> None:
    with panels.shown((PAGES | STATES)[name]) as page:
        assert faults(page) + displaced(page) == []
        if name in BY_SCRIPTS:
            assert violations(page, STRUCTURE) == []
