"""From a direction of the sky to axis angles and back."""

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from app.base.angles import separation_deg
from app.sun.position import SunPosition
from app.tracker.memory.memory import Pointing
from app.tracker.mounts.mount import aim, mode_direction, sky
from app.tracker.settings.config import Orientation
from app.tracker.values.mode import Mode
from tests.tracker.shows import PLAIN, with_range

LEVEL = Pointing()

leans = st.floats(-5.0, 5.0)
pointings = st.builds(Pointing, st.floats(-180.0, 180.0), st.floats(-3.0, 3.0), leans, leans)


@pytest.mark.parametrize(
    ("minimum_deg", "maximum_deg", "azimuth_deg", "near_deg", "expected_deg"),
    [
        (0.0, 360.0, 350.0, 10.0, 350.0),
        (0.0, 360.0, 10.0, 350.0, 10.0),
        (-180.0, 180.0, 190.0, 170.0, -170.0),
        (0.0, 540.0, 10.0, 350.0, 370.0),
        (0.0, 540.0, 10.0, 100.0, 10.0),
        (-360.0, 360.0, 90.0, -300.0, -270.0),
    ],
)
def test_the_equivalent_azimuth_nearest_to_the_axis_is_taken(
    minimum_deg: float, maximum_deg: float, azimuth_deg: float, near_deg: float, expected_deg: float
) -> None:
    target = aim(with_range(minimum_deg, maximum_deg), LEVEL, Orientation(azimuth_deg, 30.0), near_deg)
    assert target.azimuth_deg == expected_deg
    assert target.elevation_deg == 30.0
    assert not target.limited


@pytest.mark.parametrize(
    ("azimuth_deg", "stop_deg"), [(60.0, 90.0), (300.0, 270.0), (10.0, 90.0), (350.0, 270.0)]
)
def test_a_direction_out_of_reach_gives_the_nearer_end_stop_and_says_so(
    azimuth_deg: float, stop_deg: float
) -> None:
    target = aim(with_range(90.0, 270.0), LEVEL, Orientation(azimuth_deg, 30.0), 180.0)
    assert target.azimuth_deg == stop_deg
    assert target.limited


def test_a_direction_midway_between_two_stops_goes_to_the_one_nearer_to_the_axis() -> None:
    assert aim(with_range(90.0, 270.0), LEVEL, Orientation(0.0, 30.0), 250.0).azimuth_deg == 270.0
    assert aim(with_range(90.0, 270.0), LEVEL, Orientation(0.0, 30.0), 100.0).azimuth_deg == 90.0


def test_a_mast_that_leans_north_sees_the_north_higher_and_the_south_lower() -> None:
    lean = Pointing(lean_north_deg=2.0)
    assert aim(PLAIN, lean, Orientation(0.0, 40.0), 0.0).elevation_deg == pytest.approx(42.0)
    assert aim(PLAIN, lean, Orientation(180.0, 40.0), 180.0).elevation_deg == pytest.approx(38.0)


@given(
    pointing=pointings,
    azimuth_deg=st.floats(0.0, 359.999),
    elevation_deg=st.floats(0.0, 89.0),
    near_deg=st.floats(-360.0, 720.0),
    lower_deg=st.floats(-400.0, 0.0),
    width_deg=st.floats(360.0, 700.0),
)
def test_sky_is_the_inverse_of_aim(
    pointing: Pointing,
    azimuth_deg: float,
    elevation_deg: float,
    near_deg: float,
    lower_deg: float,
    width_deg: float,
) -> None:
    config = with_range(lower_deg, lower_deg + width_deg)
    target = aim(config, pointing, Orientation(azimuth_deg, elevation_deg), near_deg)
    assert config.azimuth.contains(target.azimuth_deg)
    assert config.elevation.contains(target.elevation_deg)
    assume(not target.limited)
    faced = sky(config, pointing, target.azimuth_deg, target.elevation_deg)
    assert 0.0 <= faced.azimuth_deg < 360.0
    assert separation_deg(faced.azimuth_deg, faced.elevation_deg, azimuth_deg, elevation_deg) < 1e-6


def test_each_mode_follows_the_sun_on_its_axes_and_holds_the_others() -> None:
    held, sun = Orientation(10.0, 20.0), SunPosition(150.0, 40.0, 40.1)
    assert mode_direction(Mode.FIXED, held, sun, refraction=True) == held
    assert mode_direction(Mode.AZIMUTH, held, sun, refraction=True) == Orientation(150.0, 20.0)
    assert mode_direction(Mode.ELEVATION, held, sun, refraction=True) == Orientation(10.0, 40.1)
    assert mode_direction(Mode.DUAL, held, sun, refraction=True) == Orientation(150.0, 40.1)
    assert mode_direction(Mode.DUAL, held, sun, refraction=False) == Orientation(150.0, 40.0)
