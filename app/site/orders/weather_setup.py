"""Orders about the weather: what is reported, which station is read, and how values are judged."""

from dataclasses import replace
from datetime import datetime

from app.base.hosts import checked_host
from app.base.message import N_, Message, say
from app.link.weather_orders import (
    ReportWeather,
    SetMetStation,
    SetWeatherWindows,
    SimulateWeather,
)
from app.site.state.model import SiteModel
from app.site.weather.weather import WeatherStation
from app.tracker.commands.commands import CommandRejected
from app.tracker.memory.memory import SiteState
from app.tracker.settings.config import DriveKind, TrackerConfig
from app.tracker.state.snapshot import Event, EventKind
from app.tracker.values.reason import Reason
from app.tracker.weather.simulated_weather import PlayedWeather, SimulatedStation, WeatherFault

IS_SIMULATED = Reason(
    "weather_simulated",
    N_("The site's weather is SIMULATED; measured weather is not accepted."),
    N_("Switch the simulated weather off on the Site page first."),
)
NEEDS_MADE_UP = Reason(
    "weather_not_simulated",
    N_("The site's weather is not simulated, so weather and sensor faults cannot be injected."),
    N_("Simulate the weather first, on this page or on the Site page."),
)
NEEDS_SIMULATED = Reason(
    "weather_simulated",
    N_("The site's weather is SIMULATED and must not move a real tracker."),
    N_("Switch the simulated weather off on the Site page first."),
)


def refuse_real(model: SiteModel, config: TrackerConfig) -> None:
    """Raise `CommandRejected` if this tracker is real while the site's weather is made up."""
    if model.state.simulated_weather is not None and config.drive.kind is not DriveKind.SIMULATED:
        raise CommandRejected(NEEDS_SIMULATED)


async def report(model: SiteModel, command: ReportWeather, actor: str) -> tuple[Event, ...]:
    """Take a report at once; one that demands a stow is on disk before this returns."""
    if model.state.simulated_weather is not None:
        raise CommandRejected(IS_SIMULATED)
    model.measured.receive(command.readings, command.measured_at, actor, model.now(), model.clock.now())
    model.rouse()
    model.keep_weather()
    await model.weather_file.written()
    return ()


async def set_station(model: SiteModel, command: SetMetStation, actor: str) -> tuple[Event, ...]:
    """Read another weather station from now on, or none."""
    station = command.station
    told = N_("No weather station is read now.")
    if station is not None:
        checked_host(station.host)
        told = say("The weather station {name} is now read.", name=station.name)
    made_up = model.state.simulated_weather if station is None else None
    state = replace(model.state, met_station=station, simulated_weather=made_up)
    return await _follow(model, state, told, actor)


async def simulate(model: SiteModel, command: SimulateWeather, actor: str) -> tuple[Event, ...]:
    """Make the weather up from now on, or no longer."""
    station = command.station
    if station is None:
        state = replace(model.state, simulated_weather=None)
        return await _follow(model, state, N_("The weather is no longer simulated."), actor)
    _refuse_for_real_trackers(model)
    begun = replace(station, begun_at=_begin(station, model.now()))
    state = replace(model.state, simulated_weather=begun, met_station=None)
    told = say("The weather is now SIMULATED: {scenario}.", scenario=station.scenario)
    return await _follow(model, state, told, actor)


async def set_windows(model: SiteModel, command: SetWeatherWindows, actor: str) -> tuple[Event, ...]:
    """Judge the values of the weather over other windows and ages."""
    state = replace(model.state, weather_windows=command.windows)
    for station in filter(None, (model.measured, model.made_up)):
        station.judge_by(command.windows)
    told = N_("The averaging windows and maximum ages of the weather data were set.")
    return await _keep(model, state, told, actor)


def made_up_station(model: SiteModel) -> SimulatedStation:
    """Return the station that makes the weather up, or raise `CommandRejected` where none does."""
    station = model.state.simulated_weather
    if station is None:
        raise CommandRejected(NEEDS_MADE_UP)
    return station


async def play(model: SiteModel, fault: WeatherFault | None, event: Event) -> None:
    """Play something on the made-up station from now on, None: nothing any more; stored with its event."""
    station = made_up_station(model)
    played = None if fault is None else PlayedWeather(fault, model.now())
    state = replace(model.state, simulated_weather=replace(station, played=played))
    await model.ledger.save_site(state, (event,))
    model.state = state
    await model.met.follow(model.station)


def _begin(station: SimulatedStation, now: datetime) -> datetime:
    return now if station.begun_at is None else station.begun_at


def _refuse_for_real_trackers(model: SiteModel) -> None:
    reasons = tuple(
        Reason(
            "not_simulated",
            say(
                "{tracker_id} is not simulated; simulated weather must not move it.",
                tracker_id=loop.config.tracker_id,
            ),
            N_("Simulated weather is only for sites where every tracker is simulated."),
        )
        for loop in model.loops.values()
        if loop.config.drive.kind is not DriveKind.SIMULATED
    )
    if reasons:
        raise CommandRejected(*reasons)


async def _follow(model: SiteModel, state: SiteState, told: Message, actor: str) -> tuple[Event, ...]:
    """Store the choice and read the station that it names; made-up and measured values are never mixed."""
    mixed = (state.simulated_weather is None) is not (model.state.simulated_weather is None)
    events = await _keep(model, state, told, actor)
    await model.met.close()
    if mixed:
        made_up = state.simulated_weather is not None
        model.made_up = WeatherStation(model.measured.windows, simulated=True) if made_up else None
    await model.met.follow(model.station)
    return events


async def _keep(model: SiteModel, state: SiteState, told: Message, actor: str) -> tuple[Event, ...]:
    event = model.event(EventKind.WEATHER_STATION_SET, told, actor)
    await model.ledger.save_site(state, (event,))
    model.state = state
    return (event,)
