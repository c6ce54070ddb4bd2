"""Each strategy tells its day: how often it moves, and how far it is off at most, from pole to tropic."""

from dataclasses import replace
from datetime import UTC, datetime, timedelta

import numpy as np
import pytest

from app.base.angles import separation_deg
from app.show.simulate import simulate, simulate_show
from app.show.strategy_day import strategy_day
from app.show.strategy_told import StrategyDay
from app.sun.position import Location, sun_position
from app.sun.trigonometry import SCALAR
from app.tracker.commands.commands import Track
from app.tracker.memory.memory import Pointing
from app.tracker.mounts.capabilities import default_mode
from app.tracker.mounts.kinematics import followed
from app.tracker.programs.examples import ALEXANDRU_TABLE_3
from app.tracker.programs.schedule import Moment, solar_hour
from app.tracker.programs.show import ShowPlan, check_show, schedule_of
from app.tracker.programs.step_table import from_table, to_table
from app.tracker.settings.axes import AxisConfig
from app.tracker.settings.config import MountConfig, MountKind, Orientation, Rows, TrackerConfig
from app.tracker.settings.stepped import ProgramStep, StepFrame, StepProgram, TimeBase
from app.tracker.settings.strategy import (
    Continuous,
    Deadband,
    EncoderDeadband,
    HybridConfig,
    Interval,
    IntervalAim,
    SimulatedLight,
    Stepped,
    Strategy,
)
from app.tracker.values.mode import Mode
from tests.amount import amount
from tests.tracker.plant import READY, Plant

HELD = Orientation(180.0, 45.0)
TURNING = AxisConfig(-110.0, 110.0, 4.0, 6.0, 0.5, 2.0)
LEVEL = TrackerConfig(
    "T1", "level", azimuth=TURNING, mount=MountConfig(MountKind.HORIZONTAL_SINGLE_AXIS, 180.0)
)
ROWS = replace(LEVEL, name="rows", mount=replace(LEVEL.mount, rows=Rows(0.5)))
TILTED = replace(LEVEL, name="tilted", mount=MountConfig(MountKind.TILTED_SINGLE_AXIS, 180.0, 30.0))
UPRIGHT = replace(LEVEL, name="upright", mount=MountConfig(MountKind.VERTICAL_SINGLE_AXIS, panel_tilt_deg=40))
EQUATORIAL = replace(
    LEVEL,
    name="equatorial",
    elevation=AxisConfig(-24.0, 24.0, 2.0, 6.0, 0.5, 1.0),
    mount=MountConfig(MountKind.EQUATORIAL, 180.0, 45.65),
)
BRASOV = Location(45.65, 25.6)
TWO_TURNS = AxisConfig(-270.0, 450.0, 6.0, 6.0, 0.5, 3.0)
TROMSO, ADELAIDE, NAIROBI = Location(69.65, 18.96), Location(-34.9, 138.6), Location(-1.3, 36.8)


def day(strategy: Strategy, place: Location, begin: datetime, hours: float = 4.0) -> StrategyDay:
    config = TrackerConfig("T1", "T1", azimuth=TWO_TURNS, strategy=strategy)
    end = begin + timedelta(hours=hours)
    return strategy_day(config, Pointing(), place, Mode.DUAL, HELD, begin, end)


@pytest.mark.parametrize(
    ("strategy", "bound_deg", "fewest", "most"),
    [
        (Continuous(), 0.06, 1, 1),
        (Deadband(), 0.5, 90, 180),
        (EncoderDeadband(), 1.45, 40, 170),
        (Interval(10), 1.3, 24, 26),
        (Interval(10, IntervalAim.NOW), 2.55, 24, 26),
    ],
)
@pytest.mark.parametrize(
    ("place", "begin"),
    [
        pytest.param(BRASOV, datetime(2026, 6, 21, 7, tzinfo=UTC), id="summer solstice, 46 north"),
        pytest.param(ADELAIDE, datetime(2026, 12, 21, 22, tzinfo=UTC), id="summer solstice, 35 south"),
    ][: amount(1, 2)],
)
def test_a_strategy_stays_within_its_bound(
    strategy: Strategy, place: Location, begin: datetime, bound_deg: float, fewest: int, most: int
) -> None:
    told = day(strategy, place, begin, 4.0 if fewest > 1 else amount(0.5, 4.0))
    assert told.largest_error_deg is not None
    assert bound_deg / 4.0 < told.largest_error_deg < bound_deg or isinstance(strategy, Continuous)
    assert told.largest_error_deg < bound_deg
    assert fewest <= told.moves <= most


MOUNTS = [EQUATORIAL.mount, MountConfig()]


@pytest.mark.parametrize("mount", amount(MOUNTS[:1], MOUNTS), ids=lambda mount: mount.kind)
def test_a_corrected_day_is_judged_by_the_sun_that_its_sensors_see(mount: MountConfig) -> None:
    """What remains while the correction stands is small; uncorrected it would be the misalignment."""
    axes = TrackerConfig("T1", "T1") if mount.kind is MountKind.AZIMUTH_ELEVATION else EQUATORIAL
    config = replace(
        axes,
        mount=mount,
        strategy=Continuous(),
        hybrid=HybridConfig(enabled=True, simulated=SimulatedLight(1.0, -0.6)),
    )
    begin = datetime(2026, 6, 21, 8, tzinfo=UTC)
    told = strategy_day(
        config, Pointing(0.7, 0.4), BRASOV, Mode.DUAL, HELD, begin, begin + timedelta(hours=1)
    )
    assert told.largest_error_deg is not None
    assert told.mean_error_deg is not None
    assert 0.6 < told.largest_error_deg < 1.2, "at the beginning the sensors have found nothing yet"
    assert told.mean_error_deg < 0.15
    last = separation_deg(
        told.panel_azimuth_deg[-1],
        told.panel_elevation_deg[-1],
        told.sun_azimuth_deg[-1],
        told.sun_elevation_deg[-1],
    )
    assert last < 0.15


@pytest.mark.parametrize("config", [EQUATORIAL, ROWS, TILTED, UPRIGHT], ids=lambda config: config.name)
def test_a_day_is_told_in_the_axes_of_every_mount(config: TrackerConfig) -> None:
    begin = datetime(2026, 6, 21, 8, tzinfo=UTC)
    end = begin + timedelta(hours=1)
    told = strategy_day(config, Pointing(), BRASOV, default_mode(config.mount), HELD, begin, end)
    assert told.largest_error_deg is not None
    assert 0.2 < told.largest_error_deg < config.deadband_deg
    suns = [sun_position(config.algorithm, BRASOV, at) for at in (begin, end)]
    turned = [
        followed(config.mount, default_mode(config.mount), (180.0, 45.0), sun, SCALAR)[0]
        for sun in ((sun.azimuth_deg, sun.apparent_elevation_deg) for sun in suns)
    ]
    assert told.travel_azimuth_deg == pytest.approx(turned[1] - turned[0], abs=1.0)
    assert told.travel_elevation_deg < 0.5, "the declination hardly changes, and a single axis has no second"


@pytest.mark.parametrize("strategy", [Deadband(), Interval(10)], ids=["deadband", "interval"])
def test_a_sparing_simulation_tells_the_same_day(strategy: Strategy) -> None:
    config = TrackerConfig("T1", "T1", strategy=strategy)
    begin, end = datetime(2026, 6, 21, 7, tzinfo=UTC), datetime(2026, 6, 21, 8, 30, tzinfo=UTC)
    measured, runs = [], []
    for sparing in (False, True):
        _, frames = simulate(
            config, Pointing(), BRASOV, "UTC", Mode.DUAL, HELD, begin, end,
            step=timedelta(seconds=5), sparing=sparing,
        )  # fmt: skip
        measured.append([frames.column("measured_azimuth_deg"), frames.column("measured_elevation_deg")])
        runs.append(np.count_nonzero(np.diff(frames.column("setpoint_azimuth_deg"))))
    apart_deg = np.abs(np.array(measured[0]) - np.array(measured[1])).max(axis=0)
    assert apart_deg.max() < (0.8 if isinstance(strategy, Deadband) else 3.0), "at most one run apart"
    assert np.median(apart_deg) < (0.5 if isinstance(strategy, Deadband) else 0.01)
    assert runs[1] == pytest.approx(runs[0], rel=0.03)
    assert runs[0] > 8


@pytest.mark.parametrize(
    ("minutes", "place", "begin", "hours", "fewest", "mean_deg", "bound_deg"),
    [
        pytest.param(60, TROMSO, datetime(2026, 6, 20, 20, tzinfo=UTC), 6.0, 6, 4.0, 8.0, id="polar day"),
        pytest.param(30, NAIROBI, datetime(2026, 9, 23, 7, tzinfo=UTC), 4.0, 7, 1.95, 7.0, id="tropic sun"),
    ],
)
def test_intervals_go_on_all_night_and_do_not_race_below_the_zenith(
    minutes: int,
    place: Location,
    begin: datetime,
    hours: float,
    fewest: int,
    mean_deg: float,
    bound_deg: float,
) -> None:
    """Under the tropic sun the azimuth axis turns round once, for half a minute."""
    told = day(Interval(minutes), place, begin, hours)
    assert fewest <= told.moves <= fewest + 2
    assert told.largest_error_deg is not None
    assert told.mean_error_deg is not None
    assert told.mean_error_deg < mean_deg
    assert told.largest_error_deg < bound_deg


def test_alexandrus_program_moves_at_its_times_and_stands_at_its_angles() -> None:
    config = TrackerConfig("T1", "T1", strategy=Stepped(ALEXANDRU_TABLE_3))
    begin = datetime(2026, 6, 21, amount(9, 4), tzinfo=UTC)
    end = begin + timedelta(hours=amount(2, 12))
    _, frames = simulate(config, Pointing(), BRASOV, "UTC", Mode.DUAL, HELD, begin, end)
    setpoints = frames.column("setpoint_azimuth_deg")
    moved = np.flatnonzero(np.abs(np.diff(setpoints)) > 1e-6) + 1
    hours = [
        solar_hour(Moment(at, sun_position(config.algorithm, BRASOV, at), BRASOV))
        for at in (begin + timedelta(seconds=float(frames.column("elapsed_s")[i])) for i in moved)
    ]
    steps = [step.from_h for step in ALEXANDRU_TABLE_3.steps[1:]]
    expected = amount([hour for hour in steps if hours[0] - 0.1 < hour < hours[-1] + 0.1], steps)
    assert len(hours) > 1
    assert hours == pytest.approx(expected, abs=2 / 3600)
    noon = frames.values[int(np.abs(setpoints - 180.0).argmin()) + 60]
    assert noon[8] == pytest.approx(180.0, abs=0.03)
    assert noon[9] == pytest.approx(90.0 - (BRASOV.latitude_deg - 23.45), abs=0.03)


def test_a_program_by_the_clock_holds_one_axis_and_follows_with_the_other() -> None:
    steps = (ProgramStep(9.0, 120.0), ProgramStep(12.0, 180.0), ProgramStep(15.0, 240.0))
    program = StepProgram("Three", steps, StepFrame.HORIZON, TimeBase.CLOCK, 2.0)
    config = TrackerConfig("T1", "T1", strategy=Stepped(program))
    begin = datetime(2026, 3, 21, 9, 58, tzinfo=UTC)
    _, frames = simulate(
        config, Pointing(), BRASOV, "UTC", Mode.DUAL, HELD, begin, begin + timedelta(minutes=10)
    )
    azimuth, elevation = frames.column("measured_azimuth_deg"), frames.column("measured_elevation_deg")
    assert azimuth[115] == pytest.approx(120.0, abs=0.03)
    assert azimuth[180] == pytest.approx(180.0, abs=0.03)
    assert np.abs(elevation - frames.column("sun_elevation_deg"))[30:].max() < 0.5


MOVES = [Interval(30), Stepped(ALEXANDRU_TABLE_3)]


@pytest.mark.parametrize("strategy", amount(MOVES[:1], MOVES), ids=str)
def test_a_show_moves_to_the_same_places_as_the_day(strategy: Strategy) -> None:
    config = TrackerConfig("T1", "T1", strategy=strategy)
    begin, end = datetime(2026, 6, 21, 7, tzinfo=UTC), datetime(2026, 6, 21, amount(9, 13), tzinfo=UTC)
    duration = timedelta(minutes=amount(2, 6))
    plan = ShowPlan("show", begin, end, duration, BRASOV, Mode.DUAL, HELD, schedule=schedule_of(strategy))
    _, show = simulate_show(config, Pointing(), "UTC", plan)
    _, real = simulate(config, Pointing(), BRASOV, "UTC", Mode.DUAL, HELD, begin, end)
    columns = ("setpoint_azimuth_deg", "setpoint_elevation_deg")
    places = [
        np.unique(np.round(np.array([one.column(name) for name in columns]), 3), axis=1)
        for one in (show, real)
    ]
    assert places[0].shape[1] >= amount(3, 9)
    for first_deg, second_deg in places[0].T:
        off_deg = [separation_deg(first_deg, second_deg, *place) for place in places[1].T]
        assert min(off_deg) < 0.06


def test_a_show_too_fast_for_its_moves_is_refused_with_the_shortest_time_that_works() -> None:
    config = TrackerConfig("T1", "T1", strategy=Stepped(ALEXANDRU_TABLE_3))
    begin, end = datetime(2026, 6, 21, 5, tzinfo=UTC), datetime(2026, 6, 21, 15, tzinfo=UTC)
    plan = ShowPlan("show", begin, end, timedelta(seconds=20), BRASOV, schedule=schedule_of(config.strategy))
    check = check_show(plan, config)
    assert [reason.code for reason in check.reasons] == ["moves_too_long"]
    assert check.shortest is not None
    again = replace(plan, duration=check.shortest)
    assert check_show(again, config).feasible
    assert not check_show(replace(again, duration=check.shortest - timedelta(seconds=2)), config).feasible


def test_a_wrapped_cable_unwinds_at_night_and_not_at_noon() -> None:
    """From the upper part of 540 degrees to the place of the next sunrise in the lower part."""
    wide = replace(TrackerConfig("T1", "T1").azimuth, minimum_deg=-270.0, maximum_deg=270.0)
    config = TrackerConfig("T1", "T1", azimuth=wide)
    begin, end = datetime(2026, 12, 21, 9, 30, tzinfo=UTC), datetime(2026, 12, 21, 16, tzinfo=UTC)
    step = timedelta(seconds=10)
    _, frames = simulate(
        config, Pointing(), BRASOV, "UTC", Mode.DUAL, HELD, begin, end, step=step, sparing=True
    )
    turned_deg = np.abs((np.diff(frames.column("measured_azimuth_deg")) + 180.0) % 360.0 - 180.0)
    up = frames.column("sun_elevation_deg")[1:] > 0.0
    noon = np.abs(frames.column("sun_azimuth_deg")[1:] - 180.0) < 10.0
    assert noon.sum() > 100
    assert turned_deg[up].max() < 2.0, "no way round while the sun is up"
    dusk_deg = frames.column("sun_azimuth_deg")[1:][up].max()
    assert turned_deg[~up].sum() == pytest.approx(2.0 * dusk_deg, abs=8.0), "down to the next sunrise"


def test_a_program_from_a_table_runs_on_the_machine_in_a_show_and_in_a_simulation() -> None:
    steps = (ProgramStep(0.0, 120.0, 20.0), ProgramStep(10.0, 150.0, 40.0), ProgramStep(11.0, 170.0, 50.0))
    program = StepProgram("Three places", steps, StepFrame.HORIZON, TimeBase.CLOCK, 2.0)
    strategy = Stepped(from_table(to_table(program)))
    config = TrackerConfig("T1", "T1", strategy=strategy)
    begin, end = datetime(2026, 6, 21, 7, 59, tzinfo=UTC), datetime(2026, 6, 21, 9, 20, tzinfo=UTC)
    plan = ShowPlan(
        "show", begin, end, timedelta(minutes=2), BRASOV, Mode.DUAL, HELD, schedule=schedule_of(strategy)
    )
    told, show = simulate_show(config, Pointing(), "UTC", plan)
    assert (told.outcome, told.duration_s) == ("completed", pytest.approx(120.0, abs=0.5))
    _, day_frames = simulate(config, Pointing(), BRASOV, "UTC", Mode.DUAL, HELD, begin, end)
    for frames in (show, day_frames):
        azimuth, elevation = frames.column("measured_azimuth_deg"), frames.column("measured_elevation_deg")
        for step in steps:
            off_deg = np.hypot(azimuth - step.first_deg, elevation - step.second_deg)
            assert off_deg.min() < 0.06, step
    machine = Plant(READY, config=config, at=begin + timedelta(seconds=40), location=BRASOV)
    machine.tick()
    machine.ask(Track())
    machine.forward(70.0)
    assert (machine.azimuth_deg, machine.elevation_deg) == pytest.approx((150.0, 40.0), abs=0.06)
    assert "step 2 of 3 of Three places" in machine.snapshot.activity_text
