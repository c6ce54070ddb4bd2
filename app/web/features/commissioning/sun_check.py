"""The sun check: what sightings of the sun tell about the zero, the mast and likely mistakes."""

from contextlib import suppress
from dataclasses import replace
from typing import Annotated

from fastapi import Form
from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import Response

from app.base.angles import wrap180
from app.base.message import N_
from app.base.permission import Permission
from app.link.messages import ApplySightings, SiteDetail, TakeSighting, TrackerDetail
from app.tracker.commands.commands import CommandRejected
from app.tracker.commissioning.alignment import diagnose, pointing_of
from app.tracker.memory.memory import Sighting
from app.web.api.limit_review import aim_review, must_ask
from app.web.http.errors import NotAcceptable
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.http.whole_forms import MAY_BE_ABSENT
from app.web.shell.contexts import ReviewQuestion, SunCheckPage
from app.web.shell.deps import MachineDep
from app.web.shell.frame import tracker_frame
from app.web.shell.orders import Press, PressDep
from app.web.shell.render import go, page
from app.web.shell.wizard import tracker_of

router = page_router(prefix="/trackers/{tracker_id}/sun-check")


@router.get("")
@needs(Permission.READ)
async def sun_check(request: Request, tracker_id: str, machine: MachineDep) -> Response:
    """Show the sightings, what they tell, and the correction in use."""
    detail = await machine.detail()
    tracker = tracker_of(detail, tracker_id)
    sightings = tracker.state.memory.sightings
    context = SunCheckPage(
        frame=tracker_frame(request, tracker_id, N_("Sun check")),
        sightings=sightings,
        errors=tuple(map(_error, sightings)),
        causes=_causes(detail, tracker, sightings),
        pointing=tracker.state.memory.pointing,
    )
    return page(request, context)


@router.post("/take")
@needs(Permission.CONFIGURE)
async def take(tracker_id: str, press: PressDep) -> Response:
    """Store sun and panel as they are now."""
    await press.send(TakeSighting(tracker_id))
    return go(press.request, f"/trackers/{tracker_id}/sun-check")


@router.post("/apply")
@needs(Permission.CONFIGURE)
async def apply(
    tracker_id: str, press: PressDep, machine: MachineDep, keep: Annotated[list[int], Form(), MAY_BE_ABSENT]
) -> Response:
    """Correct the pointing with the chosen sightings; the others are forgotten."""
    tracker = tracker_of(await machine.detail(), tracker_id)
    stored = tracker.state.memory.sightings
    if any(not 0 <= place < len(stored) for place in keep):
        raise NotAcceptable(N_("The list of sightings has changed; reload the page."))
    chosen = tuple(stored[place] for place in sorted(set(keep)))
    return await _corrected(press, machine, tracker, chosen)


@router.post("/forget")
@needs(Permission.CONFIGURE)
async def forget(tracker_id: str, press: PressDep, machine: MachineDep) -> Response:
    """Forget all sightings and the correction."""
    return await _corrected(press, machine, tracker_of(await machine.detail(), tracker_id), ())


async def _corrected(
    press: Press, machine: MachineDep, tracker: TrackerDetail, keep: tuple[Sighting, ...]
) -> Response:
    """Correct the pointing with these sightings, or not at all; ask first where that moves the target."""
    state, tracker_id = tracker.state, tracker.state.config.tracker_id
    with suppress(CommandRejected):  # the controller says itself why these fit to nothing
        state = replace(state, memory=replace(state.memory, pointing=pointing_of(keep)))
    asked = await run_in_threadpool(aim_review, machine.latest(), tracker.state, state)
    if await must_ask(press.request, tracker_id, asked):
        return page(press.request, ReviewQuestion(asked))
    await press.send(ApplySightings(tracker_id, keep))
    return go(press.request, f"/trackers/{tracker_id}/sun-check")


def _error(sighting: Sighting) -> tuple[float, float]:
    """Return by how much the panel's reading differs from the sun, azimuth and elevation."""
    azimuth_deg = wrap180(sighting.panel_azimuth_deg - sighting.sun_azimuth_deg)
    return azimuth_deg, sighting.panel_elevation_deg - sighting.sun_elevation_deg


def _causes(detail: SiteDetail, tracker: TrackerDetail, sightings: tuple[Sighting, ...]) -> tuple[str, ...]:
    location, config = detail.site.location, tracker.state.config
    if not sightings or location is None:
        return ()
    found = diagnose(sightings[-1], location, config.algorithm, refraction=config.refraction)
    return tuple(cause.message for cause in found)
