"""The pages look the same whatever fonts the computer has: with none at all, and with many.

All other browser tests see a computer without letters, see tests/e2e/letters.py; this one compares.
"""

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from time import monotonic

import httpx
import pytest
from playwright.sync_api import Browser, Locator, Page

from app.web.languages.known import LANGUAGES
from app.web.translation.catalogues import read, template
from tests.browser.conftest import CHROMIUM, FLAGS
from tests.browser.every_page import EVERY_PAGE
from tests.browser.letters import undrawn
from tests.browser.panels import Panels
from tests.e2e.letters import environment
from tests.patience import PATIENCE_MS

# pvlib 0.16 asks pandas 3.1 for a name that pandas will drop.
pytestmark = pytest.mark.filterwarnings("ignore:DatetimeIndex.dayofyear is deprecated")
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
EDGE_PX = 8
"""Wider than the corners of a picture are round."""
NAMES = "Ελένη Бојан Łukasz Đorđe 渡邊 直人 ひらがな 龍 Nguyễn"
DRAWN = """document.fonts.ready
  .then(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))))"""


@pytest.fixture(scope="module")
def panels(browser: Browser) -> Iterator[Panels]:
    with ExitStack() as stack:
        yield Panels(browser, stack)


@pytest.fixture(scope="module")
def many(browser: Browser, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    """Run a second browser that finds many fonts."""
    fonts = tmp_path_factory.mktemp("fonts") / "fonts.conf"
    fonts.write_text(MANY_FONTS)
    started = browser.browser_type.launch(executable_path=CHROMIUM, args=FLAGS, env=environment(fonts))
    yield started
    started.close()


def said(language: str) -> str:
    """Return every letter that the program says in a language, the documents included."""
    texts = template() if language == "en" else read(language)
    forms = [text.id if language == "en" else text.string for text in texts if text.id]
    words = [word for form in forms for word in ((form,) if isinstance(form, str) else form)]
    return "".join(sorted({letter for letter in "".join(words) if letter.isprintable() and letter != " "}))


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_letter_that_the_panel_says_is_its_own(language: str, panels: Panels) -> None:
    with panels.shown(EVERY_PAGE["document"], language) as page:
        assert undrawn(page, said(language)) == []


def test_names_in_other_scripts_are_drawn_by_the_panel(panels: Panels) -> None:
    with panels.shown(EVERY_PAGE["document"]) as page:
        assert undrawn(page, "".join(sorted(set(NAMES) - {" "}))) == []


def test_a_letter_that_no_font_of_ours_has_is_found(panels: Panels) -> None:
    with panels.shown(EVERY_PAGE["document"]) as page:
        assert undrawn(page, "a\U0001f600") == ["\U0001f600 (U+1F600)"]


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


@pytest.mark.parametrize(
    ("name", "language"), [(name, one) for name, all_ in PICTURED.items() for one in all_]
)
def test_a_page_looks_the_same_without_any_font_and_with_many(
    name: str, language: str, panels: Panels, browser: Browser, many: Browser
) -> None:
    leaf = EVERY_PAGE[name]
    address = panels.at(leaf.where).url + leaf.path
    html = httpx.get(address, cookies={"language": language}, timeout=60).text
    with still(browser, address, html) as bare, still(many, address, html) as full:
        assert bare.screenshot() == full.screenshot()


def within(scene: Locator) -> bytes:
    """Return the picture without its rounded edge, which one browser draws a shade darker than another."""
    scene.scroll_into_view_if_needed(timeout=PATIENCE_MS)
    box = scene.bounding_box()
    assert box is not None
    box["x"], box["width"] = box["x"] + EDGE_PX, box["width"] - 2 * EDGE_PX
    box["y"], box["height"] = box["y"] + EDGE_PX, box["height"] - 2 * EDGE_PX
    return scene.page.screenshot(clip=box, timeout=PATIENCE_MS)


def test_the_moving_picture_has_letters_of_its_own(panels: Panels, browser: Browser, many: Browser) -> None:
    leaf, scenes = EVERY_PAGE["player"], []
    url = panels.at(leaf.where).url
    for one in (browser, many):
        page = one.new_page(viewport={"width": 1024, "height": 1000})
        page.context.add_cookies([{"name": "language", "value": "zh_Hans", "url": url}])
        page.goto(url + leaf.path)
        scenes.append(page.locator('.scene[data-painter="webgl2"][data-frames]'))
    begun_s = monotonic()
    while len({within(scene) for scene in scenes}) > 1:
        assert monotonic() - begun_s < PATIENCE_MS / 1000.0, "drawn by the worker, and for ever different"
    for scene in scenes:
        scene.page.close()


def test_fonts_of_the_computer_would_be_seen(browser: Browser, many: Browser) -> None:
    html = "<p>Latin</p><p lang='zh-Hans'>\u4e2d\u6587</p>"
    with (
        still(browser, "http://127.0.0.1:9/", html) as bare,
        still(many, "http://127.0.0.1:9/", html) as full,
    ):
        for paragraph in range(2):
            words = [one.locator("p").nth(paragraph).screenshot() for one in (bare, full)]
            assert words[0] != words[1]
