"""The site: its weather, where that comes from, and how the machine's other doors are doing."""

from typing import Annotated

from fastapi import Form
from pydantic import BaseModel
from starlette.requests import Request
from starlette.responses import Response

from app.base.message import N_
from app.base.permission import Permission
from app.link.messages import MachineUnreachable, SiteDetail
from app.link.settings_orders import UndoSiteSettings
from app.link.weather_orders import SetMetStation, SetWeatherWindows, SimulateWeather
from app.tracker.memory.memory import SiteState
from app.tracker.settings.config import DriveKind
from app.tracker.state.snapshot import SiteSnapshot
from app.web.features.site import weather_forms as forms
from app.web.features.site.site_contexts import SitePage
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.services.counting import counted
from app.web.shell.deps import MachineDep
from app.web.shell.forms import Typed
from app.web.shell.frame import site_frame
from app.web.shell.orders import Press, PressDep
from app.web.shell.render import go, page

router = page_router(prefix="/site")

HOLDERS = {"SunSpec over Modbus TCP": "sunspec", "SunSpec over Modbus RTU": "sunspec", "MQTT": "mqtt"}
"""How control tells who holds it, for every gateway that takes orders."""


class StationForm(BaseModel):
    """The address of a weather station as it was typed."""

    host: str = ""
    port: str = ""
    unit: str = ""


class SimulationForm(BaseModel):
    """Made-up weather as it was typed."""

    scenario: str = ""
    seed: str = ""
    wind_mps: str = ""
    gustiness_pct: str = ""
    wind_direction_deg: str = ""
    irradiance_wm2: str = ""
    snow_kg: str = ""
    temperature_degc: str = ""


class WindowsForm(BaseModel):
    """Windows and ages as they were typed."""

    gust_s: str = ""
    mean_s: str = ""
    wind_old_after_s: str = ""
    light_old_after_s: str = ""
    snow_old_after_s: str = ""
    other_old_after_s: str = ""


@router.get("")
@needs(Permission.READ)
async def site(request: Request, machine: MachineDep) -> Response:
    """Show the newest weather and the state of every gateway."""
    return await _answer(request, machine, block="gateways")


@router.post("/weather-station")
@needs(Permission.CONFIGURE)
async def weather_station(
    press: PressDep, machine: MachineDep, form: Annotated[StationForm, Form()]
) -> Response:
    """Read this weather station from now on; without a host none."""
    typed = Typed(form.model_dump())
    station = forms.read_station(typed)
    if typed.errors:
        return await _refused(press, machine, "station", typed)
    await press.send(SetMetStation(station))
    return press.answer(
        N_("The weather station is now being read.") if station else N_("No weather station is in use.")
    )


@router.post("/simulated-weather")
@needs(Permission.CONFIGURE)
async def simulated_weather(
    press: PressDep, machine: MachineDep, form: Annotated[SimulationForm, Form()]
) -> Response:
    """Make the weather up from now on."""
    typed = Typed(form.model_dump())
    station = forms.read_simulation(typed)
    if station is None:
        return await _refused(press, machine, "simulation", typed)
    await press.send(SimulateWeather(station))
    return go(press.request, "/site")


@router.post("/simulated-weather/end")
@needs(Permission.CONFIGURE)
async def end_simulated_weather(press: PressDep) -> Response:
    """Make no weather up any more."""
    await press.send(SimulateWeather(None))
    return go(press.request, "/site")


@router.post("/weather-windows")
@needs(Permission.CONFIGURE)
async def weather_windows(
    press: PressDep, machine: MachineDep, form: Annotated[WindowsForm, Form()]
) -> Response:
    """Go by these windows and ages from now on."""
    typed = Typed(form.model_dump())
    windows = forms.read_windows(typed)
    if windows is None:
        return await _refused(press, machine, "windows", typed)
    await press.send(SetWeatherWindows(windows))
    return press.answer(N_("The weather evaluation now uses these windows and ages."))


@router.post("/undo")
@needs(Permission.CONFIGURE)
async def undo(press: PressDep) -> Response:
    """Set the site as it was before its settings were changed last."""
    await press.send(UndoSiteSettings())
    return go(press.request, press.back)


async def _refused(press: Press, machine: MachineDep, block: str, typed: Typed) -> Response:
    return await _answer(press.request, machine, block=block, typed=typed, status=422)


async def _answer(
    request: Request, machine: MachineDep, *, block: str, typed: Typed | None = None, status: int = 200
) -> Response:
    """Show the site, with what was typed in the form of this block."""
    try:
        detail: SiteDetail | None = await machine.detail()
    except MachineUnreachable:
        detail = None
    state = SiteState() if detail is None else detail.site
    shown = {
        "station": forms.station_texts(state.met_station),
        "simulation": forms.simulation_texts(state.simulated_weather),
        "windows": forms.window_texts(state.weather_windows),
    }
    if typed is not None:
        shown[block] = typed
    metrics = await counted(machine)
    context = SitePage(
        frame=site_frame(request, N_("Site")),
        gateways=None if metrics is None else metrics.gateways,
        is_known=detail is not None,
        form=shown["station"].form(forms.STATION_NAMES),
        simulation=shown["simulation"].form(forms.SIMULATION_NAMES),
        scenarios=forms.SCENARIOS,
        is_simulated=state.simulated_weather is not None,
        real_trackers=() if detail is None else _real(detail),
        windows=shown["windows"].form(forms.WINDOW_NAMES),
        window_hints=forms.window_hints(),
        held=_held(machine.latest()),
    )
    return page(request, context, block=block, status=status)


def _held(site: SiteSnapshot | None) -> dict[str, tuple[str, ...]]:
    """Return which trackers each gateway has control of."""
    trackers = site.trackers if site else ()
    return {
        name: tuple(one.tracker_id for one in trackers if one.control.holder and one.control.via == via)
        for name, via in HOLDERS.items()
    }


def _real(detail: SiteDetail) -> tuple[str, ...]:
    return tuple(
        name
        for name, one in detail.trackers.items()
        if one.state.config.drive.kind is not DriveKind.SIMULATED
    )
