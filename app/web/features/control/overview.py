"""The site: its trackers at a glance, a new tracker, the site's name, and STOP for all."""

from enum import StrEnum
from typing import Annotated, Literal

from fastapi import Form
from starlette.requests import Request
from starlette.responses import Response

from app.alarms.urgency import by_urgency
from app.base.message import N_, Message, say
from app.base.names import LONGEST_TYPED, tidy, unseen
from app.base.permission import Permission
from app.link.messages import AddTracker, RenameSite, SiteDetail, StopAll
from app.tracker.commissioning.steps import StepStatus
from app.tracker.settings.config import LONGEST_NAME, TrackerConfig
from app.tracker.state.snapshot import SiteSnapshot
from app.tracker.values.operator_message import StateWord
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.shell.contexts import Field, OverviewPage
from app.web.shell.contexts import Form as Fields
from app.web.shell.deps import MachineDep
from app.web.shell.frame import STEP_LABELS, site_frame
from app.web.shell.glances import Glance, counts_of, glance, urgent_of
from app.web.shell.orders import PressDep
from app.web.shell.render import go, page

router = page_router()
MANY, FIELD = 5, 9
"""From so many trackers on they are shown in rows, and as tiles."""


class Layout(StrEnum):
    """How the trackers are laid out."""

    CARDS = "cards"
    ROWS = "rows"
    TILES = "tiles"


@router.get("/")
@needs(Permission.READ)
async def overview(
    request: Request,
    machine: MachineDep,
    layout: Layout | None = None,
    state: StateWord | Literal[""] = "",
) -> Response:
    """Show every tracker of the site, the most urgent first, or those in one state."""
    return _answer(request, await machine.detail(), layout=layout, state=state)


@router.post("/trackers")
@needs(Permission.CONFIGURE)
async def add_tracker(
    press: PressDep, machine: MachineDep, tracker_id: Annotated[str, Form()], name: Annotated[str, Form()]
) -> Response:
    """Add a tracker with a simulated drive; its settings come next."""
    tracker_id, name = tracker_id.strip(), tidy(name)
    if errors := _faults(tracker_id, name, await machine.detail()):
        return _answer(press.request, await machine.detail(), (tracker_id, name), errors, 422)
    await press.send(AddTracker(TrackerConfig(tracker_id, name)))
    return go(press.request, f"/trackers/{tracker_id}/settings")


@router.post("/site/name")
@needs(Permission.CONFIGURE)
async def rename_site(press: PressDep, name: Annotated[str, Form(max_length=LONGEST_TYPED)]) -> Response:
    """Give the site another name."""
    await press.send(RenameSite(name))
    return press.answer(N_("The site's name is saved."))


@router.post("/stop")
@needs(Permission.STOP)
async def stop_all(press: PressDep) -> Response:
    """Stop every tracker now."""
    await press.send(StopAll())
    return press.answer()


def _faults(tracker_id: str, name: str, detail: SiteDetail) -> dict[str, Message]:
    errors: dict[str, Message] = {}
    if not tracker_id.replace("-", "").isalnum() or len(tracker_id) > 20:
        errors["tracker_id"] = N_("Give an ID of letters, digits, and dashes, at most 20, such as T2.")
    elif tracker_id in detail.trackers:
        errors["tracker_id"] = say(
            "Tracker {tracker_id} already exists; choose another ID.", tracker_id=tracker_id
        )
    if not name:
        errors["name"] = N_("Give the tracker a name, such as North field 2.")
    elif fault := unseen(name):
        errors["name"] = fault
    return errors


def _answer(
    request: Request,
    detail: SiteDetail,
    typed: tuple[str, str] | None = None,
    errors: dict[str, Message] | None = None,
    status: int = 200,
    layout: Layout | None = None,
    state: str = "",
) -> Response:
    frame = site_frame(request, N_("Trackers"))
    errors = errors or {}
    texts = dict(zip(("tracker_id", "name"), typed or (_free_id(detail), ""), strict=True))
    form: Fields = {name: Field(name, text, errors.get(name)) for name, text in texts.items()}
    context = OverviewPage(
        frame=frame,
        glances=(glances := _glances(frame.site, detail)),
        counts=counts_of(tuple(one.one for one in glances)),
        urgent=urgent_of(frame.site) if frame.site else None,
        state=state if len(glances) > 1 else "",
        layout=layout or _layout(len(glances)),
        chosen_layout=layout or "",
        form=form,
        longest_name=LONGEST_NAME,
    )
    return page(request, context, block="add", status=status)


def _layout(trackers: int) -> Layout:
    if trackers >= FIELD:
        return Layout.TILES
    return Layout.ROWS if trackers >= MANY else Layout.CARDS


def _free_id(detail: SiteDetail) -> str:
    return next(f"T{n}" for n in range(1, len(detail.trackers) + 2) if f"T{n}" not in detail.trackers)


def _glances(site: SiteSnapshot | None, detail: SiteDetail) -> tuple[Glance, ...]:
    if site is None:
        return ()
    progress = _progress(detail)
    return tuple(
        glance(one, _config(detail, one.tracker_id), progress.get(one.tracker_id, (0, "")))
        for one in by_urgency(site.trackers)
    )


def _config(detail: SiteDetail, tracker_id: str) -> TrackerConfig | None:
    tracker = detail.trackers.get(tracker_id)
    return None if tracker is None else tracker.state.config


def _progress(detail: SiteDetail) -> dict[str, tuple[int, str]]:
    progress = {}
    for tracker_id, tracker in detail.trackers.items():
        left = [step.name for step in tracker.steps if step.status is not StepStatus.DONE]
        progress[tracker_id] = (len(tracker.steps) - len(left), STEP_LABELS[left[0]] if left else "")
    return progress
