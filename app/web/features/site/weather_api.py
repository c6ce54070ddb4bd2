"""The weather that a station of the site measures."""

from typing import Annotated

from pydantic import Field

from app.base.instants import Instant
from app.base.message import N_, told_by
from app.base.permission import Permission
from app.link.weather_orders import ReportWeather, SetMetStation
from app.tracker.memory.memory import MetStation
from app.tracker.weather.weather import RANGES, Weather, WeatherNow
from app.web.api.base import CHANGED, NOT_FOUND, REFUSED, TAGGED, Input, api_router
from app.web.api.orders import SenderDep
from app.web.api.tags import of_site, tagged, unless_changed
from app.web.http.errors import NotAcceptable, NotFound
from app.web.http.needs import needs
from app.web.shell.deps import MachineDep, SnapshotDep

router = api_router(prefix="/site/weather", tags=["site"])


def _measured(name: str, example: float) -> object:
    title, low, high, unit = RANGES[name]
    return Field(None, ge=low, le=high, description=f"{title}, {unit}.", examples=[example])


class WeatherReport(Input):
    """What a station measured; leave out what it does not measure, but give at least one value."""

    measured_at: Instant | None = Field(
        None, description="When it was measured, by the site's clock; left out it is now."
    )
    wind_mps: Annotated[float | None, _measured("wind_mps", 4.2)] = None
    wind_direction_deg: Annotated[float | None, _measured("wind_direction_deg", 210.0)] = None
    irradiance_wm2: Annotated[float | None, _measured("irradiance_wm2", 820.0)] = None
    snow_kg: Annotated[float | None, _measured("snow_kg", 0.0)] = None
    snow_mm: Annotated[float | None, _measured("snow_mm", 0.0)] = None
    temperature_degc: Annotated[float | None, _measured("temperature_degc", 24.5)] = None
    humidity_pct: Annotated[float | None, _measured("humidity_pct", 48.0)] = None
    pressure_hpa: Annotated[float | None, _measured("pressure_hpa", 1013.0)] = None
    rain_mm: Annotated[float | None, _measured("rain_mm", 0.0)] = None


STATION = of_site(lambda site: site.met_station)


@router.get("", summary="The newest weather report", responses=NOT_FOUND)
@needs(Permission.READ)
async def read_weather(snapshot: SnapshotDep) -> WeatherNow:
    """Return the newest report with its age, also one from before a restart; 404 before the first."""
    if snapshot.weather is None:
        raise NotFound(N_("No measured weather is known yet. Set up a weather station, or send a report."))
    return snapshot.weather


class MetStationIn(Input):
    """A weather station that is read over Modbus TCP: SunSpec model 307."""

    host: str = Field(min_length=1, max_length=253, examples=["127.0.0.1"])
    port: int = Field(502, ge=1, le=65535)
    unit: int = Field(1, ge=0, le=255)


@router.get(
    "/station", summary="The weather station that is read", responses=TAGGED, dependencies=[tagged(STATION)]
)
@needs(Permission.READ)
async def read_station(machine: MachineDep) -> MetStation | None:
    """Return the SunSpec station that is read every second, null for none."""
    return (await machine.detail()).site.met_station


@router.put(
    "/station",
    summary="Read a weather station",
    responses=CHANGED | REFUSED,
    dependencies=[unless_changed(STATION)],
)
@needs(Permission.CONFIGURE)
async def set_station(station: MetStationIn, sender: SenderDep, machine: MachineDep) -> MetStation | None:
    """Read SunSpec model 307 at this address every second from now on."""
    await sender.send(SetMetStation(MetStation(station.host, station.port, station.unit)))
    return await read_station(machine)


@router.delete(
    "/station",
    status_code=204,
    summary="Read no weather station",
    responses=CHANGED | REFUSED,
    dependencies=[unless_changed(STATION)],
)
@needs(Permission.CONFIGURE)
async def remove_station(sender: SenderDep) -> None:
    """Read no weather station any more; reports are taken as before."""
    await sender.send(SetMetStation(None))


@router.put("", summary="Report the weather", responses=REFUSED)
@needs(Permission.REPORT)
async def report_weather(report: WeatherReport, sender: SenderDep) -> WeatherNow:
    """Take the values in the place of those before; wind, snow and light act on trackers as set."""
    try:
        readings = Weather(**report.model_dump(exclude={"measured_at"}))
        order = ReportWeather(readings, report.measured_at)
    except ValueError as error:
        raise NotAcceptable(told_by(error)) from error
    after = await sender.send(order)
    return await read_weather(after)
