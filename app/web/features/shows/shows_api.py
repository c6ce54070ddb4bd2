"""Shows: plan, check, go to the start, run, pause, resume, stop."""

from datetime import datetime, timedelta
from enum import StrEnum
from typing import Self
from urllib.parse import quote
from uuid import uuid4

from fastapi.responses import Response
from pydantic import Field, model_validator
from starlette.concurrency import run_in_threadpool

from app.base.instants import Day, Instant
from app.base.message import N_, say
from app.base.permission import Permission
from app.base.zones import day_in
from app.link.messages import SavePlan, TrackerDetail
from app.store.store import Reader
from app.sun.daylight import daylight
from app.sun.position import Algorithm
from app.tracker.commands.commands import (
    Command,
    CommandRejected,
    GoToStart,
    PauseShow,
    ResumeShow,
    RunShow,
    StopShow,
)
from app.tracker.mounts.capabilities import default_mode
from app.tracker.programs.show import ShowCheck, ShowPlan, check_show, schedule_of
from app.tracker.settings.config import Orientation
from app.tracker.state.snapshot import ShowProgress, SiteSnapshot, Snapshot
from app.tracker.values.mode import Mode
from app.tracker.values.reason import Reason
from app.web.api.base import NOT_FOUND, REFUSED, Azimuth, Elevation, Input, Output, TrackerId, api_router
from app.web.api.orders import SenderDep, tracker_of
from app.web.api.sun import location_of, midnights
from app.web.api.trackers import detail_of
from app.web.http.errors import NotAcceptable, NotFound
from app.web.http.needs import needs
from app.web.shell.deps import MachineDep, ReaderDep, SnapshotDep

router = api_router(prefix="/trackers/{tracker_id}/shows", tags=["shows"])

OTHER_SHOW = Reason(
    "other_show",
    N_("This show is not in progress on this tracker."),
    N_("Go to the start of the show first."),
)


class NewShow(Input):
    """Which stretch of sun time, in how long: `start` and `end`, or `date` from sunrise to sunset."""

    start: Instant | None = Field(None, examples=["2026-06-21T06:00:00+03:00"])
    end: Instant | None = Field(None, examples=["2026-06-21T20:00:00+03:00"])
    date: Day | None = Field(None, description="Civil date of the site: from sunrise to sunset.")
    duration_s: float = Field(ge=1, le=604800, description="How long the show takes.", examples=[180])
    mode: Mode | None = Field(
        None, description="Left out: the tracker's selected mode, else all axes follow."
    )
    azimuth_deg: Azimuth | None = Field(None, description="For modes that hold the azimuth.")
    elevation_deg: Elevation | None = Field(None, description="For modes that hold the elevation.")
    algorithm: Algorithm | None = None

    @model_validator(mode="after")
    def _one_of_two(self) -> Self:
        both = self.start is not None and self.end is not None
        neither = self.start is None and self.end is None
        if not ((both and self.date is None) or (neither and self.date is not None)):
            raise ValueError(N_("Give start and end, or date alone."))
        return self


class SunUp(Output):
    """A stretch of the show in which the sun is up."""

    start: datetime
    end: datetime


class ShowPathOut(Output):
    """The planned path as columns; panel angles are axis degrees."""

    sun_time_unix_s: list[float]
    sun_azimuth_deg: list[float]
    sun_elevation_deg: list[float]
    panel_azimuth_deg: list[float]
    panel_elevation_deg: list[float]
    sun_is_up: list[bool]


class Show(Output):
    """A plan, whether this tracker can do it, and where it is."""

    show_id: str
    tracker_id: str
    start: datetime
    end: datetime
    duration_s: float
    acceleration: float = Field(description="Seconds of sun time a second.")
    mode: Mode
    orientation: Orientation
    algorithm: Algorithm
    feasible: bool
    reasons: tuple[Reason, ...] = Field(description="What forbids it.")
    notices: tuple[Reason, ...] = Field(description="What is worth knowing.")
    shortest_s: float | None = Field(description="Least duration that works; None: none does.")
    shortest_minutes: float | None
    sun_up: tuple[SunUp, ...]
    peak_azimuth_dps: float = Field(description="Highest speed that is asked of the azimuth axis.")
    peak_elevation_dps: float
    start_orientation: Orientation = Field(description="Where the panel stands at the start, axis degrees.")
    path: ShowPathOut
    progress: ShowProgress | None = Field(description="Where it is, None while it is not under way.")


class ShowAction(StrEnum):
    """What can be done with a plan."""

    GO_TO_START = "go-to-start"
    RUN = "run"
    PAUSE = "pause"
    RESUME = "resume"
    STOP = "stop"


def place_of_show(tracker_id: str, plan: ShowPlan) -> str:
    """Return where a planned show is found, as a `Location`; a tracker's name may have any letters."""
    return f"/api/v1/trackers/{quote(tracker_id, safe='')}/shows/{quote(plan.show_id, safe='')}"


@router.post("", status_code=201, summary="Plan a show", responses=NOT_FOUND | REFUSED)
@needs(Permission.OPERATE)
async def plan_show(
    tracker_id: TrackerId,
    new: NewShow,
    sender: SenderDep,
    machine: MachineDep,
    site: SnapshotDep,
    response: Response,
) -> Show:
    """Keep a plan and return whether this tracker can do it, and the shortest duration that works."""
    detail = await detail_of(machine, tracker_id)
    plan = await run_in_threadpool(_plan, new, detail, site)
    checked = await run_in_threadpool(_checked, tracker_id, plan, detail, None)
    await sender.send(SavePlan(tracker_id, plan))
    response.headers["Location"] = place_of_show(tracker_id, plan)
    return checked


@router.get("/{show_id}", summary="A planned show and where it is", responses=NOT_FOUND)
@needs(Permission.READ)
async def read_show(
    tracker_id: TrackerId, show_id: str, machine: MachineDep, reader: ReaderDep, site: SnapshotDep
) -> Show:
    """Return the plan, its check against the tracker as it is set now, and its progress."""
    plan = await run_in_threadpool(stored_plan, reader, tracker_id, show_id)
    detail = await detail_of(machine, tracker_id)
    progress = tracker_of(site, tracker_id).show
    mine = progress if progress is not None and progress.show_id == show_id else None
    return await run_in_threadpool(_checked, tracker_id, plan, detail, mine)


@router.post("/{show_id}/{action}", status_code=202, summary="Act on a show", responses=NOT_FOUND | REFUSED)
@needs(Permission.OPERATE)
async def control_show(
    tracker_id: TrackerId,
    show_id: str,
    action: ShowAction,
    sender: SenderDep,
    reader: ReaderDep,
    site: SnapshotDep,
) -> Snapshot:
    """Go to the start position, run, pause, resume or stop the show."""
    plan = await run_in_threadpool(stored_plan, reader, tracker_id, show_id)
    running = tracker_of(site, tracker_id).show
    if action in ON_RUNNING and (running is None or running.show_id != show_id):
        raise CommandRejected(OTHER_SHOW)
    return await sender.command(tracker_id, _command(action, plan))


ON_RUNNING = frozenset({ShowAction.PAUSE, ShowAction.RESUME, ShowAction.STOP})


def _command(action: ShowAction, plan: ShowPlan) -> Command:
    match action:
        case ShowAction.GO_TO_START:
            return GoToStart(plan)
        case ShowAction.RUN:
            return RunShow(plan)
        case ShowAction.PAUSE:
            return PauseShow()
        case ShowAction.RESUME:
            return ResumeShow()
        case ShowAction.STOP:
            return StopShow()


def stored_plan(reader: Reader, tracker_id: str, show_id: str) -> ShowPlan:
    """Return a tracker's plan, or raise `NotFound`."""
    planned = reader.show(show_id)
    if planned is None or planned.tracker_id != tracker_id:
        raise NotFound(
            say("Tracker {tracker_id} has no show {show_id}.", tracker_id=tracker_id, show_id=show_id)
        )
    return planned.plan


def _plan(new: NewShow, detail: TrackerDetail, site: SiteSnapshot) -> ShowPlan:
    config, memory = detail.state.config, detail.state.memory
    algorithm = new.algorithm or config.algorithm
    held = memory.orientation
    begin, end = _interval(new, site, algorithm)
    return ShowPlan(
        show_id=uuid4().hex[:12],
        begin_at=begin,
        end_at=end,
        duration=timedelta(seconds=new.duration_s),
        location=location_of(site),
        mode=new.mode or memory.mode or default_mode(config.mount),
        orientation=Orientation(
            held.azimuth_deg if new.azimuth_deg is None else new.azimuth_deg,
            held.elevation_deg if new.elevation_deg is None else new.elevation_deg,
        ),
        algorithm=algorithm,
        refraction=config.refraction,
        schedule=schedule_of(config.strategy),
    )


def _interval(new: NewShow, site: SiteSnapshot, algorithm: Algorithm) -> tuple[datetime, datetime]:
    if new.start is not None and new.end is not None:
        return new.start, new.end
    begin, end = midnights(new.date or day_in(site.time_zone, site.at), site.time_zone)
    lit = daylight(algorithm, location_of(site), begin, end)
    if lit is None:
        raise NotAcceptable(N_("On this date the sun does not rise and set here; give start and end."))
    return lit


def _checked(tracker_id: str, plan: ShowPlan, detail: TrackerDetail, progress: ShowProgress | None) -> Show:
    check = check_show(plan, detail.state.config, detail.state.memory.pointing)
    shortest_s = None if check.shortest is None else check.shortest.total_seconds()
    return Show(
        show_id=plan.show_id,
        tracker_id=tracker_id,
        start=plan.begin_at,
        end=plan.end_at,
        duration_s=plan.duration.total_seconds(),
        acceleration=plan.acceleration,
        mode=plan.mode,
        orientation=plan.orientation,
        algorithm=plan.algorithm,
        feasible=check.feasible,
        reasons=check.reasons,
        notices=check.notices,
        shortest_s=shortest_s,
        shortest_minutes=None if shortest_s is None else shortest_s / 60,
        sun_up=tuple(SunUp(start=begin, end=end) for begin, end in check.sun_up),
        peak_azimuth_dps=check.peak_azimuth_dps,
        peak_elevation_dps=check.peak_elevation_dps,
        start_orientation=check.start,
        path=_path(check),
        progress=progress,
    )


def _path(check: ShowCheck) -> ShowPathOut:
    path = check.path
    return ShowPathOut(**{name: getattr(path, name).tolist() for name in ShowPathOut.model_fields})
