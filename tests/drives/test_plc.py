"""The PLC adapter: its words on the bus, who else is there, and what it does not believe."""

import asyncio
from collections.abc import AsyncIterator, Sequence
from contextlib import asynccontextmanager
from dataclasses import dataclass, replace
from datetime import timedelta

import pytest

from app.base.clock import VirtualClock
from app.drives.dialects.plc import PlcDrive
from app.drives.dialects.plc_map import PlcMap
from app.drives.dialects.plc_signs import MOST_UNCHANGED
from app.drives.profile import Profile, load_profile
from app.machine.drive_factory import DriveFactory
from app.modbus.bus import Bus, BusUnit
from app.modbus.errors import DriveError, DriveRefused
from app.modbus.server import ModbusServer
from app.modbus.tcp import TcpWire
from app.modbus.wire import Timing
from app.simulation.faults import Fault, FaultKind
from app.simulation.sim_plc import SimulatedPlc
from app.simulation.simulated import SimulatedDrive
from app.tracker.settings.config import DriveConfig, DriveKind
from app.tracker.values.motion import (
    HALT,
    AxisFeedback,
    DriveCommand,
    DriveRequest,
    Feedback,
    Position,
    RequestKind,
    Velocity,
)
from tests.drives.rigs import CONFIG, START, modbus_rig

PROFILE = load_profile("simulated-plc")
MAP = PlcMap(PROFILE)
AZIMUTH_POSITION = 8


def block(words: dict[int, int]) -> list[int]:
    return [words.get(address, 0) for address in range(40)]


def test_a_command_in_words() -> None:
    """The numbers of docs/connect/simulated-plc.md: 0.001 degrees, high word first."""
    request = DriveRequest(65537, RequestKind.HOME)
    words = MAP.command_words(DriveCommand(Position(102.4, 6.0), Velocity(-0.5), request))
    assert words == {
        21: 2, 22: 1, 23: 36864, 24: 0, 25: 6000,
        26: 1, 27: 65535, 28: 65036, 29: 0, 30: 0,
        31: 1, 32: 3,
    }  # fmt: skip


def test_a_reading_in_words() -> None:
    words = [0] * 40
    words[4:8] = [3, 0b0110001, 0b100001, 12]
    words[8:16] = [0xFFFF, 0xFF9C, 1, 0, 0, 1500, 0xFFFF, 0xFE0C]
    words[16] = 9
    assert MAP.feedback(words, 0) == Feedback(
        AxisFeedback(-0.1, 1.5, moving=True, homed=False, at_lower_limit=True),
        AxisFeedback(65.536, -0.5, moving=False, homed=False, at_origin=True),
        boot_count=3, fault_code=12, homing=True, watchdog_tripped=True, request_done=9,
    )  # fmt: skip


COMMANDS = (
    DriveCommand(),
    DriveCommand(Velocity(3.0), Position(-1.25, 4.0)),
    DriveCommand(HALT, HALT, DriveRequest(77, RequestKind.SET_HOME_ELEVATION)),
)


def test_what_the_master_writes_is_what_the_plc_reads_and_a_number_without_meaning_is_refused() -> None:
    for command in COMMANDS:
        assert MAP.command(block(MAP.command_words(command)), 0) == command
    for address in (21, 26, 32):
        with pytest.raises(ValueError, match="does not exist"):
            MAP.command(block({address: 9}), 0)


class Wire(SimulatedPlc):
    """A simulated PLC whose traffic is noted and whose registers can be damaged on the way."""

    def __init__(self, profile: Profile, drive: SimulatedDrive, clock: VirtualClock) -> None:
        super().__init__(profile, drive, clock)
        self.writes: list[tuple[int, list[int]]] = []
        self.reads = 0
        self.asked = asyncio.Event()
        self.damage: list[dict[int, int]] = []
        self.still: dict[int, int] = {}

    def read_registers(self, function: int, address: int, count: int) -> Sequence[int]:
        self.reads += 1
        self.asked.set()
        words = list(super().read_registers(function, address, count))
        damage = self.still | (self.damage.pop(0) if self.damage else {})
        for place, word in damage.items():
            words[place - address] = word
        return words

    def write_registers(self, address: int, words: Sequence[int]) -> None:
        self.writes.append((address, list(words)))
        super().write_registers(address, words)


def plc_at(port: int, clock: VirtualClock) -> PlcDrive:
    config = replace(CONFIG, drive=DriveConfig(DriveKind.MODBUS_TCP, port=port))
    drive = DriveFactory(clock).make(config)
    assert isinstance(drive, PlcDrive)
    return drive


@dataclass
class Bench:
    drive: PlcDrive
    wire: Wire
    machine: SimulatedDrive
    clock: VirtualClock
    port: int

    def later(self, milliseconds: int = 100) -> None:
        self.clock.advance(timedelta(milliseconds=milliseconds))


@pytest.fixture
async def bench() -> AsyncIterator[Bench]:
    clock = VirtualClock(START)
    machine = SimulatedDrive(CONFIG, clock)
    wire = Wire(PROFILE, machine, clock)
    server = ModbusServer(wire)
    port = await server.start("127.0.0.1", 0)
    drive = plc_at(port, clock)
    try:
        yield Bench(drive, wire, machine, clock, port)
    finally:
        await drive.close()
        await server.close()


async def test_a_cycle_is_one_read_and_one_write_of_what_changed(bench: Bench) -> None:
    command = DriveCommand(Position(110.0, 6.0), HALT)
    for _ in range(3):
        await bench.drive.read()
        await bench.drive.write(command)
        bench.later()
    await bench.drive.write(replace(command, elevation=Velocity(1.0)))
    counts = [(address, len(words)) for address, words in bench.wire.writes]
    assert counts == [(20, 11), (20, 1), (20, 1), (20, 9)]
    assert bench.wire.reads == 3
    assert [words[0] for _, words in bench.wire.writes] == [1, 2, 3, 4], "the keep-alive value changes"


async def test_the_horn_sounds_while_it_is_told_to_and_costs_no_frame_otherwise(bench: Bench) -> None:
    horn = PROFILE.registers["horn"].address
    for sounds in (False, True, True, False, False):
        await bench.drive.read()
        await bench.drive.write(DriveCommand(Velocity(0.0), Velocity(0.0), horn=sounds))
        assert bench.machine.command.horn is sounds
    await bench.drive.read()
    written = [words for address, words in bench.wire.writes if address == horn]
    assert written == [[1], [0]]


async def test_the_first_write_reads_the_state_first(bench: Bench) -> None:
    await bench.drive.write(DriveCommand())
    assert bench.wire.reads == 1


async def test_after_a_stop_everything_is_written_anew(bench: Bench) -> None:
    command = DriveCommand(Velocity(1.0), Velocity(1.0))
    await bench.drive.read()
    await bench.drive.write(command)
    await bench.drive.stop()
    assert bench.wire.writes[-1] == (33, [1])
    assert bench.machine.command == DriveCommand()
    await bench.drive.read()
    await bench.drive.write(command)
    assert [len(words) for _, words in bench.wire.writes] == [11, 1, 11]


@asynccontextmanager
async def another_master(bench: Bench) -> AsyncIterator[BusUnit]:
    link = Bus("other", TcpWire("127.0.0.1", bench.port), bench.clock).unit(1, Timing())
    try:
        yield link
    finally:
        await link.close()


@pytest.mark.parametrize(("address", "words"), [(22, [0, 5000]), (20, [999]), (33, [1])])
@pytest.mark.fault(8)
async def test_another_master_is_noticed(bench: Bench, address: int, words: list[int]) -> None:
    async with another_master(bench) as other:
        command = DriveCommand(Position(110.0, 6.0), Position(40.0, 4.0))
        await bench.drive.read()
        await bench.drive.write(command)
        bench.later()
        await bench.drive.read()
        await other.write(address, words, what="a foreign word", ticket=None)
        with pytest.raises(DriveError, match="Another master commands"):
            await bench.drive.read()
        await bench.drive.write(command)
        bench.later()
        await bench.drive.read()
        assert bench.machine.command == command, "ours is written anew"


async def test_a_watchdog_between_read_and_write_is_no_foreign_master(bench: Bench) -> None:
    command = DriveCommand(azimuth=Velocity(1.0))
    await bench.drive.read()
    await bench.drive.write(command)
    bench.later(490)
    await bench.drive.read()
    bench.later(20)
    await bench.drive.write(command)
    feedback = await bench.drive.read()
    assert feedback.watchdog_tripped
    await bench.drive.write(command)
    bench.later()
    assert (await bench.drive.read()).azimuth.moving


async def test_one_damaged_position_is_read_again(bench: Bench) -> None:
    before = await bench.drive.read()
    bench.later()
    bench.wire.damage = [{AZIMUTH_POSITION: 3}]
    assert (await bench.drive.read()).azimuth == before.azimuth
    assert bench.wire.reads == 3


async def test_a_position_out_of_range_is_never_believed(bench: Bench) -> None:
    bench.wire.damage = [{AZIMUTH_POSITION: 0x7000}, {AZIMUTH_POSITION: 0x7000}]
    with pytest.raises(DriveError, match="outside the profile's range of -1080 to 1080"):
        await bench.drive.read()


@pytest.mark.fault(11)
async def test_a_heartbeat_that_stands_still_is_an_error(bench: Bench) -> None:
    bench.wire.still = {2: 5}
    for _ in range(3):
        await bench.drive.read()
    for _ in range(2):
        with pytest.raises(DriveError, match="heartbeat does not change"):
            await bench.drive.read()
    bench.wire.still = {}
    assert await bench.drive.read()


ECHO, WATCHDOG_MS = 3, 17
TURN = DriveCommand(Velocity(2.0), HALT)


async def test_an_echo_that_stands_still_while_keep_alive_values_are_written_is_an_error(
    bench: Bench,
) -> None:
    await bench.drive.read()
    bench.wire.still = {ECHO: 0}
    for _ in range(MOST_UNCHANGED + 1):
        await bench.drive.write(TURN)
        bench.later()
        if bench.wire.reads <= MOST_UNCHANGED:
            await bench.drive.read()
    for _ in range(2):
        with pytest.raises(DriveError, match="does not echo the keep-alive value"):
            await bench.drive.read()
        await bench.drive.write(TURN)
    bench.wire.still = {}
    assert await bench.drive.read()


async def test_a_watchdog_that_stays_off_is_an_error_of_every_later_motion(bench: Bench) -> None:
    await bench.drive.read()
    bench.wire.still = {WATCHDOG_MS: 0}
    assert bench.drive.capabilities.watchdog_s
    for _ in range(2):
        assert await bench.drive.read()
        await bench.drive.write(TURN)
        bench.later()
        with pytest.raises(DriveError, match="Switch it on again"):
            await bench.drive.read()
        await bench.drive.write(DriveCommand(Velocity(0.0), Velocity(0.0)))
        bench.later(2000)
        assert await bench.drive.read()


async def test_a_watchdog_that_is_off_at_rest_is_told_as_none(bench: Bench) -> None:
    await bench.drive.read()
    bench.wire.still = {WATCHDOG_MS: 0}
    assert await bench.drive.read()
    assert bench.drive.capabilities.watchdog_s is None


async def test_another_device_is_refused(bench: Bench) -> None:
    for address, word in ((0, 4), (1, 2)):
        bench.wire.still = {address: word}
        with pytest.raises(DriveRefused, match=f"holds {word} instead of .*unit id, and profile"):
            await bench.drive.read()


async def test_a_device_without_the_registers_is_refused_with_their_name(bench: Bench) -> None:
    wide = replace(PROFILE, blocks={"status": replace(PROFILE.blocks["status"], count=50)})
    config = replace(CONFIG, drive=DriveConfig(DriveKind.MODBUS_TCP, port=bench.port))
    unit = DriveFactory(bench.clock).buses.unit(config.drive, 1, wide.timing)
    drive = PlcDrive(config, wide, bench.clock, unit)
    with pytest.raises(DriveRefused, match=r"no such register.*block status of profile simulated-plc"):
        await drive.read()
    await drive.close()


async def test_the_request_number_is_told_in_full_although_the_register_is_short() -> None:
    async with modbus_rig() as rig:
        request = DriveRequest(70001, RequestKind.SET_HOME_AZIMUTH)
        feedback = await rig.forward(0.1, DriveCommand(request=request))
        assert feedback.request_done == 70001


async def test_a_reconnection_reads_the_state_before_anything_is_written(bench: Bench) -> None:
    await bench.drive.read()
    await bench.drive.write(DriveCommand(azimuth=Velocity(1.0)))
    bench.machine.inject(Fault(FaultKind.CORRUPT_REPLIES))
    with pytest.raises(DriveError):
        await bench.drive.read()
    bench.machine.end_injected_faults()
    reads = bench.wire.reads
    await bench.drive.write(DriveCommand())
    assert bench.wire.reads == reads + 1
    assert bench.wire.writes[-1] == (20, [2, 0, 0, 0])


async def test_a_command_from_before_a_stop_is_not_written_after_it(bench: Bench) -> None:
    writing = asyncio.create_task(bench.drive.write(DriveCommand(azimuth=Velocity(1.0))))
    await bench.wire.asked.wait()
    await bench.drive.stop()
    with pytest.raises(DriveError, match="stop had priority"):
        await writing
    assert bench.machine.command == DriveCommand()


async def test_a_drive_that_restarted_is_not_given_the_command_from_before(bench: Bench) -> None:
    await bench.drive.read()
    await bench.drive.write(DriveCommand(Position(110.0, 6.0)))
    bench.machine.inject(Fault(FaultKind.CORRUPT_REPLIES))
    with pytest.raises(DriveError):
        await bench.drive.read()
    bench.machine.end_injected_faults()
    bench.machine.inject(Fault(FaultKind.POWER_LOSS))
    with pytest.raises(DriveError, match="restarted"):
        await bench.drive.write(DriveCommand(Position(110.0, 6.0)))
    assert bench.machine.command == DriveCommand()


async def test_positions_that_differ_every_time_are_not_believed(bench: Bench) -> None:
    await bench.drive.read()
    bench.later()
    bench.wire.damage = [{AZIMUTH_POSITION: 3}, {AZIMUTH_POSITION: 7}]
    with pytest.raises(DriveError, match=r"azimuth moved by .* faster than it can turn"):
        await bench.drive.read()
    assert (await bench.drive.read()).azimuth.position_deg == pytest.approx(102.4)


async def test_an_echo_need_not_change_while_nothing_is_written(bench: Bench) -> None:
    await bench.drive.read()
    await bench.drive.write(DriveCommand())
    for _ in range(3 * MOST_UNCHANGED):
        await bench.drive.read()


async def test_a_watchdog_that_is_switched_off_during_a_motion_is_an_error(bench: Bench) -> None:
    await bench.drive.read()
    await bench.drive.write(TURN)
    bench.later()
    assert (await bench.drive.read()).azimuth.moving
    bench.wire.still = {WATCHDOG_MS: 0}
    for _ in range(3):
        with pytest.raises(DriveError, match="was switched off during motion"):
            await bench.drive.read()
    bench.wire.still = {}
    assert await bench.drive.read()


async def test_a_late_reply_counts_as_none(bench: Bench) -> None:
    await bench.drive.read()
    bench.machine.inject(Fault(FaultKind.LATE_REPLIES))
    with pytest.raises(DriveError, match=r"did not answer within 0.3 s"):
        await bench.drive.read()
    bench.machine.end_injected_faults()
    bench.later(500)
    assert (await bench.drive.read()).azimuth.position_deg == pytest.approx(102.4)


async def test_without_a_watchdog_the_capabilities_say_so() -> None:
    clock = VirtualClock(START)
    machine = SimulatedDrive(CONFIG, clock, watchdog=None)
    server = ModbusServer(SimulatedPlc(PROFILE, machine, clock))
    port = await server.start("127.0.0.1", 0)
    drive = plc_at(port, clock)
    await drive.read()
    assert drive.capabilities.watchdog_s is None
    await drive.close()
    await server.close()
