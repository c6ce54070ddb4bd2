"""The keyboard alone: it reaches everything in the order of the page, is always seen, and is never caught."""

from itertools import pairwise
from typing import Any

from playwright.sync_api import Page

from tests.browser.layout import LOOKS

STOPS = (LOOKS / "stops.js").read_text()
MOST_STOPS = 400
TO_THE_TOP = """() => {
  const first = document.createElement('span');
  first.tabIndex = -1;
  document.body.prepend(first);
  first.focus();
  first.remove();
  scrollTo(0, 0);
}"""
"""As on a page that was just opened, whatever it gave the focus to."""
POINTED = """() => {
  const kinds = ['click', 'mousedown', 'pointerdown', 'touchstart', 'mouseup', 'pointerup'];
  window.pointed = [];
  const add = EventTarget.prototype.addEventListener;
  EventTarget.prototype.addEventListener = function (kind, ...rest) {
    if (kinds.includes(kind) && this instanceof Element) window.pointed.push(this);
    return add.call(this, kind, ...rest);
  };
}"""
"""Runs before the scripts of a page."""
ONLY_POINTED = """() => [...new Set(window.pointed)]
  .filter((e) => e.isConnected && e !== document.body && e !== document.documentElement)
  .filter((e) => getComputedStyle(e).pointerEvents !== 'none')
  .filter((e) => !e.closest('a[href], button, input, select, textarea, summary, label, form'))
  .map((e) => `${e.tagName.toLowerCase()}#${e.id}.${e.className}`)"""
DRAWN = ("u-over", "u-wrap", "uplot", "scene", "sign-pad")
"""Where a pointer draws or turns; beside each stand keys or fields that do the same."""


def only_pointed(page: Page) -> list[str]:
    """Return what waits for a pointer and is no control."""
    found: list[str] = page.evaluate(ONLY_POINTED)
    return [f"for a pointer alone: {one}" for one in found if not any(word in one for word in DRAWN)]


def unreached(page: Page, *, ordered: bool) -> list[str]:
    """Return what is wrong for who has no pointer, in words, from the top of a page to its end."""
    page.evaluate(TO_THE_TOP)
    wanted = reachable(page)
    stops = walk(page, "Tab", len(wanted))
    reached = {stop["key"] for stop in stops}
    found = [f"never reached: {text}" for key, text in wanted.items() if key not in reached]
    if not stops or 'class="skip"' not in stops[0]["text"]:
        found.append("the first key does not lead past the frame")
    found += [f"not seen to have the focus: {one['text']}" for one in stops if not one["marked"]]
    found += [f"behind something: {one['text']} {one['hidden']}" for one in stops if one["hidden"]]
    return found + (disordered(stops) if ordered else [])


def unreached_backwards(page: Page) -> list[str]:
    """Return what is not reached on the way back; what closes when the focus leaves it is not there then."""
    left = reachable(page)
    back = {stop["key"] for stop in walk(page, "Shift+Tab", len(left))}
    return [f"not reached backwards: {text}" for key, text in left.items() if key not in back]


def reachable(page: Page) -> dict[str, str]:
    """Return what the keyboard must reach, by its mark."""
    return {one["key"]: one["text"] for one in page.evaluate("walk.reachable()")}


def walk(page: Page, key: str, least: int) -> list[dict[str, Any]]:
    """Press a key at least so often, until the focus has gone round, and return where it rested."""
    for pressed in range(1, MOST_STOPS):
        page.keyboard.press(key)
        if pressed >= least and page.evaluate("document.activeElement === document.body"):
            break
    stops: list[dict[str, Any]] = page.evaluate("walk.stops.splice(0)")
    again = [place for place, stop in enumerate(stops) if stop["key"] == stops[0]["key"]]
    return stops[: again[1]] if len(again) > 1 else stops


def disordered(stops: list[dict[str, Any]]) -> list[str]:
    """Return where the focus goes up the page without going to the next column."""
    found = []
    for before, after in pairwise(stops):
        if before["inFooter"] or after["inFooter"]:
            continue
        if after["bottom"] <= before["top"] and after["left"] < before["right"] - 1:
            found.append(f"{before['text']} goes up to {after['text']}")
    return found


def not_past_the_frame(page: Page) -> list[str]:
    """Return what is wrong with the key that leads past the frame."""
    page.evaluate(TO_THE_TOP)
    page.keyboard.press("Tab")
    box = page.locator(".skip").bounding_box()
    if box is None or box["x"] < 0 or box["y"] < 0 or box["height"] < 64:
        return [f"the key past the frame is not seen: {box}"]
    page.keyboard.press("Enter")
    at_heading = page.evaluate("document.activeElement.id") == "heading"
    page.keyboard.press("Tab")
    goes_on = page.evaluate("document.activeElement.closest('main, footer') !== null")
    return [] if at_heading and goes_on else ["the key past the frame does not lead past it"]
