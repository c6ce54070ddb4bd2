"""Every page that has changed, in every language that has changed: what is found good is stamped."""

from collections.abc import Callable

import pytest
from playwright.sync_api import Browser, Error

from app.web.languages.known import LANGUAGES
from tests.browser.every_page import EVERY_PAGE, Where
from tests.browser.letters import undrawn
from tests.browser.panels import Panels
from tests.looks.conftest import DUE
from tests.looks.figures import PICTURES, faults_of_figures
from tests.looks.fonts import NAMES, PICTURED, said, unlike, unlike_in_motion
from tests.looks.judged import fits, silent, unfit, unusable, weight, with_all_open
from tests.looks.stamp import LETTERS, put

# pvlib 0.16 asks pandas 3.1 for a name that pandas will drop.
pytestmark = pytest.mark.filterwarnings("ignore:DatetimeIndex.dayofyear is deprecated")


@pytest.mark.timeout(1800)
def test_a_page_is_good(name: str, panels: Panels, browser: Browser, many: Browser) -> None:
    def english() -> list[str]:
        return in_english(name, panels)

    wrong: dict[str, list[str]] = {}
    for code, total in DUE[name].items():
        look: Callable[[], list[str]] = (
            english if code == "en" else lambda code=code: spoken(name, code, panels)
        )
        found = _tried(look) + _tried(lambda code=code: in_letters(name, code, panels, browser, many))
        put(name, code, None if found else total)
        if found:
            wrong[code] = found
    assert not wrong, said_of(name, wrong)


def said_of(name: str, wrong: dict[str, list[str]]) -> str:
    """Return what is wrong with a page, a line a fault."""
    return "\n".join(f"{name} {code} {one}" for code, found in wrong.items() for one in sorted(set(found)))


def _tried(look: Callable[[], list[str]]) -> list[str]:
    """Return what is found, or why nothing can be: other languages are looked at nevertheless."""
    try:
        return look()
    except (AssertionError, Error) as error:
        return [f"cannot be looked at: {error}"]


def in_english(name: str, panels: Panels) -> list[str]:
    """Return everything that is wrong with a page in English."""
    leaf, found = EVERY_PAGE[name], []
    with panels.shown(leaf) as page:
        if leaf.where is Where.CALM and not leaf.sends:
            found += weight(page, panels.at(leaf.where).url)
        if name in PICTURES:
            found += faults_of_figures(page, name)
        found += unfit(page)
    with panels.shown(leaf) as page:
        found += unusable(page)
    if name == "trouble-live":
        with panels.shown(leaf) as page:
            found += silent(page)
    return found


def spoken(name: str, code: str, panels: Panels) -> list[str]:
    """Return what does not fit in another language."""
    with panels.shown(EVERY_PAGE[name], code) as page:
        tag = page.evaluate("document.documentElement.lang")
        return (
            fits(page)
            + with_all_open(page, "phone", "desk")
            + ([] if tag == LANGUAGES[code].tag else [f"the language is {tag}"])
        )


def in_letters(name: str, code: str, panels: Panels, bare: Browser, many: Browser) -> list[str]:
    """Return that a page is written in letters of the computer."""
    leaf = EVERY_PAGE[name]
    address = panels.at(leaf.where).url + leaf.path
    found = unlike(address, code, bare, many) if code in PICTURED.get(name, ()) else []
    return found + (unlike_in_motion(address, bare, many) if (name, code) == ("player", "zh_Hans") else [])


@pytest.mark.parametrize("language", [code for code in LANGUAGES if code in DUE.get(LETTERS, {})])
def test_every_letter_that_the_panel_says_is_its_own(language: str, panels: Panels) -> None:
    with panels.shown(EVERY_PAGE["document"], language) as page:
        found = undrawn(page, said(language))
        if language == "en":
            found += undrawn(page, "".join(sorted(set(NAMES) - {" "})))
    put(LETTERS, language, None if found else DUE[LETTERS][language])
    assert found == []
