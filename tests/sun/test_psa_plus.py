"""PSA+ against golden/psa.csv, and its vectors against the angles of PSA."""

import pytest

from app.base.angles import wrap360
from app.sun import psa, psa_plus
from app.sun.trigonometry import SCALAR
from tests.golden.table import GoldenRow, golden

ROWS = golden("psa.csv")
cases = pytest.mark.parametrize("row", ROWS, ids=[row.case for row in ROWS])


@cases
def test_the_whole_chain(row: GoldenRow) -> None:
    azimuth, elevation = psa_plus.position(row.at.timestamp(), row.latitude_deg, row.longitude_deg, SCALAR)
    assert wrap360(azimuth) == pytest.approx(row.values["psa2020_azimuth"], abs=1e-6)
    assert elevation == pytest.approx(row.values["psa2020_elevation"], abs=1e-6)


@cases
def test_the_vectors_are_the_angles_of_psa(row: GoldenRow) -> None:
    sun = psa_plus.equatorial_vector(1.2, 0.409, SCALAR)
    right_ascension, declination = psa.equatorial(1.2, 0.409, SCALAR)
    vector = psa_plus.horizon_vector(sun, right_ascension + 0.7, row.latitude_deg, SCALAR)
    azimuth, zenith = psa_plus.horizontal(*vector, SCALAR)
    expected, expected_azimuth = psa.horizontal(declination, 0.7, row.latitude_deg, SCALAR)
    assert sum(part * part for part in vector) == pytest.approx(1.0, abs=1e-15)
    assert azimuth == pytest.approx(expected_azimuth, abs=1e-12)
    assert zenith == pytest.approx(expected + psa.parallax(expected, SCALAR), abs=1e-12)
