"""C. Alexandru's energy results, recomputed (doi:10.3390/math12071034): Section 4, Tables 3 and 4.

The paper does not print the turbidity of the air. 3.000 gives its fixed panel; with that, its step program
comes out if energy is counted from 6 h to 18 h solar time. Its continuous tracking and its winter gains come
out with no turbidity: here stands what the model gives.
"""

from dataclasses import dataclass

from app.energy.equatorial import declination_deg
from app.energy.optimiser import Limits, best_steps
from app.energy.stepping import (
    SolarDay,
    Steps,
    clear_day,
    fixed_whm2,
    following_whm2,
    midpoint_h,
    stepped_whm2,
)

LATITUDE_DEG = 45.65
SOLSTICE = 172
PANEL_M2 = 1.26
EFFICIENCY = 0.15
DRIVES_WH = 11.53
SOLSTICE_TILT_DEG = 22.20
RANGE_DEG = 60.0
STEPS = 12
TABLE_3_STARTS_H = (7.88, 8.63, 9.42, 10.19, 10.93, 11.56, 12.44, 13.07, 13.81, 14.59, 15.37, 16.12)
TABLE_3_ANGLES_DEG = (60.0, 50.0, 40.0, 30.0, 20.0, 10.0, 0.0, -10.0, -20.0, -30.0, -40.0, -50.0, -60.0)
TABLE_4_DAYS = (17, 46, 75, 105, 135, 161, 198, 228, 259, 289, 319, 344)
MONTH_ENDS = (31, 59, 90, 120, 151, 181, 212, 243, 273, 304, 334, 365)
PER_WHM2 = PANEL_M2 * EFFICIENCY


@dataclass(frozen=True, slots=True)
class SolsticeEnergies:
    """Electric energy of the paper's panel on 21 June, Wh, with energy counted from 6 h to 18 h or all day.

    `gain_percent` is the net gain of Table 3's program in the counted hours against the fixed panel.
    """

    fixed_wh: float
    table_3_wh: float
    table_3_whole_day_wh: float
    continuous_wh: float
    continuous_whole_day_wh: float
    within_range_wh: float
    midpoint_wh: float
    optimum_wh: float
    optimum_without_range_wh: float
    gain_percent: float


@dataclass(frozen=True, slots=True)
class DayGain:
    """One row of Table 4: the representative day of a month, declinations in degrees, the gain in percent."""

    month: int
    day_of_year: int
    declination_deg: float
    month_declination_deg: float
    gain_percent: float


def table_3() -> Steps:
    """Return the program of Table 3; the paper's steps take no time in its energy figures."""
    return Steps(TABLE_3_STARTS_H, TABLE_3_ANGLES_DEG, SOLSTICE_TILT_DEG)


def gain_percent(tracked_wh: float, fixed_wh: float, drives_wh: float = DRIVES_WH) -> float:
    """Return the net energy gain against a fixed panel (eq 4), percent."""
    return 100.0 * (tracked_wh - (fixed_wh + drives_wh)) / fixed_wh


def paper_day(day_of_year: int = SOLSTICE, *, whole: bool = False) -> SolarDay:
    """Return a clear day at the paper's latitude; energy counts from 6 h to 18 h unless `whole`."""
    return clear_day(LATITUDE_DEG, day_of_year, declination_deg(day_of_year), whole=whole)


def solstice() -> SolsticeEnergies:
    """Return every energy of Section 4 that the model gives for the longest day."""
    counted, whole = paper_day(), paper_day(whole=True)
    fixed_wh = PER_WHM2 * fixed_whm2(whole, LATITUDE_DEG)
    table_3_wh = PER_WHM2 * stepped_whm2(counted, table_3())
    midpoints = Steps(midpoint_h(TABLE_3_ANGLES_DEG), TABLE_3_ANGLES_DEG, SOLSTICE_TILT_DEG)
    return SolsticeEnergies(
        fixed_wh=fixed_wh,
        table_3_wh=table_3_wh,
        table_3_whole_day_wh=PER_WHM2 * stepped_whm2(whole, table_3()),
        continuous_wh=PER_WHM2 * following_whm2(counted, SOLSTICE_TILT_DEG),
        continuous_whole_day_wh=PER_WHM2 * following_whm2(whole, SOLSTICE_TILT_DEG),
        within_range_wh=PER_WHM2 * following_whm2(counted, SOLSTICE_TILT_DEG, RANGE_DEG),
        midpoint_wh=PER_WHM2 * stepped_whm2(counted, midpoints),
        optimum_wh=optimum_wh(STEPS),
        optimum_without_range_wh=optimum_wh(STEPS, range_deg=90.0),
        gain_percent=gain_percent(table_3_wh, fixed_wh),
    )


def optimum_wh(steps: int, range_deg: float = RANGE_DEG) -> float:
    """Return the electric energy of the best program of so many steps on the longest day, Wh."""
    return PER_WHM2 * best_steps(paper_day(), steps, Limits(range_deg)).collected_whm2


def month_declination_deg(month: int) -> float:
    """Return the mean declination of a month's days, degrees; month 1 is January."""
    first = MONTH_ENDS[month - 2] + 1 if month > 1 else 1
    days = range(first, MONTH_ENDS[month - 1] + 1)
    return sum(declination_deg(day) for day in days) / len(days)


def representative_day(month: int) -> int:
    """Return the day of the year whose declination is nearest to its month's mean."""
    first = MONTH_ENDS[month - 2] + 1 if month > 1 else 1
    mean_deg = month_declination_deg(month)
    return min(range(first, MONTH_ENDS[month - 1] + 1), key=lambda day: abs(declination_deg(day) - mean_deg))


def table_4() -> tuple[DayGain, ...]:
    """Return what the model gives for the paper's twelve days: ten-degree steps at the best instants.

    The tilt is the ideal one of the day. The paper's June day is not the nearest to its month's mean, and its
    winter gains are higher than any turbidity gives.
    """
    return tuple(_day_gain(month, day) for month, day in enumerate(TABLE_4_DAYS, start=1))


def _day_gain(month: int, day_of_year: int) -> DayGain:
    counted, whole = paper_day(day_of_year), paper_day(day_of_year, whole=True)
    tilt_deg = LATITUDE_DEG - counted.declination_deg
    steps = Steps(midpoint_h(TABLE_3_ANGLES_DEG), TABLE_3_ANGLES_DEG, tilt_deg)
    tracked_wh = PER_WHM2 * stepped_whm2(counted, steps)
    fixed_wh = PER_WHM2 * fixed_whm2(whole, LATITUDE_DEG)
    return DayGain(
        month,
        day_of_year,
        counted.declination_deg,
        month_declination_deg(month),
        gain_percent(tracked_wh, fixed_wh),
    )
