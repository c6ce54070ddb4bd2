"""A page looks the same whatever fonts the computer has: with none at all, and with many."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import httpx
from playwright.sync_api import Browser, Locator, Page

from app.web.languages.catalogue import catalogue_of
from app.web.languages.known import LANGUAGES, TRANSLATED
from tests.browser.panels import DRAWN
from tests.patience import PATIENCE_MS

ROOT = Path(__file__).resolve().parents[2]
MANY_FONTS = f"""<?xml version="1.0"?>
<!DOCTYPE fontconfig SYSTEM "urn:fontconfig:fonts.dtd">
<fontconfig>
  <include ignore_missing="yes">/etc/fonts/fonts.conf</include>
  <dir>{ROOT}/static/vendor</dir>
</fontconfig>
"""
"""What this computer has, and two more, so that a Latin and a Chinese one are there wherever this runs."""
PICTURED = {
    "settings": tuple(LANGUAGES), "homing": ("en", "zh_Hans"), "document": ("de", "zh_Hans"),
    "problem-404": ("zh_Hans",), "components": ("en",), "alarm-guide": ("ro", "tr"),
    "signed-record": ("es", "zh_Hans"), "languages": ("en",),
}  # fmt: skip
"""Which pages are compared in which languages."""
EDGE_PX = 8
"""Wider than the corners of a picture are round."""
NAMES = "Ελένη Бојан Łukasz Đorđe 渡邊 直人 ひらがな 龍 Nguyễn"


def said(language: str) -> str:
    """Return every letter that the program says in a language, the documents included."""
    catalogue = catalogue_of(TRANSLATED[0] if language == "en" else language)
    texts = {**catalogue.texts, **catalogue._read_blocks()}
    if language == "en":
        words = [text if isinstance(text, str) else text[0] for text in texts]
    else:
        words = list(texts.values())
    return "".join(sorted({letter for letter in "".join(words) if letter.isprintable() and letter != " "}))


@contextmanager
def still(browser: Browser, address: str, html: str) -> Iterator[Page]:
    """Show what a panel answered once, without its scripts, so that it stays as it was."""
    page = browser.new_page(viewport={"width": 1024, "height": 2400})
    page.route("**/*.js", lambda route: route.abort())
    page.route(address, lambda route: route.fulfill(body=html, content_type="text/html; charset=utf-8"))
    page.goto(address)
    page.evaluate(DRAWN)
    yield page
    page.close()


def unlike(address: str, language: str, bare: Browser, many: Browser) -> list[str]:
    """Return that a page looks different on a computer with many fonts."""
    html = httpx.get(address, cookies={"language": language}, timeout=PATIENCE_MS / 1000).text
    with still(bare, address, html) as one, still(many, address, html) as other:
        return [] if one.screenshot() == other.screenshot() else ["looks different with many fonts"]


def unlike_in_motion(address: str, bare: Browser, many: Browser) -> list[str]:
    """Return that the letters of a moving picture are for ever different on a computer with many fonts."""
    scenes = []
    for one in (bare, many):
        page = one.new_page(viewport={"width": 1024, "height": 1000})
        page.context.add_cookies([{"name": "language", "value": "zh_Hans", "url": address}])
        page.goto(address)
        scenes.append(page.locator('.scene[data-painter="webgl2"][data-frames]'))
    alike = until(lambda: len({within(scene) for scene in scenes}) == 1)
    for scene in scenes:
        scene.page.close()
    return [] if alike else ["the moving picture has letters of the computer"]


def until(true: Callable[[], bool]) -> bool:
    """Return whether something becomes true while it is tried often."""
    return any(true() for _ in range(TRIES))


TRIES = 60
"""A picture takes a tenth of a second and more."""


def within(scene: Locator) -> bytes:
    """Return the picture without its rounded edge, which one browser draws a shade darker than another."""
    scene.scroll_into_view_if_needed(timeout=PATIENCE_MS)
    box = scene.bounding_box()
    assert box is not None
    box["x"], box["width"] = box["x"] + EDGE_PX, box["width"] - 2 * EDGE_PX
    box["y"], box["height"] = box["y"] + EDGE_PX, box["height"] - 2 * EDGE_PX
    return scene.page.screenshot(clip=box, timeout=PATIENCE_MS)
