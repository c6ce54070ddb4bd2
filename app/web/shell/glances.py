"""One tracker at a glance: where it stands against where it should, its wind and its alarms."""

from collections.abc import Sequence
from dataclasses import dataclass

from app.alarms.urgency import IN_DANGER, first_priority, own_headline
from app.base.message import NOTHING, Message, Word, say, word
from app.tracker.protections.words import Protection
from app.tracker.settings.config import MountKind, TrackerConfig
from app.tracker.settings.protections import StowName
from app.tracker.state.snapshot import Pair, SiteSnapshot, Snapshot
from app.tracker.values.operator_message import INFORMATION, OperatorMessage, StateWord
from app.tracker.weather.weather import Quantity
from app.web.languages.known import in_words

BAR = 200.0
WHOLE_TURN_DEG, ZENITH_DEG = (0.0, 360.0), (0.0, 90.0)
LOOKS = {
    StateWord.NOT_STOWED: "fault",
    StateWord.FAULT: "fault",
    StateWord.NO_CONNECTION: "unknown",
    StateWord.STOPPING: "under-way",
    StateWord.JOGGING: "manual",
    StateWord.HOMING: "manual",
    StateWord.SETTING_HOME: "manual",
    StateWord.DRIVE_TEST: "manual",
    StateWord.MOVING: "manual",
    StateWord.STOWING: "under-way",
    StateWord.MOVING_TO_THE_SUN: "under-way",
    StateWord.LOCAL: "manual",
    StateWord.INHIBITED: "manual",
    StateWord.SERVICE_MODE: "manual",
}
"""How the tile of a tracker looks whose state is not its normal day; tiles.js is told the same."""
TOLD_ON_TOP = 2
"""The least urgent priority of which the overview tells its most urgent tracker above all others."""


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

    `priority` is that of its most urgent alarm, 0 without any, and `trouble` the first thing to know about
    it. `look` is how its tile looks, `tilt_deg` how far its panel is turned from level, seen from the side,
    None where that was never measured.
    """

    one: Snapshot
    bars: tuple[Bar, ...]
    wind: int | None
    priority: int
    trouble: Message
    done: int
    next_step: str
    look: str
    tilt_deg: int | None


@dataclass(frozen=True, slots=True)
class Count:
    """How many trackers are in a state, and the priority of their most urgent alarm where it is a danger."""

    state: StateWord
    number: int
    priority: int


@dataclass(frozen=True, slots=True)
class Urgent:
    """The most urgent tracker of a site: what to know, how to open and to stow it, and how many are alike.

    `stow` is the position to stow it in, empty for one whose trouble is another; `more` are the other
    trackers in the same dangerous state.
    """

    message: OperatorMessage
    one: Snapshot
    open_label: Message
    stow_label: Message
    stow: str
    more: int
    more_short: Message
    more_label: Message


def glance(one: Snapshot, config: TrackerConfig | None, progress: tuple[int, str]) -> Glance:
    """Return what the overview shows of a tracker."""
    quantities = [sensor.quantity for sensor in one.sensors]
    return Glance(
        one=one,
        bars=bars(one, config),
        wind=quantities.index(Quantity.WIND) if Quantity.WIND in quantities else None,
        priority=_color(first_priority(one)),
        trouble=_trouble(one),
        done=progress[0],
        next_step=progress[1],
        look=LOOKS.get(one.state, ""),
        tilt_deg=_tilt(one),
    )


def counts_of(trackers: Sequence[Snapshot]) -> tuple[Count, ...]:
    """Return of every state how many trackers are in it, the most urgent first: the sum is all trackers."""
    return tuple(_count(word, [one for one in trackers if one.state is word]) for word in StateWord)


def urgent_of(site: SiteSnapshot) -> Urgent | None:
    """Return the most urgent tracker of a site, None where nothing is wrong that cannot wait."""
    first = next((message for message in site.messages if message.tracker_id is not None), None)
    if first is None or first.priority > TOLD_ON_TOP:
        return None
    one = next(one for one in site.trackers if one.tracker_id == first.tracker_id)
    alike = sum(other.state is one.state for other in site.trackers) - 1 if one.state in IN_DANGER else 0
    return Urgent(
        message=first,
        one=one,
        open_label=say("Open {tracker}", tracker=one.tracker_id),
        stow_label=say("Stow {tracker}", tracker=one.tracker_id),
        stow=stow_position(one) if one.state is StateWord.NOT_STOWED else "",
        more=alike,
        more_short=say("{count} more", count=alike),
        more_label=say("{count} more: {state}", count=alike, state=Word(in_words(one.state))),
    )


def stow_position(one: Snapshot) -> StowName:
    """Return where a tracker is safe now: against snow where that is what it is protected against."""
    snows = one.protection is not None and one.protection.protection is Protection.SNOW
    return StowName.SNOW if snows else StowName.WIND


def _count(word: StateWord, trackers: Sequence[Snapshot]) -> Count:
    worst = min(map(first_priority, trackers), default=INFORMATION)
    return Count(word, len(trackers), _color(worst) if word in IN_DANGER else 0)


def _color(priority: int) -> int:
    return priority if priority < INFORMATION else 0


def _trouble(one: Snapshot) -> Message:
    """Return the first thing to know about a tracker; what its state says already is told with its cause."""
    first = own_headline(one)
    if first is None:
        return NOTHING
    return first.message if first.code == one.state and first.message else first.title


def _tilt(one: Snapshot) -> int | None:
    known = one.measured or one.last_measured
    return None if known is None else round(known.elevation_deg - ZENITH_DEG[1])


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
