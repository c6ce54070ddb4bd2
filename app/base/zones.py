"""Time zones for display: a computer without the zones of the world shows UTC and says so."""

from datetime import UTC, date, datetime, tzinfo
from functools import lru_cache
from zoneinfo import ZoneInfo, ZoneInfoNotFoundError

from app.base.instants import FIRST_YEAR, LAST_YEAR

FIRST_DAY, LAST_DAY = date(FIRST_YEAR + 1, 1, 1), date(LAST_YEAR - 1, 12, 31)
PLACES = ("Europe/London", "America/New_York", "Asia/Tokyo")
"""Zones that every database of time zones has."""


@lru_cache(maxsize=1024)
def zone_of(name: str) -> tzinfo:
    """Return the time zone of this name; UTC where this computer does not have it."""
    try:
        return ZoneInfo(name)
    except (ZoneInfoNotFoundError, ValueError, OSError):
        return UTC


def day_in(zone: str, at: datetime) -> date:
    """Return the date of a zone at an instant, or the nearest with a known sun in the year around it.

    What shows the sun of today lives on with a clock that is far off; the clock's own state says that it is.
    """
    return min(max(at.astimezone(zone_of(zone)).date(), FIRST_DAY), LAST_DAY)


def shown_zone(name: str) -> str:
    """Return the name of the zone in which times are shown: UTC where this computer does not have it."""
    return "UTC" if zone_of(name) is UTC else name


def zones_missing() -> bool:
    """Return whether this computer has no database of time zones at all."""
    return all(zone_of(name) is UTC for name in PLACES)
