"""Commands that were cut off, overtaken or outlived: nothing goes on moving that was told to stand."""

import asyncio
from datetime import timedelta

import pytest

from app.modbus.errors import DriveError, DriveSilent
from app.simulation.devices.sunspec import AUTOMATIC, CONTROL
from app.tracker.settings.axes import Axis
from app.tracker.values.motion import DriveCommand, DriveRequest, Position, RequestKind
from tests.drives.direct_link import (
    STATUSWORD_ENABLED,
    LinkedRig,
    another_controller_drive,
    linked_controller,
    linked_rig,
)

AXIS_DRIVES = ("kinco-cia402", "leadshine-rs", "oriental-az")
FAR = DriveCommand(azimuth=Position(140.0, 6.0), elevation=Position(60.0, 2.0))
BRAKING = timedelta(seconds=4)


def stands(rig: LinkedRig) -> bool:
    """Return whether neither axis moves once it had time to brake, as the machine itself knows."""
    rig.clock.advance(BRAKING)
    observed = rig.machine.observe()
    return not (observed.azimuth.moving or observed.elevation.moving)


async def sent_but_cut_off(rig: LinkedRig, axis: Axis, command: DriveCommand) -> None:
    """Write a command whose caller gives up waiting for the reply to its last frame."""
    link = rig.links[axis]
    link.holds = lambda request: request.startswith("write") and not rig.machine.is_resting
    writing = asyncio.create_task(rig.drive.write(command))
    await link.held.wait()
    writing.cancel()
    await asyncio.gather(writing, return_exceptions=True)
    link.holds = lambda request: False


@pytest.mark.parametrize("axis", list(Axis))
@pytest.mark.parametrize("profile", AXIS_DRIVES[:2])
async def test_a_command_that_a_stop_overtakes_moves_nothing_after_it(profile: str, axis: Axis) -> None:
    rig = linked_rig(profile)
    await rig.drive.read()
    link = rig.links[axis]
    link.holds = lambda request: request.startswith("read")
    writing = asyncio.create_task(rig.drive.write(FAR))
    await link.held.wait()
    await rig.drive.stop()
    link.holds = lambda request: False
    link.release()
    with pytest.raises(DriveError):
        await writing
    assert stands(rig)


@pytest.mark.parametrize("profile", AXIS_DRIVES)
async def test_an_axis_is_halted_although_the_reply_to_its_command_was_not_waited_for(profile: str) -> None:
    rig = linked_rig(profile)
    await rig.forward(0.5, DriveCommand(azimuth=Position(101.0, 6.0)))
    await rig.until_rest()
    await sent_but_cut_off(rig, Axis.AZIMUTH, DriveCommand(azimuth=Position(140.0, 6.0)))
    rig.clock.advance(timedelta(seconds=1))
    assert rig.machine.observe().azimuth.moving, "the drive took the command"
    await rig.forward(0.1)
    assert stands(rig)
    assert rig.machine.observe().azimuth.position_deg < 130.0


@pytest.mark.parametrize("profile", AXIS_DRIVES)
@pytest.mark.parametrize("dead", list(Axis))
async def test_an_axis_is_halted_although_the_other_drive_does_not_answer(profile: str, dead: Axis) -> None:
    rig = linked_rig(profile)
    await rig.forward(1.0, FAR)
    rig.links[dead].silent = True
    with pytest.raises(DriveSilent):
        await rig.drive.read()
    with pytest.raises(DriveSilent):
        await rig.drive.write(DriveCommand())
    rig.clock.advance(BRAKING)
    observed = rig.machine.observe()
    other = observed.elevation if dead is Axis.AZIMUTH else observed.azimuth
    assert not other.moving


@pytest.mark.parametrize("profile", AXIS_DRIVES)
async def test_what_moves_when_the_machine_starts_again_is_halted(profile: str) -> None:
    rig = linked_rig(profile)
    await rig.forward(1.0, FAR)
    rig.drive = rig.another_drive(profile)
    await rig.forward(0.1)
    assert stands(rig)


@pytest.mark.parametrize("profile", AXIS_DRIVES)
async def test_a_search_that_only_one_axis_began_has_failed(profile: str) -> None:
    rig = linked_rig(profile)
    feedback = await rig.until_rest(DriveCommand(request=DriveRequest(1, RequestKind.HOME)))
    assert (feedback.request_done, feedback.request_failed) == (1, False)
    await rig.forward(1.0, FAR)
    await rig.until_rest(FAR)
    rig.links[Axis.AZIMUTH].loses = lambda request: request.startswith("write")
    again = DriveCommand(request=DriveRequest(2, RequestKind.HOME))
    with pytest.raises(DriveSilent):
        await rig.drive.write(again)
    rig.links[Axis.AZIMUTH].loses = lambda request: False
    feedback = await rig.forward(60.0, again)
    assert (feedback.request_done, feedback.request_failed) == (2, True)


async def test_a_fault_reset_leaves_the_sound_axis_powered() -> None:
    rig = linked_rig("kinco-cia402")
    await rig.forward(1.0, FAR)
    await rig.until_rest()
    rig.switch_off(Axis.AZIMUTH)
    assert (await rig.forward(0.1)).fault_code
    feedback = await rig.forward(0.2, DriveCommand(request=DriveRequest(3, RequestKind.RESET_FAULT)))
    assert (feedback.request_done, feedback.request_failed, feedback.fault_code) == (3, False, 0)
    assert rig.statusword(Axis.ELEVATION) & 0x6F == STATUSWORD_ENABLED


@pytest.mark.parametrize("renewed", ["connection", "life"])
async def test_another_controller_is_halted_over_a_new_connection_and_in_a_new_life(renewed: str) -> None:
    rig = linked_controller()
    await rig.forward(1.0, FAR)
    if renewed == "connection":
        rig.links[Axis.AZIMUTH].renew()
        await rig.drive.write(DriveCommand())
    else:
        rig.drive = another_controller_drive(rig)
        await rig.forward(0.2)
    assert stands(rig)
    assert rig.machine.observe().azimuth.position_deg < 130.0


async def test_a_controller_in_automatic_is_left_alone_until_it_is_commanded() -> None:
    rig = linked_controller()
    rig.machine.turn(Axis.AZIMUTH, FAR.azimuth)
    await rig.forward(1.0)
    rig.links[Axis.AZIMUTH].silent = True
    with pytest.raises(DriveSilent):
        await rig.drive.read()
    rig.links[Axis.AZIMUTH].silent = False
    await rig.forward(1.0)
    assert rig.links[Axis.AZIMUTH].device.read_registers(3, CONTROL, 1) == [AUTOMATIC]
    assert not stands(rig)


async def test_a_stop_after_a_long_silence_does_not_turn_the_axes_back() -> None:
    rig = linked_controller()
    await rig.forward(1.0, FAR)
    rig.clock.advance(timedelta(seconds=3))
    stopped_at_deg = rig.machine.observe().azimuth.position_deg
    await rig.drive.stop()
    assert stands(rig)
    assert stopped_at_deg <= rig.machine.observe().azimuth.position_deg < 140.0
