"""The five steps, the sun check, and the commissioning record."""

from enum import StrEnum
from typing import Annotated
from urllib.parse import quote

from fastapi import Path
from fastapi.responses import Response
from pydantic import Field
from starlette.concurrency import run_in_threadpool

from app.base.message import say
from app.base.permission import Permission
from app.link.messages import ApplySightings, ConfirmStep, TakeSighting
from app.tracker.commissioning.steps import Step
from app.tracker.memory.memory import Pointing, Sighting, StepName
from app.web.api.base import NOT_FOUND, REFUSED, Input, Output, Page, Responses, TrackerId, api_router, whole
from app.web.api.orders import SenderDep
from app.web.api.trackers import detail_of
from app.web.features.records.record import CommissioningRecord, read_record
from app.web.features.records.record_files import draft
from app.web.features.records.record_print import record_html, record_pdf
from app.web.http.errors import NotAcceptable
from app.web.http.needs import needs
from app.web.shell.deps import MachineDep, PanelDep

router = api_router(prefix="/trackers/{tracker_id}", tags=["commissioning"])
HEADERS = {"Vary": "Cookie, Accept-Language"}

FILES: Responses = {
    200: {
        "description": "As JSON, or as a file for printing.",
        "content": {
            "text/html": {"schema": {"type": "string"}},
            "application/pdf": {"schema": {"type": "string", "format": "binary"}},
        },
    }
}


class RecordFormat(StrEnum):
    """How the commissioning record is written."""

    JSON = "json"
    HTML = "html"
    PDF = "pdf"


class SunCheck(Output):
    """The stored sightings and the correction that is applied."""

    sightings: tuple[Sighting, ...]
    pointing: Pointing


class KeptSightings(Input):
    """Which of the stored sightings to fit; none of them: forget the correction."""

    keep: tuple[Annotated[int, Field(ge=0, le=10_000)], ...] = Field(
        max_length=1000, description="Places in the list of sightings, from 0.", examples=[[0, 1, 2]]
    )


@router.get("/commissioning", summary="The five steps", responses=NOT_FOUND)
@needs(Permission.READ)
async def read_steps(tracker_id: TrackerId, machine: MachineDep) -> Page[Step]:
    """Return each step with done, to do or to be confirmed, and why."""
    return whole((await detail_of(machine, tracker_id)).steps)


@router.post("/commissioning/{step}/confirm", summary="Confirm a step", responses=NOT_FOUND | REFUSED)
@needs(Permission.CONFIGURE)
async def confirm_step(
    tracker_id: TrackerId,
    step: Annotated[StepName, Path(description="The step that is still right.")],
    sender: SenderDep,
    machine: MachineDep,
) -> Page[Step]:
    """Say that a step is still right after an earlier one was changed."""
    await sender.send(ConfirmStep(tracker_id, step))
    return whole((await detail_of(machine, tracker_id)).steps)


@router.get("/sightings", summary="The sun check", responses=NOT_FOUND)
@needs(Permission.READ)
async def read_sightings(tracker_id: TrackerId, machine: MachineDep) -> SunCheck:
    """Return the stored sightings and the correction that is applied."""
    memory = (await detail_of(machine, tracker_id)).state.memory
    return SunCheck(sightings=memory.sightings, pointing=memory.pointing)


@router.post("/sightings", status_code=201, summary="Take a sighting", responses=NOT_FOUND | REFUSED)
@needs(Permission.CONFIGURE)
async def take_sighting(tracker_id: TrackerId, sender: SenderDep, machine: MachineDep) -> SunCheck:
    """Store sun and panel as they are now: the panel faces the sun."""
    await sender.send(TakeSighting(tracker_id))
    return await read_sightings(tracker_id, machine)


@router.put("/sightings", summary="Correct by sightings", responses=NOT_FOUND | REFUSED)
@needs(Permission.CONFIGURE)
async def apply_sightings(
    tracker_id: TrackerId, kept: KeptSightings, sender: SenderDep, machine: MachineDep
) -> SunCheck:
    """Fit these sightings and correct the pointing with the result; the others are forgotten."""
    stored = (await detail_of(machine, tracker_id)).state.memory.sightings
    if any(place >= len(stored) for place in kept.keep):
        raise NotAcceptable(
            say("There are {stored} sightings, counted from 0; choose among these.", stored=len(stored))
        )
    keep = tuple(stored[place] for place in dict.fromkeys(kept.keep))
    await sender.send(ApplySightings(tracker_id, keep))
    return await read_sightings(tracker_id, machine)


@router.get(
    "/record",
    summary="The commissioning record",
    response_model=CommissioningRecord,
    responses=NOT_FOUND | FILES,
)
@needs(Permission.READ)
async def read_commissioning_record(
    tracker_id: TrackerId,
    panel: PanelDep,
    format: RecordFormat = RecordFormat.JSON,
) -> CommissioningRecord | Response:
    """Return who commissioned the tracker and when, its as-left settings and what was verified."""
    record = await read_record(panel.machine, panel.reader, tracker_id)
    name = f"commissioning-{tracker_id}"
    match format:
        case RecordFormat.JSON:
            return record
        case RecordFormat.HTML:
            return written(record_html(draft(record)), format, name)
        case RecordFormat.PDF:
            return written(await run_in_threadpool(record_pdf, draft(record)), format, name)


def written(content: str | bytes, kind: RecordFormat, name: str) -> Response:
    """Return a record as a file to be kept; `name` without its ending."""
    media_type = "text/html" if kind is RecordFormat.HTML else "application/pdf"
    attached = {"Content-Disposition": f"attachment; filename*=utf-8''{quote(name)}.{kind.value}"}
    return Response(content, media_type=media_type, headers=HEADERS | attached)
