"""One alarm: what the book knows of it, and the state that follows."""

from dataclasses import dataclass
from datetime import datetime

from app.alarms.catalogue import Entry, entry_of
from app.base.message import NOTHING, Message, plain, say
from app.tracker.values.alarm_words import AlarmState


@dataclass(frozen=True, slots=True)
class Shelf:
    """Somebody put an alarm aside until an instant (the machine's steady clock), with a reason."""

    until: datetime
    by: str
    reason: str


@dataclass(frozen=True, slots=True)
class Alarm:
    """One alarm. `raised_at`, `returned_at` and `acknowledged_at` are by the site's clock.

    `seen_since` and `gone_since` are when its condition came and went, by the steady clock: the delays run
    from there. `told` is whether it was announced since it became active; a silent one has not been.
    """

    code: str
    tracker_id: str | None
    where: str
    message: Message
    hint: Message = NOTHING
    active: bool = False
    told: bool = False
    raised_at: datetime | None = None
    returned_at: datetime | None = None
    acknowledged_at: datetime | None = None
    acknowledged_by: str = ""
    occurrences: int = 0
    first_out: bool = False
    seen_since: datetime | None = None
    gone_since: datetime | None = None
    shelf: Shelf | None = None
    suppressed_by: str = ""
    in_maintenance: bool = False

    @property
    def alarm_id(self) -> str:
        """Return its name, such as `drive_lost@T1` or `disk_low`."""
        return self.code if self.tracker_id is None else f"{self.code}@{self.tracker_id}"

    @property
    def entry(self) -> Entry:
        """Return its entry in the catalogue."""
        return entry_of(self.code)

    @property
    def silent(self) -> bool:
        """Return whether it is kept from being announced: shelved, suppressed by design, out of service."""
        return self.shelf is not None or bool(self.suppressed_by) or self.in_maintenance

    @property
    def state(self) -> AlarmState:
        """Return its state after ANSI/ISA-18.2."""
        if self.shelf is not None:
            return AlarmState.SHELVED
        if self.active and self.in_maintenance:
            return AlarmState.OUT_OF_SERVICE
        if self.active and self.suppressed_by:
            return AlarmState.SUPPRESSED
        if not self.told:
            return AlarmState.NORMAL
        if self.acknowledged_at is not None:
            return AlarmState.ACKNOWLEDGED if self.active else AlarmState.NORMAL
        return AlarmState.UNACKNOWLEDGED if self.active else AlarmState.RETURNED

    @property
    def stands(self) -> bool:
        """Return whether it is in the list: anything but normal."""
        return self.state is not AlarmState.NORMAL


def place_in(alarm_id: str) -> str | None:
    """Return the tracker in the name of an alarm, None where it is the site's."""
    return alarm_id.partition("@")[2] or None


def place_of(alarm: Alarm) -> Message:
    """Return where an alarm stands: the name of a tracker as it is, the site as a word."""
    return plain(alarm.where) if alarm.tracker_id is None else say("{name}", name=alarm.where)
