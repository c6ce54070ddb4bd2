"""A page that says *saved* says what was saved: every field that was changed, as it was and as it is."""

import pytest
from playwright.sync_api import Route, expect

from tests.browser.conftest import Opened, Plant
from tests.browser.one_panel import opened, plant
from tests.e2e.chromium import PAGE_READY

__all__ = ["opened", "plant"]

T1 = "/trackers/T1"
LIST = ".saved-what"
SAVES: dict[str, tuple[str, str, dict[str, str], list[str]]] = {
    "settings": (
        f"{T1}/settings", "#settings-form > .key-primary",
        {"#f-deadband_deg": "0.7", "#f-night": "park"},
        ["Deadband: 0.5 ° → 0.7 °", "At night: Hold at sunrise position → Move to park"],
    ),
    "protections": (
        f"{T1}/protections", "#protections-form .key-primary", {"#f-stow_wind": "16"}, [],
    ),
    "machine": (f"{T1}/machine", "#machine-form .key-primary", {}, []),
    "notifications": (
        "/site/notifications", "#notifications-form .key-main",
        {"#f-mail_to": "field@example.org", "#f-webhook_url": "https://example.org/very-secret"},
        ["Webhook", "E-mail to: – → field@example.org"],
    ),
    "windows": ("/site", "#windows-form .key", {}, []),
    "strategy": (f"{T1}/strategy", "#hybrid-form .key", {}, []),
}  # fmt: skip
FIRST_NUMBER = """(name) => {
  const form = document.querySelector(name.split(" ")[0]);
  const numbers = form.querySelectorAll("input:is([inputmode=decimal], [inputmode=numeric])");
  const one = [...numbers].find((one) => one.value);
  return `#${one.id}`;
}"""


@pytest.mark.parametrize("name", list(SAVES))
def test_what_was_saved_is_said(name: str, opened: Opened, plant: Plant) -> None:
    path, key, typed, lines = SAVES[name]
    page = opened(path, "phone", allow=("422",))
    if not lines:
        field = page.evaluate(FIRST_NUMBER, key)
        before = page.locator(field).input_value()
        typed = {field: str(round(float(before) + 1))}
        lines = [f"{before}", f"{typed[field]}"]
    for field, text in typed.items():
        if page.locator(field).evaluate("one => one.tagName") == "SELECT":
            page.locator(field).select_option(text)
        else:
            page.locator(field).fill(text)
    page.locator(key).last.click()
    said = page.locator(LIST)
    for line in lines:
        expect(said).to_contain_text(line)
    expect(said.locator("li")).to_have_count(len(typed))
    assert "very-secret" not in said.inner_text() + page.evaluate("JSON.stringify({...sessionStorage})")


def test_a_second_change_is_told_against_the_first_and_outlives_a_reload(opened: Opened) -> None:
    page = opened(f"{T1}/settings")
    for before, after in (("0.5", "0.7"), ("0.7", "0.9")):
        page.locator("#f-deadband_deg").fill(after)
        page.locator("#settings-form > .key-primary").click()
        expect(page.locator(LIST)).to_have_text(f"Deadband: {before} ° → {after} °")
    page.locator("#f-deadband_deg").fill("1.1")
    page.reload()
    expect(page.locator("#f-deadband_deg")).to_have_value("1.1")
    page.get_by_role("button", name="Discard it").click()
    expect(page.locator("#f-deadband_deg")).to_have_value("0.9")


def test_a_save_without_a_change_says_so(opened: Opened) -> None:
    page = opened(f"{T1}/settings")
    page.locator("#settings-form > .key-primary").click()
    expect(page.locator(LIST)).to_have_text("No values were changed.")


def test_a_page_says_that_what_tells_it_is_still_coming(opened: Opened, plant: Plant) -> None:
    page = opened("/account")
    held: list[Route] = []
    page.route("**/drafts.js*", lambda route: held.append(route))
    page.goto(f"{plant.url}{T1}/settings")
    page.wait_for_selector('html[data-link="live"][data-keeping="loading"]')
    held[0].continue_()
    page.wait_for_selector(PAGE_READY)
    page.locator("#f-deadband_deg").fill("0.7")
    page.locator("#settings-form > .key-primary").click()
    expect(page.locator(LIST)).to_have_text("Deadband: 0.5 ° → 0.7 °")
