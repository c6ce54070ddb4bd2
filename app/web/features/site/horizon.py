"""The horizon round the site, entered by hand, and how it cuts the year's sun."""

from typing import Annotated

from fastapi import Form
from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import Response

from app.base.message import N_, say, told_by
from app.base.permission import Permission
from app.base.zones import day_in
from app.link.messages import SiteDetail
from app.link.place_orders import SetHorizon
from app.sun.horizon import FLAT, Horizon
from app.tracker.settings.config import TrackerConfig
from app.web.charts.cartesian import cartesian
from app.web.features.site.picture_contexts import HorizonPage
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.shell.contexts import Link
from app.web.shell.deps import MachineDep
from app.web.shell.forms import Typed, Unreadable, number
from app.web.shell.frame import site_frame
from app.web.shell.orders import PressDep
from app.web.shell.render import go, page

router = page_router(prefix="/site/horizon")
WHOLE_SKY = TrackerConfig("site", N_("Site"))
LONGEST = 4000


@router.get("")
@needs(Permission.READ)
async def show(request: Request, machine: MachineDep) -> Response:
    """Show the stored horizon."""
    detail = await machine.detail()
    typed = Typed({"points": written(detail.site.horizon)})
    return await run_in_threadpool(_answer, request, detail, typed)


@router.post("")
@needs(Permission.CONFIGURE)
async def save(
    press: PressDep, machine: MachineDep, points: Annotated[str, Form(max_length=LONGEST)] = ""
) -> Response:
    """Keep the typed horizon."""
    typed = Typed({"points": points})
    horizon = typed.read("points", read, FLAT)
    if typed.errors:
        detail = await machine.detail()
        return await run_in_threadpool(_answer, press.request, detail, typed, status=422)
    await press.send(SetHorizon(horizon))
    return go(press.request, "/site/horizon")


def written(horizon: Horizon) -> str:
    """Return the points as they are typed: a line each, azimuth and elevation."""
    return "\n".join(f"{azimuth_deg:g} {elevation_deg:g}" for azimuth_deg, elevation_deg in horizon.points)


def read(text: str) -> Horizon:
    """Return the horizon that lines of azimuth and elevation mean, in any order."""
    lines = [(row, line.split()) for row, line in enumerate(text.splitlines(), start=1) if line.strip()]
    points = [_point(row, words) for row, words in lines]
    try:
        return Horizon(tuple(sorted(points)))
    except ValueError as error:
        raise Unreadable(told_by(error)) from error


def _point(row: int, words: list[str]) -> tuple[float, float]:
    if len(words) != 2:
        raise Unreadable(
            say("Line {row}: type azimuth and elevation with a space between, such as 135 8.", row=row)
        )
    azimuth_deg = number(words[0].rstrip("°"), say("Line {row}, azimuth", row=row), 0, 360)
    return azimuth_deg % 360.0, number(words[1].rstrip("°"), say("Line {row}, elevation", row=row), 0, 89.9)


def _answer(request: Request, detail: SiteDetail, typed: Typed, *, status: int = 200) -> Response:
    site, horizon = detail.site, detail.site.horizon
    frame = site_frame(request, N_("Horizon"), back=Link(N_("Site"), "/site"))
    drawn = None
    if site.location is not None and frame.site is not None:
        today = day_in(site.time_zone, frame.site.at)
        drawn = cartesian(WHOLE_SKY, site.location, site.time_zone, today, horizon)
    context = HorizonPage(
        frame=frame, form=typed.form(("points",)), count=len(horizon.points), cartesian=drawn
    )
    return page(request, context, block="form", status=status)
