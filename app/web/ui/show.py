"""Show tracking movement: plan a stretch of any day, check it, and run it on the machine."""

from datetime import date, datetime, time, timedelta
from math import ceil
from typing import Annotated
from urllib.parse import urlencode
from uuid import uuid4

from fastapi import APIRouter, Form, Query
from pydantic import BaseModel
from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import RedirectResponse, Response

from app.link.messages import SavePlan, SiteDetail, TrackerDetail
from app.sun.events import day_events
from app.sun.position import Location
from app.tracker.axes import Axis
from app.tracker.commands import CommandRejected, GoToStart, PauseShow, ResumeShow, RunShow, StopShow
from app.tracker.config import TrackerConfig
from app.tracker.mode import Mode
from app.tracker.mounts.abilities import axis_title
from app.tracker.programs.show import ShowCheck, ShowPlan, check_show, schedule_of
from app.tracker.reason import Reason
from app.web.contexts import Link, ShowPlanPage, ShowRunPage, Verdict
from app.web.deps import MachineDep, Panel, PanelDep
from app.web.errors import NotFound
from app.web.ui.daychart import chart
from app.web.ui.formats import duration, local
from app.web.ui.forms import Typed
from app.web.ui.frame import snapshot_of, tracker_frame
from app.web.ui.mode import choice
from app.web.ui.orders import PressDep
from app.web.ui.render import go, page
from app.web.ui.scene import scene_on
from app.web.ui.sunpath import diagram_of, outline
from app.web.ui.wizard import tracker_of
from app.zones import zone_of

router = APIRouter(prefix="/trackers/{tracker_id}")
NAMES = ("date", "start", "end", "minutes")
DEFAULT_MINUTES = "3"
NO_LOCATION = Reason("no_location", "The location is not saved yet.", "Do step 1 of commissioning first.")
NO_SHOW = Reason("no_show", "No show stands at its start.", "Plan a show and go to its start.")


class ShowForm(BaseModel):
    """The form as it was typed; all texts."""

    date: str = ""
    start: str = ""
    end: str = ""
    minutes: str = ""


@router.get("/show")
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
async def go_to_start(
    tracker_id: str, press: PressDep, machine: MachineDep, typed: Annotated[ShowForm, Form()]
) -> Response:
    """Keep the plan and move the panel to where the show begins."""
    detail = await machine.detail()
    location, tracker = _place(detail), tracker_of(detail, tracker_id)
    wanted = _read(Typed(typed.model_dump()), tracker, location, detail.site.time_zone)
    if wanted is None:
        return go(press.request, f"/trackers/{tracker_id}/show?{urlencode(typed.model_dump())}")
    key = press.key
    await press.send(SavePlan(tracker_id, wanted))
    press.key = f"{key}-go" if key else None
    await press.send(GoToStart(wanted), tracker_id)
    return go(press.request, f"/trackers/{tracker_id}/shows/{wanted.show_id}")


@router.get("/shows/{show_id}")
async def running(request: Request, tracker_id: str, show_id: str, built: PanelDep) -> Response:
    """Show a show on the machine: picture, progress, angles, and its keys."""
    detail = await built.machine.detail()
    return await run_in_threadpool(
        _run_page, request, tracker_id, detail, _stored(built, tracker_id, show_id), built
    )


@router.post("/show/run")
async def run(tracker_id: str, press: PressDep, built: PanelDep) -> Response:
    """Run the show that stands at its start."""
    seen = snapshot_of(built.machine.latest(), tracker_id)
    if seen is None or seen.show is None:
        raise CommandRejected(NO_SHOW)
    await press.send(RunShow(_stored(built, tracker_id, seen.show.show_id)), tracker_id)
    return press.answer("The show runs.")


@router.post("/show/pause")
async def pause(tracker_id: str, press: PressDep) -> Response:
    """Hold the show where it is."""
    await press.send(PauseShow(), tracker_id)
    return press.answer("The show is paused.")


@router.post("/show/resume")
async def resume(tracker_id: str, press: PressDep) -> Response:
    """Go on with a paused show."""
    await press.send(ResumeShow(), tracker_id)
    return press.answer("The show goes on.")


@router.post("/show/stop")
async def stop(tracker_id: str, press: PressDep) -> Response:
    """End the show before its time."""
    await press.send(StopShow(), tracker_id)
    return press.answer("The show has ended; the panel stays where it is.")


def _stored(built: Panel, tracker_id: str, show_id: str) -> ShowPlan:
    planned = built.reader.show(show_id)
    if planned is None or planned.tracker_id != tracker_id:
        raise NotFound(f"Tracker {tracker_id} has no show {show_id}. Plan a new one.")
    return planned.plan


def _place(detail: SiteDetail) -> Location:
    if detail.site.location is None:
        raise CommandRejected(NO_LOCATION)
    return detail.site.location


def _plan_page(
    request: Request, tracker_id: str, detail: SiteDetail, form: ShowForm, built: Panel
) -> Response:
    tracker, zone = tracker_of(detail, tracker_id), detail.site.time_zone
    location = _place(detail)
    latest = built.machine.latest()
    today = (latest.at if latest else built.clock.now()).astimezone(zone_of(zone)).date()
    typed = Typed(form.model_dump() if form.date else _sun_span(tracker, location, zone, today))
    wanted = _read(typed, tracker, location, zone)
    context = ShowPlanPage(
        frame=tracker_frame(request, tracker_id, "Show tracking movement"),
        form=typed.form(NAMES),
        presets=_presets(tracker, location, zone, today, typed),
        verdict=_verdict(wanted, tracker, zone, typed) if wanted else None,
    )
    return page(request, context, block="plan")


def _read(typed: Typed, tracker: TrackerDetail, location: Location, zone: str) -> ShowPlan | None:
    """Return the plan that was typed; an end that is not after the start lies on the next day."""
    day = typed.day("date", "Date")
    start, end = typed.clock_time("start", "Start"), typed.clock_time("end", "End")
    minutes = typed.number("minutes", "Minutes", 0.1, 1440)
    if typed.errors:
        return None
    last_day = day if end > start else day + timedelta(days=1)
    config, memory = tracker.state.config, tracker.state.memory
    return ShowPlan(
        show_id=uuid4().hex[:12],
        begin_at=datetime.combine(day, start, zone_of(zone)),
        end_at=datetime.combine(last_day, end, zone_of(zone)),
        duration=timedelta(seconds=round(minutes * 60)),
        location=location,
        mode=memory.mode or Mode.DUAL,
        orientation=memory.orientation,
        algorithm=config.algorithm,
        refraction=config.refraction,
        schedule=schedule_of(config.strategy),
    )


def _sun_span(
    tracker: TrackerDetail, location: Location, zone: str, day: date, minutes: str = DEFAULT_MINUTES
) -> dict[str, str]:
    """Return the form for sunrise to sunset of a day, or for the whole of a polar day."""
    begin = datetime.combine(day, time(), zone_of(zone))
    end = datetime.combine(day + timedelta(days=1), time(), zone_of(zone))
    events = day_events(tracker.state.config.algorithm, location, begin, end)
    start, stop = "00:00", "00:00"
    if events.rise and events.set and events.rise < events.set:
        start = local(events.rise + timedelta(seconds=59), zone, "%H:%M")
        stop = local(events.set, zone, "%H:%M")
    return {"date": day.isoformat(), "start": start, "end": stop, "minutes": minutes}


def _presets(
    tracker: TrackerDetail, location: Location, zone: str, today: date, typed: Typed
) -> tuple[Link, ...]:
    minutes = typed.texts.get("minutes") or DEFAULT_MINUTES
    days = (
        ("Today", today),
        ("21 March", date(today.year, 3, 21)),
        ("21 June", date(today.year, 6, 21)),
        ("21 December", date(today.year, 12, 21)),
    )
    spans = [(label, _sun_span(tracker, location, zone, day, minutes)) for label, day in days]
    return tuple(Link(label, f"?{urlencode(span)}", span == typed.texts) for label, span in spans)


def _verdict(wanted: ShowPlan, tracker: TrackerDetail, zone: str, typed: Typed) -> Verdict:
    check = check_show(wanted, tracker.state.config, tracker.state.memory.pointing)
    return Verdict(
        feasible=check.feasible,
        headline=_headline(check, wanted),
        facts=_facts(check, wanted, tracker, zone),
        reasons=check.reasons,
        notices=check.notices,
        shortest=_shortest(check, typed),
        chart=chart(check.path, zone),
    )


def _headline(check: ShowCheck, wanted: ShowPlan) -> str:
    if not check.feasible:
        return "This show cannot be run."
    return f"This works: {duration(wanted.duration)}, {wanted.acceleration:.0f} × the sun's speed."


def _shortest(check: ShowCheck, typed: Typed) -> Link | None:
    if check.feasible or check.shortest is None:
        return None
    minutes = f"{ceil(check.shortest.total_seconds() / 60 * 1000) / 1000:g}"
    query = urlencode({name: typed.texts[name] for name in NAMES} | {"minutes": minutes})
    return Link(f"Take {duration(check.shortest)} instead", f"?{query}")


def _facts(
    check: ShowCheck, wanted: ShowPlan, tracker: TrackerDetail, zone: str
) -> tuple[tuple[str, str], ...]:
    config = tracker.state.config
    spans = ", ".join(f"{local(a, zone, '%H:%M')} to {local(b, zone, '%H:%M')}" for a, b in check.sun_up)
    return (
        ("Mode", choice(config, wanted.mode).label),
        ("Sun up", spans or "not in this interval"),
        *_axis_facts(check, config),
    )


def _axis_facts(check: ShowCheck, config: TrackerConfig) -> tuple[tuple[str, str], ...]:
    """Return what the show asks of each axis that the mount has, and where they begin."""
    asked = (
        (Axis.AZIMUTH, check.peak_azimuth_dps, check.start.azimuth_deg),
        (Axis.ELEVATION, check.peak_elevation_dps, check.start.elevation_deg),
    )
    present = [(axis_title(config.mount, axis), axis, dps, deg) for axis, dps, deg in asked]
    present = [one for one in present if one[1] in config.mount.axes]
    return (
        *(
            (f"{title.capitalize()} speed", f"{dps:.2f} of {config.axis(axis).speed_dps:g} °/s")
            for title, axis, dps, _ in present
        ),
        ("Begins at", ", ".join(f"{title} {deg:.1f}°" for title, _, _, deg in present)),
    )


def _run_page(
    request: Request, tracker_id: str, detail: SiteDetail, wanted: ShowPlan, built: Panel
) -> Response:
    config = tracker_of(detail, tracker_id).state.config
    latest = built.machine.latest()
    zone = latest.time_zone if latest else "UTC"
    on = wanted.begin_at.astimezone(zone_of(zone)).date()
    minutes = f"{wanted.duration.total_seconds() / 60:.6g}"
    again = {
        "date": on.isoformat(),
        "start": local(wanted.begin_at, zone, "%H:%M:%S"),
        "end": local(wanted.end_at, zone, "%H:%M:%S"),
        "minutes": minutes,
    }
    root = f"/trackers/{config.tracker_id}/show"
    context = ShowRunPage(
        frame=tracker_frame(
            request, config.tracker_id, "Show", back=Link("Plan", f"{root}?{urlencode(again)}")
        ),
        plan=wanted,
        minutes=minutes,
        again=f"{root}?{urlencode(again)}",
        diagram=diagram_of(wanted.location, zone, on, wanted.algorithm, outline(config), detail.site.horizon),
        scene=scene_on(config, wanted.location, zone, on, wanted.algorithm, detail.site.horizon),
    )
    return page(request, context)
