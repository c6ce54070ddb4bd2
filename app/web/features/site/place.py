"""Whether a location is likely to be mistaken: swapped numbers, a lost sign, another part of the Earth."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from datetime import datetime, timedelta
from enum import IntEnum, StrEnum, auto
from math import asin, cos, radians, sin, sqrt

from app.base.message import N_, Message, say, with_format
from app.base.startup import late
from app.base.zones import zone_of
from app.link.messages import SiteDetail
from app.sun.position import Location
from app.tracker.access.location_change import against_another_location, doing
from app.tracker.commands.commands import CommandRejected
from app.tracker.state.snapshot import SiteSnapshot

SEA = "Etc/"
PLACELESS = ("UTC", SEA)
MOST_APART_H = 4.0
"""No land keeps a civil time so far from that of its sun; what western China keeps comes nearest."""
SAME_PLACE_DEG = 0.5
FAR_KM = 100.0
EARTH_KM = 6371.0


class Mistake(StrEnum):
    """How a location is likely to be mistaken, and so what the right one is."""

    EAST_WEST = "east_west"
    NORTH_SOUTH = "north_south"
    SWAPPED = "swapped"


@dataclass(frozen=True, slots=True)
class Doubt:
    """What speaks against a location; the likely mistake and the location without it where they are known."""

    sentence: Message
    mistake: Mistake | None = None
    other: Location | None = None


class _Likelier(IntEnum):
    """Why another place is likelier than the one that was given, the strongest reason first."""

    STORED = auto()
    CLOCKS = auto()
    LAND = auto()


def mended(place: Location, mistake: Mistake) -> Location | None:
    """Return a location without a mistake, None where that is no place."""
    match mistake:
        case Mistake.EAST_WEST:
            return replace(place, longitude_deg=-place.longitude_deg)
        case Mistake.NORTH_SOUTH:
            return replace(place, latitude_deg=-place.latitude_deg)
        case Mistake.SWAPPED:
            return swapped(place)


def swapped(place: Location) -> Location | None:
    """Return the place with latitude and longitude exchanged, None where that is no place."""
    if abs(place.longitude_deg) > 90.0:
        return None
    return replace(place, latitude_deg=place.longitude_deg, longitude_deg=place.latitude_deg)


def place_doubts(
    place: Location, time_zone: str, now: datetime, *, before: Location | None = None, device_zone: str = ""
) -> tuple[Doubt, ...]:
    """Return what speaks against a location; it may be right all the same.

    `before` is the location that is stored, `device_zone` what the clock of the device at hand keeps.
    """
    clocks = (time_zone, device_zone)
    mistaken = [*_side_doubts(place, device_zone, now, before), *_swap_doubts(place, clocks, before)]
    mistaken.sort(key=lambda one: one[0])
    others = (*_far_doubts(place, before), *_zone_doubts(place, time_zone, device_zone, now))
    if not mistaken and _is_sea(place):
        others = (N_("This location is in the sea."), *others)
    found = (Doubt(sentence, mistake, mended(place, mistake)) for _, mistake, sentence in mistaken)
    return (*found, *map(Doubt, others))


def _swap_doubts(
    place: Location, clocks: tuple[str, str], before: Location | None
) -> Iterator[tuple[_Likelier, Mistake, Message]]:
    other = swapped(place)
    if other is None:
        return
    if before is not None and _is_near(other, before) and not _is_near(place, before):
        said = N_("These are the coordinates of the stored location with latitude and longitude swapped.")
        yield _Likelier.STORED, Mistake.SWAPPED, said
    elif _zone_at(place).startswith(SEA) and not _zone_at(other).startswith(SEA):
        said = N_("This location is in the sea; with latitude and longitude swapped, it is on land.")
        yield _Likelier.LAND, Mistake.SWAPPED, said
    elif _zone_at(other) in clocks and _zone_at(place) not in clocks:
        said = say(
            "With latitude and longitude swapped, the location is in the time zone {other}.",
            other=_zone_at(other),
        )
        yield _Likelier.CLOCKS, Mistake.SWAPPED, said


def _side_doubts(
    place: Location, device_zone: str, now: datetime, before: Location | None
) -> Iterator[tuple[_Likelier, Mistake, Message]]:
    """Return that east and west, or north and south, are likely to be exchanged."""
    for mistake, sentences in SIDES.items():
        other = mended(place, mistake)
        likelier = other and _likelier(place, other, device_zone, now, before)
        if likelier and likelier in sentences:
            yield likelier, mistake, sentences[likelier]


def refuse_before_asking(location: Location, detail: SiteDetail, now: SiteSnapshot | None) -> None:
    """Raise `CommandRejected` where the site takes no other location now: it is in vain to ask about it."""
    if location == detail.site.location:
        return
    states = {tracker_id: tracker.state for tracker_id, tracker in detail.trackers.items()}
    if reasons := against_another_location(states, doing(now.trackers if now else ())):
        raise CommandRejected(*reasons)


SIDES = {
    Mistake.EAST_WEST: {
        _Likelier.STORED: N_("These are the coordinates of the stored location with east and west swapped."),
        _Likelier.CLOCKS: N_("With east and west swapped, the location is in the time zone of this device."),
        _Likelier.LAND: N_("This location is in the sea; with east and west swapped, it is on land."),
    },
    Mistake.NORTH_SOUTH: {
        _Likelier.STORED: N_(
            "These are the coordinates of the stored location with north and south swapped."
        ),
        _Likelier.CLOCKS: N_(
            "With north and south swapped, the location is in the time zone of this device."
        ),
    },
}
"""What is said of the other side; that it is on land says nothing where most of the half is sea."""


def _likelier(
    place: Location, other: Location, device_zone: str, now: datetime, before: Location | None
) -> _Likelier | None:
    if before is not None and _is_near(other, before) and not _is_near(place, before):
        return _Likelier.STORED
    if device_zone and not _is_sea(other):
        kept = _kept(device_zone, now)
        if _kept(_zone_at(other), now) == kept != _kept(_zone_at(place), now):
            return _Likelier.CLOCKS
    return _Likelier.LAND if _is_sea(place) and not _is_sea(other) else None


def _far_doubts(place: Location, before: Location | None) -> Iterator[Message]:
    """Return that the stored location is far away."""
    if before is None:
        return
    apart_km = round(_apart_km(place, before), -1)
    if apart_km > FAR_KM:
        yield say(
            "The stored location is {apart_km} km away.",
            apart_km=with_format(apart_km, ".0f"),
        )


def _apart_km(one: Location, other: Location) -> float:
    """Return the distance along the surface of a sphere."""
    north, other_north = radians(one.latitude_deg), radians(other.latitude_deg)
    east = radians(other.longitude_deg - one.longitude_deg)
    half = sin((other_north - north) / 2) ** 2 + cos(north) * cos(other_north) * sin(east / 2) ** 2
    return 2.0 * EARTH_KM * asin(sqrt(min(1.0, half)))


def _is_sea(place: Location) -> bool:
    return _zone_at(place).startswith(SEA)


def _zone_doubts(place: Location, time_zone: str, device_zone: str, now: datetime) -> Iterator[Message]:
    if not time_zone.startswith(PLACELESS) and abs(_solar_difference_h(place, time_zone, now)) > MOST_APART_H:
        yield (
            say(
                "Solar noon there is at {place} in the time zone {time_zone}: check sign and zone.",
                place=_solar_noon(place, time_zone, now),
                time_zone=time_zone,
            )
        )
    elif device_zone and abs(_solar_difference_h(place, device_zone, now)) > MOST_APART_H:
        yield (
            say(
                "Solar noon there is at {place} by the clock of this device: are you at the tracker?",
                place=_solar_noon(place, device_zone, now),
            )
        )


def _kept(time_zone: str, now: datetime) -> timedelta | None:
    """Return by how much the clocks of a zone are ahead of UTC."""
    return now.astimezone(zone_of(time_zone)).utcoffset()


def _zone_at(place: Location) -> str:
    return zone_at(place.latitude_deg, place.longitude_deg)


def zone_at(latitude_deg: float, longitude_deg: float) -> str:
    """Return the IANA time zone of a place, one of `Etc/` at sea."""
    return str(late("tzfpy").get_tz(longitude_deg, latitude_deg))


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
