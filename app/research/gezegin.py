"""Gezegin and Dirik, "PLC Controlled Dual-Axis Solar Tracking System Using Astronomical Equations" (2022)."""

import numpy as np

from app.research.effect import Effect, Measured, effect, not_measured
from app.research.koblick_printed import (
    ASTRONOMICAL_UNIT_KM,
    Printed,
    constant_obliquity_deg,
    constant_tilt_of_sine,
    cosine_of_degrees,
    day_without_century_rule,
    day_without_month_rule,
    growing_eccentricity,
    longitude_of_radians,
    orbit_of_degrees,
    tilts_of_radians,
    without_y,
)
from app.research.result import Erratum, Figure, Gap, Group, Paper
from app.research.sampling import from_spa, told, worse
from app.sun import koblick
from app.sun.algorithms import PUBLISHED, Algorithm
from app.sun.trigonometry import ARRAY, PER_DEGREE, Array

HOUR_S, THREE_HOURS_S = 3600.0, 10_800.0
MOUNTAIN_KM = 4.0
METRES_A_KM = 1000.0
NAME = not_measured("a name")


def gezegin() -> Paper:
    """Return what the paper's equations are worth, and what its misprints cost."""
    return Paper(
        key="gezegin-dirik",
        name="Gezegin and Dirik (2022)",
        citation="C. Gezegin, H. Dirik, PLC Controlled Dual-Axis Solar Tracking System Using Astronomical "
        "Equations, 2022; its method is D. Koblick's SolarAzEl, MATLAB Central 23051.",
        groups=(_constants(), _accuracy()),
        errata=(*_measured(), *_fatal()),
        gaps=GAPS,
    )


def _constants() -> Group:
    tilt_deg = float(koblick.obliquity(np.array([0.0]))[0])
    return Group(
        "Eqs 7 and 19, the obliquity of the ecliptic",
        "Eq 19 has a constant where eq 7 gives the obliquity of the day.",
        (
            Figure(
                "eq 19's constant, as eq 7 has it on 1999-12-31", "°", constant_obliquity_deg(), tilt_deg,
                within=0.0001, digits=4, remark="The constant is 23.4406 degrees in radians, the "
                "obliquity of January 1990.",
            ),
        ),
    )  # fmt: skip


def _accuracy() -> Group:
    plain = from_spa(PUBLISHED[Algorithm.KOBLICK].many)
    lowered = from_spa(PUBLISHED[Algorithm.KOBLICK_PARALLAX].many)
    return Group(
        "The corrected equations against NREL SPA",
        "The paper prints no azimuth or elevation to compare with.",
        (
            Figure("greatest separation", "°", None, plain.max_deg, digits=4),
            Figure("root mean square", "°", None, plain.rms_deg, digits=4),
            Figure("greatest separation with parallax", "°", None, lowered.max_deg, digits=4),
            Figure("root mean square with parallax", "°", None, lowered.rms_deg, digits=4),
        ),
    )


def _measured() -> tuple[Erratum, ...]:
    right = from_spa(Printed().position)

    def cost(printed: Printed) -> tuple[str | Measured, ...]:
        return worse(from_spa(printed.position), right)

    return (
        Erratum(
            "eq 1", "+ 2 + ⌊Y/100⌋ + ⌊Y/4⌋ − ⌊Y/100⌋", "+ 2 − ⌊Y/100⌋ + ⌊⌊Y/100⌋/4⌋",
            effect(*_days_off(), "; ", *cost(Printed(day=day_without_century_rule))),
        ),
        Erratum(
            "eq 1", "no rule for January and February", "if M ≤ 2: Y − 1 and M + 12",
            effect(*cost(Printed(day=day_without_month_rule))),
        ),
        Erratum(
            "text, section 3", "time at the same location", "UT: time zone and daylight saving taken off",
            effect("three hours of time zone taken for UT: sun off by up to ", *_late(THREE_HOURS_S)),
        ),
        Erratum(
            "eq 4", "e = 0.016709 + 1.151·10⁻⁹·Day", "e = 0.016709 − 1.151·10⁻⁹·Day",
            effect(*cost(Printed(eccentricity=growing_eccentricity))),
        ),
        Erratum(
            "eq 19", "sin(0.409115648642983)", "sin(oblecl), the obliquity of the day",
            effect(*cost(Printed(tilts=constant_tilt_of_sine))),
        ),
        Erratum(
            "eq 20", "− Alt/149598000", "nothing: the term is no parallax",
            _altitude(),
        ),
        Erratum(
            "eq 34", "no parallax", "El − 8.794″/r · cos El, as an option",
            effect(*worse(right, from_spa(PUBLISHED[Algorithm.KOBLICK_PARALLAX].many))),
        ),
    )  # fmt: skip


def _fatal() -> tuple[Erratum, ...]:
    """Return the misprints that lose the sun, each taken at its word, and those of names."""

    def lost(printed: Printed) -> Effect:
        return effect("sun off by up to ", *told(from_spa(printed.position)))

    right, plus = Printed(), Printed(z_sign=1.0)
    return (
        Erratum("eq 5", "M", "another name: M is the month in eq 1", NAME),
        Erratum("eqs 6 and 7", "oblecl in radians", "degrees", lost(Printed(tilts=tilts_of_radians))),
        Erratum(
            "eqs 8 to 10", "sin(M), cos(E) of degrees", "arguments in degrees, so times π/180",
            lost(Printed(orbit=orbit_of_degrees)),
        ),
        Erratum(
            "eqs 12 and 13", "v in radians added to w in degrees", "v·180/π",
            lost(Printed(longitude=longitude_of_radians)),
        ),
        Erratum(
            "eq 18", "cos(oblecl) of degrees", "argument times π/180", lost(Printed(tilts=cosine_of_degrees))
        ),
        Erratum(
            "eq 18", "+ zeclip·sin(oblecl)", "− zeclip·sin(oblecl)",
            effect(*worse(from_spa(plus.position), from_spa(right.position)), ": zeclip is zero"),
        ),
        Erratum(
            "eqs 21 and 22", "RA and delta in radians", "degrees, as eqs 26 to 29 need",
            lost(Printed(equatorial_unit=PER_DEGREE)),
        ),
        Erratum("eq 24", "GMTS0", "GMST0, hours", NAME),
        Erratum("eq 31", "zhor = y", "yhor = y", _left_at_zero(lost(Printed(horizontal=without_y)))),
        Erratum(
            "HMI, step 2", "clock and date", "clock, date and offset from UTC",
            effect("an hour of offset left out: sun off by up to ", *_late(HOUR_S)),
        ),
    )  # fmt: skip


GAPS = (
    Gap("Figures 1 and 2", "They count publications by year and country, from a survey that it cites."),
    Gap("Power and energy of the modes", "The paper describes them and prints no measurement."),
    Gap("Tracking accuracy of the built tracker", "The paper prints neither encoder nor sensor readings."),
)


def _left_at_zero(lost: Effect) -> Effect:
    return effect("yhor is left at zero: ", *lost.parts)


def _days_off() -> tuple[str | Measured, ...]:
    at = np.array([np.datetime64(day, "s").astype(np.float64) for day in ("2000-01-01", "2050-01-01")])
    first, last = (float(days) for days in day_without_century_rule(at) - koblick.day_number(at))
    begin, between = "Julian day too great by ", " days in the first year of the sample, "
    return begin, Measured(first, 3), between, Measured(last, 3), " after the last"


def _late(late_s: float) -> tuple[str | Measured, ...]:
    """Return how far the sun of another instant is off, as parts of an effect."""

    def position(unix_s: Array, latitude_deg: float, longitude_deg: float) -> tuple[Array, Array]:
        return koblick.position(unix_s + late_s, latitude_deg, longitude_deg, ARRAY)

    return told(from_spa(position))


def _altitude() -> Effect:
    """Return what eq 20 does on a mountain, and where its metres are entered as if they were kilometres."""
    right, in_metres = (
        _moved_deg(Printed(altitude_term=km / ASTRONOMICAL_UNIT_KM))
        for km in (MOUNTAIN_KM, MOUNTAIN_KM * METRES_A_KM)
    )
    return effect(
        "sun moved by up to ", Measured(right, 1), "° at ", Measured(MOUNTAIN_KM, 1), " km; by ",
        Measured(in_metres, 1), "° where the height is entered in meters",
    )  # fmt: skip


def _moved_deg(printed: Printed) -> float:
    """Return by how much a printed step lifts the sun over the pole in a year at most, degrees."""
    unix_s = np.arange(365.0) * 86400.0 + 1_767_225_600.0
    _, right = Printed().position(unix_s, 90.0, 0.0)
    _, moved = printed.position(unix_s, 90.0, 0.0)
    return float(np.abs(moved - right).max())
