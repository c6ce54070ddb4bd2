"""Signed commissioning records: photos for the next one, signing, reading, comparing."""

from typing import Annotated, Any

from fastapi import File, Form, Path, Query, UploadFile
from fastapi.responses import Response
from pydantic import Field

from app.base.message import N_, join, told_by
from app.base.permission import Permission
from app.store.store import RecordHead
from app.web.api.base import (
    NOT_FOUND,
    REFUSED,
    Clean,
    CleanLines,
    Cursor,
    Input,
    Limit,
    Output,
    Page,
    Responses,
    TrackerId,
    api_router,
    before,
    following,
    whole,
)
from app.web.api.orders import SenderDep
from app.web.features.records.commissioning_api import FILES, RecordFormat, written
from app.web.features.records.photos import LARGEST_UPLOAD, PhotoRefused
from app.web.features.records.record_document import LONGEST_REMARK, differences, paper, read_document
from app.web.features.records.record_orders import (
    add_photo,
    asked_before_signing,
    photo_of,
    remove_photo,
    require_tracker,
    sign,
    signed_record,
)
from app.web.features.records.record_print import record_html, record_pdf
from app.web.features.records.signatures import (
    HEIGHT,
    LONGEST_NAME,
    MOST_STROKES,
    WIDTH,
    Signature,
    SignatureRole,
)
from app.web.http.errors import NotAcceptable
from app.web.http.needs import needs
from app.web.shell.deps import PanelDep, PrincipalDep, ReaderDep

router = api_router(tags=["commissioning records"])

RecordNumber = Annotated[int, Path(ge=1, le=2**53, description="Number of the record.")]
PhotoNumber = Annotated[int, Path(ge=1, le=2**53, description="Number of the photo.")]
Across = Annotated[int, Field(ge=0, le=WIDTH)]
Down = Annotated[int, Field(ge=0, le=HEIGHT)]
Drawn = Annotated[tuple[tuple[Across, Down], ...], Field(min_length=2, max_length=2000)]
JPEG: Responses = {
    200: {
        "content": {"image/jpeg": {"schema": {"type": "string", "format": "binary"}}},
        "description": "JPEG.",
    }
}


class WaitingPhoto(Output):
    """A photo that waits for the next record of its tracker; `digest` is its SHA-256."""

    number: int
    caption: str
    added_by: str
    digest: str
    width: int = Field(description="Pixels.")
    height: int = Field(description="Pixels.")


class Signed(Input):
    """Who signs, for whom, and what was drawn: strokes of points in a field of 1000 x 300, y downwards."""

    role: SignatureRole
    name: Annotated[str, Clean] = Field(min_length=1, max_length=LONGEST_NAME)
    strokes: tuple[Drawn, ...] = Field((), max_length=MOST_STROKES)


class NewRecord(Input):
    """The signatures of a record, the technician's among them, and a remark."""

    signatures: tuple[Signed, ...] = Field(min_length=1, max_length=2)
    remark: Annotated[str, CleanLines] = Field("", max_length=LONGEST_REMARK)
    confirmed: bool = Field(
        False, description="It is to be signed although steps or drive tests are open or an alarm is active."
    )


class Line(Output):
    """One line of two records; an empty text stands where a record has no such line."""

    section: str
    name: str
    first: str
    second: str
    differs: bool


@router.get("/records", summary="Signed records, newest first")
@needs(Permission.READ)
def list_records(
    reader: ReaderDep,
    tracker_id: Annotated[str | None, Query(max_length=64)] = None,
    cursor: Cursor = None,
    limit: Limit = 200,
) -> Page[RecordHead]:
    """Return the heads of signed commissioning records."""
    found = reader.signed_records(tracker_id, limit=limit, before=before(cursor))
    return Page[RecordHead](items=tuple(found), next=following([one.number for one in found], limit))


@router.get("/records/comparison", summary="Two records side by side", responses=NOT_FOUND)
@needs(Permission.READ)
def compare_records(
    reader: ReaderDep,
    first: Annotated[int, Query(ge=1, le=2**53)],
    second: Annotated[int, Query(ge=1, le=2**53)],
) -> Page[Line]:
    """Return every line of two signed records, without what only says when they were written."""
    one, other = (read_document(signed_record(reader, number)) for number in (first, second))
    return whole(Line.model_validate(line, from_attributes=True) for line in differences(one, other))


@router.get(
    "/records/{number}",
    summary="A signed record",
    response_model=dict[str, Any],
    responses=NOT_FOUND | FILES,
)
@needs(Permission.READ, ticketed=True)
def read_signed_record(
    number: RecordNumber, reader: ReaderDep, format: RecordFormat = RecordFormat.JSON
) -> Response:
    """Return a record as it was signed. The SHA-256 of the JSON, byte for byte, is the record's `digest`."""
    signed = signed_record(reader, number)
    if format is RecordFormat.JSON:
        read_document(signed)
        return Response(signed.document.encode(), media_type="application/json")
    printed = paper(signed, reader.photos_of(number))
    name = f"commissioning-{signed.head.tracker_id}-{number}"
    content = record_html(printed) if format is RecordFormat.HTML else record_pdf(printed)
    return written(content, format, name)


@router.get("/records/{number}/photos", summary="The photos of a signed record", responses=NOT_FOUND)
@needs(Permission.READ)
def list_record_photos(number: RecordNumber, reader: ReaderDep) -> Page[WaitingPhoto]:
    """Return the photos that were signed with a record."""
    signed_record(reader, number)
    return whole(WaitingPhoto.model_validate(one, from_attributes=True) for one in reader.photos_of(number))


@router.get("/record-photos/{number}", summary="A photo", response_class=Response, responses=NOT_FOUND | JPEG)
@needs(Permission.READ, ticketed=True)
def read_photo(number: PhotoNumber, reader: ReaderDep) -> Response:
    """Return a photo as JPEG."""
    return Response(photo_of(reader, number).content, media_type="image/jpeg")


@router.post(
    "/trackers/{tracker_id}/records",
    status_code=201,
    summary="Sign the record",
    responses=NOT_FOUND | REFUSED,
)
@needs(Permission.CONFIGURE)
async def sign_record(
    tracker_id: TrackerId, new: NewRecord, sender: SenderDep, built: PanelDep, who: PrincipalDep
) -> RecordHead:
    """Keep the record as it stands now for good, with the photos that wait for it.

    With open steps, open drive tests or an active alarm it is refused with these until it is `confirmed`.
    """
    roles = [one.role for one in new.signatures]
    if SignatureRole.TECHNICIAN not in roles or len(set(roles)) != len(roles):
        raise NotAcceptable(
            N_("A record needs the technician's signature and at most one signature per role.")
        )
    if not new.confirmed and (doubts := await asked_before_signing(built, tracker_id)):
        raise NotAcceptable(
            join(" ", (*doubts, N_("To sign anyway, send the request again with `confirmed`.")))
        )
    signatures = [Signature(one.role, one.name, one.strokes) for one in new.signatures]
    return await sign(sender.send, built, tracker_id, who.actor, new.remark, signatures)


@router.get("/trackers/{tracker_id}/record/photos", summary="Photos that wait", responses=NOT_FOUND)
@needs(Permission.READ)
async def list_photos(tracker_id: TrackerId, built: PanelDep) -> Page[WaitingPhoto]:
    """Return the photos that wait for the next record of a tracker."""
    await require_tracker(built, tracker_id)
    found = built.reader.waiting_photos(tracker_id)
    return whole(WaitingPhoto.model_validate(one, from_attributes=True) for one in found)


@router.post(
    "/trackers/{tracker_id}/record/photos",
    status_code=201,
    summary="Add a photo",
    responses=NOT_FOUND | REFUSED,
)
@needs(Permission.CONFIGURE)
async def upload_photo(
    tracker_id: TrackerId,
    photo: Annotated[UploadFile, File(description="JPEG or PNG, at most 8 MB.")],
    sender: SenderDep,
    built: PanelDep,
    caption: Annotated[str, Form(max_length=120)] = "",
) -> Page[WaitingPhoto]:
    """Keep a photo for the next record of a tracker: made small, without what the camera wrote into it."""
    await require_tracker(built, tracker_id)
    try:
        await add_photo(sender.send, tracker_id, await photo.read(LARGEST_UPLOAD + 1), caption)
    except PhotoRefused as error:
        raise NotAcceptable(told_by(error)) from error
    return await list_photos(tracker_id, built)


@router.delete(
    "/trackers/{tracker_id}/record/photos/{number}",
    status_code=204,
    summary="Remove a photo",
    responses=NOT_FOUND | REFUSED,
)
@needs(Permission.CONFIGURE)
async def delete_photo(
    tracker_id: TrackerId, number: PhotoNumber, sender: SenderDep, built: PanelDep
) -> None:
    """Remove a photo that waits; one of a signed record stays."""
    await require_tracker(built, tracker_id)
    await remove_photo(sender.send, built.reader, tracker_id, number)
