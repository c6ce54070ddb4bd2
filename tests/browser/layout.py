"""What is wrong with the layout of a page that is open, in words, by its layout boxes.

Every pointer target is at least 64 px wide and high, a key that is held 112 px. Three kinds are excepted: a
link within a sentence, whose height is that of the line; the link of a card, whose target is the whole card;
what is seen only while it has the focus. Framed keys and fields stand at least 8 px apart, the keys that are
held 16 px; the parts of one choice, rows of a list, places of the rail and what the bar holds touch, being
large enough.
"""

from pathlib import Path
from typing import Any

from playwright.sync_api import Page

LIMITS = {"target": 64, "held": 112, "gap": 8, "heldGap": 16}
LOOKS = Path(__file__).parent / "looks"
"""What the tests ask of an open page, in its own language."""

PAGE_END = """() => {
  const actions = document.querySelector(".footer").getBoundingClientRect();
  return actions.left > 0 ? innerHeight : actions.top;
}"""
"""How far down the page is seen: the actions stand beside it, on a phone below it."""
LAYOUT = (LOOKS / "layout.js").read_text()


def faults(page: Page, **other: Any) -> list[str]:
    """Return what does not fit on a page, in words."""
    found: list[str] = page.evaluate(LAYOUT, LIMITS | other)
    return found


def page_end(page: Page) -> float:
    """Return how far down the page is seen, pixels."""
    return float(page.evaluate(PAGE_END))


def unfold(page: Page) -> None:
    """Open everything that is closed but what opens over the page, which is looked at by itself."""
    page.evaluate("document.querySelectorAll('details:not(.pop)').forEach((one) => { one.open = true; })")
