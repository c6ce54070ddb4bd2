"""What only the simulated drive has: its memory, its mechanics, and a life without waiting."""

from datetime import timedelta
from pathlib import Path

import pytest

from app.base.clock import VirtualClock
from app.simulation.faults import Fault, FaultKind
from app.simulation.position_memory import PositionFile
from app.simulation.simulated import SimulatedDrive
from app.simulation.simulated_axis import Mechanics
from app.tracker.settings.axes import Axis
from app.tracker.values.motion import DriveCommand, DriveRequest, Feedback, Position, RequestKind, Velocity
from tests.drives.rigs import CONFIG, START, Rig

MOVE = DriveCommand(Position(120.0, 6.0), Position(50.0, 4.0))
DOWN = DriveCommand(Velocity(-2.0), Velocity(-2.0))


def drive_at(clock: VirtualClock, memory: Path | None) -> SimulatedDrive:
    kept = None if memory is None else PositionFile(memory)
    return SimulatedDrive(CONFIG, clock, memory=kept, watchdog=None)


async def homed(clock: VirtualClock, memory: Path) -> SimulatedDrive:
    drive = drive_at(clock, memory)
    await Rig(drive, drive, clock).until_rest(DriveCommand(request=DriveRequest(1, RequestKind.HOME)))
    return drive


async def test_no_call_ever_suspends() -> None:
    drive = drive_at(VirtualClock(START), None)
    for call in (drive.read(), drive.write(MOVE), drive.stop(), drive.set_clock(START), drive.close()):
        with pytest.raises(StopIteration):
            call.send(None)


async def test_a_drive_that_stood_still_knows_its_zero_after_a_restart(tmp_path: Path) -> None:
    clock, memory = VirtualClock(START), tmp_path / "drives" / "T1.json"
    drive = await homed(clock, memory)
    await Rig(drive, drive, clock).until_rest(MOVE)
    clock.advance(timedelta(seconds=2))
    left = await drive.read()
    found = await drive_at(clock, memory).read()
    assert found.boot_count == left.boot_count == 1
    assert found.azimuth == left.azimuth
    assert found.elevation == left.elevation


async def test_a_drive_that_was_moving_has_lost_its_zero_after_a_restart(tmp_path: Path) -> None:
    clock, memory = VirtualClock(START), tmp_path / "T1.json"
    drive = await homed(clock, memory)
    clock.advance(timedelta(seconds=2))
    await drive.read()
    await drive.write(DriveCommand(azimuth=Velocity(1.0)))
    found = await drive_at(clock, memory).read()
    assert found.boot_count == 2
    assert not found.azimuth.homed
    assert not found.elevation.homed
    again = await drive_at(clock, memory).read()
    assert again.boot_count == 3, "a drive that was never seen at rest stays untrusted"


async def test_a_zero_counts_only_once_it_is_in_the_memory(tmp_path: Path) -> None:
    clock, memory = VirtualClock(START), tmp_path / "T1.json"
    drive = await homed(clock, memory)
    await drive.write(DriveCommand())
    assert not (await drive_at(clock, memory).read()).azimuth.homed


async def test_closing_in_mid_move_remembers_where_the_axes_come_to_rest(tmp_path: Path) -> None:
    clock, memory = VirtualClock(START), tmp_path / "T1.json"
    drive = await homed(clock, memory)
    rig = Rig(drive, drive, clock)
    await rig.forward(2.0, DriveCommand(azimuth=Velocity(3.0)))
    await drive.close()
    found = await drive_at(clock, memory).read()
    assert (found.boot_count, found.azimuth.homed) == (1, True)
    clock.advance(timedelta(seconds=2))
    assert found.azimuth.position_deg == pytest.approx((await drive.read()).azimuth.position_deg)


@pytest.mark.parametrize("damage", [b"", b'{"azimuth": 1}', b"\xff\xfe"])
async def test_a_damaged_memory_is_no_memory(tmp_path: Path, damage: bytes) -> None:
    memory = tmp_path / "T1.json"
    memory.write_bytes(damage)
    feedback = await drive_at(VirtualClock(START), memory).read()
    assert (feedback.boot_count, feedback.azimuth.homed) == (1, False)


async def test_how_often_it_is_read_changes_nothing() -> None:
    ends = []
    for reads in (1, 7, 500):
        clock = VirtualClock(START)
        drive = drive_at(clock, None)
        await drive.write(MOVE)
        for _ in range(reads):
            clock.advance(timedelta(seconds=3.5) / reads)
            feedback = await drive.read()
        ends.append(feedback.azimuth.position_deg)
    assert ends == pytest.approx([ends[0]] * 3, abs=0.0101)


async def test_the_encoder_counts_in_steps_of_its_gear() -> None:
    clock = VirtualClock(START)
    coarse = SimulatedDrive(CONFIG, clock, mechanics=Mechanics(gear=1.0), watchdog=None)
    await coarse.write(DriveCommand(azimuth=Velocity(0.37)))
    clock.advance(timedelta(seconds=5))
    counts = (await coarse.read()).azimuth.position_deg / 0.1
    assert counts == pytest.approx(round(counts), abs=1e-6)


async def test_after_a_turn_the_panel_follows_only_behind_the_backlash() -> None:
    clock = VirtualClock(START)
    loose = SimulatedDrive(CONFIG, clock, mechanics=Mechanics(backlash_deg=0.4), watchdog=None)
    rig = Rig(loose, loose, clock)
    up = await rig.until_rest(DriveCommand(Position(110.0, 6.0)))
    truth = loose.true_orientation.azimuth_deg
    assert up.azimuth.position_deg - 90.0 - truth == pytest.approx(0.2, abs=0.011)
    await rig.until_rest(DriveCommand(Position(109.7, 6.0)))
    assert loose.true_orientation.azimuth_deg == pytest.approx(truth), "the play is not yet used up"
    await rig.until_rest(DriveCommand(Position(109.0, 6.0)))
    assert loose.true_orientation.azimuth_deg == pytest.approx(19.2, abs=0.011)


async def test_a_target_beyond_the_end_of_travel_ends_at_the_switch() -> None:
    clock = VirtualClock(START)
    drive = drive_at(clock, None)
    feedback = await Rig(drive, drive, clock).until_rest(DriveCommand(elevation=Position(500.0, 4.0)))
    assert feedback.elevation.at_upper_limit
    assert feedback.elevation.position_deg < 130.0


async def hurt(fault: FaultKind, axis: Axis, seconds: float, command: DriveCommand) -> Feedback:
    """Return what a drive reads that has had a fault for so long."""
    clock = VirtualClock(START)
    drive = drive_at(clock, None)
    drive.inject(Fault(fault, axis, -0.2))
    return await Rig(drive, drive, clock).forward(seconds, command)


async def test_each_fault_of_the_mechanics_is_seen_as_it_would_be() -> None:
    begin_deg, elevation_deg = 102.4, 36.6
    jumped = await hurt(FaultKind.ENCODER_JUMP, Axis.AZIMUTH, 0.1, DriveCommand())
    assert jumped.azimuth.position_deg == pytest.approx(begin_deg - 0.2)
    stalled = await hurt(FaultKind.STALL, Axis.ELEVATION, 2.0, MOVE)
    assert stalled.elevation.moving, "by its own account"
    assert stalled.elevation.position_deg == pytest.approx(elevation_deg)
    assert stalled.azimuth.position_deg > 108.0
    frozen = await hurt(FaultKind.FROZEN_POSITION, Axis.AZIMUTH, 1.0, MOVE)
    assert frozen.azimuth.position_deg == pytest.approx(begin_deg)
    slipping = await hurt(FaultKind.SLIP, Axis.ELEVATION, 5.0, DriveCommand())
    assert slipping.elevation.position_deg == pytest.approx(elevation_deg - 1.0, abs=0.02)
    turned = await hurt(FaultKind.WRONG_DIRECTION, Axis.AZIMUTH, 60.0, DriveCommand(Position(150.0, 6.0)))
    assert turned.azimuth.at_lower_limit, "it runs away from its target to the end of travel"
    stuck = await hurt(FaultKind.LOWER_LIMIT_STUCK, Axis.AZIMUTH, 1.0, DOWN)
    assert (stuck.azimuth.velocity_dps, stuck.azimuth.at_lower_limit) == (0.0, True)
    assert stuck.elevation.velocity_dps == pytest.approx(-2.0)
