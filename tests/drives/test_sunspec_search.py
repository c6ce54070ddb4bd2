"""Where the map of a SunSpec device begins: each base is tried, whatever the ones before it answered."""

import asyncio
from collections.abc import Callable
from itertools import product

import pytest

from app.base.message import N_
from app.drives.connections.met_station import MetReader, weather_of
from app.drives.dialects.sunspec_models import MARK, MapSearch, located, model_at
from app.drives.profile import load_profile
from app.modbus.errors import DriveError, DriveRefused, DriveSilent
from app.tracker.weather.weather import Weather
from tests.golden.table import rows

ROWS = rows("world/sunspec_bases.csv")
EVERY = pytest.mark.parametrize("row", ROWS, ids=[row["what"] for row in ROWS])
MET = [307, 11, 215, 45, 1013, 4, 210, *[0x8000] * 6, 0xFFFF, 0]
TRACKERS = [601, 48, *[0] * 48, 0xFFFF, 0]
SENTINELS = (0, 1, 6, 0x7FFF, 0x8000, 0x8001, 0xFFFD, 0xFFFE, 0xFFFF)
WRONG: dict[str, Callable[[], DriveError]] = {
    "silent": lambda: DriveSilent(N_("The drive did not answer.")),
    "refused": lambda: DriveRefused(N_("The drive has no such register.")),
    "busy": lambda: DriveError(N_("The drive is busy.")),
    "broken": lambda: DriveError(N_("Reading failed twice.")),
}


class Device:
    """A device that answers at each base as a row says, and says nothing for ever where it `hangs`."""

    def __init__(self, row: dict[str, str], model: list[int], *, hangs: bool = False) -> None:
        self.answers = {base: row[f"at_{base}"] for base in (40000, 50000, 0)}
        self.words = [*MARK, *model]
        self.hangs = hangs
        self.asked: list[int] = []

    def __str__(self) -> str:
        return "10.0.0.9:502 unit 1"

    async def read(self, address: int, count: int, *, what: str) -> list[int]:
        self.asked.append(address)
        base = next(base for base in (50000, 40000, 0) if address >= base)
        answer = self.answers[base]
        if answer == "silent" and self.hangs:
            await asyncio.get_running_loop().create_future()
        if answer in WRONG:
            raise WRONG[answer]()
        if answer == "other":
            return [0x0000, 0xFFFF][:count]
        return [*self.words, *[0] * 200][address - base : address - base + count]

    async def close(self) -> None:
        pass


@EVERY
async def test_a_weather_station_is_found_at_every_base(row: dict[str, str]) -> None:
    device = Device(row, MET)
    reader = MetReader(device)  # type: ignore[arg-type]
    if not row["found"]:
        with pytest.raises(DriveError) as missing:
            await reader.read()
        assert row["says"] in str(missing.value)
        assert isinstance(missing.value, DriveSilent) is (row["what"] == "nothing answers")
        return
    for _ in range(2):
        readings, impossible = await reader.read()
        assert readings == Weather(
            temperature_degc=21.5,
            humidity_pct=45.0,
            pressure_hpa=1013.0,
            wind_mps=4.0,
            wind_direction_deg=210.0,
        )
        assert impossible == ()


@EVERY
async def test_another_tracker_controller_is_found_at_every_base(row: dict[str, str]) -> None:
    device, profile = Device(row, TRACKERS), load_profile("sunspec-601")
    if not row["found"]:
        with pytest.raises(DriveError, match=row["says"]):
            await located(profile, device, str(device))
        return
    found = await located(profile, device, str(device))
    base = int(row["found"])
    assert (found.registers["sunspec_id"].address, found.registers["model"].address) == (base, base + 2)


@EVERY
async def test_a_base_that_is_waited_for_in_vain_is_passed_over_the_next_time(row: dict[str, str]) -> None:
    """A controller's reading may take less long than the wait for an answer."""
    device, search = Device(row, MET, hangs=True), MapSearch()
    found = None
    for _ in range(4):
        reading = asyncio.ensure_future(search.base(device, str(device)))
        await asyncio.sleep(0)
        await asyncio.sleep(0)
        if reading.done() and reading.exception() is None:
            found = reading.result()
            break
        reading.cancel()
        await asyncio.gather(reading, return_exceptions=True)
    assert found == (int(row["found"]) if row["found"] else None)


async def test_the_base_that_was_right_is_tried_first() -> None:
    device, search = Device(ROWS[4], MET), MapSearch()
    assert await search.base(device, "here") == 0
    device.asked.clear()
    assert await search.base(device, "here") == 0
    assert device.asked == [0]


async def test_no_header_of_a_model_leads_out_of_the_addresses() -> None:
    for model, length in product(SENTINELS, SENTINELS):
        device = Device(ROWS[0], [model, length, 307, 11])
        device.answers |= {50000: "map", 0: "map"}
        try:
            address, found = await model_at(device, 40000, 307, "here")
            assert address + 2 + found <= 0x10000
        except DriveRefused as error:
            assert "has no SunSpec model 307" in str(error)  # noqa: PT017
        assert all(0 <= one <= 0xFFFE for one in device.asked)


@pytest.mark.parametrize("length", [1, 2, 6])
async def test_a_short_model_has_no_points_beyond_its_end(length: int) -> None:
    reader = MetReader(Device(ROWS[0], [307, length, *MET[2:]]))  # type: ignore[arg-type]
    readings, impossible = await reader.read()
    assert readings is not None
    assert (readings.temperature_degc, impossible) == (21.5, ())
    assert (readings.wind_mps is None) is (length < 4)


def test_what_is_out_of_range_is_told_apart_from_what_is_not_measured() -> None:
    seen, impossible = weather_of([0xFFCE, 0x8000, 0x8000, 300, 0x8000, 0xFFFF, 12])
    assert seen == Weather(temperature_degc=-5.0, snow_mm=12.0)
    assert impossible == ("wind_mps", "rain_mm")
    assert weather_of([0x8000] * 7) == (None, ())
