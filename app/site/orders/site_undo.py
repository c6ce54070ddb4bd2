"""The last change of what is set for the whole site: one order undoes it, and the same order redoes it."""

from collections.abc import Awaitable, Callable, Iterator
from dataclasses import replace

from app.link.alarm_orders import SetNotifications
from app.link.messages import RenameSite, SiteCommand
from app.link.place_orders import SetHorizon
from app.link.weather_orders import SetMetStation, SetWeatherWindows, SimulateWeather
from app.site.orders.tracker_setup import NOTHING_TO_UNDO
from app.site.state.model import SiteModel
from app.tracker.commands.commands import CommandRejected
from app.tracker.memory.memory import SiteSettings
from app.tracker.state.snapshot import Event

Obey = Callable[[SiteCommand], Awaitable[tuple[Event, ...]]]


async def change(model: SiteModel, command: SiteCommand, obey: Obey) -> tuple[Event, ...]:
    """Carry out an order; what was set before is stored with what it changes, unless it changes nothing."""
    before, former = _settings(model), model.state.former_site
    model.state = replace(model.state, former_site=before)
    try:
        return await obey(command)
    finally:
        if _settings(model) == before:
            model.state = replace(model.state, former_site=former)


async def undo(model: SiteModel, obey: Obey) -> tuple[Event, ...]:
    """Set the site as it was before its last change; once more goes forth again.

    Raises `CommandRejected` if nothing was changed, or if what was is not allowed any more.
    """
    former = model.state.former_site
    if former is None:
        raise CommandRejected(NOTHING_TO_UNDO)
    done: tuple[Event, ...] = ()
    for command in _way_back(_settings(model), former):
        done += await change(model, command, obey)
    return done


def _settings(model: SiteModel) -> SiteSettings:
    state = model.state
    station = state.simulated_weather
    return SiteSettings(
        name=state.name,
        horizon=state.horizon,
        met_station=state.met_station,
        simulated_weather=None if station is None else replace(station, played=None),
        weather_windows=model.weather.windows,
        notifications=state.notifications,
    )


def _way_back(now: SiteSettings, former: SiteSettings) -> Iterator[SiteCommand]:
    """Return the orders that set again what was; a change touches one of these, so that there is one."""
    if now.name != former.name:
        yield RenameSite(former.name)
    if now.horizon != former.horizon:
        yield SetHorizon(former.horizon)
    if now.weather_windows != former.weather_windows:
        yield SetWeatherWindows(former.weather_windows)
    if now.notifications != former.notifications:
        yield SetNotifications(former.notifications)
    if (now.met_station, now.simulated_weather) != (former.met_station, former.simulated_weather):
        yield _weather_order(now, former)


def _weather_order(now: SiteSettings, former: SiteSettings) -> SiteCommand:
    """Return the order for where the weather came from: made up, a station, or neither of the two."""
    if former.simulated_weather is not None or now.met_station == former.met_station:
        return SimulateWeather(former.simulated_weather)
    return SetMetStation(former.met_station)
