"""What axe-core finds on an open page, and which of its rules are run where."""

from pathlib import Path
from typing import Any

from playwright.sync_api import Page

from tests.browser.conftest import SIZES
from tests.browser.layout import unfold

AXE = (Path(__file__).parent / "axe" / "4.14.1" / "axe.min.js").read_text()
TAGS = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"]
QUICK: dict[str, Any] = {"resultTypes": ["violations"], "preload": False}
EVERY_RULE = QUICK | {"runOnly": {"type": "tag", "values": TAGS}}
STRUCTURE = EVERY_RULE | {"rules": {name: {"enabled": False} for name in ("color-contrast", "target-size")}}
"""Without colors, and without sizes, of which layout.py has stricter rules: half of the time."""
CONTRAST = QUICK | {"runOnly": {"type": "rule", "values": ["color-contrast"]}}
RUNS = (
    ("desk", "day", EVERY_RULE),
    ("phone", "day", CONTRAST),
    ("phone", "sun", CONTRAST),
    ("phone", "night", CONTRAST),
)
"""What is run where by make looks; the gate runs the rules of structure on a phone."""
RUN = """async options => (await axe.run(document, options)).violations.flatMap(
  rule => rule.nodes.map(node => `${rule.id}: ${node.target} ${node.html.slice(0, 120)}`))"""
THEME = "theme => { document.documentElement.dataset.theme = theme; }"
FOOTER = "where => document.querySelectorAll('.footer').forEach((one) => { one.style.position = where; })"
"""What lies below the footer is scrolled up by people, and axe-core does not scroll."""


def violations(page: Page, options: dict[str, Any]) -> list[str]:
    """Return what these rules find on an open page."""
    if not page.evaluate("'axe' in window"):
        page.evaluate(AXE)
    found: list[str] = page.evaluate(RUN, options)
    return found


def looked_at(page: Page) -> list[str]:
    """Return what axe-core finds on an open page with all of it unfolded, at two sizes and in every theme."""
    before = page.evaluate("document.documentElement.dataset.theme")
    unfold(page)
    page.evaluate(FOOTER, "static")
    found = []
    for size, theme, wanted in RUNS:
        page.set_viewport_size({"width": SIZES[size][0], "height": SIZES[size][1]})
        page.evaluate(THEME, theme)
        found += [f"{size} {theme}: {one}" for one in violations(page, wanted)]
    page.evaluate(FOOTER, "")
    page.evaluate(THEME, before)
    return found
