"""A weather station that offers SunSpec model 307 (Base Met) over Modbus TCP.

Source: SunSpec Device Information Model Reference, model 307. Its wind speed has a resolution of 1 m/s.
"""

from app.base.message import N_, say
from app.drives.connections.buses import Buses
from app.modbus.bus import BusUnit
from app.modbus.errors import DriveError, DriveRefused
from app.modbus.wire import Timing
from app.tracker.memory.memory import MetStation
from app.tracker.settings.config import DriveConfig, DriveKind
from app.tracker.weather.weather import Weather, is_possible

BASES = (40000, 50000, 0)
MARK = [0x5375, 0x6E53]
MODEL, END_MODEL, MOST_MODELS, HEADER = 307, 0xFFFF, 40, 2
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
        self._address: int | None = None

    async def read(self) -> tuple[Weather | None, tuple[str, ...]]:
        """Return what it measures and what of it is impossible, or raise `DriveError`."""
        if self._address is None:
            self._address = await self._found()
        try:
            words = await self._link.read(self._address + HEADER, len(POINTS), what=N_("SunSpec model 307"))
        except DriveError:
            self._address = None
            raise
        return weather_of(words)

    async def close(self) -> None:
        """Let go of the connection."""
        await self._link.close()

    async def _found(self) -> int:
        for base in BASES:
            try:
                mark = await self._link.read(base, len(MARK), what=N_("the beginning of the SunSpec map"))
            except DriveRefused:
                continue
            if mark == MARK:
                return await self._model(base + len(MARK))
        raise DriveRefused(
            say(
                "The device at {link} is not a SunSpec device: no register map begins with SunS.",
                link=self._link,
            )
        )

    async def _model(self, address: int) -> int:
        for _ in range(MOST_MODELS):
            model, length = await self._link.read(address, HEADER, what=N_("a SunSpec model's header"))
            if model == MODEL:
                return address
            if model == END_MODEL:
                break
            address += HEADER + length
        raise DriveRefused(
            say(
                "The device at {link} has no SunSpec model 307, Base Met. Check its unit id.", link=self._link
            )
        )


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
