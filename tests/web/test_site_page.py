"""Weather and integrations, on pages and over the API."""

from collections.abc import AsyncIterator

import httpx
import pytest

from tests.fakes import FakeMachine, fake_app, serving

API = "/api/v1/site"


@pytest.fixture
def machine() -> FakeMachine:
    return FakeMachine()


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
    assert answer.json()["source"] == "this computer"
    assert (await panel.get(API)).json()["weather"]["readings"]["wind_mps"] == 7.25
    for page in ("/", "/site"):
        text = (await panel.get(page)).text
        assert "7.2 m/s" in text
        assert "−3.4 °C" in text
        assert "Wind, snow and light act on each tracker" in text
        assert "Humidity" not in text, "what the station does not measure is not shown"


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
    told = {one["name"]: one for one in (await panel.get(f"{API}/integrations")).json()}
    assert told["SunSpec over Modbus TCP"]["status"] == "listening"
    assert told["MQTT"]["waiting"] == 128
    text = (await panel.get("/site")).text
    assert "2 clients connected." in text
    assert "128 events wait to be sent." in text
    assert "set HELIOPANEL_SUNSPEC_SERIAL to open it" in text
    metrics = (await panel.get("/api/v1/metrics")).text
    assert 'heliopanel_gateway_up{gateway="MQTT"} 0.0' in metrics
    assert 'heliopanel_gateway_up{gateway="SunSpec over Modbus TCP"} 1.0' in metrics
    machine.cut()
    assert (await panel.get(f"{API}/integrations")).status_code == 503
    assert "does not tell how its integrations are doing" in (await panel.get("/site")).text
