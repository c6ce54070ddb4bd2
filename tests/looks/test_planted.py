"""What is planted is found: the judgement of pages can fail."""

import pytest
from playwright.sync_api import Browser, Page

from tests.browser.axe_rules import EVERY_RULE, STRUCTURE, violations
from tests.browser.every_page import EVERY_PAGE
from tests.browser.layout import faults, step_faults
from tests.browser.letters import undrawn
from tests.browser.panels import Panels
from tests.browser.reading import tree_faults
from tests.looks.fonts import still
from tests.looks.judged import BARE, STILL
from tests.looks.keyboard import STOPS, only_pointed, unreached

# pvlib 0.16 asks pandas 3.1 for a name that pandas will drop.
pytestmark = pytest.mark.filterwarnings("ignore:DatetimeIndex.dayofyear is deprecated")

MISFITS = """<button class="key" style="position:absolute;left:0;top:0;width:100px;height:80px">One</button>
<button class="key" style="position:absolute;left:50px;top:40px;width:100px;height:80px">Two</button>
<button class="key" style="position:absolute;left:154px;top:40px;width:100px;height:80px">Three</button>
<button data-jog="azimuth" style="position:absolute;left:0;top:300px;width:100px;height:100px">Turn</button>
<a href="/" style="position:absolute;left:200px;top:300px;width:80px;height:50px">Low</a>
<p style="position:absolute;left:0;top:420px;margin:0">There is <a href="/">a link in a sentence</a>.</p>
<a href="/" class="key" style="position:absolute;top:200px;display:block;width:70px;height:70px;
overflow:hidden;white-space:nowrap">Referenzpunkt setzen</a><p style="width:500px">wide</p>
<p style="position:absolute;left:0;top:500px;margin:0">First words</p>
<p style="position:absolute;left:4px;top:504px;margin:0">Second words</p>
<svg viewBox="0 0 100 40" style="position:absolute;top:600px;left:0;width:100px;height:40px">
<text x="60" y="20">cut off here</text></svg>"""
A_STEP = """<style>body { margin: 0; height: 2100px } button { position: absolute; top: 2036px; height: 64px }
footer { position: fixed; bottom: 0; height: 80px; }</style><nav id="steps"></nav><main class="content">
<button>Last</button>%s</main><footer class="footer">Foot</footer>""" % ("word " * 60)
ON_A_PAGE = """() => {
  const wrong = '<input id="unnamed"><p class="faint">too faint</p><h6>deep</h6>'
    + '<div id="touched"></div><button id="hidden-focus" class="key">no edge</button>';
  const main = document.querySelector('main');
  main.insertAdjacentHTML('beforeend', wrong);
  document.querySelector('.faint').style.color = '#ccc';
  main.animate([{ opacity: 1 }, { opacity: 0.9 }], { duration: 1000, iterations: Infinity });
  const button = document.getElementById('hidden-focus');
  Object.assign(button.style, { border: 'none', outline: 'none' });
  button.setAttribute('tabindex', '0');
  document.getElementById('unnamed').addEventListener('focus', (event) => event.target.blur());
  document.getElementById('touched').addEventListener('click', () => {});
}"""


def test_what_does_not_fit_is_found(browser: Browser) -> None:
    page = browser.new_page(viewport={"width": 390, "height": 844})
    page.set_content(MISFITS)
    found = [one.split(":")[0] for one in faults(page)]
    page.close()
    assert sorted(found) == [
        "beside the screen",
        "cut off in a picture",
        "overlap",
        "too near",
        "too small",
        "too small",
        "too wide",
        "words on words",
    ]


@pytest.fixture
def planted(panels: Panels) -> Page:
    with panels.shown(EVERY_PAGE["journal"]) as page:
        page.evaluate(ON_A_PAGE)
        yield page


def test_axe_finds_it(planted: Page) -> None:
    found = " ".join(violations(planted, EVERY_RULE))
    assert "label: #unnamed" in found
    assert "color-contrast: .faint" in found
    assert "label: #unnamed" in " ".join(violations(planted, STRUCTURE))


def test_a_screen_reader_is_missed(planted: Page) -> None:
    found = " ".join(tree_faults(planted))
    assert "without a name: textbox" in found
    assert "heading 6 after" in found


def test_movement_and_missing_edges_are_found(planted: Page) -> None:
    assert any(one.startswith("moves: <main") for one in planted.evaluate(STILL))
    planted.emulate_media(forced_colors="active")
    assert any("no edge" in one for one in planted.evaluate(BARE))
    planted.emulate_media(forced_colors="none")


def test_what_the_keyboard_does_not_reach_or_show_is_found(planted: Page) -> None:
    planted.evaluate(STOPS)
    found = " ".join(unreached(planted, ordered=True))
    assert 'not seen to have the focus: <button id="hidden-focus"' in found
    assert "for a pointer alone: div#touched." in only_pointed(planted)


def test_a_letter_that_no_font_of_ours_has_is_found(panels: Panels) -> None:
    with panels.shown(EVERY_PAGE["document"]) as page:
        assert undrawn(page, "a\U0001f600") == ["\U0001f600 (U+1F600)"]


def test_fonts_of_the_computer_would_be_seen(browser: Browser, many: Browser) -> None:
    html = "<p>Latin</p><p lang='zh-Hans'>\u4e2d\u6587</p>"
    with (
        still(browser, "http://127.0.0.1:9/", html) as bare,
        still(many, "http://127.0.0.1:9/", html) as full,
    ):
        for paragraph in range(2):
            words = [one.locator("p").nth(paragraph).screenshot() for one in (bare, full)]
            assert words[0] != words[1]


def test_a_step_that_scrolls_or_says_much_is_found(browser: Browser) -> None:
    page = browser.new_page(viewport={"width": 1024, "height": 768})
    page.set_content(f'<html lang="en">{A_STEP}')
    scrolls, many = step_faults(page)
    page.set_viewport_size({"width": 390, "height": 844})
    below, _ = step_faults(page)
    page.close()
    assert scrolls == "the step scrolls by 1332 px"
    assert many.startswith("61 words: Last word")
    assert below == "below the fold by 1336 px: Last"
