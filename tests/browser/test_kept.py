"""What was typed outlives a reload; the theme follows the sun."""

from dataclasses import replace
from datetime import timedelta
from functools import partial

from playwright.sync_api import Page, expect

from tests.browser.conftest import Opened, Plant
from tests.e2e.chromium import PAGE_READY
from tests.fakes import FakeMachine

SETTINGS = "/trackers/T1/settings"
NOTE = ".kept-note"


def reloaded(page: Page) -> None:
    page.reload()
    page.wait_for_selector(PAGE_READY)


def test_what_was_typed_is_back_after_a_reload_until_it_is_saved_or_discarded(
    plant: Plant, opened: Opened
) -> None:
    page = opened(SETTINGS)
    expect(page.locator(NOTE)).to_have_count(0)
    page.locator("#f-deadband_deg").fill("0,9")
    page.locator("#f-night").select_option("park")
    page.locator('[type=checkbox][name="refraction"]').uncheck()
    reloaded(page)
    expect(page.locator(NOTE)).to_contain_text("not saved yet")
    expect(page.locator("#f-deadband_deg")).to_have_value("0,9")
    expect(page.locator("#f-night")).to_have_value("park")
    expect(page.locator('[type=checkbox][name="refraction"]')).not_to_be_checked()
    page.get_by_role("button", name="Save settings").click()
    expect(page.locator("#settings-outcome")).to_contain_text("saved")
    reloaded(page)
    expect(page.locator(NOTE)).to_have_count(0)
    expect(page.locator("#f-deadband_deg")).to_have_value("0.9")
    page.locator("#f-deadband_deg").fill("0.7")
    reloaded(page)
    page.get_by_role("button", name="Discard it").click()
    expect(page.locator(NOTE)).to_have_count(0)
    expect(page.locator("#f-deadband_deg")).to_have_value("0.9")


def test_an_order_without_an_answer_says_so_and_keeps_what_was_typed(plant: Plant, opened: Opened) -> None:
    page = opened("/trackers/T1/commissioning/location", allow=("Failed to load resource", "htmx:error"))
    page.locator("#f-latitude").fill("12.5")
    page.route("**/commissioning/location", lambda route: route.abort())
    page.locator("#forward .key").click()
    expect(page.locator("#step-form .outcome")).to_contain_text(
        "the command may or may not have been executed"
    )
    expect(page.locator("#f-latitude")).to_have_value("12.5")


def test_a_plan_worked_out_for_other_values_cannot_be_started(plant: Plant, opened: Opened) -> None:
    page = opened("/trackers/T1/show?date=2026-06-21&start=05:07&end=20:19&minutes=9")
    key = page.get_by_role("button", name="Go to start position")
    expect(key).to_be_visible()
    page.locator("#f-minutes").fill("12")
    assert page.locator("#verdict").evaluate("one => one.inert")
    expect(page.locator('#verdict [name="minutes"]')).to_have_value("12")
    assert not page.locator("#verdict").evaluate("one => one.inert")
    expect(key).to_be_enabled()


def test_auto_follows_the_sun(plant: Plant, opened: Opened) -> None:
    machine = plant.machine
    page = opened("/", theme="auto")
    offset = machine.site.clock.offset_s
    for hours, theme in ((9.5, "sun"), (21.5, "night")):
        now = machine.clock.now()
        at = now.replace(hour=0, minute=0, second=0) + timedelta(hours=hours)
        plant.do(partial(set_clock, machine, offset + (at - now).total_seconds()))
        page.wait_for_selector(f'html[data-theme="{theme}"]')
    assert page.locator("#theme-form .theme-key").inner_text().strip() == "Auto"


def set_clock(machine: FakeMachine, offset_s: float) -> None:
    machine.site = replace(machine.site, clock=replace(machine.site.clock, offset_s=offset_s))
