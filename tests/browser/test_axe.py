"""axe-core finds nothing on any page, in any state.

By default every rule runs by day on a phone, contrast of every third page by night on a desk and for all
components in the sun; pages that test_every_page.py opens are looked at there. `make soak` runs every rule in
every theme at both sizes, and in the other languages at both sizes by day.
"""

from collections.abc import Iterator
from contextlib import ExitStack

import pytest
from playwright.sync_api import Browser

from app.web.languages.known import LANGUAGES
from tests.browser.axe_rules import AXE, EVERY_RULE, RUN, looked_at
from tests.browser.conftest import Opened, Plant
from tests.browser.every_page import EVERY_PAGE, LOOKED_AT, T3, Where
from tests.browser.panels import Panels
from tests.soak import SOAK

# pvlib 0.16 asks pandas 3.1 for a name that pandas will drop.
pytestmark = pytest.mark.filterwarnings("ignore:DatetimeIndex.dayofyear is deprecated")

PLANT = """() => {
  const wrong = '<input id="unnamed"><p class="faint">too faint</p>';
  document.querySelector('main').insertAdjacentHTML('beforeend', wrong);
  document.querySelector('.faint').style.color = '#ccc';
}"""


@pytest.fixture(scope="module")
def panels(browser: Browser) -> Iterator[Panels]:
    with ExitStack() as stack:
        yield Panels(browser, stack)


@pytest.mark.timeout(900)
@pytest.mark.parametrize("language", LANGUAGES if SOAK else ["en"])
def test_axe_finds_nothing_on_any_page_in_any_theme(language: str, panels: Panels) -> None:
    found = []
    for name, leaf in EVERY_PAGE.items():
        if name in LOOKED_AT and not SOAK:
            continue
        with panels.shown(leaf, language) as page:
            assert page.evaluate("document.documentElement.lang") == LANGUAGES[language].tag
            found += looked_at(page, name, language)
    assert not found, "\n".join(sorted(set(found)))


def test_axe_would_find_what_is_planted(plant: Plant, opened: Opened) -> None:
    page = opened("/")
    page.evaluate(AXE)
    page.evaluate(PLANT)
    found = " ".join(page.evaluate(RUN, EVERY_RULE))
    assert "label: #unnamed" in found
    assert "color-contrast: .faint" in found


def test_an_alarm_that_calls_blinks_only_for_who_wants_movement(panels: Panels) -> None:
    leaf = EVERY_PAGE["trouble-live"]
    assert (leaf.path, leaf.where) == (T3, Where.TROUBLED)
    with panels.shown(leaf) as page:
        page.locator(".messages > .pop > summary").click()
        page.wait_for_selector("[data-calls]:visible")
        assert page.evaluate("document.getAnimations().length") > 0
        page.emulate_media(reduced_motion="reduce")
        assert page.evaluate("document.getAnimations().length") == 0
