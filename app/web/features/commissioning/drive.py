"""How a tracker's drive is reached: choose, test the connection, save, undo."""

from dataclasses import replace
from typing import Annotated

from fastapi import Form
from starlette.requests import Request
from starlette.responses import Response

from app.base.message import N_, told_by
from app.base.permission import Permission
from app.link.messages import (
    CheckConnection,
    ConfigureTracker,
    RestoreDrive,
    SiteDetail,
    TrackerDetail,
)
from app.web.features.commissioning.drive_contexts import DrivePage
from app.web.features.commissioning.drive_form import (
    KINDS,
    DriveForm,
    port_options,
    profile_options,
    read_drive,
    texts_of,
)
from app.web.http.errors import NotAcceptable
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.shell.deps import MachineDep
from app.web.shell.forms import Typed
from app.web.shell.frame import tracker_frame
from app.web.shell.orders import PressDep
from app.web.shell.render import go, page
from app.web.shell.wizard import tracker_of

router = page_router(prefix="/trackers/{tracker_id}/drive")
DONE = {
    "saved": N_("The drive settings are saved. Test the connection, then run the drive tests."),
    "restored": N_("The drive settings from before the last change are restored."),
}


@router.get("")
@needs(Permission.READ)
async def drive(request: Request, tracker_id: str, machine: MachineDep, done: str = "") -> Response:
    """Show the stored settings and the newest look at the drive."""
    detail = await machine.detail()
    tracker = tracker_of(detail, tracker_id)
    typed = Typed(texts_of(tracker.state.config.drive))
    return page(request, _context(request, detail, tracker, typed, DONE.get(done, "")))


@router.post("")
@needs(Permission.CONFIGURE, proven=True)
async def save(
    tracker_id: str, press: PressDep, machine: MachineDep, typed: Annotated[DriveForm, Form()]
) -> Response:
    """Save all settings, or none of them."""
    detail = await machine.detail()
    tracker = tracker_of(detail, tracker_id)
    config, found = tracker.state.config, Typed(typed.model_dump())
    wanted = read_drive(found, config.drive, detail.choices)
    if wanted is None:
        return page(press.request, _context(press.request, detail, tracker, found), block="form", status=422)
    try:
        await press.send(ConfigureTracker(replace(config, drive=wanted)))
    except NotAcceptable as refusal:
        found.errors["profile"] = told_by(refusal)
        return page(press.request, _context(press.request, detail, tracker, found), block="form", status=422)
    return go(press.request, f"/trackers/{tracker_id}/drive?done=saved")


@router.post("/test")
@needs(Permission.CONFIGURE)
async def test(
    tracker_id: str, press: PressDep, machine: MachineDep, typed: Annotated[DriveForm, Form()]
) -> Response:
    """Have the machine read a drive with the typed settings; nothing is saved, nothing is changed."""
    detail = await machine.detail()
    tracker = tracker_of(detail, tracker_id)
    found = Typed(typed.model_dump())
    wanted = read_drive(found, tracker.state.config.drive, detail.choices)
    if wanted is None:
        return page(press.request, _context(press.request, detail, tracker, found), block="form", status=422)
    await press.send(CheckConnection(tracker_id, wanted))
    detail = await machine.detail()
    context = _context(press.request, detail, tracker_of(detail, tracker_id), found)
    return page(press.request, replace(context, tested=True), block="work")


@router.post("/restore")
@needs(Permission.CONFIGURE, proven=True)
async def restore(tracker_id: str, press: PressDep) -> Response:
    """Set the drive as it was before the last change."""
    await press.send(RestoreDrive(tracker_id))
    return go(press.request, f"/trackers/{tracker_id}/drive?done=restored")


def _context(
    request: Request, detail: SiteDetail, tracker: TrackerDetail, typed: Typed, done: str = ""
) -> DrivePage:
    state = tracker.state
    return DrivePage(
        frame=tracker_frame(request, state.config.tracker_id, N_("Drive")),
        form=typed.form(DriveForm.model_fields),
        choices=detail.choices,
        profiles=profile_options(detail.choices, typed.texts.get("profile", "")),
        ports=port_options(detail.choices, typed.texts.get("serial_port", "")),
        kinds=KINDS,
        check=tracker.check,
        stored=state.config.drive,
        capabilities=tracker.capabilities,
        can_undo=state.memory.former_drive is not None,
        done=done,
    )
