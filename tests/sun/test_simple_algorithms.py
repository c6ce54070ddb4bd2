"""Every step of Cooper, of Spencer and Lamm, and of Alexandru against golden tables."""

from collections.abc import Iterable
from datetime import UTC, datetime, timedelta

import pytest

from app.base.angles import wrap360
from app.sun import alexandru, cooper, spencer_lamm
from app.sun.solar_days import day_and_hour, day_of_cycle, day_of_year
from app.sun.trigonometry import SCALAR
from tests.golden.table import GoldenRow, golden, numbers

NEAR = 1e-6
COOPER = golden("cooper.csv")
LAMM = golden("spencer_lamm.csv")
EQUATORIAL = golden("equatorial.csv")
cooper_cases = pytest.mark.parametrize("row", COOPER, ids=[row.case for row in COOPER])
lamm_cases = pytest.mark.parametrize("row", LAMM, ids=[row.case for row in LAMM])
equatorial_cases = pytest.mark.parametrize("row", EQUATORIAL, ids=[row.case for row in EQUATORIAL])


def mean_time(row: GoldenRow) -> tuple[float, float]:
    return day_and_hour(row.at.timestamp(), row.longitude_deg, SCALAR)


def day(row: GoldenRow) -> float:
    return day_of_year(mean_time(row)[0], SCALAR)


def near(row: GoldenRow, names: Iterable[str]) -> object:
    """Return the numbers of a row that are found but for rounding."""
    return pytest.approx({name: row.values[name] for name in names}, abs=NEAR)


def test_days_of_the_year_and_of_the_cycle_agree_with_the_calendar_from_1901_to_2099() -> None:
    at, end = datetime(1901, 1, 1, 12, tzinfo=UTC), datetime(2100, 1, 1, tzinfo=UTC)
    n_cycle = 366
    while at < end:
        n_cycle = 1 if (at.month, at.day) == (1, 1) and at.year % 4 == 0 else n_cycle + 1
        found, hour = day_and_hour(at.timestamp(), 0.0, SCALAR)
        assert hour == pytest.approx(12.0)
        assert day_of_year(found, SCALAR) == at.timetuple().tm_yday
        assert day_of_cycle(found, SCALAR) == n_cycle
        at += timedelta(days=1)


@cooper_cases
def test_cooper_as_printed_and_with_equation_of_time(row: GoldenRow) -> None:
    _, hour = mean_time(row)
    minutes = cooper.spencer_equation_of_time(day(row), SCALAR)
    instant = (row.at.timestamp(), row.latitude_deg, row.longitude_deg, SCALAR)
    printed, mended = cooper.position(*instant), cooper.position_with_equation_of_time(*instant)
    found = {
        "local_date_n": day(row),
        "dec": cooper.declination(day(row), SCALAR),
        "LMST_h": hour,
        "omega_noEoT": cooper.hour_angle(hour),
        "EoT_spencer_min": minutes,
        "omega_EoT": cooper.hour_angle(hour + minutes / 60.0),
        "Az_noEoT": wrap360(printed[0]),
        "Alt_noEoT": printed[1],
        "Az_EoT": wrap360(mended[0]),
        "Alt_EoT": mended[1],
    }
    assert found == near(row, found)


@lamm_cases
def test_spencers_declination_and_lamms_equation_of_time(row: GoldenRow) -> None:
    whole, hour = mean_time(row)
    gamma, cycle_day = spencer_lamm.day_angle(day(row)), day_of_cycle(whole, SCALAR)
    found_h = spencer_lamm.equation_of_time(cycle_day, SCALAR)
    azimuth, elevation = spencer_lamm.position(
        row.at.timestamp(), row.latitude_deg, row.longitude_deg, SCALAR
    )
    found = {
        "n": day(row),
        "Gamma_rad": gamma,
        "dec": spencer_lamm.declination(gamma, SCALAR),
        "N_cycle": cycle_day,
        "EoT_h": found_h,
        "omega": cooper.hour_angle(hour + found_h),
        "Az_north_cw": wrap360(azimuth),
        "Alt": elevation,
    }
    assert found == near(row, found)


def test_table_1_is_that_of_the_paper() -> None:
    printed = {int(row["k"]): (row["A_k_h"], row["B_k_h"]) for row in numbers("lamm_table1.csv")}
    assert dict(enumerate(spencer_lamm.LAMM_H)) == printed


@equatorial_cases
def test_alexandrus_declination_hour_angle_and_sun(row: GoldenRow) -> None:
    _, hour = mean_time(row)
    solar_h = hour + cooper.spencer_equation_of_time(day(row), SCALAR) / 60.0
    azimuth, elevation = alexandru.position(row.at.timestamp(), row.latitude_deg, row.longitude_deg, SCALAR)
    found = {
        "N": day(row),
        "solar_time_h": solar_h,
        "delta": alexandru.declination(day(row), SCALAR),
        "omega_paper_sign": alexandru.hour_angle(solar_h),
        "Az_north_cw": wrap360(azimuth),
        "Alt": elevation,
    }
    assert found == near(row, found)
