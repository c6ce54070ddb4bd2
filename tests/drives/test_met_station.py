"""A weather station with SunSpec model 307, read over Modbus TCP."""

from collections.abc import AsyncIterator, Sequence

import pytest

from app.base.clock import SystemClock
from app.drives.connections.buses import Buses
from app.drives.connections.met_station import MetReader, met_reader, weather_of
from app.modbus.errors import DriveError
from app.modbus.server import ModbusServer, Refusal
from app.tracker.memory.memory import MetStation
from app.tracker.weather.weather import Weather

COMMON = [1, 4, 0, 0, 0, 0]
MET = [0xFFCE, 85, 1013, 17, 210, 3, 0x8000, 0x8000, 0x8000, 0x8000, 0x8000]
"""-5.0 degrees, 85 %, 1013 hPa, 17 m/s from 210 degrees, 3 mm of rain, no snow sensor."""


class Station:
    """The registers of a SunSpec weather station from 40000 on."""

    def __init__(self, model: int = 307) -> None:
        self.words = [0x5375, 0x6E53, *COMMON, model, len(MET), *MET, 0xFFFF, 0]

    def read_registers(self, function: int, address: int, count: int) -> Sequence[int]:
        start = address - 40000
        if start < 0 or start + count > len(self.words):
            raise Refusal(2)
        return self.words[start : start + count]

    def read_bits(self, address: int, count: int) -> Sequence[bool]:
        raise Refusal(1)

    def write_bits(self, address: int, values: Sequence[bool]) -> None:
        raise Refusal(1)

    def write_registers(self, address: int, words: Sequence[int]) -> None:
        raise Refusal(1)

    async def let_out(self, reply: bytes) -> bytes | None:
        return reply


async def reader_of(station: Station) -> AsyncIterator[MetReader]:
    server = ModbusServer(station)
    port = await server.start("127.0.0.1", 0)
    reader = met_reader(Buses(SystemClock()), MetStation("127.0.0.1", port))
    try:
        yield reader
    finally:
        await reader.close()
        await server.close()


async def test_the_model_is_found_behind_others_and_read() -> None:
    station = Station()
    async for reader in reader_of(station):
        seen, impossible = await reader.read()
        assert seen == Weather(
            wind_mps=17.0, wind_direction_deg=210.0, temperature_degc=-5.0, humidity_pct=85.0,
            pressure_hpa=1013.0, rain_mm=3.0,
        )  # fmt: skip
        assert impossible == ()
        station.words[13] = 4
        seen, _ = await reader.read()
        assert seen is not None
        assert seen.wind_mps == 4.0


async def test_a_device_without_the_model_is_named() -> None:
    async for reader in reader_of(Station(model=601)):
        with pytest.raises(DriveError, match="no SunSpec model 307"):
            await reader.read()


def test_what_is_out_of_range_is_told_apart_from_what_is_not_measured() -> None:
    seen, impossible = weather_of([0x8000, 0x8000, 0x8000, 300, 0x8000, 0xFFFF, 12])
    assert seen == Weather(snow_mm=12.0)
    assert impossible == ("wind_mps", "rain_mm")
    assert weather_of([0x8000] * 7) == (None, ())
