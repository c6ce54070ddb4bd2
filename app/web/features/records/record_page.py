"""The commissioning record as it stands now: photos are added to it, and it is signed."""

from typing import Annotated

from fastapi import File, Form, UploadFile
from pydantic import BaseModel
from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import Response

from app.base.message import N_, say, told_by
from app.base.names import clean
from app.base.permission import Permission
from app.link.record_orders import RecordOrder
from app.web.features.control.mode import choice
from app.web.features.records.photos import LARGEST_UPLOAD, PhotoRefused
from app.web.features.records.record import is_future, read_record
from app.web.features.records.record_contexts import RecordPage
from app.web.features.records.record_document import LONGEST_REMARK
from app.web.features.records.record_orders import (
    Send,
    add_photo,
    asked_before_signing,
    photo_of,
    remove_photo,
    sign,
)
from app.web.features.records.signatures import Signature, SignatureRefused, SignatureRole, signature
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.http.whole_forms import MAY_BE_ABSENT
from app.web.shell.deps import Panel, PanelDep, principal
from app.web.shell.forms import Typed
from app.web.shell.frame import STATUS_TEXT, STEP_LABELS, tracker_frame
from app.web.shell.orders import Press, PressDep
from app.web.shell.render import go, page

router = page_router(prefix="/trackers/{tracker_id}/record")
MOST_PHOTOS = 12
NAMES = ("remark", "technician", "technician_drawn", "customer", "customer_drawn")


class SignForm(BaseModel):
    """Names, drawn signatures and remark as they came."""

    remark: str = ""
    technician: str = ""
    technician_drawn: str = ""
    customer: str = ""
    customer_drawn: str = ""
    confirmed: Annotated[str, MAY_BE_ABSENT] = ""


@router.get("")
@needs(Permission.READ)
async def record(request: Request, tracker_id: str, built: PanelDep) -> Response:
    """Show how the tracker stands, who commissioned it, and what was signed before."""
    return await _answer(request, tracker_id, built, Typed({}))


@router.post("")
@needs(Permission.CONFIGURE)
async def sign_record(
    tracker_id: str, press: PressDep, built: PanelDep, form: Annotated[SignForm, Form()]
) -> Response:
    """Keep the record with its signatures for good."""
    typed = Typed(form.model_dump())
    signatures = _signatures(typed)
    remark = ""
    try:
        remark = clean(form.remark, lines=True)
    except ValueError as error:
        typed.errors["remark"] = told_by(error)
    if len(remark) > LONGEST_REMARK:
        typed.errors["remark"] = say(
            "A remark can have at most {longest_remark} characters.", longest_remark=LONGEST_REMARK
        )
    if typed.errors:
        return await _answer(press.request, tracker_id, built, typed, status=422)
    if form.confirmed != "yes" and (doubts := await asked_before_signing(built, tracker_id)):
        return await _answer(press.request, tracker_id, built, typed, status=422, doubts=doubts)
    actor = principal(press.request).actor
    head = await sign(_sender(press), built, tracker_id, actor, remark, signatures)
    return go(press.request, f"/records/{head.number}")


@router.post("/photos")
@needs(Permission.CONFIGURE)
async def upload_photo(
    tracker_id: str,
    press: PressDep,
    built: PanelDep,
    photo: Annotated[UploadFile, File()],
    caption: Annotated[str, Form(max_length=120)] = "",
) -> Response:
    """Keep a photo for the next record."""
    try:
        await add_photo(_sender(press), tracker_id, await photo.read(LARGEST_UPLOAD + 1), caption)
    except PhotoRefused as error:
        typed = Typed({"caption": caption})
        return await _answer(
            press.request, tracker_id, built, typed, block="photos", status=422, photo_error=told_by(error)
        )
    if press.request.headers.get("HX-Request") == "true":
        return await _answer(press.request, tracker_id, built, Typed({}), block="photos")
    return go(press.request, f"/trackers/{tracker_id}/record#photos")


@router.post("/photos/{number}/remove")
@needs(Permission.CONFIGURE)
async def delete_photo(tracker_id: str, number: int, press: PressDep, built: PanelDep) -> Response:
    """Remove a photo that waits."""
    await remove_photo(_sender(press), built.reader, tracker_id, number)
    if press.request.headers.get("HX-Request") == "true":
        return await _answer(press.request, tracker_id, built, Typed({}), block="photos")
    return go(press.request, f"/trackers/{tracker_id}/record#photos")


@router.get("/photos/{number}.jpg")
@needs(Permission.READ)
def photo(tracker_id: str, number: int, built: PanelDep) -> Response:
    """Return a photo of this tracker."""
    found = photo_of(built.reader, number)
    return Response(found.content, media_type="image/jpeg")


def _sender(press: Press) -> Send:
    async def send(order: RecordOrder) -> None:
        await press.send(order)

    return send


def _signatures(typed: Typed) -> tuple[Signature, ...]:
    found = []
    for role in SignatureRole:
        try:
            found.append(signature(role, typed.texts[role.value], typed.texts[f"{role.value}_drawn"]))
        except SignatureRefused as error:
            typed.errors[role.value] = told_by(error)
    if not typed.errors and found[0] is None:
        typed.errors[SignatureRole.TECHNICIAN.value] = N_("Commissioned by: type the name of the technician.")
    return tuple(one for one in found if one is not None)


async def _answer(
    request: Request,
    tracker_id: str,
    built: Panel,
    typed: Typed,
    *,
    block: str = "sign",
    status: int = 200,
    photo_error: str = "",
    doubts: tuple[str, ...] = (),
) -> Response:
    found = await read_record(built.machine, built.reader, tracker_id)
    labels: dict[str, str] = {name.value: label for name, label in STEP_LABELS.items()}
    labels |= {status.value: text for status, text in STATUS_TEXT.items()}
    context = RecordPage(
        frame=tracker_frame(request, tracker_id, N_("Commissioning record")),
        record=found,
        labels=labels,
        choice=choice(found.tracker, found.mode) if found.mode else None,
        photos=tuple(await run_in_threadpool(built.reader.waiting_photos, tracker_id)),
        form=typed.form((*NAMES, "caption")),
        signed=tuple(await run_in_threadpool(built.reader.signed_records, tracker_id)),
        most_photos=MOST_PHOTOS,
        photo_error=photo_error,
        doubts=doubts,
        misdated=tuple(step.name for step in found.steps if is_future(step.confirmed_at, found.written_at)),
    )
    return page(request, context, block=block, status=status)
