"""The CiA 402 decoder and what an axis makes of its states."""

import pytest

from app.drives.dialects import cia402
from app.drives.dialects.cia402 import State, state_of
from app.drives.dialects.register_axis import DISABLED
from app.simulation.faults import Fault, FaultKind
from app.tracker.values.motion import DriveCommand, DriveRequest, Position, RequestKind, Velocity
from tests.drives.device_rigs import BENCHES, device_rig
from tests.drives.rigs import Rig

EXAMPLES = {
    0x0000: State.NOT_READY,
    0x0250: State.SWITCH_ON_DISABLED,
    0x0231: State.READY,
    0x0233: State.SWITCHED_ON,
    0x0637: State.ENABLED,
    0xC437: State.ENABLED,
    0x0617: State.QUICK_STOP,
    0x021F: State.FAULT_REACTION,
    0x0218: State.FAULT,
}
CONTROLWORD, STATUSWORD = 0x3100, 0x3200


@pytest.mark.parametrize("statusword", EXAMPLES)
def test_a_statusword_is_decoded_by_its_mask(statusword: int) -> None:
    assert state_of(statusword) is EXAMPLES[statusword]


def test_no_statusword_has_two_states() -> None:
    for statusword in range(0x80):
        assert sum(statusword & mask == value for mask, value, _ in cia402.STATES) <= 1


def test_the_transition_that_enables_does_not_move() -> None:
    assert cia402.TOWARDS_ENABLED[State.SWITCHED_ON] & cia402.HALT_BIT


def controlword(rig: Rig, unit: int = 1) -> int:
    device = rig.devices[unit]
    return device.read_registers(3, CONTROLWORD, 1)[0]


async def test_halt_is_set_in_every_cycle_without_a_target() -> None:
    async with device_rig(BENCHES["kinco-cia402"]) as rig:
        await rig.forward(0.5, DriveCommand(azimuth=Position(110.0, 6.0)))
        assert controlword(rig) == 0x3F
        assert controlword(rig, 2) == 0, "an axis that was never moved is not even powered"
        await rig.forward(0.1)
        assert controlword(rig) == cia402.HALTED
        await rig.drive.stop()
        assert controlword(rig) == cia402.HALTED


async def test_a_motor_that_somebody_switched_off_waits_for_a_reset() -> None:
    async with device_rig(BENCHES["kinco-cia402"]) as rig:
        command = DriveCommand(azimuth=Position(140.0, 6.0))
        await rig.forward(1.0, command)
        rig.devices[1].write_registers(CONTROLWORD, [0])
        feedback = await rig.forward(2.0, command)
        assert feedback.fault_code == DISABLED
        assert not feedback.azimuth.moving
        request = DriveCommand(request=DriveRequest(3, RequestKind.RESET_FAULT))
        feedback = await rig.forward(0.2, request)
        assert (feedback.request_done, feedback.request_failed, feedback.fault_code) == (3, False, 0)
        assert (await rig.forward(1.0, command)).azimuth.moving


async def test_the_fault_code_of_the_drive_is_passed_on() -> None:
    async with device_rig(BENCHES["kinco-cia402"]) as rig:
        rig.machine.inject(Fault(FaultKind.DRIVE_FAULT, amount=0x0200))
        assert (await rig.drive.read()).fault_code == 0x0200


@pytest.mark.parametrize("name", ["kinco-cia402", "leadshine-rs", "oriental-az"])
async def test_an_inverted_axis_turns_the_other_way_and_its_ends_change_places(name: str) -> None:
    async with device_rig(BENCHES[name].turned_round()) as rig:
        before = await rig.drive.read()
        feedback = await rig.forward(1.0, DriveCommand(azimuth=Velocity(2.0)))
        assert feedback.azimuth.position_deg > before.azimuth.position_deg + 1.0
        assert feedback.azimuth.velocity_dps == pytest.approx(2.0, abs=0.1)
        assert rig.machine.true_orientation.azimuth_deg < 12.4 - 1.0
        if rig.drive.capabilities.limit_switches:
            rig.machine.inject(Fault(FaultKind.UPPER_LIMIT_STUCK))
            ends = (await rig.drive.read()).azimuth
            assert (ends.at_lower_limit, ends.at_upper_limit) == (True, False)
