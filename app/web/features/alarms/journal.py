"""The journal: what happened, newest first, narrowed as one likes, and as a file."""

from datetime import datetime, timedelta
from typing import Annotated
from urllib.parse import urlencode

from fastapi import Query
from starlette.requests import Request
from starlette.responses import Response

from app.base.message import N_
from app.base.names import tidy
from app.base.permission import Permission
from app.base.zones import zone_of
from app.store.store import JournalFilter
from app.tracker.state.snapshot import EventKind
from app.web.features.alarms.alarm_contexts import JournalPage, JournalQuery
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.shell.deps import ReaderDep
from app.web.shell.frame import site_frame
from app.web.shell.render import page

router = page_router(prefix="/journal")
A_PAGE = 60
Typed = Annotated[str, Query(max_length=200)]
WRONG_DAY = N_(
    "{} is not a date: write the date as 2026-11-21. The journal is shown from its first to its last day."
)


@router.get("")
@needs(Permission.READ)
def journal(
    request: Request,
    reader: ReaderDep,
    tracker: Typed = "",
    kind: Typed = "",
    actor: Typed = "",
    text: Typed = "",
    start: Typed = "",
    end: Typed = "",
    before: int | None = None,
) -> Response:
    """Show one page of the journal; `before` is the number of the oldest entry of the page before."""
    frame = site_frame(request, N_("Journal"))
    typed = JournalQuery(tracker, kind, tidy(actor), tidy(text), start.strip(), end.strip())
    begins, wrong_since = _day(typed.start, frame.zone)
    ends, wrong_until = _day(typed.end, frame.zone, last=True)
    narrowed = JournalFilter(
        before=before if before is not None and 0 < before < 2**63 else None,
        limit=A_PAGE,
        tracker_id=typed.tracker or None,
        kinds=(EventKind(typed.kind),) if typed.kind in list(EventKind) else (),
        actor=typed.actor or None,
        text=typed.text or None,
        start=begins,
        end=ends,
    )
    found = reader.journal(narrowed)
    context = JournalPage(
        frame=frame,
        entries=tuple(found),
        trackers=tuple(state.config.tracker_id for state in reader.trackers()),
        kinds=tuple(EventKind),
        query=typed,
        error=wrong_since or wrong_until,
        csv=_file(narrowed, "excel"),
        json=_file(narrowed, "json"),
        older=_older(typed, found[-1].number) if len(found) == A_PAGE else None,
    )
    return page(request, context, status=422 if context.error else 200)


def _day(text: str, zone: str, *, last: bool = False) -> tuple[datetime | None, str]:
    """Return when a day of the site begins (with `last`: ends), and what is wrong with it."""
    if not text:
        return None, ""
    try:
        begins = datetime.strptime(text, "%Y-%m-%d").replace(tzinfo=zone_of(zone))
        return begins + timedelta(days=1, microseconds=-1) if last else begins, ""
    except (ValueError, OverflowError):
        return None, WRONG_DAY.format(repr(text))


def _older(typed: JournalQuery, before: int) -> str:
    given = {name: getattr(typed, name) for name in JournalQuery.__dataclass_fields__}
    return f"/journal?{urlencode({name: one for name, one in given.items() if one} | {'before': before})}"


def _file(narrowed: JournalFilter, kind: str) -> str:
    """Return the address of the same entries as a file."""
    start, end = narrowed.start, narrowed.end
    given = {
        "format": kind,
        "tracker_id": narrowed.tracker_id,
        "kind": narrowed.kinds[0].value if narrowed.kinds else None,
        "actor": narrowed.actor,
        "text": narrowed.text,
        "start": start.isoformat() if start else None,
        "end": end.isoformat() if end else None,
    }
    return f"/api/v1/journal/export?{urlencode({name: one for name, one in given.items() if one})}"
