"""What every drive has to do, as stories: the same for the simulated one and those on a bus."""

from collections.abc import Awaitable, Callable
from datetime import UTC, datetime
from itertools import pairwise

import pytest

from app.modbus.errors import DriveError, DriveSilent
from app.simulation.faults import Fault, FaultKind
from app.tracker.settings.axes import Axis
from app.tracker.values.motion import DriveCommand, DriveRequest, Feedback, Position, RequestKind, Velocity
from tests.drives.rigs import Rig, Trait

Story = Callable[[Rig], Awaitable[None]]
NEEDED: dict[Story, frozenset[Trait]] = {}
BEGIN_AZIMUTH_DEG, BEGIN_ELEVATION_DEG = 102.4, 36.6
LAST_COUNT_DEG = 0.0101


def story(*traits: Trait) -> Callable[[Story], Story]:
    """Mark a story, and what a drive must have for it to make sense."""

    def mark(tell: Story) -> Story:
        NEEDED[tell] = frozenset(traits)
        return tell

    return mark


def stories_for(traits: frozenset[Trait]) -> list[Story]:
    return [tell for tell, needed in NEEDED.items() if needed <= traits]


def on_every_wire() -> list[Story]:
    """What a line or another map could spoil: the connection, moves, the search for zero, and stops."""
    return [
        a_silent_drive_is_said_to_be_silent_and_found_again,
        a_move_ends_at_its_target_at_its_own_speed,
        homing_goes_on_while_halt_is_written,
        a_stop_overtakes_a_move_and_the_drive_obeys_again,
    ]


def at(azimuth_deg: float, elevation_deg: float) -> DriveCommand:
    return DriveCommand(Position(azimuth_deg, 6.0), Position(elevation_deg, 4.0))


def asking(number: int, kind: RequestKind) -> DriveCommand:
    return DriveCommand(request=DriveRequest(number, kind))


def positions(feedback: Feedback) -> tuple[float, float]:
    return feedback.azimuth.position_deg, feedback.elevation.position_deg


def is_moving(feedback: Feedback) -> bool:
    return feedback.azimuth.moving or feedback.elevation.moving


def is_homed(feedback: Feedback) -> bool:
    return feedback.azimuth.homed or feedback.elevation.homed


@story(Trait.ZERO)
async def a_new_drive_stands_still_and_has_no_zero_until_it_is_set(rig: Rig) -> None:
    feedback = await rig.drive.read()
    can = rig.drive.capabilities
    assert can.limit_switches is (Trait.SWITCHES in rig.traits)
    assert can.settable_clock is (Trait.CLOCK in rig.traits)
    assert positions(feedback) == pytest.approx((BEGIN_AZIMUTH_DEG, BEGIN_ELEVATION_DEG), abs=1e-9)
    assert (is_homed(feedback), is_moving(feedback), feedback.homing) == (False, False, False)
    assert (feedback.boot_count, feedback.fault_code, feedback.watchdog_tripped) == (1, 0, False)
    feedback = await rig.forward(0.1, asking(1, RequestKind.SET_HOME_AZIMUTH))
    assert (feedback.request_done, feedback.request_failed) == (1, False)
    assert feedback.azimuth.position_deg == 0.0
    assert (feedback.azimuth.homed, feedback.elevation.homed) == (True, False)
    feedback = await rig.forward(0.1, asking(2, RequestKind.SET_HOME_ELEVATION))
    assert feedback.request_done == 2
    assert positions(feedback) == (0.0, 0.0)
    assert feedback.elevation.homed


@story(Trait.ZERO)
async def a_request_is_carried_out_once(rig: Rig) -> None:
    await rig.forward(0.1, asking(1, RequestKind.SET_HOME_AZIMUTH))
    moved = await rig.until_rest(at(5.0, 36.6))
    again = await rig.forward(0.3, asking(1, RequestKind.SET_HOME_AZIMUTH))
    assert again.azimuth.position_deg == pytest.approx(moved.azimuth.position_deg)


@story(Trait.SPEED)
async def a_jog_turns_at_its_speed_and_a_halt_ends_it(rig: Rig) -> None:
    jogging = await rig.forward(2.0, DriveCommand(azimuth=Velocity(-3.0)))
    assert jogging.azimuth.velocity_dps == pytest.approx(-3.0, abs=rig.speed_step_dps)
    assert jogging.azimuth.position_deg == pytest.approx(BEGIN_AZIMUTH_DEG - 5.25, abs=LAST_COUNT_DEG)
    assert jogging.elevation.position_deg == pytest.approx(BEGIN_ELEVATION_DEG)
    halted = await rig.forward(0.6)
    assert halted.azimuth.velocity_dps == 0.0
    assert not halted.azimuth.moving
    assert halted.azimuth.position_deg == pytest.approx(BEGIN_AZIMUTH_DEG - 6.0, abs=LAST_COUNT_DEG)


@story()
async def a_move_ends_at_its_target_at_its_own_speed(rig: Rig) -> None:
    turning = await rig.forward(3.0, DriveCommand(Position(120.0, 1.5), Position(50.0, 4.0)))
    if Trait.SPEED in rig.traits:
        assert turning.azimuth.velocity_dps == pytest.approx(1.5, abs=rig.speed_step_dps)
    feedback = await rig.until_rest(at(120.0, 50.0))
    assert positions(feedback) == pytest.approx((120.0, 50.0), abs=LAST_COUNT_DEG)
    assert feedback.azimuth.velocity_dps == 0.0


@story(Trait.SPEED)
async def a_new_target_in_mid_move_makes_no_jump(rig: Rig) -> None:
    speeds = []
    for command in (at(130.0, 36.6), at(90.0, 36.6), at(108.0, 36.6)):
        for _ in range(15):
            feedback = await rig.forward(0.05, command)
            speeds.append(feedback.azimuth.velocity_dps)
    steps = [abs(b - a) for a, b in pairwise(speeds)]
    assert max(abs(speed) for speed in speeds) <= 6.0 + 1e-6
    assert max(steps) <= 6.0 * 0.05 + 2e-3 + rig.speed_step_dps
    feedback = await rig.until_rest(at(108.0, 36.6))
    assert feedback.azimuth.position_deg == pytest.approx(108.0, abs=LAST_COUNT_DEG)


@story(Trait.SWITCHES)
async def the_limit_switch_ends_a_jog_and_the_way_back_is_free(rig: Rig) -> None:
    down = DriveCommand(elevation=Velocity(-2.0))
    feedback = await rig.until_rest(down)
    assert feedback.elevation.at_lower_limit
    assert not feedback.elevation.at_upper_limit
    stood = feedback.elevation.position_deg
    back = await rig.forward(2.0, DriveCommand(elevation=Velocity(2.0)))
    assert back.elevation.position_deg > stood + 2.0
    assert not back.elevation.at_lower_limit
    rig.machine.inject(Fault(FaultKind.UPPER_LIMIT_STUCK, Axis.AZIMUTH))
    barred = await rig.forward(1.0, DriveCommand(azimuth=Velocity(2.0)))
    assert barred.azimuth.at_upper_limit
    assert barred.azimuth.position_deg == pytest.approx(BEGIN_AZIMUTH_DEG)


@story(Trait.ZERO)
async def a_moving_axis_cannot_be_zeroed(rig: Rig) -> None:
    request = DriveRequest(4, RequestKind.SET_HOME_AZIMUTH)
    await rig.forward(1.0, DriveCommand(azimuth=Velocity(3.0)))
    feedback = await rig.forward(0.1, DriveCommand(azimuth=Velocity(3.0), request=request))
    assert (feedback.request_done, feedback.request_failed) == (4, True)
    assert not feedback.azimuth.homed


@story(Trait.ZERO)
async def homing_finds_north_and_the_horizon(rig: Rig) -> None:
    searching = await rig.forward(1.0, asking(5, RequestKind.HOME))
    assert searching.homing
    feedback = await rig.until_rest(asking(5, RequestKind.HOME))
    assert (feedback.request_done, feedback.request_failed) == (5, False)
    assert positions(feedback) == (0.0, 0.0)
    assert feedback.azimuth.homed
    assert feedback.elevation.homed
    if Trait.SWITCHES in rig.traits:
        assert feedback.azimuth.at_origin
        assert feedback.elevation.at_origin
    truth = rig.machine.true_orientation
    assert (truth.azimuth_deg, truth.elevation_deg) == pytest.approx((0.0, 0.0), abs=0.02)


@story()
async def homing_goes_on_while_halt_is_written(rig: Rig) -> None:
    await rig.forward(0.2, asking(5, RequestKind.HOME))
    assert (await rig.forward(0.5)).homing
    assert (await rig.until_rest()).request_done == 5


@story(Trait.ZERO)
async def a_stop_ends_homing_without_a_zero(rig: Rig) -> None:
    await rig.forward(1.0, asking(5, RequestKind.HOME))
    await rig.drive.stop()
    feedback = await rig.until_rest()
    assert (feedback.request_done, feedback.request_failed, feedback.homing) == (5, True, False)
    assert not is_homed(feedback)


@story(Trait.ZERO)
async def a_stalled_axis_makes_homing_fail(rig: Rig) -> None:
    await rig.forward(0.5, asking(5, RequestKind.HOME))
    rig.machine.inject(Fault(FaultKind.STALL, Axis.AZIMUTH))
    feedback = await rig.until_rest(asking(5, RequestKind.HOME))
    assert (feedback.request_done, feedback.request_failed) == (5, True)
    assert not feedback.azimuth.homed


@story(Trait.FAULT_RESET)
async def a_fault_stops_both_axes_until_it_is_reset(rig: Rig) -> None:
    await rig.forward(1.0, at(140.0, 60.0))
    rig.machine.inject(Fault(FaultKind.DRIVE_FAULT, amount=7))
    feedback = await rig.forward(2.0, at(140.0, 60.0))
    assert feedback.fault_code == 7
    refused = await rig.forward(0.2, asking(8, RequestKind.HOME))
    assert (refused.request_done, refused.request_failed, refused.homing) == (8, True, False)
    assert (feedback.azimuth.velocity_dps, feedback.elevation.velocity_dps) == (0.0, 0.0)
    feedback = await rig.forward(0.2, asking(9, RequestKind.RESET_FAULT))
    assert (feedback.request_done, feedback.fault_code) == (9, 0)
    moved = await rig.forward(1.0, at(140.0, 60.0))
    assert moved.azimuth.position_deg > feedback.azimuth.position_deg


@story(Trait.ZERO)
async def a_drive_that_lost_power_has_a_new_life_and_no_zero(rig: Rig) -> None:
    await rig.forward(0.1, asking(1, RequestKind.SET_HOME_AZIMUTH))
    await rig.forward(0.1, asking(2, RequestKind.SET_HOME_ELEVATION))
    await rig.forward(1.0, at(20.0, 10.0))
    rig.machine.inject(Fault(FaultKind.POWER_LOSS))
    feedback = await rig.drive.read()
    assert feedback.boot_count == (2 if Trait.BOOT_COUNT in rig.traits else 1)
    assert not is_homed(feedback)
    assert not is_moving(feedback)
    assert feedback.request_done == 0
    rig.idle(1.0)
    assert positions(await rig.drive.read()) == pytest.approx(positions(feedback))
    assert (await rig.forward(1.0, DriveCommand(azimuth=Velocity(1.0)))).azimuth.moving


@story(Trait.WATCHDOG)
async def without_commands_the_watchdog_ramps_both_axes_down(rig: Rig) -> None:
    command = DriveCommand(Velocity(3.0), Velocity(2.0))
    before = await rig.forward(1.0, command)
    rig.idle(5.0)
    feedback = await rig.drive.read()
    assert feedback.watchdog_tripped
    assert not is_moving(feedback)
    way_deg = feedback.azimuth.position_deg - before.azimuth.position_deg
    assert way_deg == pytest.approx(3.0 * 0.5 + 3.0**2 / (2 * 6.0), abs=0.02)
    assert rig.drive.capabilities.watchdog_s == pytest.approx(0.5)
    await rig.drive.write(DriveCommand())
    assert not (await rig.drive.read()).watchdog_tripped
    again = await rig.forward(1.0, command)
    assert again.azimuth.position_deg > feedback.azimuth.position_deg + 1.0


@story(Trait.WATCHDOG)
async def a_drive_that_is_fed_in_time_goes_on(rig: Rig) -> None:
    command = DriveCommand(azimuth=Velocity(3.0))
    for _ in range(5):
        await rig.drive.read()
        await rig.drive.write(command)
        rig.idle(0.45)
    feedback = await rig.drive.read()
    assert not feedback.watchdog_tripped
    assert feedback.azimuth.velocity_dps == pytest.approx(3.0)


@story(Trait.WATCHDOG)
async def reading_alone_does_not_feed_the_watchdog(rig: Rig) -> None:
    await rig.forward(1.0, DriveCommand(azimuth=Velocity(3.0)))
    for _ in range(20):
        rig.idle(0.1)
        feedback = await rig.drive.read()
    assert feedback.watchdog_tripped
    assert not feedback.azimuth.moving


@story(Trait.SPEED)
async def stop_ramps_both_axes_down(rig: Rig) -> None:
    before = await rig.forward(1.0, DriveCommand(Velocity(3.0), Velocity(2.0)))
    await rig.drive.stop()
    rig.idle(0.6)
    feedback = await rig.drive.read()
    assert not is_moving(feedback)
    way_deg = feedback.azimuth.position_deg - before.azimuth.position_deg
    assert way_deg == pytest.approx(3.0**2 / (2 * 6.0), abs=0.02)


@story()
async def a_silent_drive_is_said_to_be_silent_and_found_again(rig: Rig) -> None:
    before = await rig.forward(0.2)
    rig.machine.inject(Fault(FaultKind.SILENCE))
    with pytest.raises(DriveSilent):
        await rig.drive.read()
    with pytest.raises(DriveSilent):
        await rig.drive.write(DriveCommand(azimuth=Velocity(1.0)))
    rig.machine.end_injected_faults()
    rig.idle(2.0)
    feedback = await rig.drive.read()
    assert positions(feedback) == pytest.approx(positions(before))


@story()
async def a_command_that_is_not_taken_is_an_error(rig: Rig) -> None:
    await rig.forward(0.2)
    rig.machine.inject(Fault(FaultKind.IGNORED_WRITES))
    with pytest.raises(DriveError, match=r"did not (accept|carry)"):
        await rig.forward(0.2, at(140.0, 60.0))
    rig.machine.end_injected_faults()
    assert (await rig.forward(1.0, at(140.0, 60.0))).azimuth.moving


@story()
async def an_encoder_jump_is_shown_and_a_jog_turns_the_way_that_it_says(rig: Rig) -> None:
    before = await rig.forward(0.2)
    rig.machine.inject(Fault(FaultKind.ENCODER_JUMP, Axis.AZIMUTH, 12.4))
    jumped = await rig.drive.read()
    assert jumped.azimuth.position_deg == pytest.approx(before.azimuth.position_deg + 12.4)
    turned = await rig.forward(1.0, DriveCommand(azimuth=Velocity(2.0)))
    assert turned.azimuth.position_deg > jumped.azimuth.position_deg + 1.0


@story(Trait.CLOCK)
async def the_clock_of_the_drive_can_be_set(rig: Rig) -> None:
    await rig.drive.set_clock(datetime(2031, 12, 24, 18, 30, 5, tzinfo=UTC))
    rig.idle(2.0)
    assert rig.machine.wall_clock == datetime(2031, 12, 24, 18, 30, 7, tzinfo=UTC)


@story(Trait.SPEED)
async def closing_stops_the_axes(rig: Rig) -> None:
    await rig.forward(1.0, DriveCommand(azimuth=Velocity(3.0)))
    await rig.drive.close()
    rig.idle(0.5)
    assert not rig.machine.observe().azimuth.moving


@story(Trait.STEPS)
async def without_a_watchdog_hand_motion_ends_by_itself(rig: Rig) -> None:
    assert rig.drive.capabilities.watchdog_s is None
    before = await rig.forward(1.0, DriveCommand(Velocity(3.0), Velocity(-2.0)))
    rig.idle(5.0)
    feedback = await rig.drive.read()
    way_deg = feedback.azimuth.position_deg - before.azimuth.position_deg
    assert 0.0 < way_deg <= 3.0 * 0.24 + 3.0**2 / (2 * 6.0) + 0.02
    way_deg = feedback.elevation.position_deg - before.elevation.position_deg
    assert 0.0 > way_deg >= -(2.0 * 0.24 + 2.0**2 / (2 * 6.0) + 0.02)
    rig.idle(1.0)
    assert positions(await rig.drive.read()) == positions(feedback)


@story()
async def a_stop_overtakes_a_move_and_the_drive_obeys_again(rig: Rig) -> None:
    before = await rig.forward(2.0, at(140.0, 60.0))
    await rig.drive.stop()
    rig.idle(2.0)
    stood = await rig.drive.read()
    assert positions(stood)[0] < 139.0
    rig.idle(2.0)
    assert positions(await rig.drive.read()) == positions(stood)
    moved = await rig.until_rest(at(positions(before)[0] + 5.0, 50.0))
    assert positions(moved) == pytest.approx((positions(before)[0] + 5.0, 50.0), abs=LAST_COUNT_DEG)
