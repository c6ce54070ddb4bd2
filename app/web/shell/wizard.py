"""What the five steps have in common: where they stand, the step bar, confirming, and the way forward."""

from collections.abc import Mapping

from starlette.requests import Request
from starlette.responses import RedirectResponse, Response

from app.base.message import N_
from app.base.permission import Permission
from app.link.messages import ConfirmStep, SiteDetail, TrackerDetail, UnknownTracker
from app.tracker.commissioning.steps import Step, StepStatus
from app.tracker.memory.memory import StepName
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.shell.contexts import Forward, Frame, Link, ProgressPart
from app.web.shell.deps import MachineDep
from app.web.shell.frame import STEP_LABELS, step_marks, tracker_frame
from app.web.shell.orders import PressDep
from app.web.shell.render import page

router = page_router(prefix="/trackers/{tracker_id}/commissioning")
ORDER = tuple(StepName)
PAGES_TO_SAVE = ("/commissioning/location", "/commissioning/clock", "/commissioning/mode")
WITHOUT_FORWARD = "/commissioning/clock/shadow"
"""It leads back to the page that saves."""


def tracker_of(detail: SiteDetail, tracker_id: str) -> TrackerDetail:
    """Return one tracker's stored state, or raise `UnknownTracker`."""
    if tracker_id not in detail.trackers:
        raise UnknownTracker(tracker_id)
    return detail.trackers[tracker_id]


def step_of(tracker: TrackerDetail, name: StepName) -> Step:
    """Return one of a tracker's five steps."""
    return next(step for step in tracker.steps if step.name is name)


def wizard_frame(request: Request, tracker: TrackerDetail, step: StepName, here: str | None = None) -> Frame:
    """Return the frame of one step; `here` is the page that asks, if it is not the one requested."""
    here = here or request.url.path
    tracker_id = tracker.state.config.tracker_id
    return tracker_frame(
        request,
        tracker_id,
        STEP_LABELS[step],
        steps=step_marks(tracker, step),
        back=_back(tracker_id, step, here),
        forward=onwards(tracker, step, here),
    )


def _back(tracker_id: str, step: StepName, here: str) -> Link:
    root = f"/trackers/{tracker_id}"
    if here.endswith("/orientation"):
        return Link(N_("Back"), f"{root}/commissioning/mode")
    if here.endswith(WITHOUT_FORWARD):
        return Link(N_("Back"), f"{root}/commissioning/clock")
    at = ORDER.index(step)
    return Link(N_("Back"), f"{root}/commissioning/{ORDER[at - 1]}" if at else root)


def onwards(tracker: TrackerDetail, step: StepName, here: str) -> Forward | None:
    """Return the key forward: it saves a page that is a form; elsewhere it opens when the step is done.

    The last step has none: in the place of *Next* nothing stands that does something else.
    """
    root = f"/trackers/{tracker.state.config.tracker_id}"
    found = step_of(tracker, step)
    if step is StepName.RUN or here.endswith(WITHOUT_FORWARD):
        return None
    if here.endswith(PAGES_TO_SAVE):
        needs_role = Permission.OPERATE if step is StepName.MODE else Permission.CONFIGURE
        return Forward(N_("Save and next"), form="step-form", needs=needs_role)
    if found.status is StepStatus.DONE:
        return Forward(N_("Next"), f"{root}/commissioning/{ORDER[ORDER.index(step) + 1]}")
    return Forward(N_("Next"), reasons=found.reasons)


@router.get("")
@needs(Permission.READ)
async def commissioning(tracker_id: str, machine: MachineDep) -> Response:
    """Go to the first step that is not done."""
    tracker = tracker_of(await machine.detail(), tracker_id)
    left = [step.name for step in tracker.steps if step.status is not StepStatus.DONE]
    return RedirectResponse(f"/trackers/{tracker_id}/commissioning/{left[0] if left else StepName.RUN}", 303)


@router.get("/progress/{step}")
@needs(Permission.READ)
async def progress(
    request: Request, tracker_id: str, step: StepName, machine: MachineDep, here: str = ""
) -> Response:
    """Return the step bar and the key forward as they stand now."""
    tracker = tracker_of(await machine.detail(), tracker_id)
    return page(request, ProgressPart(frame=wizard_frame(request, tracker, step, here)))


@router.post("/{step}/confirm")
@needs(Permission.CONFIGURE)
async def confirm(tracker_id: str, step: StepName, press: PressDep) -> Response:
    """Take the operator's word that a step is still right."""
    await press.send(ConfirmStep(tracker_id, step))
    return press.answer(N_("Confirmed."))


def texts_of(values: Mapping[str, object]) -> dict[str, str]:
    """Return stored values as the texts of a form."""
    return {name: str(value) for name, value in values.items()}
