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

from tests.browser.conftest import SIZES

SCREEN_SIZES = SIZES | {"wall": (1920, 1080)}
LIMITS = {"target": 64, "held": 112, "gap": 8, "heldGap": 16}
LOOKS = Path(__file__).parent / "looks"
"""What the tests ask of an open page, in its own language."""

PAGE_END = """() => {
  const actions = document.querySelector(".footer").getBoundingClientRect();
  return actions.left > 0 ? innerHeight : actions.top;
}"""
"""How far down the page is seen: the actions stand beside it, on a phone below it."""
ON_ANOTHER = """() => {
  const shown = (e) => e.checkVisibility() && !e.closest('.footer, svg, .skip, .visually-hidden');
  const touched = document.querySelectorAll('a, button, input:not([type=hidden]), select, summary');
  const whole = new Set([...touched].filter(shown).map((e) => e.closest('label') ?? e));
  const keys = [...whole].map((e) => [e, e.getBoundingClientRect()]);
  const found = [];
  keys.forEach(([a, one], index) => keys.slice(index + 1).forEach(([b, two]) => {
    const across = Math.min(one.right, two.right) - Math.max(one.left, two.left);
    const down = Math.min(one.bottom, two.bottom) - Math.max(one.top, two.top);
    if (across < 4 || down < 4 || a.contains(b) || b.contains(a)) return;
    found.push(`${a.textContent.trim() || a.className} lies on ${b.textContent.trim() || b.className}`);
  }));
  return found;
}"""
"""Which keys of a page lie on one another, whatever is open."""
LARGEST_ICON_PX = 96
ICONS = """most => [...document.querySelectorAll('svg[viewBox="0 0 24 24"][aria-hidden]')].filter((e) => {
  const { width, height } = e.getBoundingClientRect();
  return Math.max(width, height) > most;
}).map((e) => `icon of ${e.getBoundingClientRect().width} px in ${e.parentElement.outerHTML.slice(0, 80)}`)"""
LAYOUT = (LOOKS / "layout.js").read_text()
STEPS = (LOOKS / "steps.js").read_text()
MOST_WORDS = 60
"""The most words in English on one of the five steps, in the content and the actions."""


def faults(page: Page, **other: Any) -> list[str]:
    """Return what does not fit on a page, in words."""
    found: list[str] = page.evaluate(LAYOUT, LIMITS | other)
    return found


def step_faults(page: Page) -> list[str]:
    """Return what does not fit on one of the five steps; nothing on another page, or with its help open."""
    found: list[str] = page.evaluate(STEPS, MOST_WORDS)
    return found


def large_icons(page: Page) -> list[str]:
    """Return which icons of a page are larger than any should be, in words."""
    found: list[str] = page.evaluate(ICONS, LARGEST_ICON_PX)
    return found


def page_end(page: Page) -> float:
    """Return how far down the page is seen, pixels."""
    return float(page.evaluate(PAGE_END))


def unfold(page: Page) -> None:
    """Open everything that is closed but what opens over the page, which is looked at by itself."""
    page.evaluate("document.querySelectorAll('details:not(.pop)').forEach((one) => { one.open = true; })")


def displaced(page: Page) -> list[str]:
    """Return that Stop, where it is, is not where the thumb is, or not large enough."""
    box = page.locator("#stop-key").bounding_box() if page.locator("#stop-key").count() else None
    width, height = page.evaluate("[document.documentElement.clientWidth, innerHeight]")
    if box is None:
        return []
    if width >= 900:
        placed = box == {"x": width - 130, "y": height - 168, "width": 120, "height": 120}
    else:
        placed = box["x"] == 80 and box["y"] + box["height"] >= height - 8 and box["height"] >= 64
    return [] if placed and box["width"] >= 120 else [f"Stop is out of its place: {box}"]
