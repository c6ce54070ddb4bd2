"""Weather and integrations, on pages and over the API."""

import re
from dataclasses import asdict, replace

import httpx

from app.tracker.commands.control import ControlState
from app.tracker.state.snapshot import SiteSnapshot
from app.tracker.weather.simulated_weather import Scenario, SimulatedStation
from app.tracker.weather.weather import Quality, Reading, Weather, WeatherNow
from app.tracker.weather.weather_windows import WeatherWindows
from tests.fakes import FakeMachine, fake_app, serving

API = "/api/v1/site"


async def test_a_report_of_the_weather_is_shown_with_its_age(
    client: httpx.AsyncClient, machine: FakeMachine
) -> None:
    assert (await client.get(f"{API}/weather")).status_code == 404
    assert "No weather station has reported" in (await client.get("/site")).text
    answer = await client.put(f"{API}/weather", json={"wind_mps": 7.25, "temperature_degc": -3.4})
    assert answer.status_code == 200
    assert answer.json()["source"] == "local user"
    assert (await client.get(API)).json()["weather"]["readings"]["wind_mps"] == 7.25
    for page in ("/", "/site"):
        text = (await client.get(page)).text
        assert "7.2 m/s" in text
        assert "−3.4 °C" in text
        assert "Wind, snow, and irradiance act on each tracker according to its protection settings" in text
        assert "Humidity" not in text, "what the station does not measure is not shown"


async def test_without_the_machine_nothing_is_said_to_be_well(
    client: httpx.AsyncClient, machine: FakeMachine
) -> None:
    assert "No alarms" in (await client.get("/site")).text
    machine.cut()
    for path, sentence in (
        ("/site", "weather data is unavailable"),
        ("/alarms", "so the active alarms are not known"),
    ):
        text = (await client.get(path)).text
        assert sentence in text
        assert "Alarm status unavailable" in text
        assert "No alarms" not in text
        assert "No weather station has reported" not in text


async def test_every_integration_tells_its_state(client: httpx.AsyncClient, machine: FakeMachine) -> None:
    told = {one["name"]: one for one in (await client.get(f"{API}/integrations")).json()["items"]}
    assert told["SunSpec over Modbus TCP"]["status"] == "listening"
    assert told["MQTT"]["waiting"] == 128
    text = (await client.get("/site")).text
    assert "2 clients connected." in text
    assert "128 events wait to be sent." in text
    assert "set HELIOPANEL_SUNSPEC_SERIAL_PORT to enable it" in text
    metrics = (await client.get("/api/v1/metrics")).text
    assert 'heliopanel_gateway_up{gateway="MQTT"} 0.0' in metrics
    assert 'heliopanel_gateway_up{gateway="SunSpec over Modbus TCP"} 1.0' in metrics
    machine.cut()
    assert (await client.get(f"{API}/integrations")).status_code == 503
    assert "does not report the status of its integrations" in (await client.get("/site")).text


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
    client: httpx.AsyncClient, machine: FakeMachine
) -> None:
    assert "Simulate this weather" in (await client.get("/site")).text
    assert (await client.post("/site/simulated-weather", data=SIMULATED)).status_code == 303
    assert machine.site.simulated_weather == SimulatedStation(
        Scenario.MANUAL, 5, 12.5, 40.0, 300.0, None, 2.0, -4.0
    )
    text = (await client.get("/site")).text
    assert "SIMULATED now" in text
    assert 'value="12.5"' in text
    assert (await client.post("/site/simulated-weather/end")).status_code == 303
    assert machine.site.simulated_weather is None


async def test_windows_and_ages_are_set_on_the_page_and_over_the_api(
    client: httpx.AsyncClient, machine: FakeMachine
) -> None:
    url = f"{API}/weather/windows"
    usual = WeatherWindows()
    assert (await client.get(url)).json() == asdict(usual)
    text = (await client.get("/site")).text
    assert "5 to 86400, usual 300." in text
    typed = {name: str(value) for name, value in asdict(usual).items()}
    done = await client.post("/site/weather-windows", data=typed | {"wind_old_after_s": "20"})
    assert done.status_code == 303
    assert machine.site.weather_windows == replace(usual, wind_old_after_s=20.0)
    wrong = await client.post("/site/weather-windows", data=typed | {"gust_s": "61", "mean_s": "x"})
    assert wrong.status_code == 422
    assert "The window of the gust must be between 1 and 60." in wrong.text
    assert 'value="61"' in wrong.text
    assert (await client.put(url, json={"gust_s": 5})).json() == asdict(replace(usual, gust_s=5.0))
    assert (await client.put(url, json={"mean_s": 59})).status_code == 422


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
    machine: FakeMachine, client: httpx.AsyncClient
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
    page = (await client.get("/site")).text
    assert page.count("reports an implausible value") == 1
    assert "east: – m/s (impossible)" in " ".join(page.split())
    assert "Humidity" not in page.partition("</section>")[0]
