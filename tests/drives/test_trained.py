"""Faults played on a tracker whose simulated drive runs in another process, over its training registers."""

import pytest

from app.drives.dialects.plc import PlcDrive
from app.drives.profile import load_profile
from app.modbus.errors import DriveRefused, DriveSilent
from app.modbus.server import Refusal
from app.simulation.fault_injection import TRAINED_PROFILE, trainer_of
from app.simulation.faults import Fault, FaultKind
from app.simulation.sim_plc import SimulatedPlc
from app.simulation.simulated import SimulatedDrive
from app.tracker.settings.axes import Axis
from tests.drives.rigs import CONFIG, modbus_rig
from tests.drives.test_requests import NotingLink
from tests.patient_loop import LoopClock

SLIP = Fault(FaultKind.SLIP, Axis.AZIMUTH, 1.0)


async def test_faults_reach_the_other_process_and_end_there() -> None:
    async with modbus_rig() as rig:
        trainer = trainer_of(rig.drive)
        assert trainer is not None
        await trainer.play([Fault(FaultKind.LOCAL_SWITCH), Fault(FaultKind.ENCODER_JUMP, Axis.AZIMUTH, 12.4)])
        seen = rig.machine.observe()
        assert seen.local
        turned_deg = seen.azimuth.position_deg - rig.machine.true_orientation.azimuth_deg
        assert turned_deg == pytest.approx(90.0 + 12.4, abs=0.05), "an unknown zero, and the jump"
        await trainer.clear()
        assert not rig.machine.observe().local
        assert trainer_of(rig.machine) is not None


async def test_silence_begins_and_ends_although_nothing_else_is_answered() -> None:
    async with modbus_rig() as rig:
        trainer = trainer_of(rig.drive)
        assert trainer is not None
        await rig.drive.read()
        await trainer.play([Fault(FaultKind.SILENCE)])
        assert rig.machine.link_fault is FaultKind.SILENCE
        with pytest.raises(DriveSilent):
            await rig.drive.read()
        rig.idle(2.0)
        await trainer.clear()
        assert rig.machine.link_fault is None
        assert await rig.drive.read()


async def test_a_device_without_training_registers_is_never_written() -> None:
    profile = load_profile(TRAINED_PROFILE)
    link = NotingLink(refuses=set(range(900, 1000)))
    trainer = trainer_of(PlcDrive(CONFIG, profile, LoopClock(), link))  # type: ignore[arg-type]
    assert trainer is not None
    with pytest.raises(DriveRefused):
        await trainer.play([SLIP])
    assert link.writes == []
    plain = SimulatedPlc(profile, SimulatedDrive(CONFIG, LoopClock()), LoopClock())
    with pytest.raises(Refusal):
        plain.write_registers(900, [1])
