"""A weather station that offers SunSpec model 307 (Base Met) over Modbus TCP.

Source: SunSpec Device Information Model Reference, model 307. Its wind speed has a resolution of 1 m/s.
"""

from app.base.message import N_
from app.drives.connections.buses import Buses
from app.drives.dialects.sunspec_models import MODEL_HEADER, MapSearch, model_at
from app.modbus.bus import BusUnit
from app.modbus.errors import DriveError
from app.modbus.wire import Timing
from app.tracker.memory.memory import MetStation
from app.tracker.settings.config import DriveConfig, DriveKind
from app.tracker.weather.weather import Weather, is_possible

MODEL = 307
UNKNOWN, SIGN = 0x8000, 0x8000
POINTS = (
    ("temperature_degc", 0.1), ("humidity_pct", 1.0), ("pressure_hpa", 1.0), ("wind_mps", 1.0),
    ("wind_direction_deg", 1.0), ("rain_mm", 1.0), ("snow_mm", 1.0),
)  # fmt: skip
"""What of model 307 is read, in its order from behind the header on, and what one count is worth."""
TIMING = Timing(timeout_s=1.0)


class MetReader:
    """Finds model 307 at a device and reads it; a device that was away is searched anew."""

    def __init__(self, link: BusUnit) -> None:
        self._link = link
        self._search = MapSearch()
        self._address: int | None = None
        self._length = 0

    async def read(self) -> tuple[Weather | None, tuple[str, ...]]:
        """Return what it measures and what of it is impossible, or raise `DriveError`."""
        if self._address is None:
            where = str(self._link)
            base = await self._search.base(self._link, where)
            self._address, self._length = await model_at(self._link, base, MODEL, where)
        count = min(self._length, len(POINTS))
        try:
            words = await self._link.read(self._address + MODEL_HEADER, count, what=N_("SunSpec model 307"))
        except DriveError:
            self._address = None
            raise
        return weather_of([*words, *[UNKNOWN] * (len(POINTS) - count)])

    async def close(self) -> None:
        """Let go of the connection."""
        await self._link.close()


def weather_of(words: list[int]) -> tuple[Weather | None, tuple[str, ...]]:
    """Return what the points of model 307 say, None if they say nothing, and the names out of range."""
    found: dict[str, float] = {}
    impossible: list[str] = []
    for (name, scale), word in zip(POINTS, words, strict=True):
        if word == UNKNOWN:
            continue
        value = (word - 2 * SIGN if word & SIGN else word) * scale
        if is_possible(name, value):
            found[name] = value
        else:
            impossible.append(name)
    return (Weather(**found) if found else None), tuple(impossible)


def met_reader(buses: Buses, station: MetStation) -> MetReader:
    """Return a reader for a station; its line is shared with drives at the same gateway."""
    where = DriveConfig(DriveKind.MODBUS_TCP, host=station.host, port=station.port, unit=station.unit)
    return MetReader(buses.unit(where, station.unit, TIMING))
