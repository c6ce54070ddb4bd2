"""Where the sun is in the zenith, and where it is on the horizon: both against the position of the sun."""

from datetime import UTC, datetime, timedelta

import pytest

from app.sun.position import Algorithm, InstantRefused, Location, sun_position
from app.sun.terminator import subsolar_point, terminator_deg

SOLSTICE = datetime(2027, 6, 21, 9, 40, tzinfo=UTC)
EQUINOX = datetime(2027, 3, 20, 20, 25, tzinfo=UTC)
INSTANTS = [SOLSTICE + timedelta(days=days, hours=5 * days) for days in range(0, 360, 24)] + [EQUINOX]
NEAR_DEG = 0.02
"""Algorithms that consider the parallax see the sun up to 0.0024 degrees lower than from Earth's middle."""
ALGORITHMS = (Algorithm.PSA, Algorithm.PSA_PLUS, Algorithm.SPA)


@pytest.mark.parametrize("algorithm", ALGORITHMS)
@pytest.mark.parametrize("at", INSTANTS, ids=str)
def test_the_sun_is_in_the_zenith_there(algorithm: Algorithm, at: datetime) -> None:
    there = subsolar_point(algorithm, at)
    assert sun_position(algorithm, there, at).elevation_deg == pytest.approx(90.0, abs=NEAR_DEG)
    assert abs(there.latitude_deg) < 23.45


@pytest.mark.parametrize("algorithm", ALGORITHMS)
@pytest.mark.parametrize("at", INSTANTS, ids=str)
def test_the_sun_is_on_the_horizon_all_along_the_line(algorithm: Algorithm, at: datetime) -> None:
    there = subsolar_point(algorithm, at)
    for longitude_deg in range(-180, 181, 15):
        place = Location(terminator_deg(there, longitude_deg), longitude_deg)
        assert sun_position(algorithm, place, at).elevation_deg == pytest.approx(0.0, abs=NEAR_DEG)


def test_it_is_over_the_tropic_in_june_and_over_its_meridian_at_noon() -> None:
    there = subsolar_point(Algorithm.SPA, datetime(2027, 6, 21, 12, tzinfo=UTC))
    assert there.latitude_deg == pytest.approx(23.44, abs=0.01)
    assert there.longitude_deg == pytest.approx(0.46, abs=0.05), "the equation of time is -1.8 min"


def test_on_an_exact_equinox_there_is_a_line() -> None:
    assert abs(terminator_deg(Location(0.0, 0.0), 0.0)) > 89.9


def test_years_of_no_known_sun_are_refused() -> None:
    with pytest.raises(InstantRefused):
        subsolar_point(Algorithm.PSA, datetime(1900, 1, 1, tzinfo=UTC))
