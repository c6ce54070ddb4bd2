"""NREL SPA by pvlib: golden values, delta T, and what happens without pvlib."""

import subprocess
import sys

import numpy as np
import pytest

from app.base.angles import wrap360
from app.sun import koblick, spa
from app.sun.trigonometry import SCALAR
from tests.golden.table import GoldenRow, golden
from tests.patience import PATIENCE_S

ROWS = golden("spa_skyfield.csv")
cases = pytest.mark.parametrize("row", ROWS, ids=[row.case for row in ROWS])
KOBLICK = {row.case: row for row in golden("koblick.csv")}


@cases
def test_spa_is_that_of_the_golden_table(row: GoldenRow) -> None:
    azimuth, elevation = spa.position_of_one(row.at.timestamp(), row.latitude_deg, row.longitude_deg)
    level = np.cos(np.radians(elevation))
    assert wrap360(azimuth) * level == pytest.approx(row.values["spa_az"] * level, abs=2e-4)
    assert elevation == pytest.approx(row.values["spa_el_true"], abs=2e-4)


def test_delta_t_is_measured_interpolated_and_held() -> None:
    at = np.array([946_728_000.0, 1_104_580_800.0, 1_782_000_000.0, 4_000_000_000.0])
    assert spa.delta_t_s(at) == pytest.approx([63.8, 64.7, 69.1, 69.1], abs=0.05)


def test_without_pvlib_it_says_what_to_do() -> None:
    with pytest.raises(spa.AlgorithmMissing, match="install it"):
        spa._solar_position("no_such_package_at_all")


def test_neither_pvlib_nor_pandas_is_loaded_for_it() -> None:
    asked = (
        "import sys; from app.sun import spa; spa.position_of_one(1.7e9, 41.0, 36.0); "
        "print([name for name in ('pvlib', 'pandas') if name in sys.modules])"
    )
    told = subprocess.run(
        [sys.executable, "-c", asked], capture_output=True, text=True, check=True, timeout=PATIENCE_S
    )
    assert told.stdout.strip() == "[]"


def test_one_instant_after_another_is_what_many_at_once_are() -> None:
    at = np.arange(1_782_000_000.0, 1_782_086_400.0, 997.0)
    for latitude_deg in (-89.9, -34.0, 0.0, 23.4, 78.0):
        azimuth_deg, elevation_deg = spa.position(at, latitude_deg, 36.0)
        one = np.array([spa.position_of_one(instant, latitude_deg, 36.0) for instant in at.tolist()])
        turned_deg = np.mod(one[:, 0] - azimuth_deg + 180.0, 360.0) - 180.0
        assert np.abs(turned_deg * np.cos(np.radians(elevation_deg))).max() < 5e-7
        assert np.abs(one[:, 1] - elevation_deg).max() < 5e-7


@cases
def test_parallax_lowers_koblicks_sun_by_its_own_angle(row: GoldenRow) -> None:
    instant = (row.at.timestamp(), row.latitude_deg, row.longitude_deg, SCALAR)
    _, plain = koblick.position(*instant)
    _, lowered = koblick.position_with_parallax(*instant)
    distance_au = KOBLICK[row.case].values["r"]
    expected = 8.794 / 3600.0 / distance_au * np.cos(np.radians(plain))
    assert plain - lowered == pytest.approx(expected, abs=1e-8)
