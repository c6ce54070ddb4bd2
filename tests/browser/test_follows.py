"""Pages that go on with what was already there, and follow what comes: curves, weather, the pressed key."""

import re
from dataclasses import replace
from datetime import timedelta
from zoneinfo import ZoneInfo

import pytest
from playwright.sync_api import expect

from app.link.messages import SetLocation
from app.tracker.memory.recording import RecordingKind
from app.tracker.weather.weather import Weather, WeatherNow
from tests.browser.conftest import Opened, Plant
from tests.fake_data import recording


def test_the_last_ten_minutes_begin_with_what_was_recorded(plant: Plant, opened: Opened) -> None:
    began = plant.machine.clock.now() - timedelta(hours=1)
    head = recording("today", RecordingKind.DAY, "Today", 1.0, 7200.0)
    plant.machine.store.heads["today"] = replace(head, began_at=began, ended_at=None)
    page = opened("/trackers/T1", allow=("WebGL",))
    over = page.locator("[data-trend] .u-over")
    box = over.bounding_box()
    assert box is not None
    over.hover(position={"x": box["width"] * 0.02, "y": box["height"] / 2})
    told = page.locator("[data-trend] .u-legend .u-series").first.locator(".u-value")
    at = plant.machine.clock.now().astimezone(ZoneInfo(plant.machine.site.time_zone))
    since = [at - timedelta(minutes=minutes) for minutes in range(2, 11)]
    expect(told).to_have_text(re.compile("|".join(f"^{one:%H:%M}:" for one in since)))


def test_the_weather_card_follows_what_the_station_tells(plant: Plant, opened: Opened) -> None:
    page = opened("/site")
    card = page.locator("#weather")
    expect(card).to_contain_text("No weather station has reported")
    page.locator("#f-host").fill("10.0.0.7")
    for readings, simulated in (
        (Weather(wind_mps=7.5, snow_kg=3.0), True),
        (Weather(wind_mps=7.5), False),
    ):
        plant.machine.weather = WeatherNow(
            readings, plant.machine.clock.now(), 0.0, stale=False, source="mast", simulated=simulated
        )
        expect(card.get_by_role("heading")).to_have_text("Weather, SIMULATED" if simulated else "Weather")
        expect(card.get_by_text("Snow load")).to_have_count(int(readings.snow_kg is not None))
        expect(card).to_contain_text("7.5 m/s")
    expect(page.locator("#f-host")).to_have_value("10.0.0.7")


def test_a_pasted_pair_fills_both_fields_and_is_saved_as_it_is_shown(plant: Plant, opened: Opened) -> None:
    plant.machine.rest()
    page = opened("/trackers/T1/commissioning/location", allow=("422",))
    page.locator("input[name=latitude_side]").nth(1).check(force=True)
    pasted = page.locator("#f-longitude")
    pasted.fill("41°17'12.12\"N 36°19'48.0\"W")
    pasted.press("Control+A")
    pasted.press("Control+X")
    pasted.press("Control+V")
    expect(page.locator("#f-latitude")).to_have_value("41.2867")
    expect(page.locator("#f-longitude")).to_have_value("36.33")
    expect(page.locator("input[name=latitude_side]").nth(0)).to_be_checked()
    expect(page.locator("input[name=longitude_side]").nth(1)).to_be_checked()
    expect(page.locator("#larger")).to_contain_text("41° 17′ 12.1″ N  36° 19′ 48.0″ W")
    pasted.press("Enter")
    instead = page.get_by_role("button", name="Use east")
    expect(instead).to_be_visible()
    pasted.press("Enter")
    expect(instead).to_be_visible()
    assert not [order for order in plant.machine.orders if isinstance(order.command, SetLocation)]
    instead.click()
    page.wait_for_url("**/commissioning/clock")
    (saved,) = [order.command for order in plant.machine.orders if isinstance(order.command, SetLocation)]
    assert (saved.location.latitude_deg, saved.location.longitude_deg) == pytest.approx((41.2867, 36.33))


def test_what_is_typed_is_explained_and_divided_once_its_field_is_left(
    opened: Opened,
) -> None:
    page = opened("/trackers/T1/commissioning/location")
    latitude = page.locator("#f-latitude")
    latitude.fill("41.5° 30'")
    expect(page.locator("#preview")).to_contain_text("only the last number may have decimals")
    latitude.fill("35 18 29 S")
    expect(page.locator("input[name=latitude_side]").nth(1)).to_be_checked()
    expect(page.locator("#larger")).to_contain_text("35° 18′ 29.0″ S")
    page.locator("input[name=latitude_side]").nth(0).check(force=True)
    latitude.fill("39.9208 32.8541")
    expect(page.locator("#larger")).to_contain_text("39° 55′ 14.9″ N  32° 51′ 14.8″ E")
    expect(latitude).to_have_value("39.9208 32.8541")
    latitude.blur()
    expect(latitude).to_have_value("39.9208")
    expect(page.locator("#f-longitude")).to_have_value("32.8541")
