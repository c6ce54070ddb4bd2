"""Places, trackers and shows that the tests of shows share."""

from dataclasses import replace
from datetime import UTC, datetime, timedelta
from typing import Any

from app.sun.events import day_events
from app.sun.position import Algorithm, Location
from app.tracker.programs.show import ShowPlan
from app.tracker.settings.axes import AxisConfig
from app.tracker.settings.config import TrackerConfig

DAY = timedelta(days=1)
SAMSUN = Location(41.2867, 36.33)
SVALBARD = Location(78.0, 15.0)
SYDNEY = Location(-34.0, 151.0)
TROPIC = Location(23.0, 36.0)
PLAIN = TrackerConfig("t01", "T01")


def utc(year: int, month: int, day: int, hour: int = 0, minute: int = 0) -> datetime:
    return datetime(year, month, day, hour, minute, tzinfo=UTC)


def with_range(minimum_deg: float, maximum_deg: float) -> TrackerConfig:
    return replace(PLAIN, azimuth=AxisConfig(minimum_deg, maximum_deg, 6.0, 6.0, 0.5, 3.0))


def show(location: Location, begin: datetime, end: datetime, seconds: float, **more: Any) -> ShowPlan:
    return ShowPlan("s01", begin, end, timedelta(seconds=seconds), location, **more)


def daylight(location: Location, begin: datetime, seconds: float) -> ShowPlan:
    """Return a show from sunrise to sunset of the day that begins at an instant."""
    found = day_events(Algorithm.PSA, location, begin, begin + DAY)
    assert found.rise is not None
    assert found.set is not None
    return show(location, found.rise, found.set, seconds)


SOLSTICE = daylight(SAMSUN, utc(2026, 6, 21), 180.0)
ACROSS_MIDNIGHT = show(SAMSUN, utc(2026, 6, 21, 12), utc(2026, 6, 22, 9), 180.0)
ZENITH_DAY = daylight(TROPIC, utc(2026, 7, 2), 180.0)
SOUTH = daylight(SYDNEY, utc(2026, 7, 10, 14), 300.0)
