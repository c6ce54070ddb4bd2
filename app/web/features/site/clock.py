"""Step 2: whose clock to use: the controller's, that of the device at hand, or the system's again."""

from dataclasses import dataclass
from datetime import timedelta
from typing import Annotated, Literal

from fastapi import Form
from starlette.requests import Request
from starlette.responses import Response

from app.base.instants import read_instant
from app.base.message import N_, NOTHING, Message
from app.base.permission import Permission
from app.link.messages import ConfirmStep, SetClock, SiteDetail
from app.tracker.memory.memory import StepName
from app.web.features.site.clock_doubt import (
    answer_to,
    clock_doubt,
    doubt_beside,
    is_answer,
    site_moves,
    told_instant,
)
from app.web.features.site.site_contexts import ClockPage, ClockQuestion
from app.web.http.errors import NotAcceptable
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.http.whole_forms import MAY_BE_ABSENT
from app.web.shell.deps import Panel, PanelDep
from app.web.shell.orders import PressDep
from app.web.shell.render import go, page
from app.web.shell.wizard import tracker_of, wizard_frame

router = page_router(prefix="/trackers/{tracker_id}/commissioning/clock")
Source = Literal["keep", "device", "system"]
KEEP: Source = "keep"


@dataclass(frozen=True, slots=True)
class Choice:
    """What a chosen clock would do, what speaks against it, and the differences that a question names."""

    command: SetClock | ConfirmStep
    differences: tuple[timedelta, ...]
    doubt: Message = NOTHING
    moves: tuple[Message, ...] = ()

    @property
    def is_asked(self) -> bool:
        """Return whether it is asked about first."""
        return bool(self.doubt or self.moves)


@router.get("")
@needs(Permission.READ)
async def show(request: Request, tracker_id: str, built: PanelDep, done: str = "") -> Response:
    """Show the controller's clock beside this device's."""
    detail = await built.machine.detail()
    return _answer(request, tracker_id, detail, is_saved=done == "set")


@router.post("")
@needs(Permission.CONFIGURE)
async def save(
    tracker_id: str,
    press: PressDep,
    built: PanelDep,
    source: Annotated[Source, Form()],
    at: Annotated[str, Form(max_length=40), MAY_BE_ABSENT] = "",
    confirmed: Annotated[str, Form(max_length=40), MAY_BE_ABSENT] = "",
) -> Response:
    """Use the chosen clock and go on to homing; ask first where clocks differ or the site's would move."""
    detail = await built.machine.detail()
    choice = _chosen(source, tracker_id, built, detail, at)
    if choice.is_asked and not is_answer(confirmed, choice.differences):
        asked = ClockQuestion(answer_to(choice.differences), choice.doubt, choice.moves)
        return _answer(press.request, tracker_id, detail, source=source, at=at, question=asked, status=422)
    await press.send(choice.command)
    return go(press.request, f"/trackers/{tracker_id}/commissioning/homing")


def _chosen(source: Source, tracker_id: str, built: Panel, detail: SiteDetail, at: str) -> Choice:
    if source == "device":
        return _device(built, detail, at)
    if source == KEEP and detail.site.clock.source == "manual":
        return _present(tracker_id, built, at)
    return _system(built, detail, at)


def _present(tracker_id: str, built: Panel, at: str) -> Choice:
    """Keep the clock that was set manually, as it is."""
    now, device = built.site_now(), told_instant(at)
    differences = (now - (device or now),)
    return Choice(ConfirmStep(tracker_id, StepName.CLOCK), differences, clock_doubt(now, device))


def _system(built: Panel, detail: SiteDetail, at: str) -> Choice:
    """Use the clock of the controller's computer."""
    seen, now = built.machine.latest(), built.site_now()
    new = now - timedelta(seconds=seen.clock.offset_s if seen else 0.0)
    moves = site_moves(built, detail, new, detail.site.time_zone)
    system, device = built.clock.system_time(), told_instant(at)
    differences = (new - now, system - (device or system))
    return Choice(SetClock("system"), differences, doubt_beside(moves, system, device, now), moves)


def _device(built: Panel, detail: SiteDetail, at: str) -> Choice:
    """Make the controller's clock show what this device's shows."""
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
    differences = (instant - built.site_now(),)
    moves = site_moves(built, detail, instant, detail.site.time_zone)
    return Choice(SetClock("manual", instant), differences, NOTHING, moves)


def _answer(
    request: Request,
    tracker_id: str,
    detail: SiteDetail,
    *,
    source: Source = KEEP,
    at: str = "",
    question: ClockQuestion | None = None,
    is_saved: bool = False,
    status: int = 200,
) -> Response:
    context = ClockPage(
        frame=wizard_frame(request, tracker_of(detail, tracker_id), StepName.CLOCK),
        setting=detail.site.clock,
        source=source,
        at=at,
        question=question,
        is_saved=is_saved,
    )
    return page(request, context, block="question", status=status)
