"""What happened: who, when, what."""

from dataclasses import replace
from typing import Annotated

from fastapi import Depends, Query
from pydantic import Field
from starlette.responses import Response

from app.instants import Instant
from app.store.store import JournalEntry, JournalFilter
from app.tracker.snapshot import EventKind
from app.web.api.base import Output, Responses, api_router
from app.web.deps import ReaderDep
from app.web.journal_files import JournalFormat, journal_file

router = api_router(tags=["history"])


class JournalPage(Output):
    """Entries, newest first, and where the next page begins."""

    entries: list[JournalEntry]
    next_before: int | None = Field(description="Give this as `before` for older entries; None: no more.")


def _narrowed(
    tracker_id: Annotated[str | None, Query(max_length=64)] = None,
    kind: Annotated[list[EventKind] | None, Query(description="Only these kinds.")] = None,
    actor: Annotated[str | None, Query(max_length=200, description="Who did it.")] = None,
    text: Annotated[str | None, Query(max_length=200, description="Somewhere in the message.")] = None,
    since: Instant | None = None,
    until: Instant | None = None,
) -> JournalFilter:
    """Return what the query narrows the journal to."""
    kinds = tuple(kind or ())
    return JournalFilter(tracker_id=tracker_id, kinds=kinds, actor=actor, text=text, since=since, until=until)


FilterDep = Annotated[JournalFilter, Depends(_narrowed)]
FILES: Responses = {
    200: {
        "description": "All entries, newest first, as a file.",
        "content": {"text/csv": {"schema": {"type": "string"}}},
    }
}


@router.get("/journal", summary="The journal, newest first")
def read_journal(
    reader: ReaderDep,
    narrowed: FilterDep,
    before: Annotated[
        int | None, Query(ge=1, le=2**63 - 1, description="Cursor: entries before this.")
    ] = None,
    limit: Annotated[int, Query(ge=1, le=1000)] = 100,
) -> JournalPage:
    """Return events, filtered, a page at a time."""
    entries = reader.journal(replace(narrowed, before=before, limit=limit))
    more = entries[-1].number if len(entries) == limit else None
    return JournalPage(entries=entries, next_before=more)


@router.get(
    "/journal/export",
    summary="The journal as a file",
    response_model=list[dict[str, object]],
    responses=FILES,
)
def export_journal(
    reader: ReaderDep, narrowed: FilterDep, format: JournalFormat = JournalFormat.CSV
) -> Response:
    """Return everything that the filters leave, as CSV or JSON."""
    return journal_file(reader, narrowed, format)
