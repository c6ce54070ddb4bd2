"""Whether a location is likely to be mistaken: swapped numbers, a lost sign, another part of the Earth."""

from collections.abc import Iterator
from dataclasses import replace
from datetime import datetime, timedelta

from tzfpy import get_tz

from app.sun.position import Location
from app.zones import zone_of

SEA = "Etc/"
PLACELESS = ("UTC", SEA)
MOST_APART_H = 4.0
"""No land keeps a civil time so far from that of its sun; what western China keeps comes nearest."""
SAME_PLACE_DEG = 0.5


def swapped(place: Location) -> Location | None:
    """Return the place with latitude and longitude exchanged, None where that is no place."""
    if abs(place.longitude_deg) > 90.0:
        return None
    return replace(place, latitude_deg=place.longitude_deg, longitude_deg=place.latitude_deg)


def place_doubts(
    place: Location, time_zone: str, now: datetime, *, before: Location | None = None, device_zone: str = ""
) -> tuple[str, ...]:
    """Return what speaks against a location, as sentences; it may be right all the same.

    `before` is the location that is stored, `device_zone` what the clock of the device at hand keeps.
    """
    clocks = (time_zone, device_zone)
    return (*_swap_doubts(place, clocks, before), *_zone_doubts(place, time_zone, device_zone, now))


def _swap_doubts(place: Location, clocks: tuple[str, str], before: Location | None) -> Iterator[str]:
    other = swapped(place)
    if other is None:
        return
    if before is not None and _is_near(other, before) and not _is_near(place, before):
        yield "These are the numbers of the stored location with latitude and longitude exchanged."
    elif _zone_at(place).startswith(SEA) and not _zone_at(other).startswith(SEA):
        yield "This place lies in the sea; with latitude and longitude exchanged it lies on land."
    elif _zone_at(other) in clocks and _zone_at(place) not in clocks:
        yield f"With latitude and longitude exchanged the place lies where clocks keep {_zone_at(other)}."


def _zone_doubts(place: Location, time_zone: str, device_zone: str, now: datetime) -> Iterator[str]:
    if not time_zone.startswith(PLACELESS) and abs(_solar_difference_h(place, time_zone, now)) > MOST_APART_H:
        yield (
            f"At this longitude the sun is highest at {_solar_noon(place, time_zone, now)} by the clocks of "
            f"{time_zone}: look for a lost sign, or choose another time zone."
        )
    elif device_zone and abs(_solar_difference_h(place, device_zone, now)) > MOST_APART_H:
        yield (
            f"At this longitude the sun is highest at {_solar_noon(place, device_zone, now)} by the clock of "
            "this device: are you at the tracker?"
        )


def _zone_at(place: Location) -> str:
    return str(get_tz(place.longitude_deg, place.latitude_deg))


def _is_near(one: Location, other: Location) -> bool:
    return (
        abs(one.latitude_deg - other.latitude_deg) < SAME_PLACE_DEG
        and abs(one.longitude_deg - other.longitude_deg) < SAME_PLACE_DEG
    )


def _solar_difference_h(place: Location, time_zone: str, now: datetime) -> float:
    """Return by how many hours a zone's clocks are ahead of the mean sun of a place, from -12 to 12."""
    offset = now.astimezone(zone_of(time_zone)).utcoffset() or timedelta()
    ahead_h = offset / timedelta(hours=1) - place.longitude_deg / 15.0
    return (ahead_h + 12.0) % 24.0 - 12.0


def _solar_noon(place: Location, time_zone: str, now: datetime) -> str:
    minutes = round((12.0 + _solar_difference_h(place, time_zone, now)) * 60.0) % 1440
    return f"{minutes // 60:02d}:{minutes % 60:02d}"
