"""Step 2: whose clock to trust, and the sun now, to be held against a shadow."""

from collections.abc import Mapping
from datetime import datetime, timedelta
from typing import Annotated

from fastapi import Form
from pydantic import BaseModel
from starlette.requests import Request
from starlette.responses import Response

from app.base.instants import read_instant
from app.base.message import N_, NOTHING, Message
from app.base.permission import Permission
from app.link.messages import SetClock, SiteDetail
from app.tracker.access.location_change import MOST_APART
from app.tracker.memory.memory import StepName
from app.web.features.site.clock_doubt import clock_doubt, clock_moves, refuse_before_asking
from app.web.features.site.location import zones
from app.web.features.site.site_contexts import CONFIRMED, ClockPage, ClockQuestion
from app.web.http.errors import NotAcceptable
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.http.whole_forms import MAY_BE_ABSENT
from app.web.shell.deps import Panel, PanelDep
from app.web.shell.formats import local
from app.web.shell.forms import Typed, in_zone
from app.web.shell.orders import PressDep
from app.web.shell.render import go, page
from app.web.shell.wizard import tracker_of, wizard_frame

router = page_router(prefix="/trackers/{tracker_id}/commissioning/clock")
DeviceAt = Annotated[str, Form(max_length=40), MAY_BE_ABSENT]
Confirmed = Annotated[str, Form(max_length=40), MAY_BE_ABSENT]
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
async def show(request: Request, tracker_id: str, built: PanelDep, done: str = "") -> Response:
    """Show the controller's clock beside this device's."""
    detail = await built.machine.detail()
    now = built.site_now()
    zone = detail.site.time_zone
    typed = Typed(
        {"date": local(now, zone, "%Y-%m-%d"), "time": local(now, zone, "%H:%M"), "time_zone": zone}
    )
    return _answer(request, tracker_id, detail, typed, is_saved=done == "set")


@router.post("/system")
@needs(Permission.CONFIGURE)
async def keep_system(
    tracker_id: str, press: PressDep, built: PanelDep, at: DeviceAt = "", confirmed: Confirmed = ""
) -> Response:
    """Trust the clock of the controller's computer; ask first where it differs from this device's."""
    detail, seen, now = await built.machine.detail(), built.machine.latest(), built.site_now()
    new = now - timedelta(seconds=seen.clock.offset_s if seen else 0.0)
    moves = _moves(built, detail, new, detail.site.time_zone)
    system, device = built.clock.system_time(), _told(at)
    doubt = clock_doubt(system, device)
    asked = (new - now, system - (device or system))
    if (doubt or moves) and not _is_answer(confirmed, asked):
        return page(press.request, ClockQuestion(_answer_to(asked), doubt, moves), status=422)
    await press.send(SetClock("system"))
    return go(press.request, _saved(tracker_id))


@router.post("/device")
@needs(Permission.CONFIGURE)
async def copy_device(
    tracker_id: str, press: PressDep, built: PanelDep, at: DeviceAt = "", confirmed: Confirmed = ""
) -> Response:
    """Make the controller's clock show what this device's shows; ask first where that moves it."""
    try:
        instant = read_instant(at)
    except ValueError:
        raise NotAcceptable(
            N_("The browser of this device did not report its time; enter date and time manually.")
        ) from None
    if instant.tzinfo is None:
        raise NotAcceptable(
            N_("This device reported its time without a time zone; enter date and time manually.")
        )
    detail = await built.machine.detail()
    asked = (instant - built.site_now(),)
    moves = _moves(built, detail, instant, detail.site.time_zone)
    if moves and not _is_answer(confirmed, asked):
        return page(press.request, ClockQuestion(_answer_to(asked), NOTHING, moves), status=422)
    await press.send(SetClock("manual", instant))
    return go(press.request, _saved(tracker_id))


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
    doubt, moves = clock_doubt(instant, _told(typed.at)), _moves(built, detail, instant, typed.time_zone)
    now = built.site_now()
    answered = _answered(typed, instant, now)
    if (doubt or moves) and answered is None:
        asked = {"asked_for": instant.isoformat(), "asked_at": now.isoformat(), "doubt": doubt}
        return _answer(press.request, tracker_id, detail, found, status=422, moves=moves, asked=asked)
    await press.send(SetClock("manual", answered or instant, typed.time_zone))
    return go(press.request, _saved(tracker_id))


def _answer_to(differences: tuple[timedelta, ...]) -> str:
    """Return what stands for exactly these differences, in a question about them."""
    return " ".join(f"{one.total_seconds():.0f}" for one in differences)


def _is_answer(confirmed: str, differences: tuple[timedelta, ...]) -> bool:
    """Return whether these differences were confirmed, none of them over a minute off what was asked."""
    try:
        named = [int(one) for one in confirmed.split()]
    except ValueError:
        return False
    most_s = MOST_APART.total_seconds()
    pairs = zip(named, differences, strict=False)
    return len(named) == len(differences) and all(
        abs(one - by.total_seconds()) <= most_s for one, by in pairs
    )


def _answered(typed: ClockForm, instant: datetime, now: datetime) -> datetime | None:
    """Return what the clock is to show now that the question was answered; None if it was another question.

    A typed time is that of the moment at which it was first sent: what the question took is added.
    """
    asked_for, asked_at = _told(typed.asked_for), _told(typed.asked_at)
    if typed.confirmed != CONFIRMED or asked_for != instant or asked_at is None:
        return None
    took = now - asked_at
    return instant + took if timedelta(0) <= took <= LONGEST_QUESTION else None


def _told(at: str) -> datetime | None:
    """Return what a page tells of a clock, None where its browser did not tell."""
    try:
        instant = read_instant(at)
    except ValueError:
        return None
    return instant if instant.tzinfo else None


def _moves(built: Panel, detail: SiteDetail, new: datetime, zone: str) -> tuple[Message, ...]:
    """Return what a new clock would change; refuse it where a tracker is led by the present one."""
    present = built.site_now()
    refuse_before_asking(new - present, built.machine.latest())
    return clock_moves(present, new, zone, detail.site.location)


def _saved(tracker_id: str) -> str:
    return f"/trackers/{tracker_id}/commissioning/clock?done=set"


def _answer(
    request: Request,
    tracker_id: str,
    detail: SiteDetail,
    typed: Typed,
    *,
    status: int = 200,
    moves: tuple[str, ...] = (),
    asked: Mapping[str, str] | None = None,
    is_saved: bool = False,
) -> Response:
    frame = wizard_frame(request, tracker_of(detail, tracker_id), StepName.CLOCK)
    context = ClockPage(
        frame=frame,
        form=typed.form(NAMES),
        zones=zones(),
        setting=detail.site.clock,
        moves=moves,
        is_saved=is_saved,
        **(asked or {}),
    )
    return page(request, context, block="manual", status=status)
