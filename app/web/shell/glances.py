"""One tracker at a glance: where it stands against where it should, its wind and its alarms."""

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from operator import itemgetter

from app.alarms.catalogue import CATALOGUE
from app.base.message import word
from app.tracker.settings.config import MountKind, TrackerConfig
from app.tracker.state.snapshot import ActivityName, Pair, Snapshot
from app.tracker.values.alarm_words import QUIET, AlarmNow
from app.tracker.weather.weather import Quantity

BAR = 200.0
WHOLE_TURN_DEG, ZENITH_DEG = (0.0, 360.0), (0.0, 90.0)
NOT_STOWED = CATALOGUE["not_stowed"]
LOOKS = {
    ActivityName.JOGGING: "manual",
    ActivityName.MOVING: "manual",
    ActivityName.MEASURING: "manual",
    ActivityName.HOMING: "manual",
    ActivityName.SETTING_HOME: "manual",
    ActivityName.STOWING: "under-way",
    ActivityName.FAULTED: "fault",
}
"""How the tile of a tracker looks that does what is not its normal day; tiles.js is told the same."""


@dataclass(frozen=True, slots=True)
class Bar:
    """An angle on its range: places of the measured one and of the set-point on a bar 200 wide.

    None is what is not known. The ends are the soft limits; of a mount whose axes do not lie along azimuth
    and elevation they are those of the sky.
    """

    name: str
    label: str
    least_deg: float
    most_deg: float
    measured: float | None
    setpoint: float | None


@dataclass(frozen=True, slots=True)
class Glance:
    """A tracker on the overview; `wind` is the place of its wind sensor among `one.sensors`, None without.

    `trouble` names the most urgent of its alarms, of which `priority` is 0 without any. That it does not stow
    in a storm is its own state: it is told although the list of alarms, which is cut off, does not name it.
    `look` is how its tile looks, `tilt_deg` how far its panel is turned from level, seen from the side.
    """

    one: Snapshot
    bars: tuple[Bar, ...]
    wind: int | None
    priority: int
    alarms: int
    trouble: str
    done: int
    next_step: str
    look: str
    tilt_deg: int


def glance(
    one: Snapshot, config: TrackerConfig | None, alarms: Iterable[AlarmNow], progress: tuple[int, str]
) -> Glance:
    """Return what the overview shows of a tracker."""
    mine = [alarm for alarm in alarms if alarm.tracker_id == one.tracker_id and alarm.state not in QUIET]
    unlisted = one.not_stowed is not None and all(alarm.code != NOT_STOWED.code for alarm in mine)
    standing = [(alarm.priority, alarm.heading) for alarm in mine]
    standing += [(NOT_STOWED.priority, NOT_STOWED.title)] * unlisted
    priority, trouble = min(standing, key=itemgetter(0), default=(0, ""))
    quantities = [sensor.quantity for sensor in one.sensors]
    return Glance(
        one=one,
        bars=bars(one, config),
        wind=quantities.index(Quantity.WIND) if Quantity.WIND in quantities else None,
        priority=priority,
        alarms=len(standing),
        trouble=trouble,
        done=progress[0],
        next_step=progress[1],
        look=look(one),
        tilt_deg=round(one.measured.elevation_deg - ZENITH_DEG[1]) if one.measured else 0,
    )


def look(one: Snapshot) -> str:
    """Return how a tracker's tile looks, empty for a normal day: an alarm's color comes on top."""
    if one.measured is None:
        return "unknown"
    return "under-way" if one.approaching else LOOKS.get(one.activity, "")


def doing(trackers: Iterable[Snapshot]) -> tuple[tuple[ActivityName, int], ...]:
    """Return of everything that a tracker may do how many do it.

    Those on the way to the sun, and those that do not stow in a storm, are counted as that: the sum is
    all trackers.
    """
    counted = Counter(one.activity for one in trackers if not one.approaching and not one.not_stowed)
    return tuple((name, counted[name]) for name in ActivityName)


def bars(one: Snapshot, config: TrackerConfig | None) -> tuple[Bar, ...]:
    """Return azimuth and elevation of a tracker on their ranges."""
    first, second = WHOLE_TURN_DEG, ZENITH_DEG
    if config is not None and config.mount.kind is MountKind.AZIMUTH_ELEVATION:
        limits = config.turning_deg
        first, second = limits[0], limits[1] or ZENITH_DEG
    return (_bar("azimuth", one, first), _bar("elevation", one, second))


def _bar(name: str, one: Snapshot, ends: tuple[float, float]) -> Bar:
    return Bar(
        name=name,
        label=word(name.capitalize()),
        least_deg=ends[0],
        most_deg=ends[1],
        measured=_place(_angle(name, one.measured), ends),
        setpoint=_place(_angle(name, one.setpoint), ends),
    )


def _angle(name: str, pair: Pair | None) -> float | None:
    if pair is None:
        return None
    return pair.azimuth_deg if name == "azimuth" else pair.elevation_deg


def _place(angle_deg: float | None, ends: tuple[float, float]) -> float | None:
    """Return where an angle, or its like a turn away, lies on the bar; beyond the ends it is held there."""
    if angle_deg is None or ends[1] <= ends[0]:
        return None
    turned_deg = angle_deg
    while turned_deg > ends[1] and turned_deg - 360.0 >= ends[0]:
        turned_deg -= 360.0
    while turned_deg < ends[0] and turned_deg + 360.0 <= ends[1]:
        turned_deg += 360.0
    share = (turned_deg - ends[0]) / (ends[1] - ends[0])
    return round(BAR * min(1.0, max(0.0, share)), 1)
