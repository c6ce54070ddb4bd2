"""A show planned, run and replayed, and a simulated day played, on the pages of the real service."""

import re

import pytest
from playwright.sync_api import Page, expect

from tests.browser.hands import Mouse, arrive, until
from tests.browser.walking import Picture, Walker, rooms, say_where, service, walker
from tests.e2e.chromium import PAGE_READY
from tests.e2e.integrator import Integrator
from tests.patience import PATIENCE_MS

__all__ = ["rooms", "service", "walker"]


def ready(service: str) -> None:
    """Bring the tracker to where a show can be planned: placed, zeroed, its clock trusted."""
    calling = Integrator(service)
    calling.place_and_time()
    calling.zero()
    calling.command("set_mode", mode="dual")
    calling.close()


def progressed(page: Page, bar: str, beyond: float) -> None:
    """Return once a bar of the page is beyond a value."""
    shown = page.locator(bar)
    until(page, lambda: float(shown.evaluate("bar => bar.value")) > beyond, within_ms=PATIENCE_MS)


@pytest.mark.timeout(180)
def test_solstice_is_shown_and_replayed(walker: Walker, service: str, picture: Picture) -> None:
    page = walker("desk", "mouse")
    hands = Mouse(page)
    ready(service)
    page.goto(f"{service}/trackers/T1/show")
    hands.press(page.get_by_role("link", name="21 June"))
    hands.write(page.locator("#f-minutes"), "0.2")
    expect(page.locator("#verdict:not([inert])")).to_contain_text("cannot be run")
    hands.press(page.locator("#verdict a.key-primary"))
    expect(page.locator("#verdict")).to_contain_text("This works")
    hands.press(page.locator('[data-action="go_to_start"]'))
    arrive(page, "/shows/.*")
    expect(page.locator("#show-phase")).to_have_text("Ready at the start", timeout=60000)
    hands.press(page.locator('[data-action="run_show"]'))
    expect(page.locator("#show-phase")).to_have_text("Running")
    progressed(page, "#show-progress", 0.02)
    picture(page, "show-on-the-machine")
    hands.press(page.locator('[data-action="pause_show"]'))
    expect(page.locator("#show-phase")).to_have_text("Paused")
    hands.press(page.locator('[data-action="stop_show"]'))
    expect(page.locator("#show-phase")).to_have_text("Ended")
    hands.press(page.get_by_role("link", name="Replay"))
    expect(page.locator("h1")).to_have_text(re.compile("Replay: Show of .*-06-21"))
    expect(page.locator("#player-state")).to_have_text("")
    hands.press(page.locator("#player-play"))
    progressed(page, "#player-scrubber", 1.0)
    picture(page, "replay")


def test_simulated_day_is_played(walker: Walker, service: str, picture: Picture) -> None:
    page = walker("desk", "mouse")
    hands = Mouse(page)
    page.goto(f"{service}/trackers/T1/commissioning/location")
    page.wait_for_selector(PAGE_READY)
    say_where(page, hands)
    page.goto(f"{service}/simulate")
    hands.write(page.locator("#f-date"), "2026-06-21")
    hands.press(page.locator("#simulate-form button"))
    page.wait_for_url(re.compile("/recordings/"), timeout=90000)
    expect(page.locator("#player-state")).to_have_text("")
    page.locator("#player-scrubber").fill("43200")
    picture(page, "simulated-day")
    expect(page.locator('[data-value="measured_elevation_deg"]')).to_have_text(re.compile(r"^[67]\d\."))
