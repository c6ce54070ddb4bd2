"""axe-core finds nothing on any page, in any state.

By default every rule runs by day on a phone, contrast of every third page by night on a desk and for all
components in the sun; `make soak` runs every rule in every theme at both sizes, and in the other languages at
both sizes by day.
"""

from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, Page

from app.web.languages.known import LANGUAGES
from tests.browser.conftest import SIZES, Opened, Plant
from tests.browser.every_page import EVERY_PAGE, T3, Where
from tests.browser.layout import unfold
from tests.browser.panels import Panels
from tests.soak import SOAK

# pvlib 0.16 asks pandas 3.1 for a name that pandas will drop.
pytestmark = pytest.mark.filterwarnings("ignore:DatetimeIndex.dayofyear is deprecated")

AXE = (Path(__file__).parent / "axe" / "4.14.1" / "axe.min.js").read_text()
TAGS = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"]
EVERY_RULE = {"runOnly": {"type": "tag", "values": TAGS}, "resultTypes": ["violations"]}
CONTRAST = {"runOnly": {"type": "rule", "values": ["color-contrast"]}, "resultTypes": ["violations"]}
RUN = """async options => (await axe.run(document, options)).violations.flatMap(
  rule => rule.nodes.map(node => `${rule.id}: ${node.target} ${node.html.slice(0, 120)}`))"""
FOOTER_LAST = "document.querySelectorAll('.footer').forEach((one) => { one.style.position = 'static'; })"
"""What lies below the footer is scrolled up by people, and axe-core does not scroll."""
PLANT = """() => {
  const wrong = '<input id="unnamed"><p class="faint">too faint</p>';
  document.querySelector('main').insertAdjacentHTML('beforeend', wrong);
  document.querySelector('.faint').style.color = '#ccc';
}"""


@pytest.fixture(scope="module")
def panels(browser: Browser) -> Iterator[Panels]:
    with ExitStack() as stack:
        yield Panels(browser, stack)


def rules(name: str, theme: str, size: str, language: str) -> dict[str, Any] | None:
    """Return what is run; every component stands on one page in all themes, so that few need the sun."""
    if language != "en":
        return EVERY_RULE if theme == "day" else None
    if SOAK or (theme, size) == ("day", "phone"):
        return EVERY_RULE
    in_the_sun = theme == "sun" and name in ("components", "homing", "live", "trouble-live")
    by_night = theme == "night" and name in list(EVERY_PAGE)[::3]
    return CONTRAST if size == "desk" and (by_night or in_the_sun) else None


def looked_at(page: Page, name: str, language: str) -> list[str]:
    """Return what axe-core finds on an open page at every size and in every theme that is tried."""
    page.evaluate(AXE)
    unfold(page)
    page.evaluate(FOOTER_LAST)
    found = []
    for size in ("phone", "desk"):
        page.set_viewport_size({"width": SIZES[size][0], "height": SIZES[size][1]})
        for theme in ("day", "sun", "night"):
            if wanted := rules(name, theme, size, language):
                page.evaluate("theme => { document.documentElement.dataset.theme = theme; }", theme)
                found += [f"{name} {size} {theme}: {one}" for one in page.evaluate(RUN, wanted)]
    return found


@pytest.mark.timeout(900)
@pytest.mark.parametrize("language", LANGUAGES if SOAK else ["en"])
def test_axe_finds_nothing_on_any_page_in_any_theme(language: str, panels: Panels) -> None:
    found = []
    for name, leaf in EVERY_PAGE.items():
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
        page.wait_for_selector("[data-calls]")
        assert page.evaluate("document.getAnimations().length") > 0
        page.emulate_media(reduced_motion="reduce")
        assert page.evaluate("document.getAnimations().length") == 0
