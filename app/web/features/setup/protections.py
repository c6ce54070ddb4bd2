"""The protections page: what holds now, stows, the maintenance lock, and what an engineer sets."""

from dataclasses import replace
from typing import Annotated

from fastapi import Form
from starlette.requests import Request
from starlette.responses import Response

from app.base.message import N_
from app.base.names import LONGEST_TYPED
from app.base.permission import Permission
from app.link.messages import ConfigureTracker, TrackerDetail
from app.tracker.commands.commands import ReleaseInhibit, Resume, SetInhibit, Stow
from app.tracker.settings.protections import ProtectionConfig, StowName
from app.web.features.setup import protection_forms as forms
from app.web.features.setup.protection_contexts import ProtectionsPage
from app.web.http.errors import NotAcceptable
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.shell.deps import MachineDep
from app.web.shell.forms import Typed, sent
from app.web.shell.frame import tracker_frame
from app.web.shell.orders import PressDep
from app.web.shell.render import page
from app.web.shell.setting_forms import texts, typed_settings
from app.web.shell.wizard import tracker_of

router = page_router(prefix="/trackers/{tracker_id}")


@router.get("/protections")
@needs(Permission.READ)
async def protections(request: Request, tracker_id: str, machine: MachineDep) -> Response:
    """Show what holds and what is set."""
    tracker = tracker_of(await machine.detail(), tracker_id)
    return _answer(request, tracker, Typed(texts(tracker.state.config.protection)))


@router.post("/protections")
@needs(Permission.CONFIGURE)
async def save(request: Request, tracker_id: str, press: PressDep, machine: MachineDep) -> Response:
    """Save all settings, or none of them."""
    tracker = tracker_of(await machine.detail(), tracker_id)
    typed = await sent(request)
    wanted = typed_settings(typed, ProtectionConfig)
    if wanted is None:
        return _answer(press.request, tracker, typed, status=422)
    await press.send(ConfigureTracker(replace(tracker.state.config, protection=wanted)))
    return press.answer(N_("The protections are saved."))


@router.post("/stow")
@needs(Permission.OPERATE)
async def stow(tracker_id: str, press: PressDep, position: Annotated[str, Form(max_length=20)]) -> Response:
    """Go to a stow position and stay there."""
    if position not in list(StowName):
        raise NotAcceptable(N_("Choose one of the stow positions."))
    await press.send(Stow(StowName(position)), tracker_id)
    return press.answer()


@router.post("/resume")
@needs(Permission.OPERATE)
async def resume(tracker_id: str, press: PressDep) -> Response:
    """Leave the stow position that was commanded."""
    await press.send(Resume(), tracker_id)
    return press.answer()


@router.post("/lock")
@needs(Permission.OPERATE)
async def lock(
    tracker_id: str,
    press: PressDep,
    name: Annotated[str, Form(max_length=LONGEST_TYPED)] = "",
    reason: Annotated[str, Form(max_length=200)] = "",
) -> Response:
    """Forbid every automatic motion."""
    await press.send(SetInhibit(name, reason), tracker_id)
    return press.answer()


@router.post("/release-lock")
@needs(Permission.OPERATE)
async def release_inhibit(tracker_id: str, press: PressDep) -> Response:
    """Forget the lock."""
    await press.send(ReleaseInhibit(), tracker_id)
    return press.answer()


def _answer(request: Request, tracker: TrackerDetail, typed: Typed, *, status: int = 200) -> Response:
    context = ProtectionsPage(
        frame=tracker_frame(request, tracker.state.config.tracker_id, N_("Protections")),
        form=typed.form(forms.names()),
        groups=forms.groups(),
        stows=forms.stows(),
        fixed=forms.fixed(),
    )
    return page(request, context, block="form", status=status)
