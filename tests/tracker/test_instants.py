"""Instants at which clocks stumble, places without day or night: nothing moves that should not."""

from dataclasses import replace
from datetime import UTC, datetime, timedelta
from zoneinfo import ZoneInfo

import pytest

from app.site.weather.sky import Sky
from app.sun.position import Algorithm, Location
from app.tracker.commands.commands import Track
from app.tracker.state.snapshot import ActivityName, EventKind
from app.tracker.values.mode import Mode
from app.tracker.values.motion import DriveCommand
from tests.fault_result import VIRTUAL, FaultResult
from tests.tracker.plant import CONFIG, READY, SAMSUN, Plant
from tests.tracker.scripted import Scripted

AROUND = timedelta(seconds=15)
SUN_AND_DEADBAND_DEG = 1.2
"""How far an axis may turn in half a minute: one run of the deadband."""
SPITSBERGEN = Location(78.22, 15.65, 10.0)
SWITCHES = [
    ("Europe/Berlin", Location(52.52, 13.4), "2027-03-28T01:00", "2027-10-31T01:00"),
    ("America/New_York", Location(40.7, -74.0), "2027-03-14T07:00", "2027-11-07T06:00"),
    ("Australia/Lord_Howe", Location(-31.55, 159.08), "2027-10-02T15:30", "2027-04-03T15:00"),
    ("Antarctica/Troll", Location(-72.01, 2.53), "2027-03-28T01:00", "2027-10-31T01:00"),
]
ENDS = ["2027-07-01", "2028-02-29", "2036-02-07T06:28:16", "2038-01-19T03:14:08", "2099-12-28"]


def utc(text: str) -> datetime:
    return datetime.fromisoformat(text).replace(tzinfo=UTC)


def tracked_over(instant: datetime, location: Location) -> Plant:
    """Return a plant that follows the sun, having been looked at on both sides of an instant."""
    plant = Plant(replace(READY, mode=Mode.DUAL), at=instant - timedelta(seconds=90), location=location)
    plant.tick()
    plant.ask(Track())
    plant.forward(75.0)
    assert plant.clock.now() == instant - AROUND
    before, told = (plant.azimuth_deg, plant.elevation_deg), len(plant.events)
    plant.forward(30.0)
    assert plant.activity is ActivityName.TRACKING
    assert abs(plant.azimuth_deg - before[0]) < SUN_AND_DEADBAND_DEG
    assert abs(plant.elevation_deg - before[1]) < SUN_AND_DEADBAND_DEG
    assert len(plant.events) == told, "nothing happens that is worth telling"
    return plant


@pytest.mark.fault(29)
@pytest.mark.parametrize(("zone", "place", "on", "back"), SWITCHES)
def test_the_hour_at_which_clocks_are_put_on_or_back_moves_nothing(
    zone: str, place: Location, on: str, back: str, fault: FaultResult
) -> None:
    local = ZoneInfo(zone)
    for switch in (utc(on), utc(back)):
        just_before, just_after = (switch + timedelta(seconds=s) for s in (-1, 1))
        assert just_before.astimezone(local).utcoffset() != just_after.astimezone(local).utcoffset()
        tracked_over(switch, place)
    fault.prevented("the controller reckons in UTC alone")
    fault.shows_nothing("local time changes on the page, with its offset beside it")
    fault.recovers("nothing was lost")


@pytest.mark.fault(31)
@pytest.mark.fault(32)
@pytest.mark.parametrize("instant", ENDS)
def test_an_end_of_an_era_moves_nothing(instant: str, fault: FaultResult) -> None:
    tracked_over(utc(instant), SAMSUN)
    fault.prevented("no counter of the product ends with the era")
    fault.shows_nothing("nothing happens that is worth telling")
    fault.recovers("nothing was lost")


@pytest.mark.fault(33)
def test_in_the_polar_night_nothing_moves_and_nothing_is_waited_for(fault: FaultResult) -> None:
    plant = Plant(READY, at=datetime(2027, 12, 21, tzinfo=UTC), location=SPITSBERGEN, watchdog=None)
    plant.tick()
    plant.ask(Track())
    plant.forward(60.0)
    stood = (plant.azimuth_deg, plant.elevation_deg)
    for hour in range(0, 24, 2):
        plant.leap(datetime(2027, 12, 21, hour, 30, tzinfo=UTC))
        plant.forward(3.0)
        assert plant.activity is ActivityName.TRACKING
        assert (plant.azimuth_deg, plant.elevation_deg) == stood
    fault.prevented("no sunrise is waited for")
    (waits,) = plant.snapshot.waiting
    assert waits.code == "sun_down"
    fault.shows(waits.message)


@pytest.mark.fault(33)
def test_the_midnight_sun_is_followed_all_around_within_the_limits(fault: FaultResult) -> None:
    plant = Plant(READY, at=datetime(2027, 6, 21, tzinfo=UTC), location=SPITSBERGEN, watchdog=None)
    plant.tick()
    plant.ask(Track())
    plant.period = timedelta(seconds=0.4)
    faced = set()
    for hour in range(0, 24, 3):
        plant.leap(datetime(2027, 6, 21, hour, 30, tzinfo=UTC))
        plant.forward(30.0)
        assert plant.activity is ActivityName.TRACKING
        assert CONFIG.azimuth.beyond_deg(plant.azimuth_deg) < 1e-6
        faced.add(round(plant.azimuth_deg / 15.0))
    assert len(faced) == 8
    assert not plant.happened(EventKind.FAULT_RAISED)
    fault.recovers("automatic: when the sun rises")


@pytest.mark.fault(26)
@pytest.mark.parametrize(
    "by",
    [timedelta(hours=1), timedelta(hours=-1), timedelta(days=-365), timedelta(days=365)],
    ids=str,
)
def test_a_clock_that_jumps_moves_nothing_until_it_is_trusted(by: timedelta, fault: FaultResult) -> None:
    plant = tracked_over(datetime(2027, 6, 21, 9, 0, tzinfo=UTC), SAMSUN)
    plant.jump(by)
    jumped_at = plant.clock.now()
    plant.tick()
    assert plant.told == DriveCommand()
    plant.forward(2.0)
    stood = (plant.azimuth_deg, plant.elevation_deg)
    plant.forward(58.0)
    assert (plant.azimuth_deg, plant.elevation_deg) == stood
    assert plant.activity is ActivityName.TRACKING
    (waiting,) = plant.happened(EventKind.TRACKING_INTERRUPTED)
    fault.noticed((waiting.at - plant.clock_error - jumped_at).total_seconds(), VIRTUAL)
    fault.shows(waiting.message)
    plant.jump(-by)
    plant.clock_trusted = True
    plant.forward(10.0)
    assert plant.activity is ActivityName.TRACKING
    assert plant.snapshot.in_position
    fault.recovers("automatic: once the clock is trusted again")


@pytest.mark.fault(32)
def test_in_2100_the_sun_is_not_known_and_tracking_waits() -> None:
    leap_day_that_is_none = datetime(2100, 2, 28, 23, 59, 59, tzinfo=UTC)
    sky = Sky()
    assert sky.sun(SAMSUN, Algorithm.PSA, leap_day_that_is_none) is None
    assert sky.dawn(SAMSUN, Algorithm.PSA, leap_day_that_is_none) is None
    script = Scripted(READY)
    script.tick()
    script.ask(Track())
    script.sun = None
    script.tick()
    assert script.told == DriveCommand()
    assert script.snapshot.activity is ActivityName.HOLDING
    assert [reason.code for reason in script.snapshot.waiting] == ["sun_unknown"]
