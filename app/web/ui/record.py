"""The commissioning record as a page for printing."""

from fastapi import APIRouter
from starlette.requests import Request
from starlette.responses import Response

from app.web.contexts import RecordPage
from app.web.deps import PanelDep
from app.web.record import read_record
from app.web.ui.frame import STATUS_TEXT, STEP_LABELS, tracker_frame
from app.web.ui.mode import choice
from app.web.ui.render import page

router = APIRouter(prefix="/trackers/{tracker_id}/record")


@router.get("")
async def record(request: Request, tracker_id: str, built: PanelDep) -> Response:
    """Show who commissioned the tracker and when, how it was left, and what was verified."""
    found = await read_record(built.machine, built.reader, tracker_id)
    labels = {name.value: label for name, label in STEP_LABELS.items()}
    labels |= {status.value: text for status, text in STATUS_TEXT.items()}
    context = RecordPage(
        frame=tracker_frame(request, tracker_id, "Commissioning record"),
        record=found,
        labels=labels,
        choice=choice(found.tracker, found.mode) if found.mode else None,
    )
    return page(request, context)
