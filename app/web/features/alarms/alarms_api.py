"""Alarms: those that stand, the history, the catalogue, and what an operator does about them."""

from typing import Annotated

from fastapi import Path, Query
from pydantic import Field

from app.alarms.catalogue import ENTRIES
from app.alarms.view import told
from app.base.permission import Permission
from app.link.alarm_orders import AcknowledgeAlarm, AlarmOrder, ShelveAlarm, UnshelveAlarm
from app.store.store import AlarmFilter, KeptAlarm
from app.tracker.values.alarm_words import AlarmCounts, AlarmNow
from app.web.api.base import (
    NOT_FOUND,
    REFUSED,
    Cursor,
    Input,
    Limit,
    Output,
    Page,
    api_router,
    before,
    following,
    whole,
)
from app.web.api.orders import Sender, SenderDep
from app.web.http.needs import needs
from app.web.shell.deps import ReaderDep, SnapshotDep

Priority = Annotated[int, Field(ge=1, le=4)]
router = api_router(prefix="/alarms", tags=["alarms"])
AlarmId = Annotated[
    str, Path(min_length=1, max_length=120, description="Name of the alarm.", examples=["drive_lost@T1"])
]


class AlarmsNow(Page[AlarmNow]):
    """The active alarms, the most urgent first: at most 50; the counts tell of all."""

    counts: AlarmCounts


class PastAlarm(Output):
    """One alarm from its raising to its end."""

    number: int = Field(description="Its place in the history.")
    ended: bool = Field(description="Whether it has ended; if not, it stands.")
    alarm: AlarmNow


class AlarmKind(Output):
    """One kind of alarm."""

    code: str
    priority: int = Field(ge=1, le=4, description="1 at once, 2 within 10 minutes, 3 within hours, 4 days.")
    title: str
    consequence: str = Field(description="What follows without a response.")
    do: str = Field(description="What to do.")
    on_delay_s: float = Field(description="How long its condition lasts before it is raised.")
    off_delay_s: float = Field(description="How long its condition is gone before it has returned.")
    suppressed_by: tuple[str, ...] = Field(description="Codes that suppress it by design.")


class Shelving(Input):
    """For how long an alarm is put aside, and why."""

    minutes: int = Field(ge=1, le=1440, examples=[60])
    reason: str = Field(min_length=1, max_length=300, examples=["The sensor is being replaced."])


@router.get("", summary="The alarms that stand")
@needs(Permission.READ)
async def read_alarms(snapshot: SnapshotDep) -> AlarmsNow:
    """Return active, returned, shelved, suppressed alarms and those out of service, with counts."""
    return AlarmsNow(items=snapshot.alarms, counts=snapshot.alarm_counts)


@router.get("/history", summary="The history of alarms, newest first")
@needs(Permission.READ)
def read_alarm_history(
    reader: ReaderDep,
    cursor: Cursor = None,
    limit: Limit = 100,
    tracker_id: Annotated[str | None, Query(max_length=64)] = None,
    priority: Annotated[list[Priority] | None, Query(description="Only these priorities.")] = None,
) -> Page[PastAlarm]:
    """Return alarms that were raised, a page at a time."""
    found = reader.alarm_history(AlarmFilter(before(cursor), limit, tracker_id, tuple(priority or ())))
    more = following([one.number for one in found], limit)
    return Page[PastAlarm](items=tuple(_past(one) for one in found), next=more)


@router.get("/catalogue", summary="Every alarm there is")
@needs(Permission.READ)
async def read_alarm_catalogue() -> Page[AlarmKind]:
    """Return each kind of alarm with its priority, what follows and what to do."""
    return whole(
        AlarmKind(
            code=one.code,
            priority=one.priority,
            title=one.title,
            consequence=one.consequence,
            do=one.do,
            on_delay_s=one.on_delay.total_seconds(),
            off_delay_s=one.off_delay.total_seconds(),
            suppressed_by=one.suppressed_by,
        )
        for one in ENTRIES
    )


@router.post("/{alarm_id}/acknowledge", summary="Acknowledge an alarm", responses=NOT_FOUND | REFUSED)
@needs(Permission.OPERATE)
async def acknowledge_alarm(alarm_id: AlarmId, sender: SenderDep) -> AlarmsNow:
    """Say that somebody has seen it; one that is acknowledged already stays so."""
    return await _ordered(sender, AcknowledgeAlarm(alarm_id))


@router.post("/{alarm_id}/shelve", summary="Shelve an alarm", responses=NOT_FOUND | REFUSED)
@needs(Permission.OPERATE)
async def shelve_alarm(alarm_id: AlarmId, shelving: Shelving, sender: SenderDep) -> AlarmsNow:
    """Put it aside for some minutes; one of priority 1 cannot be shelved."""
    return await _ordered(sender, ShelveAlarm(alarm_id, shelving.minutes, shelving.reason))


@router.post(
    "/{alarm_id}/unshelve", summary="Take an alarm back from the shelf", responses=NOT_FOUND | REFUSED
)
@needs(Permission.OPERATE)
async def unshelve_alarm(alarm_id: AlarmId, sender: SenderDep) -> AlarmsNow:
    """Announce it again if it is still active."""
    return await _ordered(sender, UnshelveAlarm(alarm_id))


async def _ordered(sender: Sender, order: AlarmOrder) -> AlarmsNow:
    after = await sender.send(order)
    return AlarmsNow(items=after.alarms, counts=after.alarm_counts)


def _past(kept: KeptAlarm) -> PastAlarm:
    shown = told(kept.alarm, kept.ended_at)
    return PastAlarm(number=kept.number, ended=kept.ended_at is not None, alarm=shown)
