"""Every step of PSA against golden/psa.csv."""

from datetime import UTC, datetime, timedelta
from math import degrees

import pytest

from app.base.angles import wrap180, wrap360
from app.sun import psa
from app.sun.trigonometry import SCALAR
from tests.golden.table import GoldenRow, golden

ROWS = golden("psa.csv")
cases = pytest.mark.parametrize("row", ROWS, ids=[row.case for row in ROWS])
NEAR = 1e-6


def days(row: GoldenRow) -> float:
    return psa.days_since_2000(row.at.timestamp())


def longitude(row: GoldenRow) -> float:
    n = days(row)
    return psa.ecliptic_longitude(psa.mean_longitude(n), psa.mean_anomaly(n), psa.node_longitude(n), SCALAR)


def tilt(row: GoldenRow) -> float:
    return psa.obliquity(days(row), psa.node_longitude(days(row)), SCALAR)


def angle(row: GoldenRow) -> float:
    right_ascension, _ = psa.equatorial(longitude(row), tilt(row), SCALAR)
    greenwich = psa.greenwich_sidereal_time(days(row), psa.hour_of_day(row.at.timestamp(), SCALAR))
    return psa.hour_angle(psa.local_sidereal_time(greenwich, row.longitude_deg), right_ascension)


@cases
def test_every_step_is_that_of_the_table(row: GoldenRow) -> None:
    right_ascension, declination = psa.equatorial(longitude(row), tilt(row), SCALAR)
    zenith, _ = psa.horizontal(declination, angle(row), row.latitude_deg, SCALAR)
    found = {
        "JD": psa.julian_day(row.at.year, row.at.month, row.at.day, row.hour),
        "n": days(row),
        "ecl_long_mod360": wrap360(degrees(longitude(row))),
        "obliquity": degrees(tilt(row)),
        "RA": wrap360(degrees(right_ascension)),
        "dec": degrees(declination),
        "HA_wrap180": wrap180(degrees(angle(row))),
        "zenith_no_parallax": degrees(zenith),
        "zenith": degrees(zenith + psa.parallax(zenith, SCALAR)),
    }
    assert found == pytest.approx({name: row.values[name] for name in found}, abs=NEAR)


@cases
def test_the_whole_chain(row: GoldenRow) -> None:
    azimuth, elevation = psa.position(row.at.timestamp(), row.latitude_deg, row.longitude_deg, SCALAR)
    assert wrap360(azimuth) == pytest.approx(row.values["azimuth"], abs=NEAR)
    assert elevation == pytest.approx(row.values["elevation"], abs=NEAR)


def test_the_julian_day_agrees_with_the_calendar_from_1901_to_2099() -> None:
    at, end = datetime(1901, 1, 1, tzinfo=UTC), datetime(2100, 1, 1, tzinfo=UTC)
    while at < end:
        expected = psa.days_since_2000(at.timestamp()) + 2_451_545.0
        assert psa.julian_day(at.year, at.month, at.day, 0.0) == expected
        at += timedelta(days=13)
