"""What people order about alarms and where they are sent, plain data on the wire."""

from dataclasses import dataclass
from typing import ClassVar, Literal

from app.base.permission import Permission
from app.link.settings_orders import UndoSiteSettings
from app.tracker.values.notifications import Channel, Notifications
from app.tracker.values.order_spec import STORED_S, OrderSpec, setting


@dataclass(frozen=True, slots=True)
class AcknowledgeAlarm:
    """Somebody has seen an alarm."""

    alarm_id: str
    kind: Literal["acknowledge_alarm"] = "acknowledge_alarm"
    spec: ClassVar = OrderSpec(needs=Permission.OPERATE, within_s=STORED_S, in_safe_mode=True)


@dataclass(frozen=True, slots=True)
class ShelveAlarm:
    """Put an alarm aside for some minutes, 24 hours at most, with a reason; never one of priority 1."""

    alarm_id: str
    minutes: int
    reason: str
    kind: Literal["shelve_alarm"] = "shelve_alarm"
    spec: ClassVar = OrderSpec(needs=Permission.OPERATE, within_s=STORED_S, in_safe_mode=True)


@dataclass(frozen=True, slots=True)
class UnshelveAlarm:
    """Take an alarm back from the shelf."""

    alarm_id: str
    kind: Literal["unshelve_alarm"] = "unshelve_alarm"
    spec: ClassVar = OrderSpec(needs=Permission.OPERATE, within_s=STORED_S, in_safe_mode=True)


AlarmOrder = AcknowledgeAlarm | ShelveAlarm | UnshelveAlarm
"""What an operator does about one alarm."""


@dataclass(frozen=True, slots=True)
class SetNotifications:
    """Say where alarms are sent."""

    notifications: Notifications
    kind: Literal["set_notifications"] = "set_notifications"
    spec: ClassVar = setting(undone_by=UndoSiteSettings)


@dataclass(frozen=True, slots=True)
class TestNotification:
    """Send a test message by one channel."""

    __test__ = False
    channel: Channel
    kind: Literal["test_notification"] = "test_notification"
    spec: ClassVar = setting()


NotificationOrder = SetNotifications | TestNotification
"""What concerns where alarms are sent."""
