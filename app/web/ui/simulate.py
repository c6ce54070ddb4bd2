"""A whole day at the controller's fidelity, without a machine: the form, and the recording it makes."""

from datetime import date, datetime, time, timedelta
from typing import Annotated

from fastapi import APIRouter, Form
from pydantic import BaseModel
from starlette.requests import Request
from starlette.responses import Response

from app.link.messages import SaveRecording, SiteDetail
from app.tracker.config import Orientation
from app.tracker.mode import Mode
from app.web.contexts import SimulatePage
from app.web.deps import MachineDep, PanelDep
from app.web.errors import NotAcceptable
from app.web.simulations import SimulationRequest
from app.web.ui.forms import Typed, Unreadable
from app.web.ui.frame import site_frame
from app.web.ui.mode import CHOICES
from app.web.ui.orders import PressDep
from app.web.ui.render import go, page
from app.web.ui.wizard import tracker_of
from app.zones import zone_of

router = APIRouter(prefix="/simulate")
NAMES = ("tracker", "date", "mode", "azimuth", "elevation")
STEP = timedelta(seconds=1)


class SimulationForm(BaseModel):
    """The form as it was typed; all texts."""

    tracker: str = ""
    date: str = ""
    mode: str = ""
    azimuth: str = "180"
    elevation: str = "45"


@router.get("")
async def simulate(request: Request, machine: MachineDep, built: PanelDep) -> Response:
    """Show the form for a day's simulation."""
    detail = await machine.detail()
    latest = machine.latest()
    zone = zone_of(detail.site.time_zone)
    today = (latest.at if latest else built.clock.now()).astimezone(zone).date()
    first = next(iter(detail.trackers), "")
    form = SimulationForm(tracker=first, date=today.isoformat(), mode=Mode.DUAL)
    return _answer(request, detail, Typed(form.model_dump()))


@router.post("")
async def run(
    press: PressDep, machine: MachineDep, built: PanelDep, typed: Annotated[SimulationForm, Form()]
) -> Response:
    """Simulate the day, keep the recording, and open it in the player."""
    detail = await machine.detail()
    found = Typed(typed.model_dump())
    wanted = _read(found, detail)
    if wanted is None:
        return _answer(press.request, detail, found, status=422)
    try:
        info, chunks = await built.simulations.run(wanted)
    except ValueError as error:
        raise NotAcceptable(str(error)) from error
    press.issued_at = None  # It took a while, and nothing moves: this order is never too old.
    await press.send(SaveRecording(info, chunks))
    return go(press.request, f"/recordings/{info.recording_id}")


def _read(typed: Typed, detail: SiteDetail) -> SimulationRequest | None:
    location, zone = detail.site.location, detail.site.time_zone
    if location is None:
        typed.errors["tracker"] = "Save the location first: step 1 of commissioning."
    day = typed.day("date", "Date")
    mode = typed.read("mode", _mode, Mode.DUAL)
    held = Orientation(
        typed.number("azimuth", "Azimuth", 0, 360), typed.number("elevation", "Elevation", 0, 90)
    )
    if typed.errors or location is None:
        return None
    state = tracker_of(detail, typed.texts["tracker"]).state
    return SimulationRequest(
        config=state.config,
        pointing=state.memory.pointing,
        location=location,
        time_zone=zone,
        mode=mode,
        held=held,
        begin=_midnight(day, zone),
        end=_midnight(day + timedelta(days=1), zone),
        step=STEP,
        title="",
    )


def _mode(text: str) -> Mode:
    if text not in list(Mode):
        raise Unreadable("Mode: choose one from the list.")
    return Mode(text)


def _midnight(day: date, zone: str) -> datetime:
    return datetime.combine(day, time(), zone_of(zone))


def _answer(request: Request, detail: SiteDetail, typed: Typed, *, status: int = 200) -> Response:
    context = SimulatePage(
        frame=site_frame(request, "Simulate a day"),
        form=typed.form(NAMES),
        trackers=tuple((name, f"{name} {one.state.config.name}") for name, one in detail.trackers.items()),
        modes=tuple((one.mode.value, one.label) for one in CHOICES),
    )
    return page(request, context, block="form", status=status)
