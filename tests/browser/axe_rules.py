"""What axe-core finds on an open page, and which of its rules are run where."""

from pathlib import Path
from typing import Any

from playwright.sync_api import Page

from tests.browser.conftest import SIZES
from tests.browser.every_page import EVERY_PAGE
from tests.browser.layout import unfold
from tests.soak import SOAK

AXE = (Path(__file__).parent / "axe" / "4.14.1" / "axe.min.js").read_text()
TAGS = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"]
EVERY_RULE = {"runOnly": {"type": "tag", "values": TAGS}, "resultTypes": ["violations"]}
CONTRAST = {"runOnly": {"type": "rule", "values": ["color-contrast"]}, "resultTypes": ["violations"]}
RUN = """async options => (await axe.run(document, options)).violations.flatMap(
  rule => rule.nodes.map(node => `${rule.id}: ${node.target} ${node.html.slice(0, 120)}`))"""
THEME = "theme => { document.documentElement.dataset.theme = theme; }"
FOOTER = "where => document.querySelectorAll('.footer').forEach((one) => { one.style.position = where; })"
"""What lies below the footer is scrolled up by people, and axe-core does not scroll."""


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
    """Return what axe-core finds on an open page at every size and in every theme that is tried.

    The page then looks as before, with all of it unfolded.
    """
    before = page.evaluate("document.documentElement.dataset.theme")
    page.evaluate(AXE)
    unfold(page)
    page.evaluate(FOOTER, "static")
    found = []
    for size in ("phone", "desk"):
        page.set_viewport_size({"width": SIZES[size][0], "height": SIZES[size][1]})
        for theme in ("day", "sun", "night"):
            if wanted := rules(name, theme, size, language):
                page.evaluate(THEME, theme)
                found += [f"{name} {size} {theme}: {one}" for one in page.evaluate(RUN, wanted)]
    page.evaluate(FOOTER, "")
    page.evaluate(THEME, before)
    return found
