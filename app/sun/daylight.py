"""When there is daylight: from a sunrise to the sunset after it, and the next day that has enough of it."""

from datetime import UTC, datetime, timedelta

import numpy as np

from app.sun.events import crossings
from app.sun.position import END_UNIX_S, RISE_ELEVATION_DEG, Algorithm, Location, sun_path

DAY = timedelta(days=1)
YEAR = timedelta(days=370)
STEP = timedelta(minutes=20)


def daylight(
    algorithm: Algorithm, location: Location, begin: datetime, end: datetime
) -> tuple[datetime, datetime] | None:
    """Return the first sunrise between two aware instants and the sunset that follows it, aware UTC.

    None where the sun does not rise, or then stays up for longer than a day. Raises `InstantRefused` as
    `crossings` does.
    """
    rise = next((found.at for found in crossings(algorithm, location, begin, end) if found.rising), None)
    if rise is None:
        return None
    after = crossings(algorithm, location, rise, rise + DAY)
    return next(((rise, found.at) for found in after if not found.rising), None)


def next_daylight(
    algorithm: Algorithm, location: Location, after: datetime, least: timedelta = timedelta(hours=1)
) -> datetime | None:
    """Return when, within a year, the sun comes up next and stays up for `least`; None if that is not known.

    True to 20 minutes: it tells the day, not the sunrise.
    """
    step_s = STEP.total_seconds()
    last_s = min(after.timestamp() + YEAR.total_seconds(), END_UNIX_S - 1.0)
    at_unix_s = np.arange(after.timestamp(), last_s, step_s)
    steps = int(least / STEP) + 1
    if len(at_unix_s) < steps:
        return None
    up = sun_path(algorithm, location, at_unix_s).elevation_deg >= RISE_ELEVATION_DEG
    long = np.lib.stride_tricks.sliding_window_view(up, steps).all(axis=1)
    return datetime.fromtimestamp(float(at_unix_s[long.argmax()]), UTC) if long.any() else None
