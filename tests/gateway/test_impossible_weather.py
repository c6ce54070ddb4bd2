"""What no weather station can have measured is told as a number nowhere: API, page, MQTT, and SunSpec."""

import json
import re
from pathlib import Path
from typing import Any

import pytest

from app.gateway.mqtt_messages import site_payload
from app.gateway.sunspec_points import WEATHER
from app.gateway.sunspec_values import FIXED, View
from app.link.messages import SetMetStation
from app.tracker.state.snapshot import SiteSnapshot
from app.tracker.weather.weather import WeatherNow
from tests.amount import amount
from tests.fakes import FakeMachine, fake_app, serving
from tests.golden.table import rows
from tests.site.test_hostile_station import GOOD, HOST, WORDS, Station, plant_of

SHOWN = r'data-implausible><span class="label">[^<]*</span><span\s+class="value">(.*?)</span>'
ROWS = rows("world/stations.csv")
SOME = amount([ROWS[0], ROWS[4], ROWS[-1]], ROWS)
"""What each row reads as is decided in `site/test_hostile_station.py`; here it is only passed on."""
MODEL_307 = {
    "temperature_degc": "TmpAmb",
    "humidity_pct": "RH",
    "pressure_hpa": "Pres",
    "wind_mps": "WndSpd",
    "wind_direction_deg": "WndDir",
    "rain_mm": "Rain",
    "snow_mm": "Snw",
}


async def reported(row: dict[str, str], folder: Path, *, good_before: bool) -> SiteSnapshot:
    """Return the site once its station has reported this, as its first words or after good ones."""
    words = [int(row[name]) for name in WORDS]
    station = Station(GOOD if good_before else words)
    plant = plant_of(words, folder)
    plant.site.model.make_station = lambda _: station
    await plant.start()
    await plant.commission()
    await plant.ask(SetMetStation(HOST))
    await plant.forward(seconds=3)
    station.words = words
    await plant.forward(seconds=3)
    seen = plant.site.latest()
    await plant.close()
    assert seen is not None
    return seen


def expected(row: dict[str, str]) -> dict[str, float | None]:
    """Return what is to be told of each quantity that the row reports; nothing of one that is impossible."""
    told = {name: float(value) for name, _, value in (one.partition("=") for one in row["readings"].split())}
    return told | dict.fromkeys(row["impossible"].split())


async def by_panel(weather: WeatherNow | None) -> tuple[dict[str, Any], str]:
    machine = FakeMachine()
    machine.weather = weather
    machine.emit()
    async with serving(fake_app(machine)) as browser:
        call, page = await browser.get("/api/v1/site/weather"), await browser.get("/site")
    return (call.json() if call.status_code == 200 else {"readings": {}}), page.text


@pytest.mark.parametrize("good_before", [False, True], ids=["first", "after a good one"])
@pytest.mark.parametrize("row", SOME, ids=[row["what"] for row in SOME])
async def test_an_impossible_value_is_a_number_nowhere(
    row: dict[str, str], good_before: bool, tmp_path: Path
) -> None:
    seen, right = await reported(row, tmp_path, good_before=good_before), expected(row)
    impossible = {name for name, value in right.items() if value is None}
    if good_before:
        assert seen.weather is not None
        marked = {name for name, one in seen.weather.quantities.items() if one.quality == "impossible"}
        assert impossible <= marked
        check_interfaces(seen, right | dict.fromkeys(marked))
        return
    told, page = await by_panel(seen.weather)
    assert {name: told["readings"].get(name) for name in right} == right
    shown = re.findall(SHOWN, page)
    assert [re.sub("<.*?>", "", one).strip() for one in shown] == ["–"] * len(impossible)
    check_interfaces(seen, right)


def check_interfaces(seen: SiteSnapshot, right: dict[str, float | None]) -> None:
    """Compare what MQTT and SunSpec tell with what is right."""
    mqtt = json.loads(site_payload(seen))["weather"] or {}
    assert {name: mqtt.get(name) for name in right} == right
    sunspec = FIXED[WEATHER.number](View(seen, 1))
    assert {name: sunspec.get(MODEL_307[name]) for name in right} == right
