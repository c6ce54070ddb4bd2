"""Which alarm conditions are present: read from the site's snapshot and from what the machine counts."""

from collections.abc import Iterator
from dataclasses import dataclass, field

from app.alarms.catalogue import ANY_FAULT, CATALOGUE
from app.base.message import N_, NOTHING, Message, say, with_format
from app.tracker.state.snapshot import SiteSnapshot, Snapshot
from app.tracker.values.reason import Reason

SITE = N_("Site")
MEGABYTE = 1024 * 1024


@dataclass(frozen=True, slots=True)
class Condition:
    """One condition that is present now: its code, the tracker (None: the site), and what it says."""

    code: str
    tracker_id: str | None
    where: str
    message: Message
    hint: Message = NOTHING

    @property
    def alarm_id(self) -> str:
        """Return the name of its alarm, such as `drive_lost@T1` or `disk_low`."""
        return self.code if self.tracker_id is None else f"{self.code}@{self.tracker_id}"


@dataclass(frozen=True, slots=True)
class Band:
    """A limit with a deadband: present above `on`, and then until below `off`; `off` is lower."""

    on: float
    off: float

    def holds(self, value: float | None, *, before: bool) -> bool:
        """Return whether the condition is present, given whether it was; what is unknown stays as it was."""
        if value is None:
            return before
        return value > (self.off if before else self.on)


@dataclass(frozen=True, slots=True)
class SiteHealth:
    """What the machine counts about itself: shares of the last minute, from 0 to 1.

    `store_behind`: something was not stored; `disk_free_bytes` beside the database (None: not known);
    `late` ticks later than 100 ms; `unread` by tracker, readings of its drive that failed; `troubles` are
    conditions that other parts of the machine tell themselves.
    """

    store_behind: bool = False
    disk_free_bytes: int | None = None
    late: float | None = None
    unread: dict[str, float] = field(default_factory=dict)
    troubles: tuple[Condition, ...] = ()


DISK_LOW = Band(-500.0, -600.0)
DISK_FULL = Band(-50.0, -80.0)
LATE = Band(0.05, 0.02)
LINK_POOR = Band(0.05, 0.01)


def of_site(site: SiteSnapshot, health: SiteHealth, before: frozenset[str]) -> tuple[Condition, ...]:
    """Return every condition of the site itself; `before` are those that were present, for the deadbands."""
    return _once((*_told_by_site(site), *_of_health(health, before)))


def of_tracker(tracker: Snapshot, health: SiteHealth, before: frozenset[str]) -> tuple[Condition, ...]:
    """Return every condition of one tracker; `before` are those that were present, for the deadbands."""
    unread = health.unread.get(tracker.tracker_id)
    return _once((*told_by_tracker(tracker), *_of_link(tracker, unread, before)))


def _once(found: tuple[Condition, ...]) -> tuple[Condition, ...]:
    return tuple({one.alarm_id: one for one in reversed(found)}.values())[::-1]


def told_by_tracker(tracker: Snapshot) -> Iterator[Condition]:
    """Yield what a tracker tells; a fault is always one, under its own code or as any fault."""
    if tracker.not_stowed is not None:
        yield _told(tracker, tracker.not_stowed)
    if tracker.fault is not None:
        known = tracker.fault.code in CATALOGUE
        yield _told(tracker, tracker.fault, None if known else ANY_FAULT)
    for reason in (*tracker.notices, *tracker.waiting):
        if reason.code in CATALOGUE:
            yield _told(tracker, reason)
    if tracker.unreachable is not None:
        yield _told(tracker, tracker.unreachable, "drive_lost")


def _told(tracker: Snapshot, reason: Reason, code: str | None = None) -> Condition:
    return Condition(code or reason.code, tracker.tracker_id, tracker.name, reason.message, reason.hint)


def _of_link(tracker: Snapshot, unread: float | None, before: frozenset[str]) -> Iterator[Condition]:
    text = (
        NOTHING
        if unread is None
        else say(
            "{value} % of the readings of the last minute failed.", value=with_format(100.0 * unread, ".0f")
        )
    )
    found = Condition("link_poor", tracker.tracker_id, tracker.name, text)
    if LINK_POOR.holds(unread, before=found.alarm_id in before):
        yield found


def _told_by_site(site: SiteSnapshot) -> Iterator[Condition]:
    for reason in (*site.clock.reasons, *site.clock.warnings):
        if reason.code in CATALOGUE:
            yield Condition(reason.code, None, SITE, reason.message, reason.hint)
    apart = None if site.weather is None else site.weather.disagreement
    if apart is not None:
        yield Condition(apart.code, None, SITE, apart.message, apart.hint)


def _of_health(health: SiteHealth, before: frozenset[str]) -> Iterator[Condition]:
    yield from health.troubles
    if health.store_behind:
        yield Condition("store_behind", None, SITE, N_("The last changes and events were not stored."))
    free_mb = None if health.disk_free_bytes is None else health.disk_free_bytes / MEGABYTE
    text = (
        NOTHING
        if free_mb is None
        else say("{free_mb} MB are free on the database disk.", free_mb=with_format(free_mb, ".0f"))
    )
    used = None if free_mb is None else -free_mb
    late = (
        NOTHING
        if health.late is None
        else say(
            "{value} % of the ticks were over 100 ms late.", value=with_format(100.0 * health.late, ".0f")
        )
    )
    for code, band, value, words in (
        ("disk_full", DISK_FULL, used, text),
        ("disk_low", DISK_LOW, used, text),
        ("ticks_late", LATE, health.late, late),
    ):
        if band.holds(value, before=code in before):
            yield Condition(code, None, SITE, words)
