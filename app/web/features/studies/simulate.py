"""A whole day at the controller's fidelity, without a machine: the form, and the recording it makes."""

from datetime import date, datetime, time, timedelta
from typing import Annotated

from fastapi import Form
from pydantic import BaseModel, Field
from starlette.requests import Request
from starlette.responses import Response

from app.base.message import N_, told_by
from app.base.permission import Permission
from app.base.zones import day_in, zone_of
from app.link.messages import SaveRecording, SiteDetail
from app.tracker.settings.config import Orientation
from app.tracker.values.mode import Mode
from app.tracker.weather.simulated_weather import Scenario
from app.tracker.weather.weather_day import WeatherDay, day_of_scenario, read_steps, stepped_day
from app.web.features.control.mode import CHOICES
from app.web.http.errors import NotAcceptable
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.services.simulations import SimulationRequest
from app.web.shell.contexts import SimulatePage
from app.web.shell.deps import MachineDep, PanelDep
from app.web.shell.forms import Typed, Unreadable
from app.web.shell.frame import site_frame
from app.web.shell.orders import PressDep
from app.web.shell.render import go, page
from app.web.shell.wizard import tracker_of

router = page_router(prefix="/simulate")
NAMES = ("tracker", "date", "mode", "azimuth", "elevation", "weather", "begins", "steps")
STEP = timedelta(seconds=1)
NO_WEATHER, BY_STEPS = "none", "steps"
WEATHERS = (
    (NO_WEATHER, N_("None")),
    (Scenario.CALM.value, N_("A calm day")),
    (Scenario.STORM.value, N_("A storm that comes and goes")),
    (Scenario.SNOWFALL.value, N_("A snowfall that slides off")),
    (Scenario.CLOUDS.value, N_("Clouds, then heavy overcast")),
    (BY_STEPS, N_("From the steps below")),
)
EXAMPLE = "time,wind_mps,snow_kg\n00:00,3,0\n10:00,,6\n10:30,,0\n14:00,22,\n14:10,3,"


class SimulationForm(BaseModel):
    """The form as it was typed; all texts."""

    tracker: str = ""
    date: str = ""
    mode: str = ""
    azimuth: str = "180"
    elevation: str = "45"
    weather: str = NO_WEATHER
    begins: str = "12:00"
    steps: str = Field(EXAMPLE, max_length=100_000)


@router.get("")
@needs(Permission.READ)
async def simulate(request: Request, machine: MachineDep, built: PanelDep) -> Response:
    """Show the form for a day's simulation."""
    detail = await machine.detail()
    today = day_in(detail.site.time_zone, built.site_now())
    first = next(iter(detail.trackers), "")
    form = SimulationForm(tracker=first, date=today.isoformat(), mode=Mode.DUAL)
    return _answer(request, detail, Typed(form.model_dump()))


@router.post("")
@needs(Permission.SIMULATE)
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
        raise NotAcceptable(told_by(error)) from error
    press.issued_at = None  # It took a while, and nothing moves: this order is never too old.
    await press.send(SaveRecording(info, chunks))
    return go(press.request, f"/recordings/{info.recording_id}")


def _read(typed: Typed, detail: SiteDetail) -> SimulationRequest | None:
    location, zone = detail.site.location, detail.site.time_zone
    if location is None:
        typed.errors["tracker"] = N_("Save the location first: step 1 of commissioning.")
    day = typed.day("date", N_("Date"))
    mode = typed.read("mode", _mode, Mode.DUAL)
    held = Orientation(
        typed.number("azimuth", N_("Azimuth"), 0, 360, "°"),
        typed.number("elevation", N_("Elevation"), 0, 90, "°"),
    )
    weather = _weather(typed, day, zone)
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
        weather=weather,
        horizon=detail.site.horizon,
    )


def _weather(typed: Typed, day: date, zone_name: str) -> WeatherDay | None:
    """Return the weather of the day; what is wrong with it stands at the field that it was typed in."""
    kind, zone = typed.texts["weather"], zone_of(zone_name)
    if kind not in {value for value, _ in WEATHERS}:
        typed.errors["weather"] = N_("Weather: choose one from the list.")
    if "date" in typed.errors or "weather" in typed.errors or kind == NO_WEATHER:
        return None
    midnight = _midnight(day, zone_name)
    field = "steps" if kind == BY_STEPS else "begins"
    try:
        if kind == BY_STEPS:
            return stepped_day(read_steps(typed.texts["steps"]), midnight, zone)
        return day_of_scenario(Scenario(kind), typed.texts["begins"].strip(), 1, midnight, zone)
    except ValueError as error:
        typed.errors[field] = told_by(error)
        return None


def _mode(text: str) -> Mode:
    if text not in list(Mode):
        raise Unreadable(N_("Mode: choose one from the list."))
    return Mode(text)


def _midnight(day: date, zone: str) -> datetime:
    return datetime.combine(day, time(), zone_of(zone))


def _answer(request: Request, detail: SiteDetail, typed: Typed, *, status: int = 200) -> Response:
    context = SimulatePage(
        frame=site_frame(request, N_("Simulate a day")),
        form=typed.form(NAMES),
        trackers=tuple((name, f"{name} {one.state.config.name}") for name, one in detail.trackers.items()),
        modes=tuple((one.mode.value, one.label) for one in CHOICES),
        weathers=WEATHERS,
    )
    return page(request, context, block="form", status=status)
