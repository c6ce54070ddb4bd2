"""Every language at every size: nothing beside the screen, no key on another, no words too wide.

`make test` looks at every third page in one language beside English, in turns;
`make soak` at every page in six languages and four sizes. Screenshots go to build/screens.
"""

from collections.abc import Iterator
from contextlib import ExitStack

import pytest
from playwright.sync_api import Browser

from app.web.languages.known import LANGUAGES
from tests.browser.conftest import SCREENS, SIZES
from tests.browser.every_page import EVERY_PAGE
from tests.browser.layout import faults, unfold
from tests.browser.letters import foreign
from tests.browser.panels import Panels, resize
from tests.soak import SOAK, amount

# pvlib 0.16 asks pandas 3.1 for a name that pandas will drop.
pytestmark = pytest.mark.filterwarnings("ignore:DatetimeIndex.dayofyear is deprecated")

SCREEN_SIZES = SIZES | {"wall": (1920, 1080)}
OTHERS = [code for code in LANGUAGES if code != "en"]
NAMES = list(EVERY_PAGE)
SHARES = [(name, OTHERS[index % len(OTHERS)]) for index, name in enumerate(NAMES)][::3]
WHOLE = [(name, code) for code in LANGUAGES for name in NAMES]
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
TRIED_SIZES = amount(["phone", "tablet"], list(SCREEN_SIZES))


@pytest.fixture(scope="module")
def panels(browser: Browser) -> Iterator[Panels]:
    with ExitStack() as stack:
        yield Panels(browser, stack)


@pytest.mark.parametrize(("name", "language"), amount(SHARES, WHOLE))
def test_a_page_fits_in_a_language(name: str, language: str, panels: Panels) -> None:
    wrong: dict[str, list[str]] = {}
    with panels.shown(EVERY_PAGE[name], language) as page:
        assert page.evaluate("document.documentElement.lang") == LANGUAGES[language].tag
        for size in TRIED_SIZES:
            resize(page, *SCREEN_SIZES[size])
            if SOAK:
                SCREENS.mkdir(parents=True, exist_ok=True)
                page.screenshot(path=SCREENS / f"{name}-{size}-{language}.png")
            wrong[size] = faults(page)
        wrong["letters"] = foreign(page)
        unfold(page)
        for size in TRIED_SIZES:
            resize(page, *SCREEN_SIZES[size])
            wrong[f"{size}, all open"] = faults(page)
    assert {where: found for where, found in wrong.items() if found} == {}


PLANTED = """<button class="key" style="position:absolute;left:0;top:0;width:100px;height:80px">One</button>
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


def test_what_does_not_fit_is_found(browser: Browser) -> None:
    page = browser.new_page(viewport={"width": 390, "height": 844})
    page.set_content(PLANTED)
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
