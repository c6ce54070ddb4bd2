"""Every step of the corrected Koblick algorithm against golden/koblick.csv."""

from datetime import UTC, datetime, timedelta

import pytest

from app.base.angles import wrap180, wrap360
from app.sun import koblick
from app.sun.trigonometry import SCALAR
from tests.golden.table import GoldenRow, golden

ROWS = golden("koblick.csv")
cases = pytest.mark.parametrize("row", ROWS, ids=[row.case for row in ROWS])
NEAR = 1e-6


def day(row: GoldenRow) -> float:
    return koblick.day_number(row.at.timestamp())


def mean_longitude(row: GoldenRow) -> float:
    return koblick.mean_longitude(koblick.perihelion(day(row)), koblick.mean_anomaly(day(row), SCALAR))


def orbit(row: GoldenRow) -> tuple[float, float]:
    e = koblick.eccentricity(day(row))
    return koblick.orbit(
        koblick.eccentric_anomaly(koblick.mean_anomaly(day(row), SCALAR), e, SCALAR), e, SCALAR
    )


def equatorial(row: GoldenRow) -> tuple[float, float]:
    longitude = koblick.true_longitude(orbit(row)[1], koblick.perihelion(day(row)))
    return koblick.equatorial(longitude, koblick.obliquity(day(row)), SCALAR)


def angle(row: GoldenRow) -> float:
    greenwich = koblick.greenwich_sidereal_time(mean_longitude(row), SCALAR)
    hour = koblick.hour_of_day(row.at.timestamp(), SCALAR)
    sidereal = koblick.local_sidereal_time(greenwich, hour, row.longitude_deg)
    return koblick.hour_angle(sidereal, equatorial(row)[0])


@cases
def test_every_step_is_that_of_the_table(row: GoldenRow) -> None:
    right_ascension, declination = equatorial(row)
    found = {
        "JD": koblick.julian_day(row.at.year, row.at.month, row.at.day, row.hour),
        "d": day(row),
        "L_mod360": wrap360(mean_longitude(row)),
        "obliquity": koblick.obliquity(day(row)),
        "r": orbit(row)[0],
        "RA": wrap360(right_ascension),
        "dec": declination,
        "GMST0_h": koblick.greenwich_sidereal_time(mean_longitude(row), SCALAR),
        "HA_wrap180": wrap180(angle(row)),
    }
    assert found == pytest.approx({name: row.values[name] for name in found}, abs=NEAR)


@cases
def test_the_whole_chain(row: GoldenRow) -> None:
    azimuth, elevation = koblick.position(row.at.timestamp(), row.latitude_deg, row.longitude_deg, SCALAR)
    assert wrap360(azimuth) == pytest.approx(row.values["Az"], abs=NEAR)
    assert elevation == pytest.approx(row.values["El"], abs=NEAR)


def test_the_julian_day_agrees_with_the_calendar_from_1901_to_2099() -> None:
    at, end = datetime(1901, 1, 1, tzinfo=UTC), datetime(2100, 1, 1, tzinfo=UTC)
    while at < end:
        expected = koblick.day_number(at.timestamp()) + 2_451_543.5
        assert koblick.julian_day(at.year, at.month, at.day, 0.0) == expected
        at += timedelta(days=13)
