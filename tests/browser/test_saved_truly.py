"""What is told as saved is what is stored now against what was before, whatever the form went through."""

from dataclasses import replace

from playwright.sync_api import expect

from app.tracker.settings.mechanics import Corner, Region
from tests.browser.conftest import Opened, Plant
from tests.browser.one_panel import opened, plant

__all__ = ["opened", "plant"]
T1 = "/trackers/T1"
LIST = ".saved-what"
WALL = Region("Wall", (Corner(170.0, 0.0), Corner(190.0, 0.0), Corner(190.0, 30.0)))


def walled(plant: Plant) -> None:
    tracker = plant.machine.trackers["T1"]
    tracker.config = replace(tracker.config, machine=replace(tracker.config.machine, regions=(WALL,)))


def test_a_region_that_was_removed_is_told(opened: Opened, plant: Plant) -> None:
    walled(plant)
    page = opened(f"{T1}/machine")
    page.locator("#f-region0_name").fill("")
    page.locator("#f-region0_corners").fill("")
    page.get_by_role("button", name="Preview regions").click()
    expect(page.locator("#regions .rg-name")).to_have_count(0)
    page.get_by_role("button", name="Save mechanics").click()
    lines = page.locator(f"{LIST} li")
    expect(lines).to_contain_text(["Region 1: Wall → –", "170 0; 190 0; 190 30 ° → –"])
    expect(lines).to_have_count(2)


def test_a_region_that_a_preview_drew_is_told_when_it_is_saved(opened: Opened, plant: Plant) -> None:
    page = opened(f"{T1}/machine")
    page.locator("#f-region0_name").fill("Wall")
    page.locator("#f-region0_corners").fill("–10 0; 10/0; 10 30")
    page.get_by_role("button", name="Preview regions").click()
    expect(page.locator("#regions .rg-name")).to_have_text("Wall")
    page.get_by_role("button", name="Save mechanics").click()
    lines = page.locator(f"{LIST} li")
    expect(lines).to_contain_text(["Region 1: – → Wall", "– → -10 0; 10 0; 10 30 °"])
    expect(lines).to_have_count(2)


def test_a_drive_that_was_tested_before_it_was_saved_is_told(opened: Opened, plant: Plant) -> None:
    page = opened(f"{T1}/drive")
    stored = page.locator("#f-kind option:checked").inner_text()
    other = "modbus-rtu-over-tcp" if "TCP" in stored else "modbus-tcp"
    page.locator("#f-kind").select_option(other)
    chosen = page.locator("#f-kind option:checked").inner_text()
    with page.expect_response("**/drive/test"):
        page.get_by_role("button", name="Test the connection").click()
    expect(page.locator(".htmx-request")).to_have_count(0)
    page.get_by_role("button", name="Save the drive settings").click()
    expect(page.locator(LIST)).to_contain_text(f"{stored} → {chosen}")


def test_all_that_was_corrected_after_a_refusal_is_told(opened: Opened) -> None:
    page = opened(f"{T1}/settings", allow=("422", "htmx:error"))
    page.locator("#f-night").select_option("park")
    page.locator("#f-deadband_deg").fill("far")
    page.locator("#settings-form > .key-primary").click()
    expect(page.locator("#deadband_deg-error")).to_be_visible()
    page.locator("#f-deadband_deg").fill("0,7")
    page.locator("#settings-form > .key-primary").click()
    expect(page.locator(f"{LIST} li")).to_have_text(
        ["At night: Hold at sunrise position → Move to park", "Deadband: 0.5 ° → 0.7 °"]
    )


def test_a_number_written_otherwise_is_no_change(opened: Opened) -> None:
    page = opened(f"{T1}/settings")
    page.locator("#f-deadband_deg").fill("0,50")
    page.locator("#settings-form > .key-primary").click()
    expect(page.locator(LIST)).to_have_text("No values were changed.")
