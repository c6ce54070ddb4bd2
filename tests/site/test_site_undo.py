"""The last change of what is set for the site is undone by one order, and that by the same order."""

from dataclasses import replace

import pytest

from app.link.alarm_orders import SetNotifications
from app.link.messages import RenameSite, SiteCommand
from app.link.place_orders import SetHorizon
from app.link.settings_orders import UndoSiteSettings
from app.link.weather_orders import SetMetStation, SetWeatherWindows, SimulateWeather
from app.sun.horizon import Horizon
from app.tracker.commands.commands import CommandRejected
from app.tracker.memory.memory import MetStation, SiteState
from app.tracker.values.notifications import Notifications
from app.tracker.weather.simulated_weather import SimulatedStation
from app.tracker.weather.weather_windows import WeatherWindows
from tests.site.plant import Plant

STATION = MetStation("192.0.2.7")
SIMULATED = SimulatedStation(seed=7)
WALL = Horizon(((90.0, 8.0), (180.0, 3.0)))


def settings(plant: Plant) -> SiteState:
    """Return what is stored of the site without what can be undone."""
    state = replace(plant.site.model.state, former_site=None)
    return replace(state, weather_windows=plant.site.model.weather.windows)


@pytest.mark.parametrize(
    ("before", "command"),
    [
        (None, RenameSite("Hill field")),
        (None, SetHorizon(WALL)),
        (None, SetWeatherWindows(WeatherWindows(gust_s=5.0))),
        (None, SetNotifications(Notifications(mail_to=("operator@example.com",)))),
        (None, SetMetStation(STATION)),
        (None, SimulateWeather(SIMULATED)),
        (SetMetStation(STATION), SetMetStation(None)),
        (SetMetStation(STATION), SimulateWeather(SIMULATED)),
        (SimulateWeather(SIMULATED), SetMetStation(STATION)),
        (SimulateWeather(SIMULATED), SimulateWeather(None)),
    ],
)
async def test_every_change_of_the_site_is_undone_and_redone(
    before: SiteCommand | None, command: SiteCommand, plant: Plant
) -> None:
    if before is not None:
        await plant.ask(before)
    first = settings(plant)
    await plant.ask(command)
    second = settings(plant)
    assert second != first

    await plant.ask(UndoSiteSettings())
    assert settings(plant) == first
    await plant.ask(UndoSiteSettings())
    assert settings(plant) == second


async def test_a_repeated_value_is_no_change_and_leaves_what_can_be_undone(plant: Plant) -> None:
    with pytest.raises(CommandRejected, match="no stored settings change to undo"):
        await plant.ask(UndoSiteSettings())
    first = plant.site.model.state.name
    await plant.ask(RenameSite("Hill field"))
    await plant.ask(RenameSite("Hill field"))
    await plant.ask(UndoSiteSettings())
    assert plant.site.model.state.name == first
