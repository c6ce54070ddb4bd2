"""Every step of Cooper, of Spencer and Lamm, and of Alexandru against golden tables."""

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


def near(value: float) -> object:
    return pytest.approx(value, abs=NEAR)


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
def test_eq_3_coopers_declination(row: GoldenRow) -> None:
    assert day(row) == row.values["local_date_n"]
    assert cooper.declination(day(row), SCALAR) == near(row.values["dec"])


@cooper_cases
def test_the_hour_angle_that_the_paper_leaves_out(row: GoldenRow) -> None:
    _, hour = mean_time(row)
    minutes = cooper.spencer_equation_of_time(day(row), SCALAR)
    assert hour == near(row.values["LMST_h"])
    assert cooper.hour_angle(hour) == near(row.values["omega_noEoT"])
    assert minutes == near(row.values["EoT_spencer_min"])
    assert cooper.hour_angle(hour + minutes / 60.0) == near(row.values["omega_EoT"])


@cooper_cases
def test_eqs_16_and_17_azimuth_and_elevation(row: GoldenRow) -> None:
    azimuth, elevation = cooper.horizontal(
        row.values["dec"], row.values["omega_noEoT"], row.latitude_deg, SCALAR
    )
    assert wrap360(azimuth) == pytest.approx(row.values["Az_noEoT"], abs=2e-5)
    assert elevation == near(row.values["Alt_noEoT"])


@cooper_cases
def test_cooper_as_printed_and_with_equation_of_time(row: GoldenRow) -> None:
    instant = (row.at.timestamp(), row.latitude_deg, row.longitude_deg, SCALAR)
    printed, mended = cooper.position(*instant), cooper.position_with_equation_of_time(*instant)
    assert wrap360(printed[0]) == near(row.values["Az_noEoT"])
    assert printed[1] == near(row.values["Alt_noEoT"])
    assert wrap360(mended[0]) == near(row.values["Az_EoT"])
    assert mended[1] == near(row.values["Alt_EoT"])


@lamm_cases
def test_eq_3_spencers_declination(row: GoldenRow) -> None:
    gamma = spencer_lamm.day_angle(day(row))
    assert day(row) == row.values["n"]
    assert gamma == near(row.values["Gamma_rad"])
    assert spencer_lamm.declination(gamma, SCALAR) == near(row.values["dec"])


@lamm_cases
def test_eq_4_lamms_equation_of_time(row: GoldenRow) -> None:
    whole, hour = mean_time(row)
    cycle_day = day_of_cycle(whole, SCALAR)
    found_h = spencer_lamm.equation_of_time(cycle_day, SCALAR)
    assert cycle_day == row.values["N_cycle"]
    assert found_h == near(row.values["EoT_h"])
    assert cooper.hour_angle(hour + found_h) == near(row.values["omega"])


@lamm_cases
def test_eqs_1_and_2_spencer_and_lamm(row: GoldenRow) -> None:
    azimuth, elevation = spencer_lamm.position(
        row.at.timestamp(), row.latitude_deg, row.longitude_deg, SCALAR
    )
    assert wrap360(azimuth) == near(row.values["Az_north_cw"])
    assert elevation == near(row.values["Alt"])


def test_table_1_is_that_of_the_paper() -> None:
    printed = {int(row["k"]): (row["A_k_h"], row["B_k_h"]) for row in numbers("lamm_table1.csv")}
    assert dict(enumerate(spencer_lamm.LAMM_H)) == printed


@equatorial_cases
def test_eq_8_alexandrus_declination_and_hour_angle(row: GoldenRow) -> None:
    _, hour = mean_time(row)
    solar_h = hour + cooper.spencer_equation_of_time(day(row), SCALAR) / 60.0
    assert day(row) == row.values["N"]
    assert solar_h == near(row.values["solar_time_h"])
    assert alexandru.declination(day(row), SCALAR) == near(row.values["delta"])
    assert alexandru.hour_angle(solar_h) == near(row.values["omega_paper_sign"])


@equatorial_cases
def test_alexandrus_sun(row: GoldenRow) -> None:
    azimuth, elevation = alexandru.position(row.at.timestamp(), row.latitude_deg, row.longitude_deg, SCALAR)
    assert wrap360(azimuth) == near(row.values["Az_north_cw"])
    assert elevation == near(row.values["Alt"])
