"""What happened: who, when, what."""

from typing import Annotated

from fastapi import APIRouter, Query
from pydantic import AwareDatetime, Field

from app.store.store import JournalEntry, JournalFilter
from app.tracker.snapshot import EventKind
from app.web.api.base import Output
from app.web.deps import ReaderDep

router = APIRouter(tags=["history"])


class JournalPage(Output):
    """Entries, newest first, and where the next page begins."""

    entries: list[JournalEntry]
    next_before: int | None = Field(description="Give this as `before` for older entries; None: no more.")


@router.get("/journal", summary="The journal, newest first")
def read_journal(
    reader: ReaderDep,
    before: Annotated[
        int | None, Query(ge=1, le=2**63 - 1, description="Cursor: entries before this.")
    ] = None,
    limit: Annotated[int, Query(ge=1, le=1000)] = 100,
    tracker_id: Annotated[str | None, Query(max_length=64)] = None,
    kind: Annotated[list[EventKind] | None, Query(description="Only these kinds.")] = None,
    since: AwareDatetime | None = None,
    until: AwareDatetime | None = None,
) -> JournalPage:
    """Return events, filtered, a page at a time."""
    wanted = JournalFilter(before, limit, tracker_id, tuple(kind or ()), since, until)
    entries = reader.journal(wanted)
    more = entries[-1].number if len(entries) == limit else None
    return JournalPage(entries=entries, next_before=more)
