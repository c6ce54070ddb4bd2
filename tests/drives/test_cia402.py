"""The CiA 402 states, and what an axis drive makes of them, of its direction, and of a watchdog."""

from pathlib import Path

import pytest

from app.drives.dialects import cia402
from app.drives.dialects.cia402 import State, state_of
from app.drives.dialects.register_axis import DISABLED
from app.drives.profile import PROFILES
from app.simulation.faults import Fault, FaultKind
from app.tracker.values.motion import DriveCommand, DriveRequest, Position, RequestKind, Velocity
from tests.drives.device_rigs import BENCHES, Bench, device_rig
from tests.drives.rigs import Rig, Trait

EXAMPLES = {
    0x0000: State.NOT_READY,
    0x0250: State.SWITCH_ON_DISABLED,
    0x0231: State.READY,
    0x0233: State.SWITCHED_ON,
    0xC437: State.ENABLED,
    0x0617: State.QUICK_STOP,
    0x021F: State.FAULT_REACTION,
    0x0218: State.FAULT,
}
CONTROLWORD = 0x3100


def test_a_statusword_is_decoded_by_its_mask_and_the_transition_that_enables_does_not_move() -> None:
    assert {word: state_of(word) for word in EXAMPLES} == EXAMPLES
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
        rig.machine.inject(Fault(FaultKind.DRIVE_FAULT, amount=0x0200))
        assert (await rig.drive.read()).fault_code == 0x0200, "its own code is passed on"


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


WATCHDOG = """
[watchdog]
timeout_ms = 500
action = "The drive ramps down and raises an alarm."
"""


def with_watchdog(name: str, folder: Path) -> Bench:
    """Return a bench with the shipped profile and a watchdog that every request feeds."""
    (folder / "profiles").mkdir()
    text = (PROFILES / f"{name}.toml").read_text(encoding="utf-8").replace(f'name = "{name}"', 'name = "own"')
    (folder / "profiles" / "own.toml").write_text(text + WATCHDOG, encoding="utf-8")
    known = BENCHES[name]
    return Bench("own", known.gear_ratio, known.traits - {Trait.STEPS}, known.speed_step_dps)


@pytest.mark.parametrize("name", ["kinco-cia402", "leadshine-rs", "oriental-az"])
async def test_with_a_watchdog_hand_motion_is_one_command_until_the_next(name: str, tmp_path: Path) -> None:
    async with device_rig(with_watchdog(name, tmp_path), tmp_path) as rig:
        can = rig.drive.capabilities
        assert (can.watchdog_s, can.watchdog_action) == (0.5, "The drive ramps down and raises an alarm.")
        before = await rig.forward(1.5, DriveCommand(Velocity(-3.0), Velocity(2.0)))
        rig.idle(2.0)
        feedback = await rig.drive.read()
        way_deg = feedback.azimuth.position_deg - before.azimuth.position_deg
        assert way_deg == pytest.approx(-6.0, abs=0.02), "no step ends it: the device's watchdog would"
        assert feedback.elevation.velocity_dps == pytest.approx(2.0, abs=rig.speed_step_dps)
        halted = await rig.forward(1.0)
        assert not halted.azimuth.moving
        assert not halted.elevation.moving
