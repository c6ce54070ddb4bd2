"""What strategies hold, how far they are off, how often they move, and what that costs."""

import numpy as np
import pytest

from app.energy.holding import held_axes, separations_deg, turned_deg
from app.energy.ideal import AxisPath
from app.energy.motion import DriveCosts, drives_wh, travelled
from app.energy.programmed import equatorial_mount, program_axes, solar_hours
from app.sun.position import Algorithm, Location, sun_path
from app.sun.trigonometry import ARRAY
from app.tracker.mounts.kinematics import angles
from app.tracker.settings.config import MountConfig
from app.tracker.settings.stepped import ProgramStep, StepFrame, StepProgram, program_of
from app.tracker.settings.strategy import (
    Continuous,
    Deadband,
    EncoderDeadband,
    Interval,
    IntervalAim,
    Stepped,
)

SAMSUN = Location(41.2867, 36.33)
DAYS, STEPS = 1, 1440
MIDSUMMER = 1_781_992_800.0
"""2026-06-20 22:00 UTC."""


@pytest.fixture(scope="module")
def days() -> tuple[AxisPath, np.ndarray]:
    path = sun_path(Algorithm.PSA, SAMSUN, MIDSUMMER + 60.0 * np.arange(DAYS * STEPS))
    shape = (DAYS, STEPS)
    ideal = AxisPath(path.azimuth_deg.reshape(shape), path.apparent_elevation_deg.reshape(shape))
    return ideal, (path.elevation_deg > 0).reshape(shape)


def off_deg(ideal: AxisPath, up: np.ndarray, strategy, deadband_deg: float = 1.0) -> np.ndarray:
    held = held_axes(strategy, ideal, up, step_min=1.0, deadband_deg=deadband_deg)
    return separations_deg(held, ideal)[up]


def test_continuous_is_never_off_by_day_and_waits_at_sunrise(days: tuple) -> None:
    ideal, up = days
    assert off_deg(ideal, up, Continuous()).max() < 1e-9
    held = held_axes(Continuous(), ideal, up, step_min=1.0, deadband_deg=1.0)
    first = up.argmax(axis=1)
    assert held.first_deg[:, 0] == pytest.approx(ideal.first_deg[np.arange(DAYS), first])
    assert (np.diff(held.first_deg[:, -60:]) == 0).all()


def test_the_deadband_bounds_the_error_and_saves_moves(days: tuple) -> None:
    ideal, up = days
    errors = [off_deg(ideal, up, Deadband(), band).max() for band in (0.5, 1.0, 3.0)]
    assert all(error <= band for error, band in zip(errors, (0.5, 1.0, 3.0), strict=True))
    moves = [
        travelled(held_axes(Deadband(), ideal, up, step_min=1.0, deadband_deg=band)).moves.mean()
        for band in (0.5, 1.0, 3.0)
    ]
    assert moves[0] > 1.5 * moves[1] > 3 * moves[2]


def test_axes_that_count_move_by_themselves(days: tuple) -> None:
    ideal, up = days
    held = held_axes(EncoderDeadband(10, 3600), ideal, up, step_min=1.0, deadband_deg=9.0)
    for held_deg, ideal_deg in ((held.first_deg, ideal.first_deg), (held.second_deg, ideal.second_deg)):
        assert np.abs(turned_deg(held_deg, ideal_deg))[up].max() < 1.0
    moved = np.diff(held.first_deg) != 0, np.diff(held.second_deg) != 0
    assert (moved[0] & ~moved[1]).any()
    assert (moved[1] & ~moved[0]).any()


def test_an_interval_aimed_at_its_middle_is_half_as_wrong(days: tuple) -> None:
    ideal, up = days
    middle = off_deg(ideal, up, Interval(20, IntervalAim.MIDDLE)).max()
    now = off_deg(ideal, up, Interval(20, IntervalAim.NOW)).max()
    assert middle == pytest.approx(2.5, abs=0.3)
    assert now == pytest.approx(2 * middle, rel=0.15)


def test_a_program_is_no_strategy_of_the_sun(days: tuple) -> None:
    program = program_of("Any", (12.0,), (-30.0, 30.0), second_deg=20.0)
    with pytest.raises(ValueError, match="has its own positions"):
        held_axes(Stepped(program), *days, step_min=1.0, deadband_deg=1.0)


def test_the_way_back_is_travel_too() -> None:
    there = AxisPath(np.array([[350.0, 0.0, 10.0, 10.0]]), np.full((1, 4), 30.0))
    seen = travelled(there)
    assert seen.travel_deg[0] == pytest.approx(40.0)
    assert seen.moves[0] == 3
    assert travelled(there, without_rest=True).moves[0] == 2
    round_the_pole = AxisPath(np.arange(0.0, 361.0, 10.0)[None, :], np.full((1, 37), 20.0))
    assert travelled(round_the_pole).travel_deg[0] == pytest.approx(720.0), "a full turn is unwound"


def test_drives_are_paid_for_travel_starts_and_standby() -> None:
    there = travelled(AxisPath(np.array([[0.0, 10.0, 10.0]]), np.zeros((1, 3))))
    assert drives_wh(there, DriveCosts(0.1, 0.5, 2.0))[0] == pytest.approx(0.1 * 20 + 0.5 * 2 + 48.0)
    with pytest.raises(ValueError, match="below zero"):
        DriveCosts(degree_wh=-1.0)


def test_a_program_stands_where_its_steps_say_on_any_mount(days: tuple) -> None:
    ideal, _ = days
    program = program_of("Alexandru", (10.0, 14.0), (-45.0, 0.0, 45.0), second_deg=20.0)
    solar_h = solar_hours(SAMSUN.latitude_deg, ideal.first_deg, ideal.second_deg)
    polar = equatorial_mount(SAMSUN.latitude_deg)
    on_polar = program_axes(program, polar, SAMSUN.latitude_deg, ideal, solar_h, solar_h)
    assert solar_hours(-34.0, np.array([0.0]), np.array([70.0]))[0] == pytest.approx(12.0)
    assert set(np.round(on_polar.first_deg, 6).ravel()) == {-45.0, 0.0, 45.0}
    assert np.isclose(on_polar.first_deg, 45.0).mean() == pytest.approx(10 / 24, abs=0.002)
    on_mast = program_axes(program, MountConfig(), SAMSUN.latitude_deg, ideal, solar_h, solar_h)
    again = angles(polar, on_mast.first_deg, on_mast.second_deg, ARRAY)
    np.testing.assert_allclose(again[0], on_polar.first_deg, atol=1e-9)
    np.testing.assert_allclose(again[1], 20.0, atol=1e-9)


def test_a_step_that_leaves_an_angle_out_follows(days: tuple) -> None:
    ideal, _ = days
    program = StepProgram("Half", (ProgramStep(0.0, second_deg=40.0),), StepFrame.AXES)
    found = program_axes(program, MountConfig(), 41.0, ideal, np.zeros_like(ideal.first_deg), ideal.first_deg)
    np.testing.assert_array_equal(found.first_deg, ideal.first_deg)
    assert (found.second_deg == 40.0).all()
