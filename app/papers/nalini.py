"""Nalini and Hemavathi, "The Mathematical Model for Solar Angles Calculation ..." (2023)."""

from datetime import UTC, datetime, timedelta
from math import asin, degrees, radians, tan

import numpy as np

from app.papers.nalini_table import REPEATED, TABLE_1
from app.papers.result import Erratum, Figure, Gap, Group, Paper
from app.papers.sampling import from_spa, worse
from app.sun import cooper
from app.sun.algorithms import PUBLISHED, Algorithm
from app.sun.position import Location, SunPosition, sun_position
from app.sun.trigonometry import ARRAY

YEAR = 2022
CLOCK_UT_H = 3
LATITUDE_DEG = 12.9716
BENGALURU = Location(LATITUDE_DEG, 77.60)
MISPRINTED = Location(LATITUDE_DEG, 77.9946)
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
        "(the printed 77.9946 is a misprint of 77.5946). Not the paper's own equations: see below.",
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
    typed = _greatest_miss(Algorithm.SPA, MISPRINTED)
    later = [_sun(Algorithm.SPA, month, day, TEN_AND_A_HALF_HOURS) for month, day, _, _ in TABLE_1]
    return Group(
        "Table 1, greatest misses over its 24 rows",
        "How far each way of computing it is from the printed values.",
        (
            Figure("by SPA with refraction, elevation", "°", None, ours[0], digits=4),
            Figure("by SPA with refraction, azimuth", "°", None, ours[1], digits=4),
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
    sunrise_deg = degrees(asin(-tan(radians(23.45)) * tan(radians(LATITUDE_DEG))))
    return (
        Erratum("text above eq 3", "+23.50 and −23.50", "±23.5°, or ±23.45° as eq 3 has it", "none"),
        Erratum("eq 3", "0.9863", "360/365", f"declination off by up to {_rounding_deg():.1g}°"),
        Erratum(
            "eq 4", "α = 90 − L + δ", "α = 90 − |L − δ|",
            f"in Bengaluru wrong on {north} noons a year, with elevations of up to {highest_deg:.2f}°",
        ),
        Erratum("text below eq 4", "derived from eq 17", "derived from eq 16", "none"),
        Erratum(
            "eq 6", "sin ω_s = −tan δ tan L", "cos ω_s = −tan L tan δ in the hour angle of eq 16",
            f"sunrise of δ = 23.45° in Bengaluru at {sunrise_deg:.4f}° instead of −{90 - sunrise_deg:.4f}°",
        ),
        Erratum("eqs 8 and 20", "referred to", "they do not exist", "none"),
        Erratum(
            "eqs 9 and 10", "twice the same vector Z", "one is N = (−sin L cos ω, −sin L sin ω, cos L)",
            "eqs 12 and 17 cannot be derived from what is printed",
        ),
        Erratum(
            "eq 17", "Az by arccosine alone", "360° − Az in the afternoon, or a four-quadrant arctangent",
            f"azimuth wrong in {_afternoon_percent():.0f} % of daylight in Bengaluru, by up to 180°",
        ),
        Erratum("no equation", "no rule for ω", "15·(UT − 12) + longitude", "ω cannot be had"),
        Erratum("no equation", "no equation of time", "Spencer's, for one", worse(printed, mended)),
        Erratum(
            "below table 1", "longitude 77.9946 E, UTC−5.00 Indiana (East)", "77.5946 E, UTC+5:30",
            "see the misses above",
        ),
        Erratum("table 1", "Nov-27 twice", "Dec-02 in the second row", "elevation 26.03, azimuth 122.60"),
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


def _afternoon_percent() -> float:
    """Return the share of a year's daylight in which the sun is west of the meridian, percent."""
    at = np.arange(0.0, 365.0 * 86400.0, 600.0) + datetime(YEAR, 1, 1, tzinfo=UTC).timestamp()
    azimuth_deg, elevation_deg = PUBLISHED[Algorithm.COOPER].many(at, LATITUDE_DEG, BENGALURU.longitude_deg)
    west = np.mod(azimuth_deg, 360.0) > 180.0
    return float(100.0 * west[elevation_deg > 0.0].mean())
