"""How the panel hangs on its axes: kind of mount, its angles, rows, linear actuators, and its reach."""

from typing import Annotated

from fastapi import Form
from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import Response

from app.base.message import N_, told_by
from app.base.permission import Permission
from app.base.zones import day_in
from app.link.messages import ConfigureTracker, SiteDetail, TrackerDetail
from app.tracker.motion.limit_change import LimitReview
from app.tracker.mounts.capabilities import ABILITIES, abilities, axis_words
from app.tracker.mounts.reach import Reach, reach
from app.tracker.mounts.usual import mounted
from app.tracker.settings.config import MountKind, TrackerConfig
from app.web.api.limit_review import limit_review, must_ask
from app.web.charts.drawings import YearDiagram
from app.web.charts.mount_drawings import actuator_plot, rows_drawing, year_diagram
from app.web.features.setup import mount_form
from app.web.features.setup.mount_contexts import ActuatorFields, KindChoice, MountPage
from app.web.http.errors import NotAcceptable
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.shell.contexts import Frame
from app.web.shell.deps import MachineDep
from app.web.shell.forms import Typed, sent
from app.web.shell.frame import tracker_frame
from app.web.shell.orders import PressDep
from app.web.shell.render import go, page
from app.web.shell.wizard import tracker_of

router = page_router(prefix="/trackers/{tracker_id}/mount")
KINDS = tuple(KindChoice(kind.value, known.title, known.summary) for kind, known in ABILITIES.items())
MECHANISM_OPTIONS = (
    (mount_form.NO_ACTUATOR, N_("None: the drive works in degrees")),
    ("alexandru-diurnal", N_("Alexandru's diurnal actuator, 300 mm")),
    ("alexandru-elevation", N_("Alexandru's elevation actuator, 200 mm")),
    (mount_form.OWN_POINTS, N_("By the points below")),
)
SAVED = N_("The mount is saved.")


@router.get("")
@needs(Permission.READ)
async def mount(request: Request, tracker_id: str, machine: MachineDep, done: str = "") -> Response:
    """Show how the tracker is mounted and what of the year's sun it can face."""
    tracker = tracker_of(await machine.detail(), tracker_id)
    typed = Typed(mount_form.texts(tracker.state.config))
    return await run_in_threadpool(_answer, request, tracker, typed, SAVED if done else "")


@router.post("/kind")
@needs(Permission.READ, proven=True)
async def choose(
    tracker_id: str, press: PressDep, machine: MachineDep, kind: Annotated[str, Form()] = ""
) -> Response:
    """Put the tracker on another kind of mount, with its usual axis and limits."""
    if kind not in list(MountKind):
        raise NotAcceptable(N_("Choose one of the mounts in the list."))
    detail = await machine.detail()
    config = tracker_of(detail, tracker_id).state.config
    if config.mount.kind != kind:
        await press.send(ConfigureTracker(mounted(config, MountKind(kind), _latitude_deg(detail))))
    return go(press.request, f"/trackers/{tracker_id}/mount?done=1")


@router.post("")
@needs(Permission.CONFIGURE)
async def save(tracker_id: str, press: PressDep, machine: MachineDep) -> Response:
    """Save angles, rows and actuators, or none of them."""
    tracker = tracker_of(await machine.detail(), tracker_id)
    typed = await sent(press.request)
    wanted = mount_form.read(typed, tracker.state.config)
    if wanted is None:
        return await run_in_threadpool(_answer, press.request, tracker, typed, "", status=422)
    asked = await run_in_threadpool(limit_review, machine.latest(), tracker, wanted)
    if await must_ask(press.request, tracker_id, asked):
        return await run_in_threadpool(_answer, press.request, tracker, typed, "", asked=asked)
    try:
        await press.send(ConfigureTracker(wanted))
    except NotAcceptable as refusal:
        typed.errors["first_actuator"] = told_by(refusal)
        return await run_in_threadpool(_answer, press.request, tracker, typed, "", status=422)
    return go(press.request, f"/trackers/{tracker_id}/mount?done=1")


def _latitude_deg(detail: SiteDetail) -> float | None:
    location = detail.site.location
    return None if location is None else location.latitude_deg


def _answer(
    request: Request,
    tracker: TrackerDetail,
    typed: Typed,
    done: str,
    *,
    asked: LimitReview | None = None,
    status: int = 200,
) -> Response:
    config = tracker.state.config
    frame = tracker_frame(request, config.tracker_id, N_("Mount"))
    year, found = _year(frame, config)
    context = MountPage(
        frame=frame,
        form=typed.form(mount_form.FIELDS),
        kinds=KINDS,
        mount=config.mount,
        can=abilities(config.mount),
        actuators=_actuators(config),
        mechanisms=MECHANISM_OPTIONS,
        rows=rows_drawing(config.mount.rows) if config.mount.rows else None,
        year=year,
        reach=found,
        done=done,
        review=asked,
    )
    return page(request, context, block="review" if asked else "form", status=status)


def _year(frame: Frame, config: TrackerConfig) -> tuple[YearDiagram | None, Reach | None]:
    """Return the year's sun and how much of it is out of reach, nothing while the location is not known."""
    site = frame.site
    if site is None or site.location is None:
        return None, None
    year = day_in(site.time_zone, site.at).year
    return year_diagram(config, site.location, year), reach(config, site.location, year)


def _actuators(config: TrackerConfig) -> tuple[ActuatorFields, ...]:
    found = []
    for prefix, axis in mount_form.AXES.items():
        words = axis_words(config.mount, axis)
        if words is not None:
            actuator = config.axis(axis).actuator
            plot = actuator_plot(words.title, actuator) if actuator else None
            found.append(ActuatorFields(prefix, words.title, plot))
    return tuple(found)
