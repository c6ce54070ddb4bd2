"""Every mount: its angles and the sky, there and back, and pvlib's trackers beside them."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pvlib
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from app.base.angles import separation_deg, wrap180
from app.sun.position import SunPosition
from app.sun.trigonometry import ARRAY, SCALAR
from app.tracker.memory.memory import Pointing
from app.tracker.mounts.kinematics import angles, direction, followed
from app.tracker.mounts.mount import aim, mode_direction, sky, to_axes
from app.tracker.settings.axes import AxisConfig
from app.tracker.settings.config import MountConfig, MountKind, Orientation, Rows, TrackerConfig
from app.tracker.values.mode import Mode
from tests.tracker.shows import PLAIN, with_range

FREE = AxisConfig(-180.0, 180.0, 6.0, 6.0, 0.5, 3.0)
BOTH_WAYS = AxisConfig(-90.0, 90.0, 4.0, 6.0, 0.5, 2.0)
LEVEL = Pointing()
HELD = Orientation(180.0, 45.0)

azimuths = st.floats(0.0, 359.99)
tilts = st.floats(0.0, 90.0)
mounts = st.builds(MountConfig, st.sampled_from(MountKind), azimuths, tilts, tilts)
two_axes = mounts.filter(lambda mount: not mount.single_axis)
one_axis = mounts.filter(lambda mount: mount.single_axis)
heights = st.floats(-89.0, 89.0)


def tracker(mount: MountConfig) -> TrackerConfig:
    return replace(TrackerConfig("t01", "T01"), azimuth=FREE, elevation=BOTH_WAYS, mount=mount)


def sun_at(azimuth_deg: float, elevation_deg: float) -> SunPosition:
    return SunPosition(azimuth_deg, elevation_deg, elevation_deg)


@given(two_axes, azimuths, heights, st.floats(-20.0, 20.0), st.floats(-3.0, 3.0))
def test_two_axes_face_every_direction_and_say_which(
    mount: MountConfig, azimuth_deg: float, elevation_deg: float, first_deg: float, second_deg: float
) -> None:
    pointing, wanted = Pointing(first_deg, second_deg), Orientation(azimuth_deg, elevation_deg)
    config = replace(tracker(mount), elevation=replace(BOTH_WAYS, minimum_deg=-100.0, maximum_deg=100.0))
    target = aim(config, pointing, wanted, 0.0)
    faced = sky(config, pointing, target.azimuth_deg, target.elevation_deg)
    assert not target.limited
    assert separation_deg(azimuth_deg, elevation_deg, faced.azimuth_deg, faced.elevation_deg) < 1e-6


@given(one_axis, st.floats(-179.0, 179.0))
def test_a_rotation_faces_a_direction_that_leads_back_to_it(mount: MountConfig, rotation_deg: float) -> None:
    assume(mount.kind is not MountKind.VERTICAL_SINGLE_AXIS or mount.panel_tilt_deg > 1.0)
    config = tracker(mount)
    faced = sky(config, LEVEL, rotation_deg, 0.0)
    target = aim(config, LEVEL, faced, rotation_deg)
    assert target.azimuth_deg == pytest.approx(rotation_deg, abs=1e-7)


@given(one_axis, azimuths, heights, st.floats(-90.0, 90.0))
def test_no_other_rotation_within_its_limits_is_nearer_to_the_sun(
    mount: MountConfig, azimuth_deg: float, elevation_deg: float, other_deg: float
) -> None:
    config = replace(tracker(mount), azimuth=replace(FREE, minimum_deg=-90.0, maximum_deg=90.0))
    target = aim(config, LEVEL, Orientation(azimuth_deg, elevation_deg), 0.0)
    off_deg = [
        separation_deg(faced.azimuth_deg, faced.elevation_deg, azimuth_deg, elevation_deg)
        for faced in (sky(config, LEVEL, angle, 0.0) for angle in (target.azimuth_deg, other_deg))
    ]
    assert off_deg[0] <= off_deg[1] + 1e-9


@given(mounts, st.sampled_from(Mode), azimuths, heights)
def test_arrays_and_numbers_come_from_one_formula(
    mount: MountConfig, mode: Mode, azimuth_deg: float, elevation_deg: float
) -> None:
    held = (HELD.azimuth_deg, HELD.elevation_deg)
    one = followed(mount, mode, held, (azimuth_deg, elevation_deg), SCALAR)
    many = followed(mount, mode, held, (np.full(3, azimuth_deg), np.full(3, elevation_deg)), ARRAY)
    assert many[0] == pytest.approx(np.full(3, one[0]), abs=1e-9)
    assert many[1] == pytest.approx(np.full(3, one[1]), abs=1e-9)


@pytest.mark.parametrize(
    ("axis_azimuth_deg", "tilt_deg", "slope_deg", "ratio"),
    [
        (180.0, 0.0, 0.0, 0.4),
        (0.0, 0.0, 0.0, 0.35),
        (195.0, 0.0, 7.5, 0.45),
        (180.0, 25.0, 0.0, 0.5),
        (170.0, 12.0, -6.0, 0.6),
        (355.0, 18.0, 9.0, 0.3),
        (90.0, 0.0, 4.0, 0.4),
    ],
)
@pytest.mark.parametrize("latitude_deg", [52.0, 12.97, -33.9])
def test_rotation_and_backtracking_are_pvlibs(
    axis_azimuth_deg: float, tilt_deg: float, slope_deg: float, ratio: float, latitude_deg: float
) -> None:
    times = pd.date_range("2026-01-05", periods=700, freq="12h37min", tz="UTC")
    sun = pvlib.solarposition.get_solarposition(times, latitude_deg, 30.0)
    sun = sun[sun["apparent_elevation"] > 0.0]
    kind = MountKind.TILTED_SINGLE_AXIS if tilt_deg else MountKind.HORIZONTAL_SINGLE_AXIS
    for rows in (None, Rows(ratio, slope_deg)):
        mount = MountConfig(kind, axis_azimuth_deg, tilt_deg, rows=rows)
        theirs = pvlib.tracking.singleaxis(
            sun["apparent_zenith"],
            sun["azimuth"],
            axis_tilt=tilt_deg,
            axis_azimuth=axis_azimuth_deg,
            max_angle=55.0,
            backtrack=rows is not None,
            gcr=ratio,
            cross_axis_tilt=slope_deg,
        )
        path = (sun["azimuth"].to_numpy(), sun["apparent_elevation"].to_numpy())
        ours_deg = np.clip(followed(mount, Mode.AZIMUTH, (0.0, 0.0), path, ARRAY)[0], -55.0, 55.0)
        assert ours_deg == pytest.approx(theirs["tracker_theta"].to_numpy(), abs=1e-6)
        faced_deg = direction(mount, ours_deg, 0.0 * ours_deg, ARRAY)
        assert 90.0 - faced_deg[1] == pytest.approx(theirs["surface_tilt"].to_numpy(), abs=1e-6)


@pytest.mark.parametrize(("latitude_deg", "pole_azimuth_deg"), [(45.65, 180.0), (-33.9, 0.0), (0.0, 180.0)])
@given(hour_angle_deg=st.floats(-120.0, 120.0), declination_deg=st.floats(-23.45, 23.45))
def test_an_equatorial_mount_turns_by_hour_angle_and_declination(
    latitude_deg: float, pole_azimuth_deg: float, hour_angle_deg: float, declination_deg: float
) -> None:
    hour, declination, latitude = np.radians([hour_angle_deg, declination_deg, latitude_deg])
    west = np.cos(declination) * np.sin(hour)
    north = np.cos(latitude) * np.sin(declination) - np.sin(latitude) * np.cos(declination) * np.cos(hour)
    up = np.sin(latitude) * np.sin(declination) + np.cos(latitude) * np.cos(declination) * np.cos(hour)
    azimuth_deg = float(np.degrees(np.arctan2(-west, north)))
    elevation_deg = float(np.degrees(np.arctan2(up, np.hypot(west, north))))
    mount = MountConfig(MountKind.EQUATORIAL, pole_azimuth_deg, abs(latitude_deg))
    found = angles(mount, azimuth_deg, elevation_deg, SCALAR)
    assert found == pytest.approx((hour_angle_deg, declination_deg), abs=1e-6)


@given(st.floats(-170.0, 170.0), st.floats(1.0, 89.0), st.floats(0.0, 180.0))
def test_least_incidence_passes_the_zenith_and_no_elevation_is_nearer(
    aside_deg: float, height_deg: float, other_deg: float
) -> None:
    mount = MountConfig(least_incidence=True)
    config = replace(tracker(mount), elevation=replace(BOTH_WAYS, minimum_deg=0.0, maximum_deg=180.0))
    sun = sun_at((180.0 + aside_deg) % 360.0, height_deg)
    wanted = mode_direction(Mode.ELEVATION, HELD, sun, refraction=True, mount=mount)
    assert wanted.azimuth_deg == 180.0
    assert (wanted.elevation_deg > 90.0) == (abs(aside_deg) > 90.0)
    target = aim(config, LEVEL, wanted, 180.0)
    assert not target.limited
    off_deg = [
        separation_deg(faced.azimuth_deg, faced.elevation_deg, sun.azimuth_deg, height_deg)
        for faced in (sky(config, LEVEL, 180.0, angle) for angle in (target.elevation_deg, other_deg))
    ]
    assert off_deg[0] <= off_deg[1] + 1e-9


@given(st.floats(91.0, 170.0), st.floats(-5.0, 5.0), st.floats(-5.0, 5.0), azimuths)
def test_over_the_top_of_a_leaning_mast_the_azimuth_axis_does_not_turn_over(
    elevation_deg: float, north_deg: float, east_deg: float, azimuth_deg: float
) -> None:
    assume(elevation_deg > 97.0)
    lean = Pointing(lean_north_deg=north_deg, lean_east_deg=east_deg)
    first_deg, second_deg = to_axes(MountConfig(), lean, azimuth_deg, elevation_deg, SCALAR)
    assert abs(wrap180(first_deg - azimuth_deg)) < 90.0
    assert second_deg > 90.0
    faced = sky(tracker(MountConfig()), lean, first_deg, second_deg)
    wanted = (azimuth_deg + 180.0, 180.0 - elevation_deg)
    assert separation_deg(*wanted, faced.azimuth_deg, faced.elevation_deg) < 1e-6


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


def test_a_mast_sees_higher_where_it_leans_to_and_offsets_are_added() -> None:
    lean = Pointing(lean_north_deg=2.0)
    assert aim(PLAIN, lean, Orientation(0.0, 40.0), 0.0).elevation_deg == pytest.approx(42.0)
    assert aim(PLAIN, lean, Orientation(180.0, 40.0), 180.0).elevation_deg == pytest.approx(38.0)
    lean = Pointing(lean_east_deg=2.0)
    assert aim(PLAIN, lean, Orientation(90.0, 40.0), 90.0).elevation_deg == pytest.approx(42.0)
    assert aim(PLAIN, lean, Orientation(270.0, 40.0), 270.0).elevation_deg == pytest.approx(38.0)
    offset = Pointing(azimuth_offset_deg=3.0, elevation_offset_deg=-1.0)
    assert aim(PLAIN, offset, Orientation(100.0, 40.0), 0.0)[:2] == (103.0, 39.0)
    assert sky(PLAIN, LEVEL, 100.0, 95.0) == Orientation(280.0, 85.0), "past the zenith"


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
