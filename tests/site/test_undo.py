"""The last change of settings, and a home position that was set by mistake, are undone: all is as before."""

from dataclasses import replace

import pytest

from app.link.alarm_orders import SetNotifications
from app.link.messages import ConfigureTracker, RemoveTracker, RenameSite, SiteCommand
from app.link.place_orders import SetHorizon
from app.link.settings_orders import LockSettings, UndoSettings, UndoSiteSettings
from app.link.weather_orders import SetMetStation, SetWeatherWindows, SimulateWeather
from app.sun.horizon import Horizon
from app.tracker.commands.commands import CommandRejected, Move, SetHome, Step, UndoHome
from app.tracker.memory.memory import MetStation, SiteState
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import Orientation, TrackerConfig
from app.tracker.state.snapshot import ActivityName, AxisState, EventKind, Snapshot
from app.tracker.values.notifications import Notifications
from app.tracker.weather.simulated_weather import SimulatedStation
from app.tracker.weather.weather_windows import WeatherWindows
from tests.site.plant import Begun, Plant
from tests.site.tracking_field import Stands, homed

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
        (SetMetStation(STATION), SimulateWeather(SIMULATED)),
        (SimulateWeather(SIMULATED), SetMetStation(STATION)),
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
    for _ in range(2):
        await plant.ask(RenameSite("Hill field"))
    await plant.ask(UndoSiteSettings())
    assert plant.site.model.state.name == first


def config(plant: Plant) -> TrackerConfig:
    return plant.site.model.tracker("T1").config


async def test_the_last_change_of_a_tracker_is_undone_and_redone_unless_it_is_locked(plant: Plant) -> None:
    with pytest.raises(CommandRejected, match="no stored settings change to undo"):
        await plant.ask(UndoSettings("T1"))
    second = replace(config(plant), deadband_deg=1.5, park=Orientation(90.0, 45.0))
    await plant.ask(ConfigureTracker(second))
    other_axis = replace(second, azimuth=replace(second.azimuth, maximum_deg=300.0))
    await plant.ask(ConfigureTracker(other_axis))
    await plant.ask(UndoSettings("T1"))
    assert config(plant) == second
    await plant.ask(UndoSettings("T1"))
    assert config(plant) == other_axis
    await plant.ask(LockSettings("T1"))
    with pytest.raises(CommandRejected, match="locked"):
        await plant.ask(UndoSettings("T1"))
    assert config(plant) == other_axis


async def test_a_removed_tracker_leaves_nothing_to_undo(plant: Plant) -> None:
    await plant.ask(ConfigureTracker(replace(config(plant), deadband_deg=1.5)))
    await plant.ask(RemoveTracker("T1"))
    assert plant.site.model.state.former == {}


def angles(seen: Snapshot) -> tuple[float, float]:
    assert seen.measured is not None
    return round(seen.measured.azimuth_deg, 1), round(seen.measured.elevation_deg, 1)


async def set_here(plant: Plant) -> None:
    await plant.ask(SetHome())
    await plant.until(lambda seen: seen.activity is ActivityName.HOLDING and seen.homed)
    assert angles(plant.tracker()) == (0.0, 0.0)


async def test_a_home_position_is_undone_with_its_angles_and_who_set_it(begun: Begun) -> None:
    plant = await begun(homed(memory=Stands(102.4, 36.6)))
    await plant.forward(seconds=0.3)
    before = plant.tracker()
    assert angles(before) == (102.4, 36.6)
    await set_here(plant)
    assert plant.tracker().can_undo_home
    await plant.ask(UndoHome())
    await plant.forward(seconds=2.0)
    now = plant.tracker()
    assert angles(now) == (102.4, 36.6)
    assert (now.home, now.homed, now.fault) == (before.home, True, None)
    assert [event.actor for event in plant.happened(EventKind.HOME_POSITION_UNDONE)] == ["technician"]
    with pytest.raises(CommandRejected, match="no former home position"):
        await plant.ask(UndoHome())

    await plant.ask(Move(Orientation(110.0, 40.0)))
    await plant.until(lambda seen: seen.in_position and seen.activity is ActivityName.HOLDING)
    assert angles(plant.tracker()) == (110.0, 40.0)
    read = await plant.drives["T1"].read()
    assert read.azimuth.position_deg == pytest.approx(110.0 - 102.4, abs=0.1)
    assert read.elevation.position_deg == pytest.approx(40.0 - 36.6, abs=0.1)
    await set_here(plant)
    assert plant.site.model.tracker("T1").memory.home_shift.azimuth_deg == 0.0


async def test_a_home_position_is_not_undone_where_the_axes_have_moved_since(ready: Plant) -> None:
    await set_here(ready)
    await ready.ask(Step(Axis.ELEVATION, 1.0))
    await ready.until(lambda seen: seen.activity is ActivityName.HOLDING and angles(seen) == (0.0, 1.0))
    assert not ready.tracker().can_undo_home
    with pytest.raises(CommandRejected, match="have moved since"):
        await ready.ask(UndoHome())
    assert angles(ready.tracker()) == (0.0, 1.0)


async def test_an_axis_that_was_not_homed_before_is_not_shown_as_homed_again(plant: Plant) -> None:
    await plant.ask(Step(Axis.AZIMUTH, 5.0))
    await plant.until(lambda seen: seen.activity is ActivityName.HOLDING)
    await set_here(plant)
    assert [axis.homed for axis in axes(plant)] == [True, True]
    await plant.ask(UndoHome())
    await plant.forward(seconds=1.0)
    assert not plant.tracker().homed
    assert [axis.homed for axis in axes(plant)] == [False, False]


def axes(plant: Plant) -> list[AxisState]:
    seen = plant.tracker()
    return [axis for axis in (seen.azimuth, seen.elevation) if axis is not None]
