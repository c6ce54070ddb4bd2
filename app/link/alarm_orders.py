"""What people order about alarms and where they are sent, plain data on the wire."""

from dataclasses import dataclass
from typing import Literal

from app.tracker.notifications import Channel, Notifications


@dataclass(frozen=True, slots=True)
class AcknowledgeAlarm:
    """Somebody has seen an alarm."""

    alarm_id: str
    kind: Literal["acknowledge_alarm"] = "acknowledge_alarm"


@dataclass(frozen=True, slots=True)
class ShelveAlarm:
    """Put an alarm aside for some minutes, 24 hours at most, with a reason; never one of priority 1."""

    alarm_id: str
    minutes: int
    reason: str
    kind: Literal["shelve_alarm"] = "shelve_alarm"


@dataclass(frozen=True, slots=True)
class UnshelveAlarm:
    """Take an alarm back from the shelf."""

    alarm_id: str
    kind: Literal["unshelve_alarm"] = "unshelve_alarm"


AlarmOrder = AcknowledgeAlarm | ShelveAlarm | UnshelveAlarm
"""What an operator does about one alarm."""


@dataclass(frozen=True, slots=True)
class SetNotifications:
    """Say where alarms are sent."""

    notifications: Notifications
    kind: Literal["set_notifications"] = "set_notifications"


@dataclass(frozen=True, slots=True)
class TestNotification:
    """Send a test message by one channel."""

    __test__ = False
    channel: Channel
    kind: Literal["test_notification"] = "test_notification"


NotificationOrder = SetNotifications | TestNotification
"""What concerns where alarms are sent."""
