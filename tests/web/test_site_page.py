"""Weather and integrations, on pages and over the API."""

import re
from collections.abc import AsyncIterator
from dataclasses import asdict, replace

import httpx
import pytest

from app.base.build import VERSION
from app.tracker.commands.control import ControlState
from app.tracker.settings.config import DriveConfig, DriveKind
from app.tracker.state.snapshot import SiteSnapshot
from app.tracker.weather.simulated_weather import Scenario, SimulatedStation
from app.tracker.weather.weather import Quality, Reading, Weather, WeatherNow
from app.tracker.weather.weather_windows import WeatherWindows
from tests.fakes import FakeMachine, fake_app, serving

API = "/api/v1/site"


@pytest.fixture
async def panel(machine: FakeMachine) -> AsyncIterator[httpx.AsyncClient]:
    async with serving(fake_app(machine)) as client:
        yield client


async def test_a_report_of_the_weather_is_shown_with_its_age(
    panel: httpx.AsyncClient, machine: FakeMachine
) -> None:
    assert (await panel.get(f"{API}/weather")).status_code == 404
    assert "No weather station has reported" in (await panel.get("/site")).text
    answer = await panel.put(f"{API}/weather", json={"wind_mps": 7.25, "temperature_degc": -3.4})
    assert answer.status_code == 200
    assert answer.json()["source"] == "local user"
    assert (await panel.get(API)).json()["weather"]["readings"]["wind_mps"] == 7.25
    for page in ("/", "/site"):
        text = (await panel.get(page)).text
        assert "7.2 m/s" in text
        assert "−3.4 °C" in text
        assert "Wind, snow, and irradiance act on each tracker according to its protection settings" in text
        assert "Humidity" not in text, "what the station does not measure is not shown"


async def test_the_page_ends_with_the_version(panel: httpx.AsyncClient) -> None:
    assert f">Heliopanel {VERSION}</p>" in (await panel.get("/site")).text


async def test_without_the_machine_nothing_is_said_to_be_well(
    panel: httpx.AsyncClient, machine: FakeMachine
) -> None:
    assert "No alarms" in (await panel.get("/site")).text
    machine.cut()
    for path, sentence in (
        ("/site", "weather data is unavailable"),
        ("/alarms", "so the active alarms are not known"),
    ):
        text = (await panel.get(path)).text
        assert sentence in text
        assert "Alarm status unavailable" in text
        assert "No alarms" not in text
        assert "No weather station has reported" not in text


@pytest.mark.parametrize(
    "wrong",
    [
        "{}",
        '{"wind_mps": NaN}',
        '{"wind_mps": -1}',
        '{"humidity_pct": 101}',
        '{"wind_mps": 3, "moon": 1}',
        '{"wind_mps": 3, "measured_at": "2026-11-21T10:00:00"}',
    ],
)
async def test_weather_that_cannot_be_is_refused(panel: httpx.AsyncClient, wrong: str) -> None:
    head = {"Content-Type": "application/json"}
    assert (await panel.put(f"{API}/weather", content=wrong, headers=head)).status_code == 422
    assert (await panel.get(f"{API}/weather")).status_code == 404


async def test_every_integration_tells_its_state(panel: httpx.AsyncClient, machine: FakeMachine) -> None:
    told = {one["name"]: one for one in (await panel.get(f"{API}/integrations")).json()["items"]}
    assert told["SunSpec over Modbus TCP"]["status"] == "listening"
    assert told["MQTT"]["waiting"] == 128
    text = (await panel.get("/site")).text
    assert "2 clients connected." in text
    assert "128 events wait to be sent." in text
    assert "set HELIOPANEL_SUNSPEC_SERIAL_PORT to enable it" in text
    metrics = (await panel.get("/api/v1/metrics")).text
    assert 'heliopanel_gateway_up{gateway="MQTT"} 0.0' in metrics
    assert 'heliopanel_gateway_up{gateway="SunSpec over Modbus TCP"} 1.0' in metrics
    machine.cut()
    assert (await panel.get(f"{API}/integrations")).status_code == 503
    assert "does not report the status of its integrations" in (await panel.get("/site")).text


SIMULATED = {
    "scenario": "manual",
    "seed": "5",
    "wind_mps": "12,5",
    "gustiness_pct": "40",
    "wind_direction_deg": "300",
    "irradiance_wm2": "",
    "snow_kg": "2",
    "temperature_degc": "-4",
}


async def test_made_up_weather_is_chosen_and_ended_on_the_page(
    panel: httpx.AsyncClient, machine: FakeMachine
) -> None:
    assert "Simulate this weather" in (await panel.get("/site")).text
    assert (await panel.post("/site/simulated-weather", data=SIMULATED)).status_code == 303
    assert machine.site.simulated_weather == SimulatedStation(
        Scenario.MANUAL, 5, 12.5, 40.0, 300.0, None, 2.0, -4.0
    )
    text = (await panel.get("/site")).text
    assert "SIMULATED now" in text
    assert 'value="12.5"' in text
    assert (await panel.post("/site/simulated-weather/end")).status_code == 303
    assert machine.site.simulated_weather is None


async def test_made_up_weather_that_cannot_be_keeps_what_was_typed(
    panel: httpx.AsyncClient, machine: FakeMachine
) -> None:
    wrong = SIMULATED | {"wind_mps": "51", "scenario": "hurricane", "snow_kg": ""}
    answer = await panel.post("/site/simulated-weather", data=wrong)
    assert answer.status_code == 422
    assert "3 values have errors" in answer.text
    assert "The simulated mean wind must be between 0 and 50." in answer.text
    assert 'value="51"' in answer.text
    assert machine.orders == []


async def test_a_site_with_a_real_tracker_is_offered_no_made_up_weather(
    panel: httpx.AsyncClient, machine: FakeMachine
) -> None:
    real = machine.trackers["T2"]
    real.config = replace(real.config, drive=DriveConfig(DriveKind.MODBUS_TCP, host="10.0.0.5"))
    text = (await panel.get("/site")).text
    assert "Only for sites where every tracker is simulated: T2 is not" in text
    assert "Simulate this weather" not in text


async def test_made_up_weather_over_the_api(panel: httpx.AsyncClient, machine: FakeMachine) -> None:
    url = f"{API}/weather/simulation"
    assert (await panel.get(url)).json() is None
    told = await panel.put(url, json={"scenario": "storm", "seed": 9})
    assert told.status_code == 200
    assert (told.json()["scenario"], told.json()["seed"]) == ("storm", 9)
    for wrong in ({"wind_mps": 51}, {"seed": -1}, {"scenario": "flood"}, {"moon": 1}):
        assert (await panel.put(url, json=wrong)).status_code == 422
    assert (await panel.delete(url)).status_code == 204
    assert machine.site.simulated_weather is None


async def test_windows_and_ages_are_set_on_the_page_and_over_the_api(
    panel: httpx.AsyncClient, machine: FakeMachine
) -> None:
    url = f"{API}/weather/windows"
    usual = WeatherWindows()
    assert (await panel.get(url)).json() == asdict(usual)
    text = (await panel.get("/site")).text
    assert "5 to 86400, usual 300." in text
    typed = {name: str(value) for name, value in asdict(usual).items()}
    done = await panel.post("/site/weather-windows", data=typed | {"wind_old_after_s": "20"})
    assert done.status_code == 303
    assert machine.site.weather_windows == replace(usual, wind_old_after_s=20.0)
    wrong = await panel.post("/site/weather-windows", data=typed | {"gust_s": "61", "mean_s": "x"})
    assert wrong.status_code == 422
    assert "The window of the gust must be between 1 and 60." in wrong.text
    assert 'value="61"' in wrong.text
    assert (await panel.put(url, json={"gust_s": 5})).json() == asdict(replace(usual, gust_s=5.0))
    assert (await panel.put(url, json={"mean_s": 59})).status_code == 422


async def test_made_up_weather_is_marked_where_it_is_shown(
    panel: httpx.AsyncClient, machine: FakeMachine
) -> None:
    source = "SIMULATED station (storm)"
    machine.weather = WeatherNow(
        Weather(wind_mps=9.0), machine.clock.now(), 0.0, stale=False, source=source, simulated=True
    )
    machine.emit()
    for page in ("/", "/site"):
        text = (await panel.get(page)).text
        assert "Weather, SIMULATED" in text
        assert "the simulated station" in text
    assert (await panel.get(f"{API}/weather")).json()["simulated"] is True


async def test_without_the_machine_no_settings_are_offered(
    panel: httpx.AsyncClient, machine: FakeMachine
) -> None:
    machine.cut()
    text = (await panel.get("/site")).text
    assert "its settings are unavailable" in text
    assert "station-form" not in text


class HeldMachine(FakeMachine):
    """A machine of whose trackers SunSpec has control of the second."""

    def _snapshot(self) -> SiteSnapshot:
        site = super()._snapshot()
        held = replace(site.trackers[1], control=ControlState(3, holder="SunSpec", via="sunspec"))
        return replace(site, trackers=(site.trackers[0], held))


async def test_the_site_says_who_may_write_and_what_a_gateway_has_control_of() -> None:
    async with serving(fake_app(HeldMachine())) as client:
        page = (await client.get("/site")).text
        told = (await client.get("/api/v1/site/integrations")).json()["items"]
        overview = (await client.get("/")).text
    assert "10.0.0.5 may write; all other hosts can only read. This integration has control of T2." in page
    assert told[0]["writes"] == "10.0.0.5 may write; all other hosts can only read."
    assert re.search(r'data-live="control.holder"[^>]*>SunSpec<', overview)
    async with serving(fake_app(FakeMachine())) as client:
        assert "This integration has control of no tracker" in (await client.get("/site")).text


async def test_an_implausible_value_is_shown_without_a_number_also_of_a_second_mast(
    machine: FakeMachine, panel: httpx.AsyncClient
) -> None:
    reading, nothing = Reading(4.0, Quality.GOOD, 0.0, "west"), Reading(None, Quality.IMPOSSIBLE, 0.0, "east")
    machine.weather = WeatherNow(
        Weather(wind_mps=4.0),
        machine.clock.now(),
        0.0,
        stale=False,
        source="west",
        quantities={"wind_mps": reading, "pressure_hpa": nothing},
        winds={"west": reading, "east": nothing},
    )
    machine.emit()
    page = (await panel.get("/site")).text
    assert page.count("reports an implausible value") == 1
    assert "east: – m/s (impossible)" in " ".join(page.split())
    assert "Humidity" not in page.partition("</section>")[0]
