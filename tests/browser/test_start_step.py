"""Step 5: how long the panel takes to its target, and what takes the place of *Start tracking*."""

from playwright.sync_api import expect

from app.tracker.commands.commands import SelectMode
from app.tracker.settings.config import Orientation
from app.tracker.values.mode import Mode
from tests.browser.page_clock import Stage

START = "/trackers/T1/commissioning/run"


def test_the_duration_is_that_of_the_slower_axis(stage: Stage) -> None:
    """T1 stands at 180 and 45 degrees; both its axes turn at 3 °/s and speed up by 1.5 °/s²."""
    tracker = stage.plant.machine.trackers["T1"]
    config = tracker.config
    page = stage.open(START, "tablet")
    for azimuth_deg, elevation_deg in ((180.0, 45.0), (181.0, 45.0), (180.0, 85.0), (270.0, 45.0)):
        choice = SelectMode(Mode.FIXED, Orientation(azimuth_deg, elevation_deg))
        stage.do(lambda choice=choice: tracker.handle(choice, stage.clock.now(), "ada"))
        page.reload()
        stage.live(page)
        ways = (abs(azimuth_deg - 180.0), config.azimuth), (abs(elevation_deg - 45.0), config.elevation)
        lasts_s = max(seconds(way, axis.speed_dps, axis.acceleration_dps2) for way, axis in ways)
        minutes, rest = divmod(round(lasts_s + 0.4999), 60)
        told = (
            f"{minutes} min {rest:02d} s"
            if minutes and rest
            else f"{minutes} min"
            if minutes
            else f"{rest} s"
        )
        stage.until(lambda told=told: page.locator("#run-lasts").inner_text() == told)
        assert page.locator('[data-to="azimuth"]').inner_text() == f"{azimuth_deg:.2f}°"
        assert page.locator('[data-to="elevation"]').inner_text() == f"{elevation_deg:.2f}°"


def seconds(way_deg: float, speed_dps: float, acceleration_dps2: float) -> float:
    """Return how long a way takes from rest to rest, stepped in milliseconds by the axis's own ramp."""
    gone_deg, now_dps, steps = 0.0, 0.0, 0
    while way_deg - gone_deg > 1e-6:
        braking_dps = (2.0 * acceleration_dps2 * (way_deg - gone_deg)) ** 0.5
        now_dps = min(now_dps + acceleration_dps2 / 1000.0, speed_dps, braking_dps)
        gone_deg += max(now_dps, 1e-4) / 1000.0
        steps += 1
    return steps / 1000.0


def test_what_ends_tracking_takes_the_place_of_what_started_it(stage: Stage) -> None:
    page = stage.open(START, "tablet")
    start = page.locator('.slot-1 [data-action="track"]')
    stage.until(start.is_enabled)
    box = start.bounding_box()
    start.click()
    end = page.locator('.slot-1 form[action$="/stop"] button')
    stage.until(end.is_visible)
    assert end.bounding_box() == box
    expect(page.locator("#forward .key")).to_have_count(0)
    expect(page.locator(".run-card").filter(has_text="Pointing error")).to_be_visible()
    expect(page.locator("#run-lasts")).to_be_hidden()
