"""Days as the papers of the simple algorithms count them: from 1 January, and from that of a leap year.

Valid from 1901 to 2099, in which every fourth year is a leap year. The papers take the day from the clock
on the wall; here it is the day of local mean solar time (longitude / 15 hours from UT), which needs no time
zone and changes at night.
"""

from app.sun.trigonometry import T, Trigonometry

CYCLE_DAYS = 1461.0
CYCLE_BEGIN_DAYS = 731.0
"""Days from 1968-01-01, the first day of a leap year, to 1970-01-01."""


def day_and_hour(unix_s: T, longitude_deg: float, trig: Trigonometry[T]) -> tuple[T, T]:
    """Return the day, counted from 1970-01-01, and the hour in [0, 24) of local mean solar time."""
    days = unix_s / 86400.0 + longitude_deg / 360.0
    day = trig.floor(days)
    return day, (days - day) * 24.0


def day_of_cycle(day: T, trig: Trigonometry[T]) -> T:
    """Return N, 1 on 1 January of a leap year to 1461 on 31 December before the next."""
    return trig.wrap(day + CYCLE_BEGIN_DAYS, CYCLE_DAYS) + 1.0


def day_of_year(day: T, trig: Trigonometry[T]) -> T:
    """Return n, 1 on 1 January to 365 or 366 on 31 December."""
    gone = day_of_cycle(day, trig) - 1.0
    years = trig.floor(gone / 365.25)
    return gone + trig.floor(-365.25 * years) + 1.0
