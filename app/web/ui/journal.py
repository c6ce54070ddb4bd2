"""The journal: what happened, newest first."""

from urllib.parse import urlencode

from fastapi import APIRouter
from starlette.requests import Request
from starlette.responses import Response

from app.store.store import JournalFilter
from app.web.contexts import JournalPage
from app.web.deps import ReaderDep
from app.web.ui.frame import site_frame
from app.web.ui.render import page

router = APIRouter(prefix="/journal")
A_PAGE = 60


@router.get("")
def journal(request: Request, reader: ReaderDep, tracker: str = "", before: int | None = None) -> Response:
    """Show one page of the journal; `before` is the number of the oldest entry of the page before."""
    found = reader.journal(JournalFilter(before=before, limit=A_PAGE, tracker_id=tracker or None))
    older = {"before": str(found[-1].number)} | ({"tracker": tracker} if tracker else {}) if found else {}
    context = JournalPage(
        frame=site_frame(request, "Journal"),
        entries=tuple(found),
        trackers=tuple(state.config.tracker_id for state in reader.trackers()),
        tracker=tracker,
        older=f"/journal?{urlencode(older)}" if len(found) == A_PAGE else None,
    )
    return page(request, context)
