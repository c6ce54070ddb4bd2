"""Show tracking movement: plan a stretch of any day, check it, and run it on the machine."""

from typing import Annotated
from urllib.parse import urlencode

from fastapi import Form, Query
from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import RedirectResponse, Response

from app.base.message import N_, say
from app.base.permission import Permission
from app.base.zones import day_in, zone_of
from app.link.messages import SavePlan, SiteDetail
from app.tracker.commands.commands import CommandRejected, GoToStart, PauseShow, ResumeShow, RunShow, StopShow
from app.tracker.programs.show import ShowPlan
from app.tracker.values.reason import Reason
from app.tracker.values.typed_numbers import written
from app.web.charts.sunpath import diagram_of, outline
from app.web.features.shows.show_contexts import ShowPlanPage, ShowRunPage
from app.web.features.shows.show_plan import LONGEST_MIN, NAMES, Place, ShowForm, planned, presets
from app.web.http.errors import NotFound
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.shell.contexts import Link
from app.web.shell.deps import Panel, PanelDep
from app.web.shell.formats import local
from app.web.shell.frame import snapshot_of, tracker_frame
from app.web.shell.orders import PressDep
from app.web.shell.render import go, page
from app.web.shell.scene import scene_on
from app.web.shell.wizard import tracker_of

router = page_router(prefix="/trackers/{tracker_id}")
NO_LOCATION = Reason(
    "no_location", N_("The location is not saved yet."), N_("Do step 1 of commissioning first.")
)
NO_SHOW = Reason("no_show", N_("No show is ready at its start."), N_("Plan a show and go to its start."))


@router.get("/show")
@needs(Permission.READ)
async def plan(
    request: Request, tracker_id: str, typed: Annotated[ShowForm, Query()], built: PanelDep
) -> Response:
    """Show the form and what the check says about what is typed in it; while a show runs, the show."""
    seen = snapshot_of(built.machine.latest(), tracker_id)
    if seen is not None and seen.show is not None and not request.query_params:
        return RedirectResponse(f"/trackers/{tracker_id}/shows/{seen.show.show_id}", 303)
    detail = await built.machine.detail()
    return await run_in_threadpool(_plan_page, request, tracker_id, detail, typed, built)


@router.post("/show/go-to-start")
@needs(Permission.OPERATE)
async def go_to_start(
    tracker_id: str, press: PressDep, built: PanelDep, typed: Annotated[ShowForm, Form()]
) -> Response:
    """Keep the plan and move the panel to where the show begins."""
    place = _place(await built.machine.detail(), tracker_id, built)
    wanted = (await run_in_threadpool(planned, typed, place)).plan
    if wanted is None:
        texts = typed.model_dump(exclude_none=True)
        return go(press.request, f"/trackers/{tracker_id}/show?{urlencode(texts)}")
    key = press.key
    await press.send(SavePlan(tracker_id, wanted))
    press.key = f"{key}-go" if key else None
    await press.send(GoToStart(wanted), tracker_id)
    return go(press.request, f"/trackers/{tracker_id}/shows/{wanted.show_id}")


@router.get("/shows/{show_id}")
@needs(Permission.READ)
async def running(request: Request, tracker_id: str, show_id: str, built: PanelDep) -> Response:
    """Show a show on the machine: picture, progress, angles, and its keys."""
    detail = await built.machine.detail()
    return await run_in_threadpool(
        _run_page, request, tracker_id, detail, _stored(built, tracker_id, show_id), built
    )


@router.post("/show/run")
@needs(Permission.OPERATE)
async def run(tracker_id: str, press: PressDep, built: PanelDep) -> Response:
    """Run the show that stands at its start."""
    seen = snapshot_of(built.machine.latest(), tracker_id)
    if seen is None or seen.show is None:
        raise CommandRejected(NO_SHOW)
    await press.send(RunShow(_stored(built, tracker_id, seen.show.show_id)), tracker_id)
    return press.answer()


@router.post("/show/pause")
@needs(Permission.OPERATE)
async def pause(tracker_id: str, press: PressDep) -> Response:
    """Hold the show where it is."""
    await press.send(PauseShow(), tracker_id)
    return press.answer()


@router.post("/show/resume")
@needs(Permission.OPERATE)
async def resume(tracker_id: str, press: PressDep) -> Response:
    """Go on with a paused show."""
    await press.send(ResumeShow(), tracker_id)
    return press.answer()


@router.post("/show/stop")
@needs(Permission.OPERATE)
async def stop(tracker_id: str, press: PressDep) -> Response:
    """End the show before its time."""
    await press.send(StopShow(), tracker_id)
    return press.answer()


def _stored(built: Panel, tracker_id: str, show_id: str) -> ShowPlan:
    planned = built.reader.show(show_id)
    if planned is None or planned.tracker_id != tracker_id:
        raise NotFound(
            say(
                "Tracker {tracker_id} has no show {show_id}. Plan a new one.",
                tracker_id=tracker_id,
                show_id=show_id,
            )
        )
    return planned.plan


def _place(detail: SiteDetail, tracker_id: str, built: Panel) -> Place:
    """Return what a plan depends on, or raise `CommandRejected` where the site has no location yet."""
    if detail.site.location is None:
        raise CommandRejected(NO_LOCATION)
    zone = detail.site.time_zone
    today = day_in(zone, built.site_now())
    return Place(tracker_of(detail, tracker_id), detail.site.location, zone, today)


def _plan_page(
    request: Request, tracker_id: str, detail: SiteDetail, form: ShowForm, built: Panel
) -> Response:
    place = _place(detail, tracker_id, built)
    found = planned(form, place)
    context = ShowPlanPage(
        frame=tracker_frame(request, tracker_id, N_("Show tracking movement")),
        form=found.typed.form(NAMES),
        presets=presets(place, found.typed),
        verdict=found.verdict,
    )
    return page(request, context, block="plan")


def _run_page(
    request: Request, tracker_id: str, detail: SiteDetail, wanted: ShowPlan, built: Panel
) -> Response:
    config = tracker_of(detail, tracker_id).state.config
    latest = built.machine.latest()
    zone = latest.time_zone if latest else "UTC"
    on = wanted.begin_at.astimezone(zone_of(zone)).date()
    minutes = written(wanted.duration.total_seconds() / 60, LONGEST_MIN, 6)
    again = {
        "date": on.isoformat(),
        "start": local(wanted.begin_at, zone, "%H:%M:%S"),
        "end": local(wanted.end_at, zone, "%H:%M:%S"),
        "minutes": minutes,
    }
    root = f"/trackers/{config.tracker_id}/show"
    context = ShowRunPage(
        frame=tracker_frame(
            request, config.tracker_id, N_("Show"), back=Link(N_("Plan"), f"{root}?{urlencode(again)}")
        ),
        plan=wanted,
        minutes=minutes,
        again=f"{root}?{urlencode(again)}",
        diagram=diagram_of(wanted.location, zone, on, wanted.algorithm, outline(config), detail.site.horizon),
        scene=scene_on(config, wanted.location, zone, on, wanted.algorithm, detail.site.horizon),
    )
    return page(request, context)
