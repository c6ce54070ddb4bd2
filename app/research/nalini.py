"""Nalini and Hemavathi, "The Mathematical Model for Solar Angles Calculation ..." (2023)."""

from datetime import UTC, datetime, timedelta
from math import asin, degrees, radians, tan

import numpy as np

from app.research.effect import Effect, Measured, effect, not_measured
from app.research.nalini_table import REPEATED, TABLE_1
from app.research.result import Erratum, Figure, Gap, Group, Paper
from app.research.sampling import from_spa, worse
from app.sun import cooper
from app.sun.algorithms import PUBLISHED, Algorithm
from app.sun.position import Location, SunPosition, sun_position
from app.sun.trigonometry import ARRAY

YEAR = 2022
CLOCK_UT_H = 3
LATITUDE_DEG = 12.9716
BENGALURU = Location(LATITUDE_DEG, 77.60)
MISPRINTED = Location(LATITUDE_DEG, 77.9946)
CENTER = Location(LATITUDE_DEG, 77.5946)
SOLSTICE_DEG, ROUNDED_SOLSTICE_DEG = 23.45, 23.50
REFERENCE = not_measured("a reference")
ELEVATION_WITHIN_DEG, AZIMUTH_WITHIN_DEG = 0.006, 0.007
TEN_AND_A_HALF_HOURS = timedelta(hours=10.5)
DAYS = np.arange(1.0, 366.0)
MONTHS = ("Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec")


def nalini() -> Paper:
    """Return Table 1 as it can be had, and what the paper's own equations make of it."""
    return Paper(
        key="nalini-hemavathi",
        name="Nalini and Hemavathi (2023)",
        citation="M. C. Nalini, R. Hemavathi, The Mathematical Model for Solar Angles Calculation in "
        "Automatic Solar Panel Tracker Using PLC and SCADA, 2023.",
        groups=(_table_1(), _misses()),
        errata=_errata(),
        gaps=GAPS,
    )


def _table_1() -> Group:
    figures = [figure for row in TABLE_1 for figure in _row(*row)]
    return Group(
        "Table 1, solar angles over a year",
        "Apparent position by NREL SPA at 03:00 UTC of each day of 2022, latitude 12.9716, longitude 77.60 "
        "fitted to the table (the printed 77.9946 is a misprint of 77.5946). Not the paper's own equations: "
        "see below.",
        (*figures, *_row(*REPEATED, remark="The table repeats 27 November; the day should be 2 December.")),
    )


def _row(
    month: int, day: int, elevation_deg: float, azimuth_deg: float, remark: str = ""
) -> tuple[Figure, Figure]:
    sun, name = _sun(Algorithm.SPA, month, day), f"{MONTHS[month - 1]}-{day:02}"
    elevation = sun.apparent_elevation_deg
    return (
        Figure(f"{name} elevation", "°", elevation_deg, elevation, ELEVATION_WITHIN_DEG, 3, remark),
        Figure(f"{name} azimuth", "°", azimuth_deg, sun.azimuth_deg, AZIMUTH_WITHIN_DEG, 3, remark),
    )


def _misses() -> Group:
    ours, printed, mended = (
        _greatest_miss(one) for one in (Algorithm.SPA, Algorithm.COOPER, Algorithm.COOPER_EOT)
    )
    typed, unfitted = (_greatest_miss(Algorithm.SPA, place) for place in (MISPRINTED, CENTER))
    later = [_sun(Algorithm.SPA, month, day, TEN_AND_A_HALF_HOURS) for month, day, _, _ in TABLE_1]
    return Group(
        "Table 1, greatest misses over its 24 rows",
        "How far each way of computing it is from the printed values.",
        (
            Figure("by SPA with refraction, elevation", "°", None, ours[0], digits=4),
            Figure("by SPA with refraction, azimuth", "°", None, ours[1], digits=4),
            Figure("by SPA at the longitude 77.5946, elevation", "°", None, unfitted[0], digits=4),
            Figure("by SPA at the longitude 77.5946, azimuth", "°", None, unfitted[1], digits=4),
            Figure("by the paper's eqs 3, 16 and 17, elevation", "°", None, printed[0]),
            Figure("by the paper's eqs 3, 16 and 17, azimuth", "°", None, printed[1]),
            Figure("by the same with an equation of time, elevation", "°", None, mended[0]),
            Figure("by the same with an equation of time, azimuth", "°", None, mended[1]),
            Figure("by SPA at the printed longitude 77.9946, elevation", "°", None, typed[0]),
            Figure("by SPA at the printed longitude 77.9946, azimuth", "°", None, typed[1]),
            Figure(
                "rows with the sun up, the printed UTC-5 taken at its word", "rows", None,
                float(sum(sun.is_up for sun in later)), digits=0,
                remark="08:30 at UTC-5 is 13:30 UTC, night there.",
            ),
        ),
    )  # fmt: skip


def _errata() -> tuple[Erratum, ...]:
    printed, mended = (from_spa(PUBLISHED[one].many) for one in (Algorithm.COOPER, Algorithm.COOPER_EOT))
    north, highest_deg = _noons_north_of_zenith()
    sunrise_deg = degrees(asin(-tan(radians(SOLSTICE_DEG)) * tan(radians(LATITUDE_DEG))))
    return (
        Erratum("text above eq 3", "+23.50 and −23.50", "±23.5°, or ±23.45° as eq 3 has it", _solstices()),
        Erratum(
            "eq 3", "0.9863", "360/365",
            effect("declination off by up to ", Measured(_rounding_deg(), 1), "°"),
        ),
        Erratum(
            "eq 4", "α = 90 − L + δ", "α = 90 − |L − δ|",
            effect(
                "in Bengaluru wrong on ", Measured(north, 3), " noons a year, with elevations of up to ",
                Measured(highest_deg, 5), "°",
            ),
        ),
        Erratum("text below eq 4", "derived from eq 17", "derived from eq 16", REFERENCE),
        Erratum(
            "eq 6", "sin ω_s = −tan δ tan L", "cos ω_s = −tan L tan δ in the hour angle of eq 16",
            effect(
                "sunrise of the summer solstice in Bengaluru at ", Measured(sunrise_deg, 5),
                "° instead of ", Measured(sunrise_deg - 90.0, 6), "°",
            ),
        ),
        Erratum("eqs 8 and 20", "referred to", "they do not exist", REFERENCE),
        Erratum(
            "eqs 9 and 10", "twice the same vector Z", "one is N = (−sin L cos ω, −sin L sin ω, cos L)",
            not_measured("without a vector to the north no azimuth can be derived"),
        ),
        Erratum(
            "eq 17", "Az by arccosine alone", "360° − Az in the afternoon, or a four-quadrant arctangent",
            _mornings_alone(),
        ),
        Erratum("no equation", "no rule for ω", "15·(UT − 12) + longitude", not_measured("ω cannot be had")),
        Erratum("no equation", "no equation of time", "Spencer's, for one", effect(*worse(printed, mended))),
        Erratum(
            "below table 1", "longitude 77.9946 E, UTC−5.00 Indiana (East)", "77.5946 E, UTC+5:30",
            _misplaced(),
        ),
        Erratum("table 1", "Nov-27 twice", "Dec-02 in the second row", _repeated()),
    )  # fmt: skip


GAPS = (
    Gap("The table of the cell's parameters", "It names them and prints no values."),
    Gap("Figure 16", "It draws Table 1 and prints no further numbers."),
    Gap(
        "Figures 12 to 15, Simulink models",
        "Their blocks are drawn, their values and wiring are not printed.",
    ),
    Gap(
        "Output efficiency with tracking",
        "The paper names it as its purpose and prints no energy, irradiance or panel to compute it from.",
    ),
)


def _sun(
    algorithm: Algorithm, month: int, day: int, late: timedelta = timedelta(), place: Location = BENGALURU
) -> SunPosition:
    return sun_position(algorithm, place, datetime(YEAR, month, day, CLOCK_UT_H, tzinfo=UTC) + late)


def _greatest_miss(algorithm: Algorithm, place: Location = BENGALURU) -> tuple[float, float]:
    """Return how far an algorithm is from Table 1 at most; SPA as it is seen, the paper's own as it is."""
    seen = algorithm is Algorithm.SPA
    elevations, azimuths = [], []
    for month, day, elevation_deg, azimuth_deg in TABLE_1:
        sun = _sun(algorithm, month, day, place=place)
        found = sun.apparent_elevation_deg if seen else sun.elevation_deg
        elevations.append(abs(found - elevation_deg))
        azimuths.append(abs(sun.azimuth_deg - azimuth_deg))
    return max(elevations), max(azimuths)


def _rounding_deg() -> float:
    exact = 23.45 * np.sin(np.radians(360.0 / 365.0 * (284.0 + DAYS)))
    return float(np.abs(cooper.declination(DAYS, ARRAY) - exact).max())


def _noons_north_of_zenith() -> tuple[int, float]:
    """Return on how many days of a year eq 4 gives more than 90 degrees, and how many it gives at most."""
    noon = 90.0 - LATITUDE_DEG + cooper.declination(DAYS, ARRAY)
    return int((noon > 90.0).sum()), float(noon.max())


def _mornings_alone() -> Effect:
    """Return what the arccosine of eq 17 makes of a year's daylight: no azimuth beyond south."""
    at = np.arange(0.0, 365.0 * 86400.0, 600.0) + datetime(YEAR, 1, 1, tzinfo=UTC).timestamp()
    azimuth_deg, elevation_deg = PUBLISHED[Algorithm.COOPER].many(at, LATITUDE_DEG, BENGALURU.longitude_deg)
    by_day_deg = np.mod(azimuth_deg[elevation_deg > 0.0], 360.0)
    turned_deg = np.degrees(np.arccos(np.cos(np.radians(by_day_deg))))
    off_deg = np.abs(np.mod(by_day_deg - turned_deg + 180.0, 360.0) - 180.0)
    share_percent = float(100.0 * (by_day_deg > 180.0).mean())
    return effect(
        "azimuth wrong in ", Measured(share_percent, 2), " % of daylight in Bengaluru, by up to ",
        Measured(float(off_deg.max()), 3), "°",
    )  # fmt: skip


def _solstices() -> Effect:
    apart_deg = ROUNDED_SOLSTICE_DEG - float(cooper.declination(DAYS, ARRAY).max())
    return effect("greatest declination ", Measured(apart_deg, 1), "° beyond that of the equation")


def _misplaced() -> Effect:
    """Return what the printed longitude and time zone do to Table 1."""
    elevation_deg, azimuth_deg = _greatest_miss(Algorithm.SPA, MISPRINTED)
    up = sum(_sun(Algorithm.SPA, month, day, TEN_AND_A_HALF_HOURS).is_up for month, day, _, _ in TABLE_1)
    return effect(
        "table missed by up to ", Measured(elevation_deg, 2), "° in elevation and ",
        Measured(azimuth_deg, 2), "° in azimuth; ", Measured(up, 1), " rows with the sun up",
    )  # fmt: skip


def _repeated() -> Effect:
    month, day, elevation_deg, azimuth_deg = REPEATED
    sun = _sun(Algorithm.SPA, month, day)
    return effect(
        "elevation off by ", Measured(abs(elevation_deg - sun.apparent_elevation_deg), 2),
        "°, azimuth by ", Measured(abs(azimuth_deg - sun.azimuth_deg), 2), "°",
    )  # fmt: skip
