"""The keys of control on every page of a tracker, and the lock on its settings."""

from typing import Annotated, Literal, assert_never

from fastapi import Form
from starlette.responses import Response

from app.base.message import N_
from app.base.permission import Permission
from app.link.messages import (
    AnswerControl,
    ReleaseControl,
    RequestControl,
    SiteCommand,
)
from app.link.settings_orders import LockSettings, UnlockSettings
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.http.whole_forms import MAY_BE_ABSENT
from app.web.shell.orders import PressDep

router = page_router(prefix="/trackers/{tracker_id}")

Wanted = Literal["request", "take_over", "hand_over", "keep", "release"]
Reason = Annotated[str, Form(max_length=200), MAY_BE_ABSENT]
DONE = {
    "request": N_("Control was requested."),
    "take_over": N_("Control transfers when the countdown ends, unless the request is declined."),
    "hand_over": N_("Control was handed over."),
    "keep": N_("Request declined. You keep control."),
    "release": N_("You released control."),
}


@router.post("/control")
@needs(Permission.OPERATE)
async def control(
    tracker_id: str, press: PressDep, wanted: Annotated[Wanted, Form()], reason: Reason = ""
) -> Response:
    """Do what a key of control says."""
    await press.send(_command(tracker_id, wanted, reason))
    return press.answer(DONE[wanted])


def _command(tracker_id: str, wanted: Wanted, reason: str) -> SiteCommand:
    match wanted:
        case "request" | "take_over":
            return RequestControl((tracker_id,), wanted == "take_over", reason)
        case "hand_over" | "keep":
            return AnswerControl(tracker_id, wanted == "hand_over")
        case "release":
            return ReleaseControl(tracker_id)
        case _:
            assert_never(wanted)


@router.post("/settings-lock")
@needs(Permission.CONFIGURE)
async def lock(tracker_id: str, press: PressDep) -> Response:
    """Lock the settings."""
    await press.send(LockSettings(tracker_id))
    return press.answer(N_("The settings are locked."))


@router.post("/settings-lock/open")
@needs(Permission.CONFIGURE)
async def unlock(tracker_id: str, press: PressDep, reason: Reason = "") -> Response:
    """Unlock the settings for a reason."""
    await press.send(UnlockSettings(tracker_id, reason))
    return press.answer(N_("The settings are unlocked."))
