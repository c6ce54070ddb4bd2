"""The words of alarms as every door tells them: priority, state, one alarm now, how many there are."""

from dataclasses import dataclass
from datetime import datetime
from enum import StrEnum

from app.base.message import Message

PRIORITIES = (1, 2, 3, 4)
MOST_SHOWN = 50


class AlarmState(StrEnum):
    """The states of ANSI/ISA-18.2; `returned` is returned to normal and not yet acknowledged."""

    NORMAL = "normal"
    UNACKNOWLEDGED = "unacknowledged"
    ACKNOWLEDGED = "acknowledged"
    RETURNED = "returned"
    SHELVED = "shelved"
    SUPPRESSED = "suppressed"
    OUT_OF_SERVICE = "out_of_service"


CALLING = (AlarmState.UNACKNOWLEDGED, AlarmState.RETURNED)
"""Waits to be acknowledged."""
QUIET = (AlarmState.SHELVED, AlarmState.SUPPRESSED, AlarmState.OUT_OF_SERVICE)
"""Was put aside by a user."""


@dataclass(frozen=True, slots=True)
class AlarmNow:
    """One alarm as it stands: what, where, since when, what to do. Instants are by the site's clock.

    `priority` is 1 (at once) to 4 (when there is time). `first_out` marks the first of its group, which most
    likely caused the others; `collapsed` is shown behind the others while there is a flood. `occurrences`
    counts how often it came before it was acknowledged.
    """

    alarm_id: str
    code: str
    tracker_id: str | None
    where: Message
    priority: int
    title: Message
    message: Message
    do: Message
    state: AlarmState
    since: datetime
    returned_at: datetime | None = None
    acknowledged_at: datetime | None = None
    acknowledged_by: str = ""
    shelved_until: datetime | None = None
    shelved_by: str = ""
    shelved_for: str = ""
    silenced_by: str = ""
    first_out: bool = False
    collapsed: bool = False
    occurrences: int = 1

    @property
    def calls(self) -> bool:
        """Return whether it waits to be acknowledged."""
        return self.state in CALLING


@dataclass(frozen=True, slots=True)
class AlarmCounts:
    """How many alarms stand, by priority 1 to 4, and how many of these wait to be acknowledged.

    `shelved` are those that somebody shelved, `silenced` those suppressed by design or out of service;
    `more` do not fit into the snapshot; `flood` says that there were more than 10 in 10 minutes.
    """

    standing: tuple[int, int, int, int] = (0, 0, 0, 0)
    calling: tuple[int, int, int, int] = (0, 0, 0, 0)
    shelved: int = 0
    silenced: int = 0
    more: int = 0
    flood: bool = False
