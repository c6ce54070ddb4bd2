"""Time zones for display: a computer without the zones of the world shows UTC and says so."""

from datetime import UTC, tzinfo
from functools import lru_cache
from zoneinfo import ZoneInfo, ZoneInfoNotFoundError

PLACES = ("Europe/London", "America/New_York", "Asia/Tokyo")
"""Zones that every database of time zones has."""


@lru_cache(maxsize=1024)
def zone_of(name: str) -> tzinfo:
    """Return the time zone of this name; UTC where this computer does not have it."""
    try:
        return ZoneInfo(name)
    except (ZoneInfoNotFoundError, ValueError, OSError):
        return UTC


def shown_zone(name: str) -> str:
    """Return the name of the zone in which times are shown: UTC where this computer does not have it."""
    return "UTC" if zone_of(name) is UTC else name


def zones_missing() -> bool:
    """Return whether this computer has no database of time zones at all."""
    return all(zone_of(name) is UTC for name in PLACES)
