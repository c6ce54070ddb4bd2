"""Who ordered what, with what came of it; for administrators."""

import json
from dataclasses import asdict
from datetime import datetime
from typing import Annotated, Any

from fastapi import Query
from pydantic import Field

from app.audit.entry import Sealed
from app.base.instants import Instant
from app.base.permission import Permission
from app.store.store import AuditFilter
from app.web.api.base import Cursor, Limit, Output, Page, api_router, before, following
from app.web.http.needs import needs
from app.web.shell.deps import PanelDep, ReaderDep

router = api_router(tags=["history"])


class AuditEntry(Output):
    """An order or a change of settings, chained to the entry before by its hash."""

    seq: int
    utc: datetime
    mono_ms: int = Field(description="The computer's monotonic counter, which nobody can set.")
    boot_id: str
    clock_quality: str = Field(description="synchronised, trusted, or why the clock is not to be trusted.")
    actor: str
    via: str
    address: str
    action: str
    object: str = Field(description="A tracker, a recording, or the site.")
    given: dict[str, Any] = Field(description="What was asked for.")
    before: dict[str, Any] = Field(description="Only what was changed, as it was.")
    after: dict[str, Any] = Field(description="Only what was changed, as it is.")
    result: str
    prev_hash: str
    hash: str


class AccessEntry(Output):
    """Something that was done or tried at the door: users, sessions, tokens, network, refusals."""

    number: int
    at: datetime
    actor: str
    via: str
    address: str
    action: str
    object: str
    result: str


@router.get("/audit/access", summary="Log-ins, users, tokens, network and refusals, newest first")
@needs(Permission.ADMINISTER)
async def read_access(
    built: PanelDep,
    cursor: Cursor = None,
    limit: Limit = 100,
) -> Page[AccessEntry]:
    """Return what happened at the panel's door; the same refusal is recorded once a minute, with a count."""
    found = await built.keeper.events(before(cursor), limit)
    return Page[AccessEntry](
        items=tuple(AccessEntry(number=one.number, **asdict(one.event)) for one in found),
        next=following([one.number for one in found], limit),
    )


@router.get("/audit", summary="Who ordered what, newest first")
@needs(Permission.ADMINISTER)
def read_audit(
    reader: ReaderDep,
    cursor: Cursor = None,
    limit: Limit = 100,
    actor: Annotated[str | None, Query(max_length=64)] = None,
    about: Annotated[str | None, Query(max_length=64, description="A tracker, a recording, or site.")] = None,
    start: Instant | None = None,
    end: Instant | None = None,
) -> Page[AuditEntry]:
    """Return audit entries, filtered, a page at a time; `heliopanel audit verify` checks their chain."""
    wanted = AuditFilter(before=before(cursor), limit=limit, actor=actor, object=about, start=start, end=end)
    found = reader.audit(wanted)
    return Page[AuditEntry](
        items=tuple(_entry(one) for one in found), next=following([one.seq for one in found], limit)
    )


def _entry(one: Sealed) -> AuditEntry:
    entry = one.entry
    return AuditEntry(
        seq=one.seq,
        utc=entry.utc,
        mono_ms=entry.mono_ms,
        boot_id=entry.boot_id,
        clock_quality=entry.clock_quality,
        actor=entry.actor,
        via=entry.via,
        address=entry.address,
        action=entry.action,
        object=entry.object,
        given=json.loads(entry.given),
        before=json.loads(entry.before),
        after=json.loads(entry.after),
        result=entry.result,
        prev_hash=one.prev_hash,
        hash=one.hash,
    )
