"""What a location means before it is saved: today's sun there, and where the sun is now."""

from collections.abc import Sequence
from datetime import datetime, time, timedelta

from app.base.message import N_, NOTHING, Message
from app.base.zones import day_in, zone_of
from app.sun.events import PolarDay, SunEvents, day_events
from app.sun.position import Algorithm, InstantRefused, Location, sun_position
from app.web.features.site.location_contexts import LocationPreview, SunRow
from app.web.features.site.place import SEA, Mistake, zone_at
from app.web.features.site.site_map import label_of, side_of
from app.web.languages import pgettext
from app.web.shell.formats import UNKNOWN, angle, decimals, formatted, local, offset


def preview_of(
    place: Location, zone: str, algorithm: Algorithm, now: datetime, *, is_pair: bool
) -> LocationPreview:
    """Return today's sun at a place, in the local time of a zone."""
    midnight = datetime.combine(day_in(zone, now), time(), zone_of(zone))
    events = day_events(algorithm, place, midnight, midnight + timedelta(days=1))
    noon_deg = events.transit_elevation_deg
    return LocationPreview(
        is_pair=is_pair,
        normal=normal_form(place),
        zone=zone,
        zone_offset=offset(now, zone),
        rise=_time(events.rise, zone),
        transit=_time(events.transit, zone),
        set=_time(events.set, zone),
        noon_elevation=UNKNOWN if noon_deg is None else f"{decimals(noon_deg, 1)}°",
        polar=_polar(events),
    )


def sun_rows(
    places: Sequence[Location], mistake: Mistake | None, algorithm: Algorithm, now: datetime
) -> tuple[SunRow, ...]:
    """Return the sun now at the entered place and, while it is asked about, at the one that may be meant."""
    if not places:
        return (SunRow("place", "", UNKNOWN, UNKNOWN, is_down=False, zone=""),)
    if len(places) == 1:
        return (_row("place", "", places[0], algorithm, now),)
    kinds = ("doubted", "other")
    return tuple(
        _row(kind, _tag(place, mistake), place, algorithm, now)
        for kind, place in zip(kinds, places, strict=True)
    )


def _tag(place: Location, mistake: Mistake | None) -> str:
    """Return by what two places are told apart: the letter of the side, or the whole latitude."""
    if mistake in (Mistake.EAST_WEST, Mistake.NORTH_SOUTH):
        return side_of(place, mistake)
    return label_of(place, mistake)


def _row(kind: str, tag: str, place: Location, algorithm: Algorithm, now: datetime) -> SunRow:
    """Return the sun of one place, nothing of it while the clock shows years of no known sun."""
    name = zone_at(place.latitude_deg, place.longitude_deg)
    zone = N_("Open sea") if name.startswith(SEA) else name
    try:
        sun = sun_position(algorithm, place, now)
    except InstantRefused:
        return SunRow(kind, tag, UNKNOWN, UNKNOWN, is_down=False, zone=zone)
    height_deg = sun.apparent_elevation_deg
    return SunRow(kind, tag, angle(sun.azimuth_deg, 1), angle(height_deg, 1), height_deg <= 0.0, zone)


def normal_form(place: Location) -> str:
    """Return a place in degrees, minutes and seconds, as on a map."""
    return f"{_dms(place.latitude_deg, 'NS')}  {_dms(place.longitude_deg, 'EW')}"


def _dms(value_deg: float, sides: str) -> str:
    total = round(abs(value_deg) * 36000)
    minutes, tenths = divmod(total, 600)
    side = pgettext("compass", sides[value_deg < 0])
    return f"{minutes // 60}° {minutes % 60:02d}′ {formatted('%04.1f', tenths / 10)}″ {side}"


def _time(at: datetime | None, zone: str) -> str:
    return UNKNOWN if at is None else local(at, zone, "%H:%M")


def _polar(events: SunEvents) -> Message:
    match events.polar:
        case PolarDay.DAY:
            return N_("The sun does not set today: polar day.")
        case PolarDay.NIGHT:
            return N_("The sun does not rise today: polar night.")
        case None:
            return NOTHING
