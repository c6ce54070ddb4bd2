"""The protections page: what is set, what is refused with what was typed, stows and the maintenance lock."""

import httpx
import pytest

from app.tracker.commands.commands import ReleaseInhibit, Resume, SetInhibit, Stow
from app.tracker.memory.memory import MetStation
from app.tracker.settings.protections import (
    PROTECTED,
    Facing,
    ProtectionConfig,
    Reaction,
    StowName,
    StowPlace,
)
from app.web.shell.setting_forms import texts
from tests.fakes import FakeMachine

ROOT = "/trackers/T1"
PAGE = f"{ROOT}/protections"
API = "/api/v1/trackers/T1"


def kept(machine: FakeMachine) -> ProtectionConfig:
    found = machine.trackers["T1"].config.protection
    assert isinstance(found, ProtectionConfig)
    return found


async def test_what_the_page_shows_is_what_it_saves(client: httpx.AsyncClient, machine: FakeMachine) -> None:
    await client.post(PAGE, data=texts(PROTECTED))
    assert kept(machine) == PROTECTED
    changed = {
        "wind_gust_mps": "14,5",
        "wind_bad": "hold",
        "wind_facing": "back",
        "snow_enabled": "",
        "stows_hail_elevation_deg": "20",
        "stows_hail_azimuth_deg": "270",
        "warning_s": "8",
    }
    await client.post(PAGE, data=texts(PROTECTED) | changed)
    saved = kept(machine)
    assert saved.wind.gust_mps == 14.5
    assert (saved.wind.bad, saved.wind.facing) == (Reaction.HOLD, Facing.BACK)
    assert not saved.snow.enabled
    assert saved.stows.hail == StowPlace(20.0, 270.0)
    assert saved.stows.wind == StowPlace(90.0)
    assert saved.warning_s == 8.0


@pytest.mark.parametrize(
    ("typed", "sentence"),
    [
        ({"wind_gust_mps": "fast"}, "Wind: Gust threshold: type a number"),
        ({"wind_hysteresis_mps": "18"}, "must be smaller than both wind thresholds"),
        ({"light_bad": "stow"}, "Low light: Sensor-fault reaction: choose one from the list"),
        ({"wind_bad": "pray"}, "Wind: Sensor-fault reaction: choose one from the list"),
        ({"stows_snow_azimuth_deg": "400"}, "Snow: Azimuth must be between 0 and 360"),
    ],
)
async def test_what_cannot_be_is_refused_and_stays_in_the_form(
    client: httpx.AsyncClient, machine: FakeMachine, typed: dict[str, str], sentence: str
) -> None:
    answer = await client.post(PAGE, data=texts(PROTECTED) | {"wind_resume_after_s": "777"} | typed)
    assert answer.status_code == 422
    assert sentence in answer.text
    assert 'value="777"' in answer.text
    assert not machine.orders


async def test_the_keys_give_the_commands(client: httpx.AsyncClient, machine: FakeMachine) -> None:
    await client.post(f"{ROOT}/stow", data={"position": "hail"})
    await client.post(f"{ROOT}/resume")
    await client.post(f"{ROOT}/lock", data={"name": "Ada", "reason": "new bearing"})
    await client.post(f"{ROOT}/release-lock")
    given = [order.command for order in machine.orders]
    assert given == [Stow(StowName.HAIL), Resume(), SetInhibit("Ada", "new bearing"), ReleaseInhibit()]
    assert (await client.post(f"{ROOT}/stow", data={"position": "moon"})).status_code == 422


async def test_the_api_does_what_the_page_does(client: httpx.AsyncClient, machine: FakeMachine) -> None:
    for body in (
        {"type": "stow", "position": "cleaning"},
        {"type": "resume"},
        {"type": "set_inhibit", "name": "Ada"},
        {"type": "release_inhibit"},
    ):
        assert (await client.post(f"{API}/commands", json=body)).status_code == 202
    given = [order.command for order in machine.orders]
    assert given == [Stow(StowName.CLEANING), Resume(), SetInhibit("Ada"), ReleaseInhibit()]
    change = {"wind": {"gust_mps": 12.0}, "stows": {"snow": {"azimuth_deg": 90.0}}}
    assert (await client.patch(API, json={"protection": change})).status_code == 200
    assert (kept(machine).wind.gust_mps, kept(machine).stows.snow) == (12.0, StowPlace(0.0, 90.0))
    await client.patch(API, json={"protection": {"stows": {"snow": {"azimuth_deg": None}}}})
    assert kept(machine).stows.snow == StowPlace(0.0)
    wrong = await client.patch(API, json={"protection": {"light": {"bad": "stow"}}})
    assert (wrong.status_code, "cannot cause a stow" in wrong.text) == (422, True)


async def test_a_weather_station_is_set_on_the_site_page_and_over_the_api(
    client: httpx.AsyncClient, machine: FakeMachine
) -> None:
    await client.post("/site/weather-station", data={"host": "10.0.0.9", "port": "1502", "unit": "7"})
    assert machine.site.met_station == MetStation("10.0.0.9", 1502, 7)
    assert 'value="1502"' in (await client.get("/site")).text
    api = "/api/v1/site/weather/station"
    assert (await client.get(api)).json() == {"host": "10.0.0.9", "port": 1502, "unit": 7}
    wrong = await client.post("/site/weather-station", data={"host": "mast", "port": "none", "unit": "1"})
    assert wrong.status_code == 422
    assert 'value="mast"' in wrong.text
    await client.post("/site/weather-station", data={"host": "", "port": "502", "unit": "1"})
    assert machine.site.met_station is None
    assert (await client.put(api, json={"host": "mast"})).json() == {"host": "mast", "port": 502, "unit": 1}
    assert (await client.delete(api)).status_code == 204
    assert (await client.get(api)).json() is None
