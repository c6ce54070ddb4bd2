"""The sun by name: accuracy against NREL SPA, one instant against many, what is refused."""

from datetime import UTC, datetime

import numpy as np
import pvlib
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.base.angles import wrap180
from app.sun.algorithms import PUBLISHED
from app.sun.position import (
    Algorithm,
    InstantRefused,
    Location,
    SunPath,
    SunPosition,
    sun_path,
    sun_position,
    wrap360_path,
)
from app.sun.refraction import refraction_deg, refraction_path
from app.sun.trigonometry import Array
from tests.fault_result import FaultResult
from tests.golden.table import GoldenRow, golden

SAMSUN = Location(41.2867, 36.33)
PLACES = 10
INSTANTS = 300
WORST_DEG = {algorithm: published.max_deg for algorithm, published in PUBLISHED.items()}
TOLERANCE = 1.02
REFRACTION_ROUNDING_DEG = 0.0005

algorithms = pytest.mark.parametrize("algorithm", list(Algorithm))
precise = pytest.mark.parametrize("algorithm", [one for one in Algorithm if WORST_DEG[one] < 0.02])
places = st.builds(Location, st.floats(-90.0, 90.0), st.floats(-180.0, 180.0))
instants = st.integers(-2_177_452_800, 4_102_444_799).map(lambda unix_s: datetime.fromtimestamp(unix_s, UTC))


def spa(location: Location, unix_s: Array) -> SunPath:
    latitude, longitude = location.latitude_deg, location.longitude_deg
    apparent_zenith, _, _, elevation, azimuth, _ = pvlib.spa.solar_position_numpy(
        unix_s, latitude, longitude, 0.0, 1010.0, 10.0, 69.0, 0.5667, 1
    )
    return SunPath(azimuth, elevation, 90.0 - apparent_zenith)


def separations_deg(a: SunPath, b: SunPath, *, apparent: bool) -> Array:
    first = np.radians(a.apparent_elevation_deg if apparent else a.elevation_deg)
    second = np.radians(b.apparent_elevation_deg if apparent else b.elevation_deg)
    turned = np.radians(a.azimuth_deg - b.azimuth_deg) / 2.0
    half = np.sin((first - second) / 2.0) ** 2 + np.cos(first) * np.cos(second) * np.sin(turned) ** 2
    return np.degrees(2.0 * np.arcsin(np.sqrt(half)))


@pytest.fixture(scope="module")
def sample() -> list[tuple[Location, Array, SunPath]]:
    random = np.random.default_rng(20260621)
    begin, end = datetime(2000, 1, 1, tzinfo=UTC).timestamp(), datetime(2050, 1, 1, tzinfo=UTC).timestamp()
    drawn = []
    for _ in range(PLACES):
        location = Location(float(random.uniform(-65.0, 65.0)), float(random.uniform(-180.0, 180.0)))
        unix_s = np.floor(random.uniform(begin, end, INSTANTS))
        drawn.append((location, unix_s, spa(location, unix_s)))
    return drawn


@precise
def test_the_apparent_sun_is_as_near_to_spa_as_the_true_one(
    algorithm: Algorithm, sample: list[tuple[Location, Array, SunPath]]
) -> None:
    for location, unix_s, reference in sample:
        found = sun_path(algorithm, location, unix_s)
        off = separations_deg(found, reference, apparent=True)[reference.elevation_deg > 0.0]
        assert off.max() <= WORST_DEG[algorithm] * TOLERANCE + REFRACTION_ROUNDING_DEG


@pytest.mark.parametrize("row", golden("spa_skyfield.csv"), ids=lambda row: row.case)
@algorithms
@pytest.mark.fault(36)
def test_golden_places_agree_with_spa_and_skyfield(
    algorithm: Algorithm, row: GoldenRow, fault: FaultResult
) -> None:
    sun = sun_position(algorithm, Location(row.latitude_deg, row.longitude_deg), row.at)
    worst_deg = WORST_DEG[algorithm]
    assert sun.elevation_deg == pytest.approx(row.values["spa_el_true"], abs=worst_deg)
    assert sun.elevation_deg == pytest.approx(row.values["skyfield_el_true"], abs=worst_deg)
    assert sun.apparent_elevation_deg == pytest.approx(row.values["spa_el_app_1010mb_10C"], abs=worst_deg)
    level = np.cos(np.radians(sun.elevation_deg))
    assert abs(wrap180(sun.azimuth_deg - row.values["spa_az"])) * level <= worst_deg
    fault.prevented("the sun is computed the same everywhere, within the stated degrees of SPA")
    fault.shows_nothing("nothing is wrong")
    fault.recovers("nothing was lost")


@algorithms
@given(location=places, at=instants)
def test_one_instant_and_many_agree(algorithm: Algorithm, location: Location, at: datetime) -> None:
    within_deg = 5e-7 if algorithm is Algorithm.SPA else 1e-9
    one = sun_position(algorithm, location, at)
    many = sun_path(algorithm, location, np.array([at.timestamp()]))
    assert 0.0 <= one.azimuth_deg < 360.0
    assert 0.0 <= float(many.azimuth_deg[0]) < 360.0
    level = np.cos(np.radians(one.elevation_deg))
    assert abs(wrap180(one.azimuth_deg - float(many.azimuth_deg[0]))) * level <= within_deg
    assert abs(one.elevation_deg - float(many.elevation_deg[0])) <= within_deg
    assert abs(one.apparent_elevation_deg - float(many.apparent_elevation_deg[0])) <= within_deg


def test_a_path_longer_than_a_block_is_whole() -> None:
    unix_s = np.arange(1.7e9, 1.7e9 + 20_000.0)
    path = sun_path(Algorithm.PSA, SAMSUN, unix_s)
    last = sun_path(Algorithm.PSA, SAMSUN, unix_s[-1:])
    assert path.azimuth_deg.shape == unix_s.shape
    assert path.elevation_deg[-1] == last.elevation_deg[0]
    assert np.abs(np.diff(path.elevation_deg)).max() < 0.01


def test_a_naive_instant_is_refused_with_what_to_do() -> None:
    with pytest.raises(InstantRefused, match="has no time zone: give the instant with its offset"):
        sun_position(Algorithm.PSA, SAMSUN, datetime(2026, 6, 21, 9, tzinfo=UTC).replace(tzinfo=None))


@pytest.mark.parametrize("year", [1900, 2100])
def test_years_outside_1901_to_2099_are_refused(year: int) -> None:
    at = datetime(year, 6, 1, tzinfo=UTC)
    with pytest.raises(InstantRefused, match="1901 to 2099"):
        sun_position(Algorithm.PSA, SAMSUN, at)
    with pytest.raises(InstantRefused, match="1901 to 2099"):
        sun_path(Algorithm.PSA, SAMSUN, np.array([at.timestamp()]))


@pytest.mark.parametrize("year", [1901, 2099])
@pytest.mark.fault(32)
def test_the_first_and_the_last_year_are_known(year: int) -> None:
    assert (
        -90.0
        <= sun_position(Algorithm.KOBLICK, SAMSUN, datetime(year, 6, 1, tzinfo=UTC)).elevation_deg
        <= 90.0
    )


@pytest.mark.parametrize(
    ("azimuth_deg", "wrapped_deg"), [(-1e-20, 0.0), (360.0, 0.0), (-90.0, 270.0), (90.0, 90.0)]
)
def test_azimuths_wrap_into_0_to_360(azimuth_deg: float, wrapped_deg: float) -> None:
    assert wrap360_path(np.array([azimuth_deg]))[0] == wrapped_deg


@pytest.mark.parametrize(("elevation_deg", "expected_deg"), [(0.0, 0.4830), (10.0, 0.0901), (-1.34, 0.0)])
def test_refraction_is_what_the_formula_says(elevation_deg: float, expected_deg: float) -> None:
    assert refraction_deg(elevation_deg) == pytest.approx(expected_deg, abs=1e-4)


def test_the_apparent_elevation_is_continuous_and_rises_with_the_true_one() -> None:
    true_deg = np.arange(-3.0, 3.0, 0.001)
    apparent_deg = true_deg + refraction_path(true_deg)
    steps = np.diff(apparent_deg)
    assert steps.min() > 0.0
    assert steps.max() < 0.0025


def test_the_sun_is_up_while_its_upper_limb_is() -> None:
    assert SunPosition(90.0, -0.83, -0.2).is_up
    assert not SunPosition(90.0, -0.84, -0.2).is_up


@pytest.mark.parametrize(
    ("fields", "words"),
    [((91.0, 0.0), "Latitude"), ((0.0, -181.0), "Longitude"), ((0.0, 0.0, 9001.0), "Altitude")],
)
def test_a_place_that_is_not_on_earth_is_refused(fields: tuple[float, ...], words: str) -> None:
    with pytest.raises(ValueError, match=f"{words} must lie between"):
        Location(*fields)
