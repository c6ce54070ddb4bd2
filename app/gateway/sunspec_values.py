"""What every point tells, taken from the newest snapshot; what is not known is told as not implemented."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from datetime import datetime
from enum import IntEnum
from uuid import getnode

from app.base.build import VERSION
from app.base.zones import zone_of
from app.gateway.sunspec_map import Block
from app.gateway.sunspec_points import COMMON, DEGREES_SF, LOCATION, TRACKERS, WEATHER, Value
from app.tracker.settings.config import MountKind
from app.tracker.state.snapshot import ActivityName, Pair, SiteSnapshot, Snapshot
from app.tracker.weather.weather import Weather

UNKNOWN_TYPE, OTHER_TYPE = 0, 99
TYPES = {
    MountKind.HORIZONTAL_SINGLE_AXIS: 2,
    MountKind.TILTED_SINGLE_AXIS: 3,
    MountKind.VERTICAL_SINGLE_AXIS: 4,
    MountKind.AZIMUTH_ELEVATION: 5,
    MountKind.EQUATORIAL: 5,
}
SET_POINT, ELEVATION_OBSTRUCTED, AZIMUTH_OBSTRUCTED = 1, 2, 4


class Control(IntEnum):
    """The control register of a tracker, and of all of them."""

    AUTOMATIC = 0
    MANUAL = 1
    CALIBRATE = 2


@dataclass(frozen=True, slots=True)
class Targets:
    """Where Manual goes: what was last written, None where nothing was."""

    elevation_deg: float | None = None
    azimuth_deg: float | None = None


@dataclass(frozen=True, slots=True)
class View:
    """What a reader is told from: the site now, and what was written at this door."""

    site: SiteSnapshot
    unit: int
    targets: Mapping[str | None, Targets] = field(default_factory=dict)
    calibrating: frozenset[str] = frozenset()
    type: int = UNKNOWN_TYPE

    @property
    def local(self) -> datetime:
        """Return the site's civil time."""
        return self.site.at.astimezone(zone_of(self.site.time_zone))

    def control(self, tracker: Snapshot) -> Control:
        """Return what a tracker's control register tells: what it does, not what was written."""
        if tracker.tracker_id in self.calibrating or tracker.activity is ActivityName.HOMING:
            return Control.CALIBRATE
        return Control.AUTOMATIC if tracker.tracking_on else Control.MANUAL


def tracker_type(mounts: Iterable[MountKind]) -> int:
    """Return SunSpec's type of a controller whose trackers have these mounts."""
    types = {TYPES[mount] for mount in mounts}
    if not types:
        return UNKNOWN_TYPE
    return types.pop() if len(types) == 1 else OTHER_TYPE


def block_words(view: View, block: Block) -> list[int]:
    """Return the words of a whole block."""
    told = _told(view, block)
    return [word for placed in block.points for word in placed.point.words(told.get(placed.point.name))]


def _told(view: View, block: Block) -> dict[str, Value]:
    head: dict[str, Value] = {"ID": block.model.number, "L": block.length}
    if block.tracker_id is not None:
        tracker = next((one for one in view.site.trackers if one.tracker_id == block.tracker_id), None)
        return {} if tracker is None else _tracker(view, tracker)
    return head | FIXED[block.model.number](view)


def _common(view: View) -> dict[str, Value]:
    return {
        "Mn": "Heliopanel",
        "Md": "Heliopanel controller",
        "Vr": VERSION,
        "SN": f"{getnode():012x}",
        "DA": view.unit,
    }


def _controller(view: View) -> dict[str, Value]:
    targets, local = view.targets.get(None, Targets()), view.local
    alarms = 0
    for one in view.site.trackers:
        alarms |= alarm_bits(one)
    controls = {view.control(one) for one in view.site.trackers}
    return {
        "Nam": view.site.site_name,
        "Typ": view.type,
        "DtLoc": f"{local:%Y%m%d}",
        "TmLoc": f"{local:%H%M%S}",
        "Day": local.timetuple().tm_yday,
        "GlblElCtl": targets.elevation_deg,
        "GlblAzCtl": targets.azimuth_deg,
        "GlblCtl": controls.pop() if len(controls) == 1 else None,
        "GlblAlm": alarms,
        "Dgr_SF": DEGREES_SF,
        "N": len(view.site.trackers),
    }


def _tracker(view: View, tracker: Snapshot) -> dict[str, Value]:
    written = view.targets.get(tracker.tracker_id, Targets())
    target_elevation_deg, target_azimuth_deg = _angles(tracker.target)
    elevation_deg, azimuth_deg = _angles(tracker.measured)
    return {
        "Id": tracker.name,
        "ElTrgt": target_elevation_deg,
        "AzTrgt": target_azimuth_deg,
        "ElPos": elevation_deg,
        "AzPos": azimuth_deg,
        "ElCtl": written.elevation_deg,
        "AzCtl": written.azimuth_deg,
        "Ctl": view.control(tracker),
        "Alm": alarm_bits(tracker),
    }


def _angles(pair: Pair | None) -> tuple[float | None, float | None]:
    return (None, None) if pair is None else (pair.elevation_deg, pair.azimuth_deg)


def alarm_bits(tracker: Snapshot) -> int:
    """Return a tracker's alarms: not where it should be or not known to be, and axes on a limit switch."""
    bits = 0
    if tracker.fault is not None or tracker.measured is None or tracker.waiting:
        bits |= SET_POINT
    for axis, bit in ((tracker.elevation, ELEVATION_OBSTRUCTED), (tracker.azimuth, AZIMUTH_OBSTRUCTED)):
        if axis is not None and (axis.at_lower_limit or axis.at_upper_limit):
            bits |= bit
    return bits


def _location(view: View) -> dict[str, Value]:
    at, place = view.site.at, view.site.location
    told: dict[str, Value] = {
        "Tm": f"{at:%H%M%S}.{at.microsecond // 1000:03d}Z",
        "Date": f"{at:%Y%m%d}",
        "Loc": view.site.site_name,
    }
    if place is not None:
        told |= {"Lat": place.latitude_deg, "Long": place.longitude_deg, "Alt": place.altitude_m}
    return told


def _weather(view: View) -> dict[str, Value]:
    weather = view.site.weather
    readings: Weather | None = weather.usable if weather else None
    if readings is None or (weather is not None and weather.simulated):
        return {}
    return {
        "TmpAmb": readings.temperature_degc,
        "RH": readings.humidity_pct,
        "Pres": readings.pressure_hpa,
        "WndSpd": readings.wind_mps,
        "WndDir": readings.wind_direction_deg,
        "Rain": readings.rain_mm,
        "Snw": readings.snow_mm,
    }


FIXED: dict[int, Callable[[View], dict[str, Value]]] = {
    COMMON.number: _common,
    TRACKERS.number: _controller,
    LOCATION.number: _location,
    WEATHER.number: _weather,
}
