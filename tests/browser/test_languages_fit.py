"""Every language at every size: nothing beside the screen, no key on another, no words wider than their key.

`make test` looks at German on a phone, the longest words on the narrowest screen; with `HELIOPANEL_SOAK=1`
(`make soak`) every page is looked at in six languages and four sizes. Screenshots go to build/screens.
"""

import os

import pytest
from playwright.sync_api import Browser, Page

from app.web.languages.known import LANGUAGES
from tests.browser.conftest import SCREENS, SIZES, Plant
from tests.browser.test_pages_fit import LEAST_TARGET_PX, PAGES, TOO_SMALL

SOAK = "HELIOPANEL_SOAK" in os.environ
SCREEN_SIZES = SIZES | {"wall": (1920, 1080)}
DAILY = (
    "overview",
    "live",
    "location",
    "homing",
    "mode",
    "run",
    "settings",
    "show",
    "alarms",
    "site",
    "network",
)
LOOKED_AT = PAGES if SOAK else {name: PAGES[name] for name in DAILY}
TRIED = [(code, size) for code in LANGUAGES for size in SCREEN_SIZES] if SOAK else [("de", "phone")]
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
TOO_WIDE = """() => [...document.querySelectorAll('.key, .tabs a, .step-link, th, h1, h2')]
  .filter((e) => e.checkVisibility() && !e.closest('.visually-hidden') && e.scrollWidth > e.clientWidth + 1)
  .map((e) => `${e.textContent.trim()}: ${e.scrollWidth} of ${e.clientWidth}`)"""


def faults(page: Page) -> list[str]:
    """Return what does not fit on a page, in words."""
    beside = page.evaluate("document.documentElement.scrollWidth - innerWidth")
    found = [f"{beside} px beside the screen"] if beside > 0 else []
    found += [f"too small: {one}" for one in page.evaluate(TOO_SMALL, LEAST_TARGET_PX)]
    found += [f"overlap: {one}" for one in page.evaluate(ON_ANOTHER)]
    return found + [f"too wide: {one}" for one in page.evaluate(TOO_WIDE)]


@pytest.mark.timeout(300)
@pytest.mark.parametrize(("language", "size"), TRIED)
def test_pages_fit_in_a_language(language: str, size: str, browser: Browser, plant: Plant) -> None:
    width, height = SCREEN_SIZES[size]
    context = browser.new_context(viewport={"width": width, "height": height}, locale="en-GB")
    context.add_cookies([{"name": "language", "value": language, "url": plant.url}])
    page = context.new_page()
    wrong: dict[str, list[str]] = {}
    for name, path in LOOKED_AT.items():
        page.goto(plant.url + path)
        page.wait_for_selector('html[data-link="live"]')
        assert page.evaluate("document.documentElement.lang") == LANGUAGES[language].tag
        if SOAK:
            SCREENS.mkdir(parents=True, exist_ok=True)
            page.screenshot(path=SCREENS / f"{name}-{size}-{language}.png")
        if found := faults(page):
            wrong[name] = found
    context.close()
    assert "\n".join(f"{name}: {one}" for name, found in wrong.items() for one in found) == ""


def test_what_does_not_fit_is_found(browser: Browser) -> None:
    page = browser.new_page(viewport={"width": 390, "height": 844})
    page.set_content(
        "<button style='position:absolute;left:0;top:0;width:100px;height:80px'>One</button>"
        "<button style='position:absolute;left:50px;top:40px;width:100px;height:80px'>Two</button>"
        "<a class='key' style='position:absolute;top:200px;display:block;width:70px;height:70px;"
        "overflow:hidden;white-space:nowrap'>Referenzpunkt setzen</a><p style='width:500px'>wide</p>"
    )
    found = faults(page)
    page.close()
    assert [one.split(":")[0].split(" px")[-1] for one in found] == [
        " beside the screen",
        "overlap",
        "too wide",
    ]
