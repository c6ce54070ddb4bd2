"""Alarms and the age of the journal in the database: what stands, what ended, what is old enough to go."""

from datetime import datetime
from typing import Any

from sqlalchemy import Connection, Row, Select, delete, func, insert, select

from app.store import putting, tables
from app.store.documents import ALARM
from app.store.store import AlarmFilter, KeptAlarm

ONLY_ROW = 1


def standing() -> Select[Any]:
    """Return the query for the alarms that stand, in the order they were raised."""
    columns = tables.alarms.c
    return select(tables.alarms).where(columns.ended_at.is_(None)).order_by(columns.number)


def history(wanted: AlarmFilter) -> Select[Any]:
    """Return the query for a page of the history, newest first."""
    columns = tables.alarms.c
    query = select(tables.alarms).order_by(columns.number.desc()).limit(wanted.limit)
    if wanted.before is not None:
        query = query.where(columns.number < wanted.before)
    if wanted.tracker_id is not None:
        query = query.where(columns.tracker_id == wanted.tracker_id)
    if wanted.priorities:
        query = query.where(columns.priority.in_(wanted.priorities))
    return query


def kept(row: Row[*tuple[Any, ...]]) -> KeptAlarm:
    """Return an alarm from its row."""
    return KeptAlarm(ALARM.read(row.document, row.alarm_id), row.ended_at, row.number)


def put(connection: Connection, one: KeptAlarm) -> None:
    """Store an alarm in the place of what was stored of it since it was raised."""
    alarm = one.alarm
    values = {
        "tracker_id": alarm.tracker_id,
        "priority": alarm.entry.priority,
        "ended_at": one.ended_at,
        "document": ALARM.write(alarm),
    }
    putting.put(connection, tables.alarms, {"alarm_id": alarm.alarm_id, "raised_at": alarm.raised_at}, values)


def prune(connection: Connection, before: datetime) -> int:
    """Remove ended alarms and journal entries from before an instant; return how many entries.

    Entries go from the oldest on, up to the first that is young enough: none is taken out of the middle.
    """
    events, retention = tables.events, tables.journal_retention
    connection.execute(delete(tables.alarms).where(tables.alarms.c.ended_at < before))
    first_kept = select(func.min(events.c.number)).where(events.c.at >= before)
    number = connection.execute(first_kept).scalar_one()
    if number is None:
        return 0
    connection.execute(delete(retention))
    connection.execute(insert(retention).values(number=ONLY_ROW, before_number=number))
    return connection.execute(delete(events).where(events.c.number < number)).rowcount
