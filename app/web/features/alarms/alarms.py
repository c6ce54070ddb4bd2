"""Alarms on pages: those that stand, those put aside, the history, and what each of them means."""

from collections.abc import Iterable
from typing import Annotated
from urllib.parse import urlencode

from fastapi import Form, Query
from starlette.requests import Request
from starlette.responses import Response

from app.alarms.catalogue import CATALOGUE, ENTRIES
from app.alarms.view import ASIDE, told
from app.base.message import N_, told_by
from app.base.permission import Permission
from app.link.alarm_orders import AcknowledgeAlarm, ShelveAlarm, UnshelveAlarm
from app.store.store import AlarmFilter, KeptAlarm
from app.tracker.values.alarm_words import PRIORITIES, AlarmCounts, AlarmNow
from app.web.features.alarms.alarm_contexts import AlarmGuidePage, AlarmsPage, PastAlarm, ShelfForm
from app.web.http.errors import NotAcceptable
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.shell.contexts import Link
from app.web.shell.deps import ReaderDep
from app.web.shell.frame import site_frame
from app.web.shell.orders import PressDep
from app.web.shell.render import page

router = page_router(prefix="/alarms")
A_PAGE = 60
VIEWS = (("active", N_("Active")), ("shelved", N_("Shelved")), ("history", N_("History")))
Priorities = Annotated[list[int], Query()]


@router.get("")
@needs(Permission.READ)
def alarms(
    request: Request,
    reader: ReaderDep,
    p: Priorities = [],  # noqa: B006 - FastAPI copies a default
    view: str = "active",
    before: int | None = None,
) -> Response:
    """Show one of the three lists, narrowed to some priorities."""
    wanted = tuple(one for one in PRIORITIES if one in p)
    past = _past(reader, wanted, before) if view == "history" else ()
    return page(request, _context(request, view, wanted, past), block="list")


@router.get("/guide")
@needs(Permission.READ)
def guide(request: Request) -> Response:
    """Show every alarm there is: what it means, what follows, what to do."""
    return page(request, AlarmGuidePage(site_frame(request, N_("Alarm guide"), back=_BACK), ENTRIES))


@router.post("/acknowledge")
@needs(Permission.OPERATE)
async def acknowledge(press: PressDep, alarm_id: Annotated[list[str], Form(max_length=500)]) -> Response:
    """Acknowledge the alarms that somebody has seen."""
    for one in alarm_id:
        await press.send(AcknowledgeAlarm(one))
    return press.answer(N_("Acknowledged."))


@router.post("/shelve")
@needs(Permission.OPERATE)
async def shelve(
    press: PressDep,
    alarm_id: Annotated[str, Form(max_length=120)],
    minutes: Annotated[str, Form(max_length=10)] = "",
    reason: Annotated[str, Form(max_length=300)] = "",
) -> Response:
    """Put an alarm aside, or show the same form with what is wrong."""
    try:
        duration = int(minutes) if minutes.isdecimal() else 0
        await press.send(ShelveAlarm(alarm_id, duration, reason))
    except NotAcceptable as error:
        wrong = ShelfForm(alarm_id, minutes, reason, told_by(error))
        return page(press.request, _context(press.request, "active", (), (), wrong), status=422)
    return press.answer(N_("Shelved."))


@router.post("/unshelve")
@needs(Permission.OPERATE)
async def unshelve(press: PressDep, alarm_id: Annotated[str, Form(max_length=120)]) -> Response:
    """Take an alarm back from the shelf."""
    await press.send(UnshelveAlarm(alarm_id))
    return press.answer(N_("Unshelved."))


_BACK = Link(N_("Alarms"), "/alarms")


def _context(
    request: Request,
    view: str,
    wanted: tuple[int, ...],
    past: tuple[PastAlarm, ...],
    wrong: ShelfForm | None = None,
) -> AlarmsPage:
    frame = site_frame(request, N_("Alarms"))
    standing = frame.site.alarms if frame.site else ()
    listed = tuple(one for one in _of(view, standing) if not wanted or one.priority in wanted)
    older = _here("history", wanted, before=past[-1].number) if len(past) == A_PAGE else None
    return AlarmsPage(
        frame=frame,
        view=view,
        views=tuple(Link(label, _here(name, wanted), name == view) for name, label in VIEWS),
        filters=tuple(_filter(view, one, wanted) for one in PRIORITIES),
        here=_here(view, wanted),
        listed=tuple(one for one in listed if not one.collapsed),
        collapsed=tuple(one for one in listed if one.collapsed),
        past=past,
        older=older,
        counts=frame.site.alarm_counts if frame.site else AlarmCounts(),
        calling=tuple(one.alarm_id for one in listed if one.calls and not one.collapsed),
        entries=CATALOGUE,
        wrong=wrong,
    )


def _of(view: str, standing: Iterable[AlarmNow]) -> Iterable[AlarmNow]:
    """Return the alarms of a list; what is shelved, suppressed or out of service stands in one of its own."""
    if view == "history":
        return ()
    return (one for one in standing if (one.state in ASIDE) == (view == "shelved"))


def _past(reader: ReaderDep, wanted: tuple[int, ...], before: int | None) -> tuple[PastAlarm, ...]:
    return tuple(map(_shown, reader.alarm_history(AlarmFilter(before, A_PAGE, priorities=wanted))))


def _shown(kept: KeptAlarm) -> PastAlarm:
    return PastAlarm(kept.number, told(kept.alarm, kept.ended_at), kept.ended_at is not None)


def _filter(view: str, priority: int, wanted: tuple[int, ...]) -> Link:
    """Return the key that adds a priority to the filter or takes it out."""
    others = tuple(one for one in wanted if one != priority)
    chosen = others if priority in wanted else tuple(sorted((*wanted, priority)))
    return Link(str(priority), _here(view, chosen), priority in wanted)


def _here(view: str, wanted: Iterable[int], before: int | None = None) -> str:
    query: list[tuple[str, object]] = [("view", view), *(("p", one) for one in wanted)]
    if before is not None:
        query.append(("before", before))
    return f"/alarms?{urlencode(query)}"
