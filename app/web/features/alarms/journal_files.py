"""The journal as a file: CSV or JSON, read a page at a time, so that its length does not matter."""

import csv
import io
from collections.abc import Iterable, Iterator
from dataclasses import asdict, replace
from enum import StrEnum
from itertools import chain

import orjson
from starlette.responses import Response, StreamingResponse

from app.store.store import JournalEntry, JournalFilter, Reader
from app.web.http.attachments import BYTE_ORDER_MARK, kept_as

AT_ONCE = 1000
COLUMNS = ("number", "at", "kind", "tracker_id", "actor", "message", "data")
FORMULA = ("=", "+", "-", "@", "\t", "\r")


class JournalFormat(StrEnum):
    """The kinds of file; `excel` is CSV that begins with a byte order mark."""

    CSV = "csv"
    EXCEL = "excel"
    JSON = "json"


def journal_file(reader: Reader, wanted: JournalFilter, kind: JournalFormat) -> Response:
    """Return the whole journal as the filter narrows it, newest first."""
    pages = _pages(reader, wanted)
    first = next(pages, [])  # read before the answer begins, so that a failing store is told as such
    entries = chain.from_iterable(chain((first,), pages))
    if kind is JournalFormat.JSON:
        return StreamingResponse(
            _json(entries), media_type="application/json", headers=kept_as("journal.json")
        )
    mark = (BYTE_ORDER_MARK,) if kind is JournalFormat.EXCEL else ()
    lines, headers = chain(mark, _csv(entries)), kept_as("journal.csv")
    return StreamingResponse(lines, media_type="text/csv; charset=utf-8", headers=headers)


def _pages(reader: Reader, wanted: JournalFilter) -> Iterator[list[JournalEntry]]:
    wanted = replace(wanted, limit=AT_ONCE)
    while found := reader.journal(wanted):
        yield found
        if len(found) < AT_ONCE:
            return
        wanted = replace(wanted, before=found[-1].number)


def _csv(entries: Iterable[JournalEntry]) -> Iterator[str]:
    yield _row(COLUMNS)
    for entry in entries:
        event = entry.event
        yield _row(
            (
                entry.number,
                event.at.isoformat(),
                event.kind.value,
                event.tracker_id or "",
                _harmless(event.actor),
                _harmless(event.message),
                orjson.dumps(event.data, default=str).decode(),
            )
        )


def _row(values: Iterable[object]) -> str:
    line = io.StringIO()
    csv.writer(line).writerow(values)
    return line.getvalue()


def _harmless(text: str) -> str:
    """Return text that no spreadsheet takes for a formula."""
    return f"'{text}" if text.startswith(FORMULA) else text


def _json(entries: Iterable[JournalEntry]) -> Iterator[bytes]:
    """Yield a JSON array, one entry a line."""
    before = b"[\n"
    for entry in entries:
        yield before + orjson.dumps({"number": entry.number, **asdict(entry.event)}, default=str)
        before = b",\n"
    yield b"[]\n" if before == b"[\n" else b"\n]\n"
