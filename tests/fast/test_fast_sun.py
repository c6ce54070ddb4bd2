"""The compiled sun against the formulas it stands for, and against pvlib's SPA."""

import math
from datetime import UTC, datetime

import numpy as np
import pvlib
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.base.angles import separation_deg
from app.fast.compiled import compiled
from app.fast.spa_table import build, delta_t_s
from app.fast.sun import psa_plus_path, spa_path
from app.fast.trigonometry import arctangent2, sine_cosine
from app.sun.position import Algorithm, Location, SunPath, sun_path
from app.sun.trigonometry import Array

YEAR_S = 1_767_225_600.0
ANGLES = st.floats(-1e4, 1e4)


@compiled
def polynomials(angle: Array, found: Array) -> None:
    for i in range(angle.size):
        found[0, i], found[1, i] = sine_cosine(angle[i])
        found[2, i] = arctangent2(found[0, i], found[1, i])


@given(st.lists(ANGLES, min_size=1, max_size=50))
@settings(max_examples=20, deadline=None)
def test_the_polynomials_keep_to_the_errors_they_claim(angles: list[float]) -> None:
    found = np.empty((3, len(angles)))
    polynomials(np.array(angles), found)
    for angle, sine, cosine, back in zip(angles, *found, strict=True):
        assert sine == pytest.approx(math.sin(angle), abs=7e-9)
        assert cosine == pytest.approx(math.cos(angle), abs=1e-9)
        assert math.remainder(back - angle, math.tau) == pytest.approx(0.0, abs=2.5e-8)


def instants(begin_s: float, days: float, count: int = 500) -> Array:
    return np.linspace(begin_s, begin_s + days * 86400.0 - 1.0, count)


def apart_deg(a: SunPath, azimuth_deg: Array, elevation_deg: Array) -> float:
    pairs = zip(a.azimuth_deg, a.elevation_deg, azimuth_deg, elevation_deg, strict=True)
    return max(separation_deg(*map(float, pair)) for pair in pairs)


@pytest.mark.parametrize("latitude_deg", [-89.9, 0.0, 41.2867])
def test_psa_plus_compiled_is_psa_plus(latitude_deg: float) -> None:
    place, at = Location(latitude_deg, 36.33), instants(YEAR_S - 20 * 365.25 * 86400.0, 40 * 365.25)
    ours, reference = psa_plus_path(place, at), sun_path(Algorithm("psa-plus"), place, at)
    assert apart_deg(ours, reference.azimuth_deg, reference.elevation_deg) < 2e-6
    assert np.all((ours.azimuth_deg >= 0.0) & (ours.azimuth_deg < 360.0))


@pytest.mark.parametrize(("latitude_deg", "altitude_m"), [(0.0, 2850.0), (78.2, 10.0)])
@pytest.mark.parametrize("year", [2000, 2049])
def test_the_table_is_spa_within_a_hundred_thousandth_of_a_degree(
    latitude_deg: float, altitude_m: float, year: int
) -> None:
    at = instants(datetime(year, 3, 1, tzinfo=UTC).timestamp(), 90.0)
    ours = spa_path(build(at[0], at[-1]), Location(latitude_deg, -70.5, altitude_m), at)
    spa = pvlib.spa.solar_position_numpy(
        at, latitude_deg, -70.5, altitude_m, 1010.0, 10.0, delta_t_s(at[0] // 86400.0), 0.5667, 1
    )
    assert apart_deg(ours, spa[4], spa[3]) < 1e-5


def test_an_instant_outside_the_table_is_refused() -> None:
    table = build(YEAR_S, YEAR_S + 86400.0)
    with pytest.raises(ValueError, match="does not cover"):
        spa_path(table, Location(41.0, 36.0), np.array([YEAR_S - 1.0]))
    with pytest.raises(ValueError, match="does not cover"):
        spa_path(table, Location(41.0, 36.0), np.array([YEAR_S, YEAR_S + 2 * 86400.0]))
