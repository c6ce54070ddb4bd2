"""What is chosen in the frame stays: language and theme; the browser writes values as the server does."""

from contextvars import copy_context
from datetime import UTC, datetime
from typing import Any

from playwright.sync_api import Page, expect

from app.web.languages import CATALOGUE
from app.web.languages.catalogue import catalogue_of
from app.web.languages.known import LANGUAGES
from app.web.shell.formats import shown
from tests.browser.conftest import Opened, Plant

ZONE = "Europe/Istanbul"
AT = datetime(2026, 6, 20, 21, 30, 5, tzinfo=UTC)
VALUES: tuple[tuple[Any, str], ...] = (
    (102.404, "angle2"),
    (-0.001, "angle2"),
    (-12.5, "angle1"),
    (359.6, "angle0"),
    (18.27, "mps"),
    (-3.14, "degc"),
    (1013.2, "hpa"),
    (0.4, "age"),
    (1234.0, "factor"),
    (65.0, "duration"),
    (-23.0, "signed_seconds"),
    (247.6, "compass"),
    (78.0, "compass"),
    ("tracking", "words"),
    ("stowing", "words"),
    (True, "freshness"),
    (AT, "date"),
    (AT, "moment"),
    (AT, "minute"),
    (None, "angle2"),
)
IN_THE_BROWSER = """async (cases) => {
  const { src } = document.querySelector('script[src*="js/page.js"]');
  const { shown } = await import(src.replace("page.js", "format.js"));
  return cases.map(([value, form]) => shown(value, form, "Europe/Istanbul"));
}"""


def speak(page: Page, code: str) -> None:
    """Choose a language from the list in the rail."""
    page.locator(".language summary").click()
    page.locator(f'.language button[value="{code}"]').click()
    page.wait_for_selector(f'html[lang="{LANGUAGES[code].tag}"][data-link="live"]:not([data-keeping])')


def on_the_server(code: str) -> list[str]:
    """Return the values as the server writes them in a language."""

    def written() -> list[str]:
        CATALOGUE.set(catalogue_of(code))
        return [shown(value, form, ZONE) for value, form in VALUES]

    return copy_context().run(written)


def test_both_sides_write_values_alike(opened: Opened) -> None:
    page = opened("/")
    cases = [[value.isoformat() if isinstance(value, datetime) else value, form] for value, form in VALUES]
    for code in ("es", "de", "en"):
        speak(page, code)
        assert page.evaluate(IN_THE_BROWSER, cases) == on_the_server(code), code


def test_live_values_stay_in_the_language_of_the_page(opened: Opened, plant: Plant) -> None:
    page = opened("/trackers/T1")
    speak(page, "de")
    german = catalogue_of("de")
    said = page.locator(".says-text [data-live]")
    site = plant.machine.latest()
    assert site is not None
    words = site.trackers[0].activity_text
    expect(said).to_have_text(german.said(words))
    page.evaluate("document.querySelector('.says-text [data-live]').textContent = ''")
    expect(said).to_have_text(german.said(words))
    assert german.said(words) != words


def test_the_theme_changes_at_one_tap_stays_and_is_told_in_the_language_of_the_page(opened: Opened) -> None:
    page, german = opened("/journal"), catalogue_of("de")
    speak(page, "de")
    key = page.locator("#theme-form .theme-key")
    key.click()
    sun = german.pgettext("theme", "Sun")
    label = german.gettext("%(theme)s: change to the next theme of day, sun, night, and auto.")
    expect(key).to_have_text(sun)
    expect(page.locator("html")).to_have_attribute("data-theme", "sun")
    expect(key).to_have_attribute("aria-label", label % {"theme": sun})
    page.reload()
    expect(page.locator("html")).to_have_attribute("data-theme", "sun")


def test_arrows_choose_and_space_and_enter_press(opened: Opened) -> None:
    page = opened("/trackers/T1/commissioning/mode")
    first = page.locator('main input[type="radio"]:checked')
    before = first.input_value()
    first.focus()
    page.keyboard.press("ArrowUp")
    expect(page.locator('main input[type="radio"]:checked')).not_to_have_value(before)
    page.locator("#help summary").focus()
    for key, is_open in ((" ", True), ("Enter", False)):
        page.keyboard.press(key)
        assert page.locator("#help").evaluate("one => one.open") is is_open
