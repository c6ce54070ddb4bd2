"""The survey of accuracy: the errors that the table of algorithms promises, and what a survey tells."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.base.angles import separation_deg
from app.sun.accuracy import MEASURED, Question, Sight, Survey, separations_deg, survey
from app.sun.accuracy_table import table
from app.sun.algorithms import PUBLISHED, Algorithm
from app.sun.position import Location

MIDNIGHT_SUN_DEG = 0.96
"""Spencer's whole day is farthest from the sun at midnight, where the sun is up only beyond 65 degrees."""
SAMSUN = Location(41.2867, 36.33)
azimuths = st.floats(0.0, 360.0)
elevations = st.floats(-90.0, 90.0)


@pytest.fixture(scope="module")
def globe() -> Survey:
    return survey(Question(samples=30_000))


@pytest.mark.parametrize("algorithm", MEASURED)
def test_no_algorithm_is_farther_from_spa_than_its_table_says(algorithm: Algorithm, globe: Survey) -> None:
    found = next(error for error in globe.errors if error.algorithm is algorithm).spreads[Sight.TRUE]
    expected = PUBLISHED[algorithm]
    assert globe.sun_up > 12_000
    assert 0.85 * expected.max_deg <= found.max_deg <= 1.02 * expected.max_deg
    assert found.rms_deg == pytest.approx(expected.rms_deg, rel=0.04)


@pytest.mark.parametrize("latitudes", [(-90.0, -65.0), (-65.0, 0.0), (0.0, 65.0), (65.0, 90.0)])
def test_every_algorithm_holds_its_error_in_both_hemispheres_to_the_poles(
    latitudes: tuple[float, float],
) -> None:
    beyond = {Algorithm.SPENCER_LAMM: MIDNIGHT_SUN_DEG} if max(latitudes, key=abs) in (-90.0, 90.0) else {}
    for error in survey(Question(samples=6_000, latitudes=latitudes)).errors:
        most_deg = beyond.get(error.algorithm, PUBLISHED[error.algorithm].max_deg)
        assert error.spreads[Sight.TRUE].max_deg <= 1.02 * most_deg


def test_leaving_refraction_out_costs_half_a_degree_at_the_horizon(globe: Survey) -> None:
    psa = next(error for error in globe.errors if error.algorithm is Algorithm.PSA)
    assert psa.spreads[Sight.APPARENT].max_deg == pytest.approx(psa.spreads[Sight.TRUE].max_deg, rel=0.02)
    assert 0.45 < psa.spreads[Sight.UNREFRACTED].max_deg < 0.50


def test_the_profiles_reach_the_maximum_and_mean_the_rms(globe: Survey) -> None:
    for error in globe.errors:
        whole = error.spreads[Sight.TRUE]
        for profile in (error.over_year, error.over_elevation):
            assert np.nanmax(profile.max_deg) == whole.max_deg
            assert np.nanmin(profile.rms_deg) <= whole.rms_deg <= np.nanmax(profile.rms_deg)
    assert len(globe.day_of_year) == len(globe.errors[0].over_year.max_deg) == 73
    assert len(globe.elevation_deg) == len(globe.errors[0].over_elevation.max_deg) == 18


def test_a_site_where_the_sun_never_stands_high_has_no_error_there() -> None:
    found = survey(Question(Location(78.22, 15.65), 2026, 2026, 2_000), [Algorithm.PSA])
    heights = found.errors[0].over_elevation.max_deg
    assert np.isnan(heights[found.elevation_deg > 40.0]).all()
    assert not np.isnan(heights[found.elevation_deg < 20.0]).any()


def test_the_table_has_a_line_for_every_algorithm(globe: Survey) -> None:
    lines = table(globe).splitlines()
    assert "latitude -65 to 65, 2000 to 2049" in lines[0]
    assert [line.split()[0] for line in lines[3:12]] == [algorithm.value for algorithm in MEASURED]
    assert "latitude 41.2867" in table(survey(Question(SAMSUN, 2026, 2026, 1_000), [Algorithm.PSA]))


@pytest.mark.parametrize(
    ("fields", "words"),
    [
        ({"from_year": 2050, "to_year": 2000}, "the first not after the last"),
        ({"from_year": 1900}, "between 1901 and 2099"),
        ({"samples": 999}, "between 1,000 and 500,000"),
    ],
)
def test_what_cannot_be_measured_is_refused(fields: dict[str, int], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        Question(**fields)


@given(azimuths, elevations, azimuths, elevations)
def test_separation_of_one_pair_and_of_many_agree(a: float, b: float, c: float, d: float) -> None:
    many = separations_deg(*(np.array([value]) for value in (a, b, c, d)))
    assert many[0] == pytest.approx(separation_deg(a, b, c, d), abs=1e-5)
