"""What a person at a tracker is told first: short words for its state, and messages in their order."""

from dataclasses import dataclass
from datetime import datetime
from enum import StrEnum

from app.base.message import NOTHING, Message

INFORMATION = 5
"""The priority of a message that is no alarm; alarms have 1 to 4."""


class StateWord(StrEnum):
    """The state of a tracker in a word or two, the most urgent first; exactly one holds at a time."""

    NOT_STOWED = "not_stowed"
    FAULT = "fault"
    NO_CONNECTION = "no_connection"
    STOPPING = "stopping"
    JOGGING = "jogging"
    HOMING = "homing"
    SETTING_HOME = "setting_home"
    DRIVE_TEST = "drive_test"
    MOVING = "moving"
    SHOW = "show"
    STOWING = "stowing"
    MOVING_TO_THE_SUN = "moving_to_the_sun"
    INTERRUPTED = "interrupted"
    LOCAL = "local"
    INHIBITED = "inhibited"
    SERVICE_MODE = "service_mode"
    NOT_HOMED = "not_homed"
    AT_STANDSTILL = "at_standstill"
    WAITING = "waiting"
    STOWED = "stowed"
    TRACKING = "tracking"


@dataclass(frozen=True, slots=True)
class OperatorMessage:
    """One thing to know about a tracker or the site: what, what to do, since when, and by whom.

    `priority` is that of the alarm, 5 of what is none. `calls` says that its alarm `alarm_id`
    waits to be acknowledged. `tracker_id` and `where` name the tracker, in a list of the whole site; `where`
    is empty for the site itself.
    """

    code: str
    priority: int
    title: Message
    message: Message = NOTHING
    hint: Message = NOTHING
    since: datetime | None = None
    by: str = ""
    alarm_id: str = ""
    calls: bool = False
    tracker_id: str | None = None
    where: str = ""

    @property
    def is_alarm(self) -> bool:
        """Return whether it is an alarm, and colored as one."""
        return self.priority < INFORMATION
