"""The shadow test of step 2: where a shadow points by the present clock, and a clock that is typed."""

from collections.abc import Mapping
from datetime import datetime, timedelta
from typing import Annotated

from fastapi import Form
from pydantic import BaseModel
from starlette.requests import Request
from starlette.responses import Response

from app.base.message import N_
from app.base.permission import Permission
from app.link.messages import SetClock, SiteDetail
from app.tracker.memory.memory import StepName
from app.web.features.site.clock_doubt import doubt_beside, site_moves, told_instant
from app.web.features.site.location import zones
from app.web.features.site.site_contexts import CONFIRMED, ShadowPage
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.http.whole_forms import MAY_BE_ABSENT
from app.web.shell.deps import PanelDep
from app.web.shell.formats import local
from app.web.shell.forms import Typed, in_zone
from app.web.shell.orders import PressDep
from app.web.shell.render import go, page
from app.web.shell.wizard import tracker_of, wizard_frame

router = page_router(prefix="/trackers/{tracker_id}/commissioning/clock/shadow")
NAMES = ("date", "time", "time_zone")
LONGEST_QUESTION = timedelta(minutes=10)
"""What was asked longer ago is asked again."""


class ClockForm(BaseModel):
    """The form as it was typed; all texts."""

    date: str = ""
    time: str = ""
    time_zone: str = ""
    at: Annotated[str, MAY_BE_ABSENT] = ""
    confirmed: Annotated[str, MAY_BE_ABSENT] = ""
    asked_for: Annotated[str, MAY_BE_ABSENT] = ""
    asked_at: Annotated[str, MAY_BE_ABSENT] = ""


@router.get("")
@needs(Permission.READ)
async def show(request: Request, tracker_id: str, built: PanelDep) -> Response:
    """Show where a shadow points now, and a form to set the clock."""
    detail = await built.machine.detail()
    now = built.site_now()
    zone = detail.site.time_zone
    typed = Typed(
        {"date": local(now, zone, "%Y-%m-%d"), "time": local(now, zone, "%H:%M"), "time_zone": zone}
    )
    return _answer(request, tracker_id, detail, typed)


@router.post("")
@needs(Permission.CONFIGURE)
async def set_by_hand(
    tracker_id: str, press: PressDep, built: PanelDep, typed: Annotated[ClockForm, Form()]
) -> Response:
    """Set the controller's clock to a typed date and time; ask first where a clock differs."""
    detail = await built.machine.detail()
    found = Typed(typed.model_dump(include=set(NAMES)))
    day, time = found.day("date", N_("Date")), found.clock_time("time", N_("Time"))
    if typed.time_zone not in zones():
        found.errors["time_zone"] = N_("Choose a time zone from the list.")
    if found.errors:
        return _answer(press.request, tracker_id, detail, found, status=422)
    instant = in_zone(day, time, typed.time_zone)
    moves = site_moves(built, detail, instant, typed.time_zone)
    now = built.site_now()
    doubt = doubt_beside(moves, instant, told_instant(typed.at), now)
    answered = _answered(typed, instant, now)
    if (doubt or moves) and answered is None:
        asked = {"asked_for": instant.isoformat(), "asked_at": now.isoformat(), "doubt": doubt}
        return _answer(press.request, tracker_id, detail, found, status=422, moves=moves, asked=asked)
    await press.send(SetClock("manual", answered or instant, typed.time_zone))
    return go(press.request, f"/trackers/{tracker_id}/commissioning/clock?done=set")


def _answered(typed: ClockForm, instant: datetime, now: datetime) -> datetime | None:
    """Return what the clock is to show now that the question was answered; None if it was another question.

    A typed time is that of the moment at which it was first sent: what the question took is added.
    """
    asked_for, asked_at = told_instant(typed.asked_for), told_instant(typed.asked_at)
    if typed.confirmed != CONFIRMED or asked_for != instant or asked_at is None:
        return None
    took = now - asked_at
    return instant + took if timedelta(0) <= took <= LONGEST_QUESTION else None


def _answer(
    request: Request,
    tracker_id: str,
    detail: SiteDetail,
    typed: Typed,
    *,
    status: int = 200,
    moves: tuple[str, ...] = (),
    asked: Mapping[str, str] | None = None,
) -> Response:
    context = ShadowPage(
        frame=wizard_frame(request, tracker_of(detail, tracker_id), StepName.CLOCK),
        form=typed.form(NAMES),
        zones=zones(),
        moves=moves,
        **(asked or {}),
    )
    return page(request, context, block="manual", status=status)
