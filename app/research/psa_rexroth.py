"""PSA as it is reprinted in a paper on a sun tracker with a Rexroth PLC."""

from typing import cast

import numpy as np

from app.research.effect import effect, not_measured
from app.research.koblick_printed import calendar
from app.research.result import Erratum, Figure, Gap, Group, Paper
from app.research.sampling import from_spa, worse
from app.sun import psa
from app.sun.algorithms import PUBLISHED, Algorithm
from app.sun.trigonometry import ARRAY, PER_DEGREE, PER_RADIAN, Array

J2000 = 2_451_545.0


def psa_rexroth() -> Paper:
    """Return what the reprinted algorithm is worth, and what its misprints cost."""
    return Paper(
        key="psa-rexroth",
        name="PSA on a Rexroth PLC",
        citation="Automated sun tracking by PLC and the PSA algorithm on a Rexroth PLC; the algorithm is of "
        "M. Blanco-Muriel et al., Solar Energy 70 (2001) 431-441, doi:10.1016/S0038-092X(00)00156-0.",
        groups=(_constants(), _accuracy(), _real()),
        errata=_errata(),
        gaps=GAPS,
    )


def _constants() -> Group:
    noon = psa.julian_day(2000, 1, 1, 12.0)
    arc_seconds = psa.PARALLAX * PER_RADIAN * 3600.0
    return Group(
        "Eqs 2 and 15",
        "What the printed constants must come to.",
        (
            Figure("eq 1 at noon of 1 January 2000, Julian day", "d", J2000, noon, 1e-9, 1),
            Figure("eq 15, the sun's parallax at the horizon", "″", None, arc_seconds, digits=3),
        ),
    )


def _accuracy() -> Group:
    old, new = (from_spa(PUBLISHED[one].many) for one in (Algorithm.PSA, Algorithm.PSA_PLUS))
    return Group(
        "The corrected equations against NREL SPA",
        "All coefficients of the reprint are the original's. PSA+ has those of 2020.",
        (
            Figure("greatest separation", "°", None, old.max_deg, digits=4),
            Figure("root mean square", "°", None, old.rms_deg, digits=4),
            Figure("greatest separation of PSA+", "°", None, new.max_deg, digits=4),
            Figure("root mean square of PSA+", "°", None, new.rms_deg, digits=4),
        ),
    )


def _real() -> Group:
    whole, split = from_spa(_julian_day_in_real), from_spa(_days_in_real)
    return Group(
        "On a PLC with 32-bit REAL",
        "The paper does not say how its PLC holds a Julian day; REAL has 24 bits, a quarter of a day of it.",
        (
            Figure("Julian day in REAL, greatest separation", "°", None, whole.max_deg, digits=3),
            Figure("Julian day in REAL, root mean square", "°", None, whole.rms_deg, digits=3),
            Figure("days since 2000 in REAL, greatest separation", "°", None, split.max_deg, digits=4),
            Figure("days since 2000 in REAL, root mean square", "°", None, split.rms_deg, digits=4),
        ),
    )


def _errata() -> tuple[Erratum, ...]:
    right = from_spa(PUBLISHED[Algorithm.PSA].many)
    return (
        Erratum(
            "eq 1", "integer divisions, not said which way", "divisions that truncate towards zero",
            effect("divisions that round down, as in Python: ", *worse(from_spa(_rounding_down), right)),
        ),
        Erratum(
            "eq 8", "tan⁻¹", "a four-quadrant arctangent",
            effect(*worse(from_spa(_half_of_right_ascensions), right)),
        ),
        Erratum(
            "eq 14", "tan⁻¹", "a four-quadrant arctangent",
            effect(*worse(from_spa(_half_of_azimuths), right)),
        ),
        Erratum(
            "eq 11", "layout: π/180 beside Long", "π/180 times the whole bracket",
            effect(*worse(from_spa(_factor_on_longitude), right)),
        ),
        Erratum("numbering", "two series of 5 to 8", "one series", not_measured("a numbering")),
    )  # fmt: skip


GAPS = (
    Gap("Table 1", "It ticks which author gives which quantity and prints no numbers."),
    Gap("Power gain of 35.75 %", "No power, irradiance, day or panel is printed from which it could follow."),
    Gap("Sun angles on the PLC", "They are described; no date, place and result are printed together."),
)


def _chain(day: Array, sidereal_hour: Array, longitude_deg: float) -> tuple[Array, Array, Array]:
    """Return right ascension, declination and local sidereal time, radians."""
    node = psa.node_longitude(day)
    longitude = psa.ecliptic_longitude(psa.mean_longitude(day), psa.mean_anomaly(day), node, ARRAY)
    right_ascension, declination = psa.equatorial(longitude, psa.obliquity(day, node, ARRAY), ARRAY)
    greenwich = psa.greenwich_sidereal_time(day, sidereal_hour)
    return right_ascension, declination, psa.local_sidereal_time(greenwich, longitude_deg)


def _seen(declination: Array, angle: Array, latitude_deg: float) -> tuple[Array, Array]:
    zenith, azimuth = psa.horizontal(declination, angle, latitude_deg, ARRAY)
    return azimuth * PER_RADIAN, 90.0 - (zenith + psa.parallax(zenith, ARRAY)) * PER_RADIAN


def _rounding_down(unix_s: Array, latitude_deg: float, longitude_deg: float) -> tuple[Array, Array]:
    """Return the sun by eq 1 with floor in place of truncation."""
    year, month, day, hour = calendar(unix_s)
    early = np.floor((month - 14.0) / 12.0)
    years = np.floor(1461.0 * (year + 4800.0 + early) / 4.0)
    months = np.floor(367.0 * (month - 2.0 - 12.0 * early) / 12.0)
    centuries = np.floor(3.0 * np.floor((year + 4900.0 + early) / 100.0) / 4.0)
    julian = years + months - centuries + day - 32075.0 - 0.5 + hour / 24.0
    right_ascension, declination, sidereal = _chain(julian - J2000, hour, longitude_deg)
    return _seen(declination, sidereal - right_ascension, latitude_deg)


def _julian_day_in_real(unix_s: Array, latitude_deg: float, longitude_deg: float) -> tuple[Array, Array]:
    """Return the sun with eq 1's result held in 32 bits."""
    julian = _as_real(psa.days_since_2000(unix_s) + J2000)
    return _in_real(julian - np.float32(J2000), unix_s, latitude_deg, longitude_deg)


def _days_in_real(unix_s: Array, latitude_deg: float, longitude_deg: float) -> tuple[Array, Array]:
    """Return the sun with the whole days of eq 1 subtracted as integers, and only then 32 bits."""
    return _in_real(_as_real(psa.days_since_2000(unix_s)), unix_s, latitude_deg, longitude_deg)


def _in_real(day: Array, unix_s: Array, latitude_deg: float, longitude_deg: float) -> tuple[Array, Array]:
    hour = _as_real(psa.hour_of_day(unix_s, ARRAY))
    right_ascension, declination, sidereal = _chain(day, hour, longitude_deg)
    azimuth_deg, elevation_deg = _seen(declination, sidereal - right_ascension, latitude_deg)
    return azimuth_deg.astype(np.float64), elevation_deg.astype(np.float64)


def _as_real(value: Array) -> Array:
    """Return numbers in 32 bits, which the formulas take as they take those of 64."""
    return cast("Array", value.astype(np.float32))


def _half_of_right_ascensions(
    unix_s: Array, latitude_deg: float, longitude_deg: float
) -> tuple[Array, Array]:
    """Return the sun with the right ascension of a two-quadrant arctangent."""
    day, hour = psa.days_since_2000(unix_s), psa.hour_of_day(unix_s, ARRAY)
    right_ascension, declination, sidereal = _chain(day, hour, longitude_deg)
    return _seen(declination, sidereal - np.arctan(np.tan(right_ascension)), latitude_deg)


def _half_of_azimuths(unix_s: Array, latitude_deg: float, longitude_deg: float) -> tuple[Array, Array]:
    """Return the sun with the azimuth of a two-quadrant arctangent."""
    azimuth_deg, elevation_deg = psa.position(unix_s, latitude_deg, longitude_deg, ARRAY)
    return np.arctan(np.tan(azimuth_deg * PER_DEGREE)) * PER_RADIAN, elevation_deg


def _factor_on_longitude(unix_s: Array, latitude_deg: float, longitude_deg: float) -> tuple[Array, Array]:
    """Return the sun with pi/180 on the longitude alone."""
    day, hour = psa.days_since_2000(unix_s), psa.hour_of_day(unix_s, ARRAY)
    right_ascension, declination, _ = _chain(day, hour, longitude_deg)
    sidereal = psa.greenwich_sidereal_time(day, hour) * 15.0 + longitude_deg * PER_DEGREE
    return _seen(declination, sidereal - right_ascension, latitude_deg)
