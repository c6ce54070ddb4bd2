"""What happened: who, when, what."""

from dataclasses import replace
from typing import Annotated

from fastapi import Depends, Query
from starlette.responses import Response

from app.base.instants import Instant
from app.base.names import tidy
from app.base.permission import Permission
from app.store.store import JournalEntry, JournalFilter
from app.tracker.state.snapshot import EventKind
from app.web.api.base import Cursor, Limit, Page, Responses, api_router, before, following
from app.web.features.alarms.journal_files import JournalFormat, journal_file
from app.web.http.needs import needs
from app.web.shell.deps import ReaderDep

router = api_router(tags=["history"])


def _narrowed(
    tracker_id: Annotated[str | None, Query(max_length=64)] = None,
    kind: Annotated[list[EventKind] | None, Query(description="Only these kinds.")] = None,
    actor: Annotated[str | None, Query(max_length=200, description="Who did it.")] = None,
    text: Annotated[str | None, Query(max_length=200, description="Somewhere in the message.")] = None,
    start: Instant | None = None,
    end: Instant | None = None,
) -> JournalFilter:
    """Return what the query narrows the journal to."""
    kinds = tuple(kind or ())
    actor, text = (found if found is None else tidy(found) for found in (actor, text))
    return JournalFilter(tracker_id=tracker_id, kinds=kinds, actor=actor, text=text, start=start, end=end)


FilterDep = Annotated[JournalFilter, Depends(_narrowed)]
FILES: Responses = {
    200: {
        "description": "All entries, newest first, as a file.",
        "content": {"text/csv": {"schema": {"type": "string"}}},
    }
}


@router.get("/journal", summary="The journal, newest first")
@needs(Permission.READ)
def read_journal(
    reader: ReaderDep,
    narrowed: FilterDep,
    cursor: Cursor = None,
    limit: Limit = 100,
) -> Page[JournalEntry]:
    """Return events, filtered, a page at a time."""
    entries = reader.journal(replace(narrowed, before=before(cursor), limit=limit))
    more = following([one.number for one in entries], limit)
    return Page[JournalEntry](items=tuple(entries), next=more)


@router.get(
    "/journal/export",
    summary="The journal as a file",
    response_model=list[dict[str, object]],
    responses=FILES,
)
@needs(Permission.READ, ticketed=True)
def export_journal(
    reader: ReaderDep, narrowed: FilterDep, format: JournalFormat = JournalFormat.CSV
) -> Response:
    """Return everything that the filters leave, as CSV, as CSV for Excel, or as JSON."""
    return journal_file(reader, narrowed, format)
