"""Who ordered what, with what came of it; for administrators."""

import json
from dataclasses import asdict
from datetime import datetime
from typing import Annotated, Any

from fastapi import Query
from pydantic import Field

from app.audit.entry import Sealed
from app.instants import Instant
from app.store.store import AuditFilter
from app.web.api.base import Output, api_router
from app.web.deps import PanelDep, ReaderDep

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


class AuditPage(Output):
    """Entries, newest first, and where the next page begins."""

    entries: list[AuditEntry]
    next_before: int | None = Field(description="Give this as `before` for older entries; None: no more.")


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


class AccessPage(Output):
    """Entries, newest first, and where the next page begins."""

    entries: list[AccessEntry]
    next_before: int | None = Field(description="Give this as `before` for older entries; None: no more.")


@router.get("/audit/access", summary="Log-ins, users, tokens, network and refusals, newest first")
async def read_access(
    built: PanelDep,
    before: Annotated[
        int | None, Query(ge=1, le=2**63 - 1, description="Cursor: entries before this.")
    ] = None,
    limit: Annotated[int, Query(ge=1, le=1000)] = 100,
) -> AccessPage:
    """Return what happened at the panel's door; the same refusal is recorded once a minute, with a count."""
    found = await built.keeper.events(before, limit)
    return AccessPage(
        entries=[AccessEntry(number=one.number, **asdict(one.event)) for one in found],
        next_before=found[-1].number if len(found) == limit else None,
    )


@router.get("/audit", summary="Who ordered what, newest first")
def read_audit(
    reader: ReaderDep,
    before: Annotated[
        int | None, Query(ge=1, le=2**63 - 1, description="Cursor: entries before this.")
    ] = None,
    limit: Annotated[int, Query(ge=1, le=1000)] = 100,
    actor: Annotated[str | None, Query(max_length=64)] = None,
    about: Annotated[str | None, Query(max_length=64, description="A tracker, a recording, or site.")] = None,
    since: Instant | None = None,
    until: Instant | None = None,
) -> AuditPage:
    """Return audit entries, filtered, a page at a time; `heliopanel audit verify` checks their chain."""
    wanted = AuditFilter(before=before, limit=limit, actor=actor, object=about, since=since, until=until)
    found = reader.audit(wanted)
    return AuditPage(
        entries=[_entry(one) for one in found],
        next_before=found[-1].seq if len(found) == limit else None,
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
