"""A clock that would move the site's is shown with what it changes, and set by a key that is held."""

from dataclasses import replace
from datetime import timedelta

from playwright.sync_api import Page

from app.link.messages import SetClock
from app.tracker.memory.memory import ClockSetting
from tests.browser.page_clock import Stage
from tests.fakes import FakeMachine

CLOCK = "/trackers/T1/commissioning/clock"
SURE = '.question [name="confirmed"]'
COUNTS_MS = 2000
COARSE_MS = 250
AHEAD = timedelta(hours=11, minutes=39)


def test_a_clock_that_is_copied_from_this_device_is_held(stage: Stage) -> None:
    stage.beat_ms = COARSE_MS
    stage.plant.machine.off_s = 20.0
    stage.do(stage.plant.machine.rest)
    page = stage.open(CLOCK, "phone", touch=True, allow=("422",))
    error = page.locator("#clock-error")
    stage.until(error.is_visible)
    stage.do(lambda: set_ahead(stage.plant.machine))
    stage.until(error.is_hidden)
    page.locator('input[value="device"]').check()
    page.locator("#forward .key").click()
    stage.until(page.locator(SURE).count)
    asked = page.locator(".question").inner_text()
    assert "The controller's clock would be set back by 11 h 39 min." in asked
    assert "Sun: " in asked
    hold(stage, page, COUNTS_MS - COARSE_MS)
    stage.advance(500)
    assert not clocks(stage)
    hold(stage, page, COUNTS_MS + COARSE_MS)
    stage.until(lambda: page.locator(SURE).count() == 0)
    (order,) = clocks(stage)
    assert order.source == "manual"
    assert order.at is not None


def test_a_clock_that_is_refused_keeps_what_was_typed(stage: Stage) -> None:
    page = stage.open(f"{CLOCK}/shadow", "tablet", allow=("409", "Failed to load resource", "htmx:error"))
    page.locator("#f-date").fill("2026-06-21")
    page.locator("#f-time").fill("12:00:30")
    page.locator("#manual-form .key-main").click()
    told = page.locator("#manual-form .outcome")
    stage.until(lambda: "End tracking of T2 first." in told.inner_text())
    assert page.locator("#f-time").input_value() == "12:00:30"
    assert page.locator(SURE).count() == 0
    assert not clocks(stage)


def hold(stage: Stage, page: Page, for_ms: int) -> None:
    page.locator(SURE).focus()
    page.keyboard.down("Enter")
    stage.advance(for_ms)
    page.keyboard.up("Enter")


def set_ahead(machine: FakeMachine) -> None:
    machine.site = replace(machine.site, clock=ClockSetting("manual", AHEAD.total_seconds()))
    machine.emit()


def clocks(stage: Stage) -> list[SetClock]:
    return [one.command for one in stage.plant.machine.orders if isinstance(one.command, SetClock)]
