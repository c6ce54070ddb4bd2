"""SunSpec's points and the four models that a tracker controller serves, as tables."""

from dataclasses import dataclass
from enum import StrEnum

from app.base.names import JOINERS


class PointType(StrEnum):
    """How a point is packed."""

    UINT16 = "uint16"
    INT16 = "int16"
    INT32 = "int32"
    ENUM16 = "enum16"
    BITFIELD16 = "bitfield16"
    SUNSSF = "sunssf"
    STRING = "string"
    PAD = "pad"


NOT_IMPLEMENTED = {
    PointType.UINT16: 0xFFFF,
    PointType.INT16: 0x8000,
    PointType.INT32: 0x8000_0000,
    PointType.ENUM16: 0xFFFF,
    PointType.BITFIELD16: 0xFFFF,
    PointType.SUNSSF: 0x8000,
    PointType.STRING: 0,
    PointType.PAD: 0x8000,
}
RANGES = {
    PointType.UINT16: (0, 0xFFFE),
    PointType.INT16: (-0x7FFF, 0x7FFF),
    PointType.INT32: (-0x7FFF_FFFF, 0x7FFF_FFFF),
    PointType.ENUM16: (0, 0xFFFE),
    PointType.BITFIELD16: (0, 0x7FFF),
    PointType.SUNSSF: (-10, 10),
}
DEGREES_SF = -3
"""Angles of model 601 are told in thousandths of a degree."""

Value = float | int | str | None


@dataclass(frozen=True, slots=True)
class Point:
    """One value of a model: its raw integer times 10 to the power of `scale` is the value in `units`."""

    name: str
    type: PointType
    size: int = 1
    scale: int = 0
    units: str = ""
    writable: bool = False
    text: str = ""

    def words(self, value: Value) -> tuple[int, ...]:
        """Return the packed value; what is not known or does not fit is SunSpec's "not implemented"."""
        if self.type is PointType.STRING:
            return _text_words(str(value or ""), self.size)
        raw = NOT_IMPLEMENTED[self.type]
        if value is not None and self.type is not PointType.PAD:
            scaled = round(float(value) * 10.0**-self.scale)
            low, high = RANGES[self.type]
            raw = scaled if low <= scaled <= high else raw
        return tuple(raw >> 16 * place & 0xFFFF for place in reversed(range(self.size)))

    def value(self, words: tuple[int, ...]) -> float | None:
        """Return the number that was written, None for "not implemented"."""
        raw = 0
        for word in words:
            raw = raw << 16 | word
        if raw == NOT_IMPLEMENTED[self.type]:
            return None
        if self.type in (PointType.INT16, PointType.INT32) and raw >> (16 * self.size - 1):
            raw -= 1 << 16 * self.size
        return round(raw * 10.0**self.scale, 9)


@dataclass(frozen=True, slots=True)
class Model:
    """A model's id, its points after id and length, and those of the block that it repeats."""

    number: int
    title: str
    points: tuple[Point, ...]
    repeated: tuple[Point, ...] = ()

    def length(self, count: int = 0) -> int:
        """Return the model's length as its second register tells it: without id and length."""
        return sum(one.size for one in self.points) + count * sum(one.size for one in self.repeated)


def _text_words(text: str, size: int) -> tuple[int, ...]:
    """Return UTF-8 in a fixed number of words, cut between characters, zeros behind."""
    cut = text.encode()[: 2 * size].decode(errors="ignore").rstrip(JOINERS)
    packed = cut.encode().ljust(2 * size, b"\0")
    return tuple(int.from_bytes(packed[place : place + 2]) for place in range(0, 2 * size, 2))


def _string(name: str, size: int, text: str) -> Point:
    return Point(name, PointType.STRING, size, text=text)


def _angle(name: str, text: str, *, writable: bool = False) -> Point:
    return Point(name, PointType.INT32, 2, DEGREES_SF, "degrees", writable, text)


def _int16(name: str, units: str, text: str, scale: int = 0) -> Point:
    return Point(name, PointType.INT16, scale=scale, units=units, text=text)


CONTROLS = "0 automatic, 1 manual, 2 calibrate"
ALARMS = "bit 0 setpoint, 1 elevation obstructed, 2 azimuth obstructed"

COMMON = Model(
    1,
    "Common",
    (
        _string("Mn", 16, "maker"),
        _string("Md", 16, "model"),
        _string("Opt", 8, "options"),
        _string("Vr", 8, "version"),
        _string("SN", 16, "serial number: the computer's hardware address"),
        Point("DA", PointType.UINT16, text="unit ID"),
        Point("Pad", PointType.PAD),
    ),
)
TRACKERS = Model(
    601,
    "Tracker controller",
    (
        _string("Nam", 8, "name of the site"),
        Point("Typ", PointType.ENUM16, text="2 horizontal, 3 tilted, 4 azimuth, 5 dual-axis, 99 other"),
        _string("DtLoc", 5, "local date, YYYYMMDD"),
        _string("TmLoc", 3, "local time, hhmmss"),
        Point("Day", PointType.UINT16, text="day of the year"),
        _angle("GlblElCtl", "manual elevation for all trackers", writable=True),
        _angle("GlblAzCtl", "manual azimuth for all trackers", writable=True),
        Point("GlblCtl", PointType.ENUM16, writable=True, text=f"all trackers: {CONTROLS}"),
        Point("GlblAlm", PointType.BITFIELD16, text=f"any tracker: {ALARMS}"),
        Point("Dgr_SF", PointType.SUNSSF, text="scale of the angles"),
        Point("N", PointType.UINT16, text="number of trackers"),
    ),
    (
        _string("Id", 8, "name of the tracker"),
        _angle("ElTrgt", "elevation that the panel should have"),
        _angle("AzTrgt", "azimuth that the panel should have"),
        _angle("ElPos", "measured elevation"),
        _angle("AzPos", "measured azimuth"),
        _angle("ElCtl", "manual elevation", writable=True),
        _angle("AzCtl", "manual azimuth", writable=True),
        Point("Ctl", PointType.ENUM16, writable=True, text=CONTROLS),
        Point("Alm", PointType.BITFIELD16, text=ALARMS),
    ),
)
LOCATION = Model(
    305,
    "Location",
    (
        _string("Tm", 6, "UTC, hhmmss.sssZ"),
        _string("Date", 4, "UTC date, YYYYMMDD"),
        _string("Loc", 20, "name of the site"),
        Point("Lat", PointType.INT32, 2, -7, "degrees", text="latitude, north positive"),
        Point("Long", PointType.INT32, 2, -7, "degrees", text="longitude, east positive"),
        Point("Alt", PointType.INT32, 2, 0, "m", text="altitude"),
    ),
)
WEATHER = Model(
    307,
    "Base meteorological",
    (
        _int16("TmpAmb", "degrees Celsius", "air temperature", -1),
        _int16("RH", "%", "relative humidity"),
        _int16("Pres", "hPa", "air pressure"),
        _int16("WndSpd", "m/s", "wind speed"),
        _int16("WndDir", "degrees", "where the wind comes from"),
        _int16("Rain", "mm", "rain"),
        _int16("Snw", "mm", "snow depth"),
        _int16("PPT", "", "precipitation type; not measured"),
        _int16("ElecFld", "V/m", "electric field; not measured"),
        _int16("SurWet", "kOhm", "surface wetness; not measured"),
        _int16("SoilWet", "%", "soil wetness; not measured"),
    ),
)
