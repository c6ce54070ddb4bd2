"""Xia et al., "High Precision Biaxial Solar Tracker" (2015), with Spencer's and Lamm's series."""

from datetime import UTC, datetime

import numpy as np

from app.research.effect import Effect, Measured, effect
from app.research.result import Erratum, Figure, Gap, Group, Paper
from app.research.sampling import from_spa, told, worse
from app.sun import cooper, psa, spa, spencer_lamm
from app.sun.algorithms import PUBLISHED, Algorithm
from app.sun.solar_days import day_and_hour, day_of_cycle, day_of_year
from app.sun.trigonometry import ARRAY, PER_DEGREE, PER_RADIAN, Array

HURRICANE_MPS = 36.9
AIR_KN_M3 = 0.01225
GRAVITY = 9.81
PRINTED_LOAD_KN_M2 = 1.7
ENCODER_COUNTS = 3600.0
CYCLE_YEARS = (0, 366, 731, 1096)
LATITUDES = (0.0, 13.0, 26.0, 45.65, 60.0)
DAYS = np.arange(1.0, 366.0)


def xia() -> Paper:
    """Return what the paper's equations are worth, and what its misprints cost."""
    return Paper(
        key="xia",
        name="Xia et al. (2015)",
        citation="Z. Y. Xia, X. Y. Chen, S. G. Chen, L. H. Hu, D. S. Wu, G. J. Jin, High Precision Biaxial "
        "Solar Tracker, 2015.",
        groups=(_wind(), _equation_of_time(), _accuracy()),
        errata=_errata(),
        gaps=GAPS,
    )


def _wind() -> Group:
    pressure = _pressure_kn_m2()
    return Group(
        "Section 5, wind pressure, and section 3, encoders",
        "Eq 5 with g = 9.81 m/s² and eq 6 at 36.9 m/s, the upper end of force 12.",
        (
            Figure("pressure by eq 6", "kN/m²", 0.85, pressure, 0.005),
            Figure("pressure by eq 5", "kN/m²", 0.85, AIR_KN_M3 * HURRICANE_MPS**2 / (2 * GRAVITY), 0.005),
            Figure(
                "load on each piece of 2 m²", "10⁻³ MPa", PRINTED_LOAD_KN_M2, pressure, 0.05,
                remark="1.7 is the force in kN; the pressure in MPa is half that number.",
            ),
            Figure("one encoder count", "°", 0.1, 360.0 / ENCODER_COUNTS, 1e-9),
        ),
    )  # fmt: skip


def _equation_of_time() -> Group:
    years = [_equation_of_time_rms_s(1976, 1984, shift) for shift in CYCLE_YEARS]
    names = ("the leap year", "the year before it", "two years before it", "three years before it")
    figures = [
        Figure(f"1976 to 1983, N = 1 in {name}, rms", "s", None, rms_s)
        for name, rms_s in zip(names, years, strict=True)
    ]
    now_s = _equation_of_time_rms_s(2000, 2050, 0)
    return Group(
        "Eq 4 against NREL SPA at 12:00 UT",
        "The paper says N = 1 to 1461 and not which year opens the cycle: Lamm's leap year does.",
        (*figures, Figure("2000 to 2049, N = 1 in the leap year, rms", "s", None, now_s)),
    )


def _accuracy() -> Group:
    plain, phased = (
        from_spa(PUBLISHED[one].many) for one in (Algorithm.SPENCER_LAMM, Algorithm.SPENCER_LAMM_PHASE)
    )
    return Group(
        "The corrected equations against NREL SPA",
        "The paper calls its tracker highly precise and prints no azimuth or altitude to compare with.",
        (
            Figure("greatest separation", "°", None, plain.max_deg),
            Figure("root mean square", "°", None, plain.rms_deg),
            Figure("greatest separation with the phase fix", "°", None, phased.max_deg, digits=3),
            Figure("root mean square with the phase fix", "°", None, phased.rms_deg, digits=3),
        ),
    )


def _errata() -> tuple[Erratum, ...]:
    right = from_spa(PUBLISHED[Algorithm.SPENCER_LAMM].many)
    return (
        Erratum(
            "eq 3", "0.070257Γ", "0.070257 sin Γ",
            effect(
                "declination off by up to ", Measured(_missing_sine_deg(), 3), "°; ",
                *worse(from_spa(_without_sine), right),
            ),
        ),
        Erratum(
            "eq 2", "Az by arcsine", "a four-quadrant arctangent",
            _behind(),
        ),
        Erratum(
            "text below eq 3", "hour angle = local standard time + EQT",
            "15·(time + (longitude − 15 zone)/15 + EQT − 12)",
            effect("taken at its word: sun off by up to ", *told(from_spa(_hours_as_degrees))),
        ),
        Erratum(
            "figure 1", "azimuth from south, west positive", "kept",
            effect("taken for one from north: sun off by up to ", *told(from_spa(_from_south))),
        ),
        Erratum(
            "eqs 3 and 4", "n and N", "n counts days of a year, N days of four years",
            effect("N = n in every year: ", *worse(from_spa(_one_year), right)),
        ),
        Erratum(
            "section 5", "1.7·10⁻³ MPa on each piece", "0.85·10⁻³ MPa, or 1.7 kN",
            effect("load ", Measured(PRINTED_LOAD_KN_M2 / _pressure_kn_m2(), 3), " times what it is"),
        ),
        Erratum(
            "sections 3 and 4", "over 10, rise to 10, reaches 10", "10 counts",
            effect("one count, ", Measured(360.0 / ENCODER_COUNTS, 1), "°"),
        ),
    )  # fmt: skip


GAPS = (
    Gap("Figures 5 and 6, deformation and stress", "They need the tracker's geometry, which is not printed."),
    Gap("Tracking accuracy", "The paper prints no measured or computed angle."),
)


def _equation_of_time_rms_s(first_year: int, end_year: int, shift_days: int) -> float:
    """Return how far eq 4 is from SPA at noon UT, root mean square in seconds, with a cycle shifted in N."""
    begin, end = (datetime(year, 1, 1, 12, tzinfo=UTC).timestamp() for year in (first_year, end_year))
    at = np.arange(begin, end, 86400.0)
    day, _ = day_and_hour(at, 0.0, ARRAY)
    number = np.mod(day_of_cycle(day, ARRAY) - 1.0 + shift_days, 1461.0) + 1.0
    off_s = 3600.0 * (spencer_lamm.equation_of_time(number, ARRAY) - _true_equation_of_time_h(at))
    return float(np.sqrt(np.mean(off_s**2)))


def _true_equation_of_time_h(noon_unix_s: Array) -> Array:
    """Return the equation of time by SPA at noon UT: the sun's hour angle at longitude 0, hours."""
    azimuth_deg, elevation_deg = spa.position(noon_unix_s, 0.0, 0.0)
    azimuth, elevation = azimuth_deg * PER_DEGREE, elevation_deg * PER_DEGREE
    west = -np.sin(azimuth) * np.cos(elevation)
    return np.asarray(np.arctan2(west, np.sin(elevation)) * PER_RADIAN / 15.0, dtype=np.float64)


def _missing_sine(angle: Array) -> Array:
    """Return the declination by eq 3 as printed, degrees."""
    return spencer_lamm.declination(angle, ARRAY) + PER_RADIAN * 0.070257 * (angle - np.sin(angle))


def _missing_sine_deg() -> float:
    angle = spencer_lamm.day_angle(DAYS)
    return float(np.abs(_missing_sine(angle) - spencer_lamm.declination(angle, ARRAY)).max())


def _without_sine(unix_s: Array, latitude_deg: float, longitude_deg: float) -> tuple[Array, Array]:
    day, hour = day_and_hour(unix_s, longitude_deg, ARRAY)
    delta = _missing_sine(spencer_lamm.day_angle(day_of_year(day, ARRAY)))
    apparent_h = hour + spencer_lamm.equation_of_time(day_of_cycle(day, ARRAY), ARRAY)
    return cooper.horizontal(delta, cooper.hour_angle(apparent_h), latitude_deg, ARRAY)


def _one_year(unix_s: Array, latitude_deg: float, longitude_deg: float) -> tuple[Array, Array]:
    day, hour = day_and_hour(unix_s, longitude_deg, ARRAY)
    n = day_of_year(day, ARRAY)
    delta = spencer_lamm.declination(spencer_lamm.day_angle(n), ARRAY)
    apparent_h = hour + spencer_lamm.equation_of_time(n, ARRAY)
    return cooper.horizontal(delta, cooper.hour_angle(apparent_h), latitude_deg, ARRAY)


def _beyond_percent(latitude_deg: float) -> float:
    """Return the share of a year's daylight with the sun more than 90 degrees from south, percent."""
    declination = np.repeat(spencer_lamm.declination(spencer_lamm.day_angle(DAYS), ARRAY), 288)
    angle = np.tile(np.arange(288.0) * 1.25 - 180.0, len(DAYS))
    zenith, azimuth = psa.horizontal(declination * PER_DEGREE, angle * PER_DEGREE, latitude_deg, ARRAY)
    behind = np.cos(azimuth) > 0.0
    return float(100.0 * behind[zenith < np.pi / 2].mean())


def _pressure_kn_m2() -> float:
    """Return the wind pressure by eq 6."""
    return HURRICANE_MPS**2 / 1600.0


def _latitude(latitude_deg: float) -> Measured:
    return Measured(latitude_deg, 1 if latitude_deg.is_integer() else 4)


def _behind() -> Effect:
    shares = [
        part
        for latitude_deg in LATITUDES
        for part in (_latitude(latitude_deg), "° ", Measured(_beyond_percent(latitude_deg), 2), " %, ")
    ]
    return effect(
        "azimuth wrong behind the east-west line, so much of daylight: latitude ", *shares[:-1], " %"
    )


def _hours_as_degrees(unix_s: Array, latitude_deg: float, longitude_deg: float) -> tuple[Array, Array]:
    """Return the sun with local standard time and equation of time, hours, taken for the angle in degrees."""
    day, hour = day_and_hour(unix_s, longitude_deg, ARRAY)
    delta = spencer_lamm.declination(spencer_lamm.day_angle(day_of_year(day, ARRAY)), ARRAY)
    standard_h = hour - (longitude_deg / 15.0 - round(longitude_deg / 15.0))
    angle_deg = standard_h + spencer_lamm.equation_of_time(day_of_cycle(day, ARRAY), ARRAY)
    return cooper.horizontal(delta, angle_deg, latitude_deg, ARRAY)


def _from_south(unix_s: Array, latitude_deg: float, longitude_deg: float) -> tuple[Array, Array]:
    """Return the sun with figure 1's azimuth from south where one from north is asked."""
    azimuth_deg, elevation_deg = PUBLISHED[Algorithm.SPENCER_LAMM].many(unix_s, latitude_deg, longitude_deg)
    return azimuth_deg - 180.0, elevation_deg
