"""A storm over a field, as real processes: the controller lives, ticks come on time, all go to shelter."""

import asyncio
from collections.abc import AsyncIterator, Awaitable, Callable
from datetime import UTC, datetime
from pathlib import Path

import pytest

from app.link.messages import StopAll
from app.link.weather_orders import ReportWeather
from app.tracker.snapshot import ActivityName, EventKind
from app.tracker.weather import Weather
from tests.fault_result import BY_ITSELF, REAL, FaultResult
from tests.machine.field import Punctuality, doing, last_of, noon_place, prepare, sheltered
from tests.machine.service import Service, eventually

FIELD = 100
WATCHED_S = 10.5
LATEST_MS = 50.0
SHELTERED_WITHIN_S = 1.0
STORM = ReportWeather(Weather(wind_mps=28.0))


async def punctual(service: Service, act: Callable[[], Awaitable[float]]) -> tuple[float, Punctuality]:
    """Do something in a field that tracks; return what it took, and how late ticks came of ten thousand."""
    await eventually(lambda: doing(service.link.latest(), ActivityName.TRACKING) == FIELD)
    await service.ask(ReportWeather(Weather(wind_mps=3.0)))
    await asyncio.sleep(2.0)
    before = await service.link.metrics()
    took_s = await act()
    await asyncio.sleep(WATCHED_S)
    return took_s, Punctuality.between(before, await service.link.metrics())


@pytest.fixture
async def field(tmp_path: Path) -> AsyncIterator[Service]:
    prepare(tmp_path / "data", FIELD, noon_place(datetime.now(UTC)))
    service = await Service.start(tmp_path / "data")
    yield service
    await service.stop()


@pytest.mark.fault(73)
async def test_a_field_survives_its_storm(field: Service, fault: FaultResult) -> None:
    """One report of 28 m/s ended the controller, and 76 of 100 trackers stood in the wind."""

    async def storm() -> float:
        return await last_of(field, EventKind.STOW_STARTED, STORM, FIELD, within_s=10.0)

    took_s, found = await punctual(field, storm)
    print(took_s, found)
    assert took_s <= SHELTERED_WITHIN_S
    assert sheltered(field.link.latest()) == FIELD
    assert found.ticks >= 10_000
    assert found.p999_ms <= LATEST_MS
    assert not field.deaths()
    fault.noticed(took_s, REAL)
    fault.shows_nothing("every tracker stows, and says so")
    fault.recovers(BY_ITSELF)


@pytest.mark.fault(74)
async def test_stop_all_reaches_a_whole_field_at_once(field: Service, fault: FaultResult) -> None:
    async def stop() -> float:
        return await last_of(field, EventKind.STOPPED, StopAll(), FIELD, within_s=10.0)

    took_s, found = await punctual(field, stop)
    print(took_s, found)
    assert took_s <= SHELTERED_WITHIN_S
    assert not doing(field.link.latest(), ActivityName.TRACKING)
    assert found.ticks >= 10_000
    assert found.p999_ms <= LATEST_MS
    assert not field.deaths()
    fault.noticed(took_s, REAL)
    fault.shows_nothing("every tracker says that it holds")
    fault.recovers("the operator starts tracking again")
