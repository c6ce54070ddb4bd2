"""The site: its weather, and how the machine's other doors are doing."""

from typing import Annotated

from fastapi import APIRouter, Form
from pydantic import BaseModel
from starlette.requests import Request
from starlette.responses import Response

from app.link.messages import MachineUnreachable
from app.link.weather_orders import SetMetStation
from app.tracker.memory import MetStation
from app.web.deps import MachineDep
from app.web.metrics import counted
from app.web.site_contexts import SitePage
from app.web.ui.forms import Typed
from app.web.ui.frame import site_frame
from app.web.ui.orders import PressDep
from app.web.ui.render import page

router = APIRouter(prefix="/site")


class StationForm(BaseModel):
    """The address of a weather station as it was typed."""

    host: str = ""
    port: str = "502"
    unit: str = "1"


@router.get("")
async def site(request: Request, machine: MachineDep) -> Response:
    """Show the newest weather and the state of every gateway."""
    try:
        station = (await machine.detail()).site.met_station
    except MachineUnreachable:
        station = None
    return await _answer(request, machine, _texts(station))


@router.post("/weather-station")
async def weather_station(
    press: PressDep, machine: MachineDep, form: Annotated[StationForm, Form()]
) -> Response:
    """Read this weather station from now on; without a host none."""
    typed = Typed(form.model_dump())
    host = form.host.strip()
    port = typed.whole("port", "Port", 1, 65535)
    unit = typed.whole("unit", "Unit", 0, 255)
    if typed.errors:
        return await _answer(press.request, machine, typed, block="station", status=422)
    await press.send(SetMetStation(MetStation(host, port, unit) if host else None))
    return press.answer("The weather station is read from now on." if host else "No weather station is read.")


def _texts(station: MetStation | None) -> Typed:
    if station is None:
        return Typed(StationForm().model_dump())
    return Typed({"host": station.host, "port": str(station.port), "unit": str(station.unit)})


async def _answer(
    request: Request, machine: MachineDep, typed: Typed, *, block: str = "gateways", status: int = 200
) -> Response:
    metrics = await counted(machine)
    context = SitePage(
        frame=site_frame(request, "Site"),
        gateways=None if metrics is None else metrics.gateways,
        form=typed.form(StationForm.model_fields),
    )
    return page(request, context, block=block, status=status)
