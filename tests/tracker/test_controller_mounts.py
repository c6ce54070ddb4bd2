"""Trackers on every mount: they follow, wait, show and refuse as their mount allows."""

from dataclasses import replace
from datetime import UTC, datetime, timedelta
from itertools import pairwise

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.base.angles import separation_deg
from app.sun.position import Algorithm, Location, sun_position
from app.tracker.activities.tracking import TWILIGHT_DEG
from app.tracker.commands.commands import CommandRejected, Jog, Move, Park, SelectMode, SetHome, Step, Track
from app.tracker.memory.memory import Pointing
from app.tracker.mounts.capabilities import default_mode
from app.tracker.mounts.mount import aim, mode_direction
from app.tracker.programs.show import check_show
from app.tracker.settings.axes import Axis, AxisConfig
from app.tracker.settings.config import MountConfig, MountKind, Orientation, TrackerConfig
from app.tracker.state.snapshot import EventKind
from app.tracker.values.mode import Mode
from tests.amount import amount
from tests.fault_result import FaultResult
from tests.tracker.plant import BLANK, CONFIG, MORNING, READY, SAMSUN, Plant
from tests.tracker.shows import show, utc

FIRST = AxisConfig(-100.0, 100.0, 4.0, 6.0, 0.5, 2.0)
EQUATORIAL = replace(
    CONFIG,
    azimuth=replace(FIRST, minimum_deg=-110.0, maximum_deg=110.0),
    elevation=AxisConfig(-24.0, 24.0, 2.0, 6.0, 0.5, 1.0),
    mount=MountConfig(MountKind.EQUATORIAL, 180.0, SAMSUN.latitude_deg),
)
LEVEL = replace(CONFIG, azimuth=FIRST, mount=MountConfig(MountKind.HORIZONTAL_SINGLE_AXIS))
TILTED = replace(CONFIG, azimuth=FIRST, mount=MountConfig(MountKind.TILTED_SINGLE_AXIS, 180.0, 30.0))
UPRIGHT = replace(
    CONFIG,
    azimuth=replace(FIRST, minimum_deg=-160.0, maximum_deg=160.0),
    mount=MountConfig(MountKind.VERTICAL_SINGLE_AXIS, 180.0, panel_tilt_deg=50.0),
)
SINGLE = [LEVEL, TILTED, UPRIGHT]


def tracking(config: TrackerConfig, at: datetime = MORNING, mode: Mode | None = None) -> Plant:
    """Return a plant that has tracked for two minutes at one tick a second."""
    memory = replace(READY, mode=mode or default_mode(config.mount))
    plant = Plant(memory, config=config, at=at, watchdog=None)
    plant.period = timedelta(seconds=1)
    plant.tick()
    plant.ask(Track())
    return plant.forward(120.0)


def jogged(axis: Axis) -> Jog:
    return Jog("p1", axis, 1)


@pytest.mark.parametrize("config", [TILTED, UPRIGHT], ids=lambda config: config.mount.kind.value)
def test_a_single_axis_faces_the_sun_as_nearly_as_it_can(config: TrackerConfig) -> None:
    plant = tracking(config)
    rested_deg = plant.elevation_deg
    for _ in range(5):
        plant.forward(60.0)
        shown = plant.snapshot
        assert shown.target is not None
        assert shown.measured is not None
        target, measured = shown.target, shown.measured
        off_deg = separation_deg(
            target.azimuth_deg, target.elevation_deg, measured.azimuth_deg, measured.elevation_deg
        )
        assert off_deg < CONFIG.deadband_deg
        assert shown.elevation is None
        assert shown.azimuth is not None
        assert shown.azimuth.position_deg == pytest.approx(plant.azimuth_deg)
    assert plant.elevation_deg == rested_deg
    assert not plant.happened(EventKind.FAULT_RAISED)


def test_a_single_axis_is_homed_by_its_first_axis_alone() -> None:
    plant = Plant(BLANK, config=LEVEL)
    plant.tick()
    plant.ask(SetHome())
    plant.forward(2.0)
    assert plant.snapshot.homed
    assert plant.snapshot.azimuth is not None
    assert not plant.drive.observe().elevation.homed


@pytest.mark.parametrize("command", [jogged(Axis.ELEVATION), Step(Axis.ELEVATION, 1.0)])
def test_an_absent_axis_cannot_be_moved(command: Jog | Step) -> None:
    plant = Plant(READY, config=LEVEL)
    plant.tick()
    with pytest.raises(CommandRejected, match="and no second axis"):
        plant.ask(command)
    with pytest.raises(CommandRejected, match="No axis of this mount"):
        plant.ask(SetHome((Axis.ELEVATION,)))
    assert EventKind.JOG_STARTED in plant.ask(jogged(Axis.AZIMUTH))
    assert plant.snapshot.activity_text == "Jogging rotation to the right of the axis's direction, slow"


@pytest.mark.parametrize(
    ("config", "mode"), [(LEVEL, Mode.DUAL), (LEVEL, Mode.ELEVATION), (UPRIGHT, Mode.DUAL)]
)
def test_a_mode_that_the_mount_cannot_do_is_refused(config: TrackerConfig, mode: Mode) -> None:
    plant = Plant(READY, config=config)
    plant.tick()
    with pytest.raises(CommandRejected, match="does not support the mode"):
        plant.ask(SelectMode(mode, Orientation(180.0, 45.0)))
    checked = check_show(show(SAMSUN, utc(2026, 6, 21, 6), utc(2026, 6, 21, 9), 300.0, mode=mode), config)
    assert [reason.code for reason in checked.reasons] == ["mode_not_possible"]


def test_an_orientation_means_the_nearest_that_a_single_axis_can_face() -> None:
    plant = Plant(READY, config=LEVEL)
    plant.tick()
    plant.ask(Move(Orientation(90.0, 60.0)))
    plant.forward(60.0)
    assert plant.azimuth_deg == pytest.approx(-30.0, abs=0.1)
    plant.ask(Park())
    plant.forward(60.0)
    assert plant.azimuth_deg == pytest.approx(0.0, abs=0.1)


@pytest.mark.parametrize("config", [EQUATORIAL, *SINGLE], ids=lambda config: config.mount.kind.value)
def test_the_night_brings_every_mount_to_the_next_sunrise(config: TrackerConfig) -> None:
    plant = tracking(config, datetime(2026, 6, 21, 21, 0, tzinfo=UTC))
    assert plant.dawn is not None
    wanted = mode_direction(
        default_mode(config.mount), Orientation(180.0, 45.0), plant.dawn, refraction=True, mount=config.mount
    )
    target = aim(config, Pointing(), wanted, config.azimuth.minimum_deg)
    assert plant.azimuth_deg == pytest.approx(target.azimuth_deg, abs=0.5)
    assert plant.azimuth_deg < 0.0


def test_least_incidence_goes_over_the_top_and_shows_where_the_panel_faces() -> None:
    config = replace(
        CONFIG,
        elevation=replace(CONFIG.elevation, maximum_deg=150.0),
        mount=MountConfig(least_incidence=True),
    )
    plant = tracking(config, datetime(2026, 6, 21, 3, 30, tzinfo=UTC), Mode.ELEVATION)
    assert plant.elevation_deg > 95.0
    target, measured = plant.snapshot.target, plant.snapshot.measured
    assert target is not None
    assert measured is not None
    assert (target.azimuth_deg, measured.azimuth_deg) == pytest.approx((0.0, 0.0))
    assert target.elevation_deg == pytest.approx(measured.elevation_deg, abs=0.5)


RANGES = {
    MountKind.AZIMUTH_ELEVATION: ((2.0, 358.0), (-178.0, 178.0)),
    MountKind.VERTICAL_SINGLE_AXIS: ((-178.0, 178.0), (-178.0, 178.0)),
    MountKind.EQUATORIAL: ((-178.0, 178.0), (-178.0, 178.0)),
    MountKind.HORIZONTAL_SINGLE_AXIS: ((-90.0, 90.0), (-90.0, 90.0)),
    MountKind.TILTED_SINGLE_AXIS: ((-120.0, 120.0), (-120.0, 120.0)),
}


@pytest.mark.fault(35)
def test_a_move_through_north_goes_the_long_way_within_the_travel(fault: FaultResult) -> None:
    plant = tracking(CONFIG)
    plant.ask(Move(Orientation(350.0, 20.0)))
    plant.forward(90.0)
    assert plant.snapshot.in_position
    plant.ask(Move(Orientation(10.0, 20.0)))
    passed: list[float] = []
    plant.forward(90.0, lambda: passed.append(plant.azimuth_deg))
    assert plant.snapshot.in_position
    assert all(CONFIG.azimuth.beyond_deg(azimuth_deg) < 1e-6 for azimuth_deg in passed)
    assert any(170.0 < azimuth_deg < 190.0 for azimuth_deg in passed), "it turned back through the south"
    fault.prevented("the way is planned within the travel, never through an end stop")
    fault.shows_nothing("the axis turns the long way")
    fault.recovers("nothing was lost")


@settings(max_examples=amount(10, 40))
@given(
    kind=st.sampled_from(MountKind),
    latitude_deg=st.floats(-60.0, 60.0).filter(lambda degrees: abs(degrees) > 24.0),
    day=st.integers(0, 364),
)
@pytest.mark.fault(35)
def test_below_a_full_turn_no_mount_unwinds_while_the_sun_is_up(
    kind: MountKind, latitude_deg: float, day: int
) -> None:
    southern = latitude_deg < 0.0
    equator_deg = 0.0 if southern else 180.0
    mount = MountConfig(kind, equator_deg, abs(latitude_deg))
    low_deg, high_deg = RANGES[kind][southern]
    config = replace(CONFIG, azimuth=replace(FIRST, minimum_deg=low_deg, maximum_deg=high_deg), mount=mount)
    days_deg = daylight_angles(config, Location(latitude_deg, 0.0), day)
    assert any(days_deg) or abs(latitude_deg) > 45.0
    for day_deg in days_deg:
        assert max((abs(b - a) for a, b in pairwise(day_deg)), default=0.0) < 90.0


def daylight_angles(config: TrackerConfig, location: Location, day: int) -> list[list[float]]:
    """Return the first axis's angles every two minutes, from each sunrise to the sunset after it."""
    at = datetime(2026, 1, 1, tzinfo=UTC) + timedelta(days=day)
    near_deg, spans = config.azimuth.minimum_deg, [[]]
    for _ in range(720):
        at += timedelta(minutes=2)
        sun = sun_position(Algorithm.PSA, location, at)
        if sun.apparent_elevation_deg < TWILIGHT_DEG:
            spans.append([])
            continue
        mode = default_mode(config.mount)
        wanted = mode_direction(mode, config.park, sun, refraction=True, mount=config.mount)
        near_deg = aim(config, Pointing(), wanted, near_deg).azimuth_deg
        spans[-1].append(near_deg)
    return spans
