"""Orders about the weather: what is reported, which station is read, and how values are judged."""

from dataclasses import replace
from datetime import datetime
from typing import assert_never

from app.hosts import checked_host
from app.link.weather_orders import (
    ReportWeather,
    SetMetStation,
    SetWeatherWindows,
    SimulateWeather,
    WeatherOrder,
)
from app.site.model import SiteModel
from app.site.weather import WeatherStation
from app.tracker.commands import CommandRejected
from app.tracker.config import DriveKind, TrackerConfig
from app.tracker.memory import MetStation, SiteState
from app.tracker.reason import Reason
from app.tracker.simulated_weather import PlayedWeather, SimulatedStation, WeatherFault
from app.tracker.snapshot import Event, EventKind

IS_SIMULATED = Reason(
    "weather_simulated",
    "The site's weather is SIMULATED; measured weather is not accepted.",
    "Switch the simulated weather off on the Site page first.",
)
NEEDS_MADE_UP = Reason(
    "weather_not_simulated",
    "The site's weather is not simulated, so weather and sensor faults cannot be injected.",
    "Simulate the weather first, on this page or on the Site page.",
)
NEEDS_SIMULATED = Reason(
    "weather_simulated",
    "The site's weather is SIMULATED and must not move a real tracker.",
    "Switch the simulated weather off on the Site page first.",
)


async def carry_out(model: SiteModel, command: WeatherOrder, actor: str) -> tuple[Event, ...]:
    """Carry out one order about the weather, stored before this returns, and return what happened."""
    match command:
        case ReportWeather():
            return await _report(model, command, actor)
        case SetMetStation():
            return await _set_station(model, command.station, actor)
        case SimulateWeather():
            return await _simulate(model, command.station, actor)
        case SetWeatherWindows():
            state = replace(model.state, weather_windows=command.windows)
            for station in filter(None, (model.measured, model.made_up)):
                station.judge_by(command.windows)
            return await _keep(
                model, state, ("The averaging windows and maximum ages of the weather data were set."), actor
            )
        case _:
            assert_never(command)


def refuse_real(model: SiteModel, config: TrackerConfig) -> None:
    """Raise `CommandRejected` if this tracker is real while the site's weather is made up."""
    if model.state.simulated_weather is not None and config.drive.kind is not DriveKind.SIMULATED:
        raise CommandRejected(NEEDS_SIMULATED)


async def _report(model: SiteModel, command: ReportWeather, actor: str) -> tuple[Event, ...]:
    """Take a report at once; one that demands a stow is on disk before this returns."""
    if model.state.simulated_weather is not None:
        raise CommandRejected(IS_SIMULATED)
    model.measured.receive(command.readings, command.measured_at, actor, model.now(), model.clock.now())
    model.rouse()
    model.keep_weather()
    await model.weather_file.written()
    return ()


async def _set_station(model: SiteModel, station: MetStation | None, actor: str) -> tuple[Event, ...]:
    told = "No weather station is read now."
    if station is not None:
        checked_host(station.host)
        told = f"The weather station {station.name} is now read."
    made_up = model.state.simulated_weather if station is None else None
    state = replace(model.state, met_station=station, simulated_weather=made_up)
    return await _follow(model, state, told, actor)


async def _simulate(model: SiteModel, station: SimulatedStation | None, actor: str) -> tuple[Event, ...]:
    if station is None:
        state = replace(model.state, simulated_weather=None)
        return await _follow(model, state, "The weather is no longer simulated.", actor)
    _refuse_for_real_trackers(model)
    begun = replace(station, begun_at=_begin(station, model.now()))
    state = replace(model.state, simulated_weather=begun, met_station=None)
    told = f"The weather is now SIMULATED: {station.scenario.value.replace('_', ' ')}."
    return await _follow(model, state, told, actor)


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
            f"{loop.config.tracker_id} is not simulated; simulated weather must not move it.",
            "Simulated weather is only for sites where every tracker is simulated.",
        )
        for loop in model.loops.values()
        if loop.config.drive.kind is not DriveKind.SIMULATED
    )
    if reasons:
        raise CommandRejected(*reasons)


async def _follow(model: SiteModel, state: SiteState, told: str, actor: str) -> tuple[Event, ...]:
    """Store the choice and read the station that it names; made-up and measured values are never mixed."""
    mixed = (state.simulated_weather is None) is not (model.state.simulated_weather is None)
    events = await _keep(model, state, told, actor)
    await model.met.close()
    if mixed:
        made_up = state.simulated_weather is not None
        model.made_up = WeatherStation(model.measured.windows, simulated=True) if made_up else None
    await model.met.follow(model.station)
    return events


async def _keep(model: SiteModel, state: SiteState, told: str, actor: str) -> tuple[Event, ...]:
    event = model.event(EventKind.WEATHER_STATION_SET, told, actor)
    await model.ledger.save_site(state, (event,))
    model.state = state
    return (event,)
