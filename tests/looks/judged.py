"""What is wrong with a page, in words: in English everything, in other languages what words need room for."""

from typing import Any

import httpx
from playwright.sync_api import Page

from tests.browser.axe_rules import looked_at
from tests.browser.conftest import SIZES
from tests.browser.layout import LOOKS, SCREEN_SIZES, displaced, faults, step_faults, unfold
from tests.browser.letters import foreign
from tests.browser.panels import resize
from tests.browser.reading import tree_faults
from tests.looks.keyboard import STOPS, not_past_the_frame, only_pointed, unreached, unreached_backwards

MOST_BYTES = 150_000
STILL = (LOOKS / "still.js").read_text()
BARE = (LOOKS / "forced.js").read_text()
PARTS = """() => {
  const later = new Set([...document.querySelectorAll('img[loading=lazy]')].map((one) => one.src));
  return performance.getEntriesByType('resource').map((one) => one.name).filter((one) => !later.has(one));
}"""
"""What a page is made of; pictures that come when somebody scrolls to them are not of it."""
PICTURES_COME = """() => Promise.all([...document.images].map((one) => {
  one.loading = 'eager';
  return one.decode().catch(() => null);
}))"""
"""Pictures that come late move what lies below them."""


def misfits(page: Page) -> list[str]:
    """Return what does not fit at any size, closed or open, and letters that are not ours."""
    return _at(page, *SCREEN_SIZES) + with_all_open(page, "phone", "tablet")


def fits(page: Page) -> list[str]:
    """Return what does not fit on one of the five steps, on a phone and on a tablet."""
    found = []
    for size in ("phone", "tablet"):
        resize(page, *SIZES[size])
        found += [f"{size}: {one}" for one in step_faults(page)]
    return found


def with_all_open(page: Page, *sizes: str) -> list[str]:
    """Return what does not fit on a page with everything open, and letters that are not ours."""
    unfold(page)
    return [f"letters: {one}" for one in foreign(page)] + [f"all open, {one}" for one in _at(page, *sizes)]


def _at(page: Page, *sizes: str) -> list[str]:
    found = []
    for size in sizes:
        resize(page, *SCREEN_SIZES[size])
        found += [f"{size}: {one}" for one in faults(page) + displaced(page) + step_faults(page)]
    return found


def unfit(page: Page) -> list[str]:
    """Return what else is wrong with a page that was just opened; it is then all unfolded."""
    found = tree_faults(page) + only_pointed(page)
    page.emulate_media(reduced_motion="reduce")
    found += page.evaluate(STILL)
    page.emulate_media(reduced_motion="no-preference")
    schemes: tuple[Any, ...] = ("light", "dark")
    for scheme in schemes:
        page.emulate_media(forced_colors="active", color_scheme=scheme)
        found += [f"system's colors, {scheme}: {one}" for one in page.evaluate(BARE)]
    page.emulate_media(forced_colors="none", color_scheme="light")
    return found + misfits(page) + looked_at(page)


def unusable(page: Page) -> list[str]:
    """Return what is wrong for who has only the keyboard, on a page that was just opened."""
    page.evaluate(STOPS)
    page.evaluate(PICTURES_COME)
    resize(page, *SIZES["phone"])
    found = [f"keyboard, phone: {one}" for one in unreached(page, ordered=False)]
    resize(page, *SIZES["tablet"])
    there = unreached(page, ordered=True)
    found += [f"keyboard, tablet: {one}" for one in there + unreached_backwards(page)]
    return found + not_past_the_frame(page)


def weight(page: Page, url: str) -> list[str]:
    """Return that a page is heavier on its way than a slow link allows, or has parts of another computer."""
    parts = page.evaluate(PARTS)
    found = [f"from elsewhere: {one}" for one in parts if not one.startswith((url, "data:"))]
    if not any("frame.css" in one for one in parts):
        found.append("what the browser remembers counts, too")
    sent = {one for one in parts if one.startswith(url) and "/api/" not in one}
    with httpx.Client(headers={"accept-encoding": "gzip"}, timeout=60) as client:
        bytes_ = sum(_weighed(client, one) for one in sent | {page.url.split("#")[0]})
    return [*found, *([f"{bytes_} bytes"] if bytes_ >= MOST_BYTES else [])]


_KNOWN: dict[str, int] = {}


def _weighed(client: httpx.Client, url: str) -> int:
    if url not in _KNOWN:
        _KNOWN[url] = client.get(url).num_bytes_downloaded
    return _KNOWN[url]


def silent(page: Page) -> list[str]:
    """Return that the bar is not steady: an alarm is told by color and shape, and nothing blinks."""
    moves = page.evaluate("document.getAnimations().length")
    return [f"the bar moves: {moves} movements"] if moves else []
