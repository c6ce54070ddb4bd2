"""The horizon round the site, entered by hand, and how it cuts the year's sun."""

from decimal import Decimal
from typing import Annotated
from urllib.parse import urlencode

from fastapi import Form, Query
from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import Response

from app.base.message import N_, Message
from app.base.permission import Permission
from app.base.zones import day_in
from app.link.messages import SiteDetail
from app.link.place_orders import SetHorizon
from app.sun.horizon import FLAT, Horizon
from app.tracker.settings.config import TrackerConfig
from app.web.charts.cartesian import cartesian
from app.web.features.site.horizon_text import NOTES, HorizonRead, read
from app.web.features.site.picture_contexts import HorizonPage
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.shell.contexts import Link
from app.web.shell.deps import MachineDep
from app.web.shell.forms import Typed
from app.web.shell.frame import site_frame
from app.web.shell.orders import PressDep
from app.web.shell.render import go, page

router = page_router(prefix="/site/horizon")
WHOLE_SKY = TrackerConfig("site", N_("Site"))
LONGEST = 40_000


@router.get("")
@needs(Permission.READ)
async def show(
    request: Request, machine: MachineDep, note: Annotated[tuple[str, ...], Query()] = ()
) -> Response:
    """Show the stored horizon, and what was changed in reading it."""
    detail = await machine.detail()
    typed = Typed({"points": written(detail.site.horizon)})
    notes = tuple(sentence for name, sentence in NOTES.items() if name in note)
    return await run_in_threadpool(_answer, request, detail, typed, notes=notes)


@router.post("")
@needs(Permission.CONFIGURE)
async def save(
    press: PressDep, machine: MachineDep, points: Annotated[str, Form(max_length=LONGEST)] = ""
) -> Response:
    """Keep the typed horizon."""
    typed = Typed({"points": points})
    found = typed.read("points", read, HorizonRead(FLAT))
    if typed.errors:
        detail = await machine.detail()
        return await run_in_threadpool(_answer, press.request, detail, typed, status=422)
    await press.send(SetHorizon(found.horizon))
    query = f"?{urlencode({'note': found.notes}, doseq=True)}" if found.notes else ""
    return go(press.request, f"/site/horizon{query}")


def written(horizon: Horizon) -> str:
    """Return the points as they are typed: a line each, azimuth and elevation, with all their digits."""
    return "\n".join(f"{_digits(azimuth)} {_digits(elevation)}" for azimuth, elevation in horizon.points)


def _digits(value: float) -> str:
    return format(Decimal(repr(value)).normalize(), "f")


def _answer(
    request: Request,
    detail: SiteDetail,
    typed: Typed,
    *,
    notes: tuple[Message, ...] = (),
    status: int = 200,
) -> Response:
    site, horizon = detail.site, detail.site.horizon
    frame = site_frame(request, N_("Horizon"), back=Link(N_("Site"), "/site"))
    drawn = None
    if site.location is not None and frame.site is not None:
        today = day_in(site.time_zone, frame.site.at)
        drawn = cartesian(WHOLE_SKY, site.location, site.time_zone, today, horizon)
    context = HorizonPage(
        frame=frame, form=typed.form(("points",)), count=len(horizon.points), cartesian=drawn, notes=notes
    )
    return page(request, context, block="form", status=status)
