"""Alarms of a machine in memory."""

from collections import Counter
from dataclasses import replace
from datetime import datetime

from app.alarms.alarm import Alarm
from app.alarms.catalogue import CATALOGUE
from app.alarms.view import ASIDE
from app.link.alarm_orders import AcknowledgeAlarm, AlarmOrder, ShelveAlarm
from app.tracker.values.alarm_words import QUIET, AlarmCounts, AlarmNow, AlarmState


def alarm(code: str, at: datetime, tracker_id: str | None = "T1") -> AlarmNow:
    """Return an alarm that nobody has acknowledged."""
    entry, name = CATALOGUE[code], f"{code}@{tracker_id}" if tracker_id else code
    where = tracker_id or "Site"
    return AlarmNow(
        name, code, tracker_id, where, entry.priority, entry.title, f"It is {code}.", entry.do,
        AlarmState.UNACKNOWLEDGED, at,
    )  # fmt: skip


def in_book(alarm: AlarmNow) -> Alarm:
    """Return an alarm as the book has it."""
    return Alarm(
        alarm.code,
        alarm.tracker_id,
        alarm.where,
        alarm.message,
        active=alarm.state is not AlarmState.RETURNED,
        told=True,
        raised_at=alarm.since,
        acknowledged_at=alarm.since if alarm.state is AlarmState.ACKNOWLEDGED else None,
        suppressed_by="a test" if alarm.state in QUIET else "",
    )


def counted(alarms: tuple[AlarmNow, ...]) -> AlarmCounts:
    """Return how many there are."""
    listed = [one for one in alarms if one.state not in ASIDE]
    standing = Counter(one.priority for one in listed)
    calling = Counter(one.priority for one in listed if one.calls)
    return AlarmCounts(
        (standing[1], standing[2], standing[3], standing[4]),
        (calling[1], calling[2], calling[3], calling[4]),
        shelved=len(alarms) - len(listed),
    )


def after(alarms: tuple[AlarmNow, ...], order: AlarmOrder, at: datetime, actor: str) -> tuple[AlarmNow, ...]:
    """Return the alarms after an operator's order."""
    if isinstance(order, AcknowledgeAlarm):
        changes = {"state": AlarmState.ACKNOWLEDGED, "acknowledged_at": at, "acknowledged_by": actor}
    elif isinstance(order, ShelveAlarm):
        if not order.reason.strip():
            raise ValueError("Enter the reason for shelving the alarm.")
        changes = {
            "state": AlarmState.SHELVED, "shelved_until": at, "shelved_by": actor, "shelved_for": order.reason
        }  # fmt: skip
    else:
        changes = {"state": AlarmState.UNACKNOWLEDGED}
    return tuple(
        replace(one, **changes) if one.alarm_id == order.alarm_id else one  # type: ignore[arg-type]
        for one in alarms
    )
