"""Faults played on a tracker whose simulated drive runs in another process, over its training registers."""

from collections.abc import Awaitable, Callable, Sequence
from dataclasses import replace
from datetime import timedelta

import pytest

from app.base.clock import SystemClock, VirtualClock
from app.drives.dialects.plc import PlcDrive
from app.drives.profile import load_profile
from app.machine.drive_factory import DriveFactory
from app.modbus.bus import Priority
from app.modbus.errors import DriveError, DriveRefused, DriveSilent
from app.modbus.server import Refusal
from app.simulation.fault_injection import TRAINED_PROFILE, trainer_of
from app.simulation.faults import Fault, FaultKind
from app.simulation.servers.sim_server import serve
from app.simulation.sim_plc import SimulatedPlc
from app.simulation.simulated import SimulatedDrive
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import DriveConfig, DriveKind, TrackerConfig
from tests.site.plant import SUMMER_NOON

CONFIG = TrackerConfig("T1", "North")


class Wired:
    """The registers of a device, without a wire; a `plain` one has no training registers."""

    ticket = 1

    def __init__(self, device: SimulatedPlc, *, plain: bool = False) -> None:
        self._device = device
        self._plain = plain
        self.written: list[int] = []

    async def read(
        self, address: int, count: int, *, what: str, priority: Priority = Priority.POLL
    ) -> list[int]:
        self._refuse(address, what)
        return list(self._device.read_registers(3, address, count))

    async def write(self, address: int, words: Sequence[int], *, what: str, ticket: int | None) -> None:
        self._refuse(address, what)
        self.written.append(address)
        self._device.write_registers(address, words)

    def _refuse(self, address: int, what: str) -> None:
        if self._plain and address >= 900:
            raise DriveRefused(f"There is no such register ({what}).")


def rig(*, plain: bool = False) -> tuple[SimulatedDrive, PlcDrive, Wired]:
    clock = VirtualClock(SUMMER_NOON)
    profile = load_profile(TRAINED_PROFILE)
    machine = SimulatedDrive(CONFIG, clock)
    link = Wired(SimulatedPlc(profile, machine, clock), plain=plain)
    return machine, PlcDrive(CONFIG, profile, clock, link), link  # type: ignore[arg-type]


async def test_faults_reach_the_other_process_and_end_there() -> None:
    machine, drive, _ = rig()
    trainer = trainer_of(drive)
    assert trainer is not None
    await trainer.play([Fault(FaultKind.LOCAL_SWITCH), Fault(FaultKind.ENCODER_JUMP, Axis.AZIMUTH, 12.4)])
    before_deg = machine.observe().azimuth.position_deg - machine.true_orientation.azimuth_deg
    assert machine.observe().local
    assert before_deg == pytest.approx(90.0 + 12.4, abs=0.05), "an unknown zero, and the jump"
    await trainer.clear()
    assert not machine.observe().local


async def test_silence_is_played_and_ended_although_nothing_else_is_answered() -> None:
    machine, drive, _ = rig()
    trainer = trainer_of(drive)
    assert trainer is not None
    await trainer.play([Fault(FaultKind.SILENCE)])
    assert machine.link_fault is FaultKind.SILENCE
    await trainer.clear()
    assert machine.link_fault is None


async def test_a_device_without_training_registers_is_never_written() -> None:
    _, drive, link = rig(plain=True)
    trainer = trainer_of(drive)
    assert trainer is not None
    with pytest.raises(DriveRefused):
        await trainer.play([Fault(FaultKind.SLIP, Axis.AZIMUTH, 1.0)])
    assert link.written == []


async def test_over_a_socket_silence_begins_and_ends() -> None:
    clock = SystemClock()
    machine = SimulatedDrive(CONFIG, clock)
    server, port = await serve("127.0.0.1", 0, load_profile(TRAINED_PROFILE), machine, clock)
    reached = DriveConfig(DriveKind.MODBUS_TCP, TRAINED_PROFILE, host="127.0.0.1", port=port)
    drive = DriveFactory(clock).make(replace(CONFIG, drive=reached))
    trainer = trainer_of(drive)
    assert trainer is not None
    assert not (await drive.read()).local
    await trainer.play([Fault(FaultKind.SILENCE), Fault(FaultKind.LOCAL_SWITCH)])
    with pytest.raises(DriveSilent):
        await drive.read()
    await repeated(clock, trainer.clear)
    await repeated(clock, drive.read)
    assert not (await drive.read()).local
    await drive.close()
    await server.close()


async def repeated(clock: SystemClock, work: Callable[[], Awaitable[object]]) -> None:
    """Do it again while the connection is being made anew, for five seconds at most."""
    give_up = clock.now() + timedelta(seconds=5)
    while True:
        try:
            await work()
        except DriveError:
            assert clock.now() < give_up
            await clock.sleep_until(clock.now() + timedelta(milliseconds=100))
        else:
            return


def test_only_the_profile_of_the_simulator_is_trained() -> None:
    clock = VirtualClock(SUMMER_NOON)
    machine, drive, _ = rig()
    assert trainer_of(machine) is not None
    assert drive.profile_name == TRAINED_PROFILE
    with pytest.raises(Refusal):
        SimulatedPlc(load_profile(TRAINED_PROFILE), machine, clock).write_registers(900, [1])
