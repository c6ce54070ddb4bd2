"""Gezegin and Dirik, "PLC Controlled Dual-Axis Solar Tracking System Using Astronomical Equations" (2022)."""

import numpy as np

from app.papers.koblick_printed import (
    ASTRONOMICAL_UNIT_KM,
    Printed,
    constant_obliquity_deg,
    day_without_century_rule,
    day_without_month_rule,
    growing_eccentricity,
)
from app.papers.result import Erratum, Figure, Gap, Group, Paper
from app.papers.sampling import figures, from_spa, told, worse
from app.sun import koblick
from app.sun.algorithms import PUBLISHED, Algorithm
from app.sun.trigonometry import ARRAY, Array

THREE_HOURS_S = 10_800.0
NO_SUN = "no usable sun"


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

    def cost(printed: Printed) -> str:
        return worse(from_spa(printed.position), right)

    return (
        Erratum(
            "eq 1", "+ 2 + ⌊Y/100⌋ + ⌊Y/4⌋ − ⌊Y/100⌋", "+ 2 − ⌊Y/100⌋ + ⌊⌊Y/100⌋/4⌋",
            f"{_days_off()}; {cost(Printed(day=day_without_century_rule))}",
        ),
        Erratum(
            "eq 1", "no rule for January and February", "if M ≤ 2: Y − 1 and M + 12",
            cost(Printed(day=day_without_month_rule)),
        ),
        Erratum(
            "text, section 3", "time at the same location", "UT: time zone and daylight saving taken off",
            f"three hours of time zone taken for UT: sun off by up to {told(from_spa(_three_hours_late))}",
        ),
        Erratum(
            "eq 4", "e = 0.016709 + 1.151·10⁻⁹·Day", "e = 0.016709 − 1.151·10⁻⁹·Day",
            cost(Printed(eccentricity=growing_eccentricity)),
        ),
        Erratum(
            "eq 19", "sin(0.409115648642983)", "sin(oblecl), the obliquity of the day",
            cost(Printed(sine_obliquity_deg=constant_obliquity_deg())),
        ),
        Erratum(
            "eq 20", "− Alt/149598000", "nothing: the term is no parallax",
            f"sun moved by up to {figures(_altitude_effect(4.0), 1)}° at 4 km; by "
            f"{figures(_altitude_effect(4000.0), 1)}° "
            "where 4000 m are entered as if they were km",
        ),
        Erratum(
            "eq 34", "no parallax", "El − 8.794″/r · cos El, as an option",
            worse(right, from_spa(PUBLISHED[Algorithm.KOBLICK_PARALLAX].many)),
        ),
    )  # fmt: skip


def _fatal() -> tuple[Erratum, ...]:
    return (
        Erratum("eq 5", "M", "another name: M is the month in eq 1", "none on paper; a name clash in a PLC"),
        Erratum("eqs 6 and 7", "oblecl in radians", "degrees", NO_SUN),
        Erratum("eqs 8 to 10", "sin(M), cos(E) of degrees", "arguments in degrees, so times π/180", NO_SUN),
        Erratum("eqs 12 and 13", "v in radians added to w in degrees", "v·180/π", NO_SUN),
        Erratum("eq 18", "cos(oblecl) of degrees", "argument times π/180", NO_SUN),
        Erratum("eq 18", "+ zeclip·sin(oblecl)", "− zeclip·sin(oblecl)", "none: zeclip is 0"),
        Erratum("eqs 21 and 22", "RA and delta in radians", "degrees, as eqs 26 to 29 need", NO_SUN),
        Erratum("eq 24", "GMTS0", "GMST0, hours", "none"),
        Erratum("eq 31", "zhor = y", "yhor = y", NO_SUN),
        Erratum("HMI, step 2", "clock and date", "clock, date and offset from UTC", "15° an hour of offset"),
    )


GAPS = (
    Gap("Figures 1 and 2", "They count publications by year and country, from a survey that it cites."),
    Gap("Power and energy of the modes", "The paper describes them and prints no measurement."),
    Gap("Tracking accuracy of the built tracker", "The paper prints neither encoder nor sensor readings."),
)


def _days_off() -> str:
    at = np.array([946_684_800.0, 2_524_521_600.0])
    days = day_without_century_rule(at) - koblick.day_number(at)
    return f"Julian day too great by {days.min():.0f} days in 2000, {days.max():.0f} in 2049"


def _three_hours_late(unix_s: Array, latitude_deg: float, longitude_deg: float) -> tuple[Array, Array]:
    return koblick.position(unix_s + THREE_HOURS_S, latitude_deg, longitude_deg, ARRAY)


def _altitude_effect(altitude_km: float) -> float:
    """Return by how much eq 20 turns the sun in a year at most, degrees."""
    unix_s = np.arange(365.0) * 86400.0 + 1_767_225_600.0
    _, right = Printed().position(unix_s, 90.0, 0.0)
    _, moved = Printed(altitude_term=altitude_km / ASTRONOMICAL_UNIT_KM).position(unix_s, 90.0, 0.0)
    return float(np.abs(moved - right).max())
