"""A page that says *saved* says what was saved: what is stored now against what was before."""

from dataclasses import replace

import pytest
from playwright.sync_api import Route, expect

from app.tracker.settings.mechanics import Corner, Region
from tests.browser.conftest import Opened, Plant
from tests.e2e.chromium import PAGE_READY

T1 = "/trackers/T1"
SETTINGS = f"{T1}/settings"
LIST = ".saved-what"
SAVE = "#settings-form > .key-primary"
WALL = Region("Wall", (Corner(170.0, 0.0), Corner(190.0, 0.0), Corner(190.0, 30.0)))
SAVES: dict[str, tuple[str, str, dict[str, str], list[str]]] = {
    "notifications": (
        "/site/notifications", "#notifications-form .key-main",
        {"#f-mail_to": "field@example.org", "#f-webhook_url": "https://example.org/very-secret"},
        ["Webhook", "E-mail to: – → field@example.org"],
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", list(SAVES))
def test_what_was_saved_is_said_but_no_secret(name: str, opened: Opened) -> None:
    path, key, typed, lines = SAVES[name]
    page = opened(path, "phone")
    for field, text in typed.items():
        page.locator(field).fill(text)
    page.locator(key).last.click()
    said = page.locator(LIST)
    for line in lines:
        expect(said).to_contain_text(line)
    expect(said.locator("li")).to_have_count(len(typed))
    assert "very-secret" not in said.inner_text() + page.evaluate("JSON.stringify({...sessionStorage})")


def test_a_change_is_told_against_the_one_before_and_none_is_told_as_none(opened: Opened) -> None:
    page = opened(SETTINGS)
    for before, after in (("0.5", "0.7"), ("0.7", "0.9")):
        page.locator("#f-deadband_deg").fill(after)
        page.locator(SAVE).click()
        expect(page.locator(LIST)).to_have_text(f"Deadband: {before} ° → {after} °")
    page.locator("#f-deadband_deg").fill("0,90")
    page.locator(SAVE).click()
    expect(page.locator(LIST)).to_have_text("No values were changed.")


def test_all_that_was_corrected_after_a_refusal_is_told(opened: Opened) -> None:
    page = opened(SETTINGS, allow=("422", "htmx:error"))
    page.locator("#f-night").select_option("park")
    page.locator("#f-deadband_deg").fill("far")
    page.locator(SAVE).click()
    expect(page.locator("#deadband_deg-error")).to_be_visible()
    page.locator("#f-deadband_deg").fill("0,7")
    page.locator(SAVE).click()
    expect(page.locator(f"{LIST} li")).to_have_text(
        ["At night: Hold at sunrise position → Move to park", "Deadband: 0.5 ° → 0.7 °"]
    )


def test_a_region_that_was_removed_is_told_though_a_preview_took_it_from_the_page(
    opened: Opened, plant: Plant
) -> None:
    tracker = plant.machine.trackers["T1"]
    tracker.config = replace(tracker.config, machine=replace(tracker.config.machine, regions=(WALL,)))
    page = opened(f"{T1}/machine")
    page.locator("#f-region0_name").fill("")
    page.locator("#f-region0_corners").fill("")
    page.get_by_role("button", name="Preview regions").click()
    expect(page.locator("#regions .rg-name")).to_have_count(0)
    page.get_by_role("button", name="Save mechanics").click()
    lines = page.locator(f"{LIST} li")
    expect(lines).to_contain_text(["Region 1: Wall → –", "170 0; 190 0; 190 30 ° → –"])
    expect(lines).to_have_count(2)


def test_a_page_says_that_what_tells_it_is_still_coming(opened: Opened, plant: Plant) -> None:
    page = opened("/account")
    held: list[Route] = []
    page.route("**/drafts.js*", lambda route: held.append(route))
    page.goto(plant.url + SETTINGS)
    page.wait_for_selector('html[data-link="live"][data-keeping="loading"]')
    held[0].continue_()
    page.wait_for_selector(PAGE_READY)
    page.locator("#f-deadband_deg").fill("0.7")
    page.locator(SAVE).click()
    expect(page.locator(LIST)).to_have_text("Deadband: 0.5 ° → 0.7 °")


DRIVE = f"{T1}/drive"


@pytest.mark.parametrize("is_tested", [False, True])
def test_another_drive_is_told_against_the_one_before(opened: Opened, *, is_tested: bool) -> None:
    page = opened(DRIVE)
    page.locator("#f-kind").select_option("modbus-tcp")
    page.locator("#f-host").fill("127.0.0.1")
    page.locator("#f-port").fill("15999")
    page.locator("#f-unit").fill("7")
    if is_tested:
        page.get_by_role("button", name="Test the connection").click()
        expect(page.locator("#drive-check[data-focus]")).to_be_attached()
    page.get_by_role("button", name="Save the drive settings").click()
    expect(page.locator("main .outcome-ok")).to_contain_text("network, 127.0.0.1:15999, unit 7.")
    expect(page.locator(f"{LIST} li")).to_have_text(
        ["Connection: Simulated, built in → Modbus TCP, by network", "Port: 5020 → 15999", "Unit: 1 → 7"]
    )


def test_a_clock_that_was_set_says_what_is_in_use(opened: Opened) -> None:
    page = opened(f"{T1}/commissioning/clock/shadow")
    said = page.locator("main .outcome-ok")
    expect(said).to_have_count(0)
    page.locator("#manual-form .key-main").click()
    expect(said).to_contain_text("Saved. In use: a manually set clock, since")
    expect(said).to_be_in_viewport(ratio=1)
    expect(page.get_by_text("No values were changed.")).to_have_count(0)
