"""Made-up weather for simulated sites, and how values of the weather are judged."""

from typing import Annotated

from pydantic import Field

from app.base.instants import Instant
from app.base.permission import Permission
from app.link.weather_orders import SetWeatherWindows, SimulateWeather
from app.tracker.weather.simulated_weather import MOST_SEED, SPANS, Scenario, SimulatedStation
from app.tracker.weather.weather_windows import LIMITS, WeatherWindows
from app.web.api.base import CHANGED, REFUSED, TAGGED, Input, api_router
from app.web.api.orders import SenderDep
from app.web.api.tags import of_site, tagged, unless_changed
from app.web.http.needs import needs
from app.web.shell.deps import MachineDep

router = api_router(prefix="/site/weather", tags=["site"])
SIMULATION = of_site(lambda site: site.simulated_weather)
WINDOWS = of_site(lambda site: site.weather_windows)
USUAL, STATION = WeatherWindows(), SimulatedStation()


def _made_up(name: str, text: str = "") -> object:
    title, low, high, unit = SPANS[name]
    return Field(getattr(STATION, name), ge=low, le=high, description=f"{title}, {unit}.{text}")


class SimulatedStationIn(Input):
    """Made-up weather; wind, light, snow and temperature count by hand only, the direction always."""

    scenario: Scenario = Field(Scenario.MANUAL, examples=["storm"])
    seed: int = Field(1, ge=0, le=MOST_SEED, description="The same seed makes the same gusts and clouds.")
    wind_mps: Annotated[float, _made_up("wind_mps")] = STATION.wind_mps
    gustiness_pct: Annotated[
        float, _made_up("gustiness_pct", " How far the strongest gust exceeds the mean.")
    ] = STATION.gustiness_pct
    wind_direction_deg: Annotated[float, _made_up("wind_direction_deg")] = STATION.wind_direction_deg
    irradiance_wm2: Annotated[
        float | None,
        _made_up("irradiance_wm2", " Left out it is that of a clear sky, by the sun's elevation."),
    ] = None
    snow_kg: Annotated[float, _made_up("snow_kg")] = STATION.snow_kg
    temperature_degc: Annotated[float, _made_up("temperature_degc")] = STATION.temperature_degc
    begun_at: Instant | None = Field(
        None, description="When the scenario begins, by the site's clock; left out it begins at once."
    )

    def station(self) -> SimulatedStation:
        """Return it in the machine's words."""
        return SimulatedStation(**self.model_dump())


def _window(name: str) -> object:
    title, low, high = LIMITS[name]
    return Field(getattr(USUAL, name), ge=low, le=high, description=f"{title}, s.")


class WeatherWindowsIn(Input):
    """Windows and ages; what is left out is as usual."""

    gust_s: Annotated[float, _window("gust_s")] = USUAL.gust_s
    mean_s: Annotated[float, _window("mean_s")] = USUAL.mean_s
    wind_old_after_s: Annotated[float, _window("wind_old_after_s")] = USUAL.wind_old_after_s
    light_old_after_s: Annotated[float, _window("light_old_after_s")] = USUAL.light_old_after_s
    snow_old_after_s: Annotated[float, _window("snow_old_after_s")] = USUAL.snow_old_after_s
    other_old_after_s: Annotated[float, _window("other_old_after_s")] = USUAL.other_old_after_s


@router.get(
    "/simulation", summary="The simulated weather", responses=TAGGED, dependencies=[tagged(SIMULATION)]
)
@needs(Permission.READ)
async def read_simulation(machine: MachineDep) -> SimulatedStation | None:
    """Return the made-up weather that the site lives in, null for none."""
    return (await machine.detail()).site.simulated_weather


@router.put(
    "/simulation",
    summary="Simulate the weather",
    responses=CHANGED | REFUSED,
    dependencies=[unless_changed(SIMULATION)],
)
@needs(Permission.CONFIGURE)
async def simulate_weather(
    wanted: SimulatedStationIn, sender: SenderDep, machine: MachineDep
) -> SimulatedStation | None:
    """Make the weather up from now on; refused unless every tracker of the site is simulated."""
    await sender.send(SimulateWeather(wanted.station()))
    return await read_simulation(machine)


@router.delete(
    "/simulation",
    status_code=204,
    summary="Simulate no weather",
    responses=CHANGED | REFUSED,
    dependencies=[unless_changed(SIMULATION)],
)
@needs(Permission.CONFIGURE)
async def end_simulation(sender: SenderDep) -> None:
    """Make no weather up any more; what it did to the protections ends with it."""
    await sender.send(SimulateWeather(None))


@router.get("/windows", summary="Weather evaluation", responses=TAGGED, dependencies=[tagged(WINDOWS)])
@needs(Permission.READ)
async def read_windows(machine: MachineDep) -> WeatherWindows:
    """Return over how long gust and mean are taken, and when values are old."""
    windows = (await machine.detail()).site.weather_windows
    return USUAL if windows is None else windows


@router.put(
    "/windows",
    summary="Set how the weather is judged",
    responses=CHANGED | REFUSED,
    dependencies=[unless_changed(WINDOWS)],
)
@needs(Permission.CONFIGURE)
async def set_windows(wanted: WeatherWindowsIn, sender: SenderDep, machine: MachineDep) -> WeatherWindows:
    """Go by these windows and ages from now on."""
    await sender.send(SetWeatherWindows(WeatherWindows(**wanted.model_dump())))
    return await read_windows(machine)
