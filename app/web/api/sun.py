"""Where the sun stands, and its path over a day."""

import csv
import io
from collections.abc import Iterable
from datetime import UTC, date, datetime, time, timedelta
from enum import StrEnum
from typing import Annotated

import numpy as np
from fastapi import Query
from fastapi.responses import Response
from pydantic import Field

from app.base.instants import Day, Instant
from app.base.message import N_, say
from app.base.permission import Permission
from app.base.zones import day_in, zone_of
from app.sun.accuracy import FIRST_YEAR, LAST_YEAR
from app.sun.algorithms import PUBLISHED
from app.sun.events import PolarDay, day_events
from app.sun.position import Algorithm, InstantRefused, Location, sun_path, sun_position
from app.tracker.commands.commands import CommandRejected
from app.tracker.state.snapshot import SiteSnapshot
from app.tracker.values.reason import Reason
from app.web.api.base import REFUSED, Output, Responses, api_router
from app.web.http.needs import needs
from app.web.shell.deps import SnapshotDep

router = api_router(prefix="/sun", tags=["sun"])

NO_LOCATION = Reason(
    "location_not_set",
    N_("The site's location is not known."),
    N_("Set the location in step 1: PUT /api/v1/site/location."),
)
AlgorithmQuery = Annotated[
    Algorithm,
    Query(
        description="Published algorithm, and its error with the sun up, 2000 to 2049: "
        + "; ".join(f"`{algorithm}` up to {one.max_deg:g} degrees" for algorithm, one in PUBLISHED.items())
        + "."
    ),
]
CSV: Responses = {
    200: {"content": {"text/csv": {"schema": {"type": "string"}}}, "description": "As JSON or as CSV."}
}


class TextFormat(StrEnum):
    """How a table is written."""

    JSON = "json"
    CSV = "csv"


class SunNow(Output):
    """The sun at one instant, azimuth clockwise from true north."""

    at: datetime
    algorithm: Algorithm
    location: Location
    azimuth_deg: float
    elevation_deg: float = Field(description="True elevation, without refraction.")
    apparent_elevation_deg: float = Field(description="With refraction.")
    is_up: bool = Field(description="Its upper limb is above the horizon.")


class SunPoint(Output):
    """One point of the path."""

    at: datetime
    azimuth_deg: float
    elevation_deg: float
    apparent_elevation_deg: float


class SunDay(Output):
    """A civil day of the site. `rise` and `set` are None where there is none; `polar` says why."""

    date: date
    time_zone: str
    start: datetime
    end: datetime
    algorithm: Algorithm
    rise: datetime | None
    transit: datetime | None
    set: datetime | None
    transit_elevation_deg: float | None
    polar: PolarDay | None
    step_s: int
    path: list[SunPoint]


@router.get("", summary="The sun at an instant", responses=REFUSED)
@needs(Permission.READ)
async def read_sun(
    site: SnapshotDep,
    at: Annotated[Instant | None, Query(description="With offset; left out: now.")] = None,
    algorithm: AlgorithmQuery = Algorithm.PSA,
) -> SunNow:
    """Return the sun's place over the site."""
    place, instant = location_of(site), at or site.at
    sun = sun_position(algorithm, place, instant)
    return SunNow(
        at=instant,
        algorithm=algorithm,
        location=place,
        azimuth_deg=sun.azimuth_deg,
        elevation_deg=sun.elevation_deg,
        apparent_elevation_deg=sun.apparent_elevation_deg,
        is_up=sun.is_up,
    )


@router.get("/day", summary="The sun's path over a day", response_model=SunDay, responses=REFUSED | CSV)
@needs(Permission.READ)
def read_sun_day(
    site: SnapshotDep,
    date: Annotated[Day | None, Query(description="Civil date of the site; left out: today.")] = None,
    step_s: Annotated[int, Query(ge=10, le=21600, description="Seconds between points.")] = 300,
    algorithm: AlgorithmQuery = Algorithm.PSA,
    format: TextFormat = TextFormat.JSON,
) -> SunDay | Response:
    """Return rise, transit, set and the path, as JSON or as CSV."""
    day = sun_day(site, date or day_in(site.time_zone, site.at), step_s, algorithm)
    return day if format is TextFormat.JSON else Response(_csv(day.path), media_type="text/csv")


def location_of(site: SiteSnapshot) -> Location:
    """Return where the site is, or refuse with the sentence that says how to set it."""
    if site.location is None:
        raise CommandRejected(NO_LOCATION)
    return site.location


def midnights(day: date, time_zone: str) -> tuple[datetime, datetime]:
    """Return the instants at which a civil day begins and ends, or raise `InstantRefused`."""
    if not FIRST_YEAR <= day.year <= LAST_YEAR:
        raise InstantRefused(
            say(
                "Sun positions are available for the years {first_year} to {last_year}, not for {day}.",
                first_year=FIRST_YEAR,
                last_year=LAST_YEAR,
                day=day,
            )
        )
    zone = zone_of(time_zone)
    begin, end = (datetime.combine(one, time(), zone) for one in (day, day + timedelta(days=1)))
    return begin.astimezone(UTC), end.astimezone(UTC)


def sun_day(site: SiteSnapshot, day: date, step_s: int, algorithm: Algorithm) -> SunDay:
    """Return the sun of one civil day of the site."""
    place = location_of(site)
    begin, end = midnights(day, site.time_zone)
    events = day_events(algorithm, place, begin, end)
    return SunDay(
        date=day,
        time_zone=site.time_zone,
        start=begin,
        end=end,
        algorithm=algorithm,
        rise=events.rise,
        transit=events.transit,
        set=events.set,
        transit_elevation_deg=events.transit_elevation_deg,
        polar=events.polar,
        step_s=step_s,
        path=_path(algorithm, place, begin, end, step_s),
    )


def _path(
    algorithm: Algorithm, place: Location, begin: datetime, end: datetime, step_s: int
) -> list[SunPoint]:
    unix_s = np.arange(begin.timestamp(), end.timestamp() + 0.5, step_s, dtype=np.float64)
    path = sun_path(algorithm, place, unix_s)
    columns = (unix_s, path.azimuth_deg, path.elevation_deg, path.apparent_elevation_deg)
    return [
        SunPoint(
            at=datetime.fromtimestamp(at, UTC), azimuth_deg=az, elevation_deg=el, apparent_elevation_deg=up
        )
        for at, az, el, up in zip(*(column.tolist() for column in columns), strict=True)
    ]


def _csv(points: Iterable[SunPoint]) -> str:
    text = io.StringIO()
    table = csv.writer(text)
    table.writerow(("at", "azimuth_deg", "elevation_deg", "apparent_elevation_deg"))
    for point in points:
        angles = (point.azimuth_deg, point.elevation_deg, point.apparent_elevation_deg)
        table.writerow((point.at.isoformat(), *(f"{angle:.6f}" for angle in angles)))
    return text.getvalue()
