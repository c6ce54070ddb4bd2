"""What a tracker did over minutes, hours and days, as curves that go on while one looks."""

from enum import StrEnum
from typing import Annotated

from fastapi import Query
from starlette.requests import Request
from starlette.responses import Response

from app.base.message import N_
from app.base.permission import Permission
from app.link.messages import UnknownTracker
from app.web.features.site.picture_contexts import TrendsPage
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.shell.contexts import Link
from app.web.shell.deps import SnapshotDep
from app.web.shell.frame import tracker_frame
from app.web.shell.render import page

router = page_router(prefix="/trackers/{tracker_id}/trends")


class Span(StrEnum):
    """How far back the curves go."""

    MINUTES = "10min"
    HOUR = "1h"
    SHIFT = "8h"
    DAY = "1d"
    WEEK = "7d"


SPANS: dict[Span, tuple[str, int]] = {
    Span.MINUTES: (N_("10 min"), 600),
    Span.HOUR: ("1 h", 3600),
    Span.SHIFT: ("8 h", 8 * 3600),
    Span.DAY: (N_("1 day"), 86_400),
    Span.WEEK: (N_("7 days"), 7 * 86_400),
}
"""The words on each key, and the seconds behind them."""


@router.get("")
@needs(Permission.READ)
async def show(
    request: Request,
    tracker_id: str,
    snapshot: SnapshotDep,
    span: Annotated[Span, Query(description="How far back.")] = Span.HOUR,
) -> Response:
    """Show the curves of one span; the script of the page asks for them."""
    if all(one.tracker_id != tracker_id for one in snapshot.trackers):
        raise UnknownTracker(tracker_id)
    spans = tuple(Link(words, f"?span={one}", one is span) for one, (words, _) in SPANS.items())
    frame = tracker_frame(request, tracker_id, N_("Trends"))
    context = TrendsPage(frame=frame, spans=spans, seconds=SPANS[span][1], words=SPANS[span][0])
    return page(request, context)
