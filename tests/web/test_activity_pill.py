"""Pages say of a panel on its way that it moves to the sun, and of simulated weather that it is simulated."""

import re

import httpx
import pytest

from app.tracker.state.snapshot import ActivityName, SensorState
from app.tracker.weather.weather import Quality, Quantity, Weather, WeatherNow
from tests.fakes import FakeMachine

T1 = "/trackers/T1"
WIND = SensorState(Quantity.WIND, True, True, 9.0, 17.0, "m/s", Quality.GOOD, 0.0, "Protects against wind.")
MARK = re.compile(r'<b class="simulated" data-when="site.weather.simulated=true">SIMULATED</b>')
HIDDEN_MARK = re.compile(r'<b class="simulated" data-when="site.weather.simulated=true" hidden>')


@pytest.mark.parametrize("page", ["/", T1, f"{T1}/commissioning/homing"])
async def test_the_pill_tells_the_way_from_tracking(
    page: str, client: httpx.AsyncClient, machine: FakeMachine
) -> None:
    tracker = machine.trackers["T1"]
    for approaching, word in ((True, "Moving to the sun"), (False, "Tracking")):
        tracker.activity, tracker.approaching = ActivityName.TRACKING, approaching
        machine.emit()
        text = (await client.get(page)).text
        if page == "/":
            text = text.split('data-tracker="T1"')[1].split("</li>")[0]
        assert re.search(rf'data-live="state" data-form="words">{word}<', text)


@pytest.mark.parametrize("page", ["/", T1, f"{T1}/trends"])
async def test_wherever_wind_is_shown_simulated_weather_is_marked(
    page: str, client: httpx.AsyncClient, machine: FakeMachine
) -> None:
    machine.trackers["T1"].sensors = (WIND,)
    for simulated in (True, False):
        machine.weather = WeatherNow(
            Weather(wind_mps=9.0), machine.clock.now(), 0.0, stale=False, source="x", simulated=simulated
        )
        machine.emit()
        text = (await client.get(page)).text
        assert bool(MARK.search(text)) is simulated
        assert bool(HIDDEN_MARK.search(text)) is not simulated
        assert page != "/" or (">Weather, SIMULATED<" in text) is simulated
