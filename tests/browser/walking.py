"""The real service, `heliopanel serve` with a simulated tracker, and a technician who walks its steps."""

import re
from collections.abc import Callable, Iterator

import pytest
from playwright.sync_api import Browser, BrowserContext, Locator, Page, expect

from tests.browser.conftest import SIZES, TAKES_PICTURES, WRITES_DOCS
from tests.browser.hands import Hands, arrive
from tests.e2e.product import Product
from tests.patience import PATIENCE_MS

PRESSES = 5
PHOTOGRAPHED = "Applying inline style violates"
"""The browser's remark on the style that Playwright adds while it photographs a page."""
Picture = Callable[[Page, str], None]


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """Run the whole service in a folder of its own and give its address."""
    product = Product.start(tmp_path_factory.mktemp("data"))
    yield product.url
    product.stop()


Walker = Callable[[str, str], Page]


@pytest.fixture(scope="module")
def rooms(browser: Browser) -> Iterator[dict[bool, BrowserContext]]:
    """A browser without and one with a touch screen, which keep what the pages of the service share."""
    contexts = {touch: browser.new_context(has_touch=touch, locale="en-GB") for touch in (False, True)}
    for context in contexts.values():
        context.set_default_timeout(PATIENCE_MS)
    yield contexts
    for context in contexts.values():
        context.close()


@pytest.fixture
def walker(rooms: dict[bool, BrowserContext]) -> Iterator[Walker]:
    """Open an empty page of a size for a hand; nothing may be complained of in its console."""
    complaints: list[str] = []
    pages: list[Page] = []

    def start(size: str, hand: str) -> Page:
        width, height = SIZES[size]
        page = rooms[hand == "finger"].new_page()
        pages.append(page)
        page.set_viewport_size({"width": width, "height": height})
        page.on("console", lambda one: complaints.append(one.text) if one.type == "error" else None)
        page.on("pageerror", lambda error: complaints.append(str(error)))
        return page

    yield start
    for page in pages:
        page.close()
    expected = ["422", *([PHOTOGRAPHED] if TAKES_PICTURES or WRITES_DOCS else [])]
    beyond_what_is_asked = [one for one in complaints if not any(words in one for words in expected)]
    assert not beyond_what_is_asked, beyond_what_is_asked


def add_tracker(page: Page, hands: Hands, url: str, tracker_id: str) -> None:
    page.goto(url)
    hands.write(page.locator("#f-tracker_id"), tracker_id)
    hands.write(page.locator("#f-name"), "Walked")
    hands.press(page.locator("#add-form button"))
    arrive(page, "/settings")


def move_by_hand(hands: Hands, key: Locator, reading: Locator) -> None:
    """Hold a key until its axis has moved; a busy computer ends a hold, as it must, and one presses again."""
    expect(reading).to_have_text(re.compile(r"\d"))
    before = reading.inner_text()
    for _ in range(PRESSES):
        hands.hold(key)
        if reading.inner_text() != before:
            return
    pytest.fail(f"The axis never moved while the key was held: {before}.")
