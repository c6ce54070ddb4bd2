"""Training on a simulated tracker: play a fault and see what an operator would see."""

from typing import Annotated

from fastapi import Form
from starlette.requests import Request
from starlette.responses import Response

from app.base.message import N_
from app.base.permission import Permission
from app.link.messages import EndInjectedFaults, InjectFault, SiteDetail
from app.link.weather_orders import SimulateWeather
from app.tracker.programs.fault_scenarios import LESSONS, Lesson, Subject
from app.tracker.settings.config import DriveConfig, DriveKind
from app.tracker.weather.simulated_weather import SimulatedStation
from app.web.features.commissioning.drive_contexts import TrainingPage, TrainingPlace
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.shell.deps import MachineDep
from app.web.shell.formats import words
from app.web.shell.frame import tracker_frame
from app.web.shell.orders import PressDep
from app.web.shell.render import go, page
from app.web.shell.wizard import tracker_of

router = page_router(prefix="/trackers/{tracker_id}/fault-injection")
TRAINED_PROFILE = "simulated-plc"


@router.get("")
@needs(Permission.READ)
async def training(request: Request, tracker_id: str, machine: MachineDep) -> Response:
    """Show every fault that can be played."""
    detail = await machine.detail()
    place = _place(tracker_of(detail, tracker_id).state.config.drive)
    real = _real(detail)
    station = detail.site.simulated_weather
    context = TrainingPage(
        frame=tracker_frame(request, tracker_id, N_("Training")),
        place=place,
        lessons={} if place is TrainingPlace.NOWHERE else _by_subject(),
        weather_is=None if real else station is not None,
        playing=words(station.played.fault) if station is not None and station.played is not None else "",
        real_trackers=real,
    )
    return page(request, context)


@router.post("/play")
@needs(Permission.CONFIGURE)
async def play(tracker_id: str, press: PressDep, fault: Annotated[str, Form(max_length=40)] = "") -> Response:
    """Play one fault."""
    await press.send(InjectFault(tracker_id, fault))
    return press.answer(N_("The fault is injected."))


@router.post("/clear")
@needs(Permission.CONFIGURE)
async def clear(tracker_id: str, press: PressDep) -> Response:
    """End every fault that is played."""
    await press.send(EndInjectedFaults(tracker_id))
    return press.answer(N_("All injected faults have ended. Reset the latched faults."))


@router.post("/weather")
@needs(Permission.CONFIGURE)
async def weather(request: Request, tracker_id: str, press: PressDep) -> Response:
    """Make up quiet weather for the site, so that storms and broken sensors can be played."""
    await press.send(SimulateWeather(SimulatedStation()))
    return go(request, f"/trackers/{tracker_id}/fault-injection#weather")


def _place(drive: DriveConfig) -> TrainingPlace:
    if drive.kind is DriveKind.SIMULATED:
        return TrainingPlace.HERE
    return TrainingPlace.DRIVE_SIM if drive.profile == TRAINED_PROFILE else TrainingPlace.NOWHERE


def _by_subject() -> dict[str, tuple[Lesson, ...]]:
    return {subject.value: tuple(one for one in LESSONS if one.subject is subject) for subject in Subject}


def _real(detail: SiteDetail) -> tuple[str, ...]:
    """Return the trackers that may be real, so that no weather may be made up for them."""
    return tuple(
        name
        for name, one in detail.trackers.items()
        if one.state.config.drive.kind is not DriveKind.SIMULATED
    )
