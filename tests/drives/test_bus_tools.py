"""Scan, record and replay: looking at devices without changing anything."""

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import dataclass, replace
from datetime import timedelta

import pytest

from app.drives.connections.bus_tools import record, replay, scan
from app.drives.connections.buses import Buses
from app.drives.connections.probe import probe
from app.drives.profile import Profile, load_profile
from app.modbus.errors import DriveError, DriveSilent
from app.modbus.server import ModbusServer
from app.modbus.trace import Exchange, Replay, ReplayDevice, parse_trace
from app.modbus.wire import Ask
from app.simulation.devices.shelf import devices
from app.simulation.faults import Fault, FaultKind
from app.simulation.simulated import SimulatedDrive
from app.tracker.memory.drive_check import CheckOutcome
from app.tracker.settings.config import AxisDrive, DriveConfig, DriveKind, TrackerConfig
from tests.drives.rigs import CONFIG
from tests.patient_loop import LoopClock

REPLY = (3, 5)
ASK = Ask(1, 0x3200, 2)


@dataclass
class Bench:
    """A simulated device behind a socket, and the settings that reach it."""

    profile: Profile
    machine: SimulatedDrive
    server: ModbusServer
    config: TrackerConfig


@asynccontextmanager
async def on_the_bench(name: str) -> AsyncIterator[Bench]:
    profile = load_profile(name)
    machine = SimulatedDrive(CONFIG, LoopClock(), watchdog=None)
    found = devices(profile, machine, LoopClock(), 1)
    server = ModbusServer(found[1], 1, others=found)
    port = await server.start("127.0.0.1", 0)
    other = AxisDrive(unit=2) if len(found) > 1 else AxisDrive()
    drive = DriveConfig(DriveKind.MODBUS_TCP, name, port=port, elevation=other)
    try:
        yield Bench(profile, machine, server, replace(CONFIG, drive=drive))
    finally:
        await server.close()


async def test_a_scan_finds_who_answers_and_who_only_refuses() -> None:
    async with on_the_bench("leadshine-rs") as bench:
        found = [one async for one in scan(bench.config.drive, range(1, 4), LoopClock(), address=1)]
        assert [(one.unit, one.said) for one in found] == [
            (1, "register 1 holds 10000"),
            (2, "register 1 holds 10000"),
        ]
        refused = [one async for one in scan(bench.config.drive, (1,), LoopClock(), address=9)]
        assert "has no such register" in refused[0].said
    async with on_the_bench("kinco-cia402") as bench:
        drive = bench.config.drive
        refused = [one async for one in scan(drive, (1, 2), LoopClock(), address=9)]
        assert ["has no such register" in one.said for one in refused] == [True, True], "code 0x81"
    with pytest.raises(DriveSilent, match="There is no connection to 127"):
        _ = [one async for one in scan(drive, range(1, 248), LoopClock())]


@pytest.mark.parametrize("name", ["kinco-cia402", "leadshine-rs", "oriental-az", "delta-dvp", "sunspec-601"])
async def test_a_probe_reads_every_register_of_every_device(name: str) -> None:
    async with on_the_bench(name) as bench:
        readings = await probe(Buses(LoopClock()), bench.config.drive, bench.profile)
        assert readings.outcome is CheckOutcome.ANSWERED, readings.message
        axes = 2 if bench.profile.adapter.has_unit_per_axis else 1
        assert len(readings.registers) == axes * len(bench.profile.registers)
        assert {one.name for one in readings.registers if not one.verified} == set(bench.profile.unverified)


@pytest.mark.parametrize("name", ["kinco-cia402", "sunspec-601"])
async def test_what_was_recorded_reads_the_same_again_and_nothing_was_written(name: str) -> None:
    async with on_the_bench(name) as bench:
        kept: list[Exchange] = []
        command = bench.machine.command
        length = timedelta(seconds=0.3)
        good = await record(bench.config, bench.profile, LoopClock(), kept.append, length)
        assert good >= 1
        assert bench.machine.command == command
        assert not any(one.ask.words for one in kept)
        lines = [one.line() for one in kept]
    played = await replay(bench.config, bench.profile, parse_trace(lines, "bench.jsonl"))
    assert played
    for one in played:
        assert one.feedback is not None, one.trouble
        assert one.feedback.azimuth.position_deg == pytest.approx(102.4, abs=0.02)
        assert one.feedback.elevation.position_deg == pytest.approx(36.6, abs=0.02)
    assert [one.at_s for one in played] == sorted(one.at_s for one in played)


async def test_a_silence_and_a_refusal_are_recorded_and_played_as_such() -> None:
    async with on_the_bench("kinco-cia402") as bench:
        kept: list[Exchange] = []
        recording = asyncio.create_task(
            record(bench.config, bench.profile, LoopClock(), kept.append, timedelta(seconds=0.5))
        )
        await asyncio.sleep(0.1)
        bench.machine.inject(Fault(FaultKind.SILENCE))
        await recording
    assert any(one.silent for one in kept)
    played = await replay(bench.config, bench.profile, parse_trace([one.line() for one in kept], "x"))
    assert "did not answer" in played[-1].trouble


EXCHANGES = [
    Exchange(0.0, ASK, (1, 2)),
    Exchange(0.1, ASK, REPLY),
    Exchange(0.2, Ask(1, 7, 1), refused=2),
    Exchange(0.3, Ask(2, 7, 1), silent=True),
    Exchange(0.4, Ask(2, 8, 1), broken="the checksum is wrong"),
    Exchange(0.5, Ask(2, 9, 2, (4, 5)), (4, 5)),
]


def test_a_trace_is_the_same_when_read_and_answers_in_order_and_the_last_answer_stays() -> None:
    assert parse_trace([one.line() for one in EXCHANGES], "x") == EXCHANGES
    answers = Replay(EXCHANGES)
    assert answers.units == (1, 2)
    assert answers.remaining == 6
    assert [answers.next(ASK).reply for _ in range(3)] == [(1, 2), REPLY, REPLY]
    assert answers.remaining == 4
    assert answers.next(Ask(1, 0x9999, 1)).refused == 2


async def test_a_recorded_device_is_served_with_its_silences() -> None:
    device = ReplayDevice(Replay(EXCHANGES), 2)
    device.read_registers(3, 7, 1)
    assert await device.let_out(b"reply") is None
    device.write_registers(9, (4, 5))
    assert await device.let_out(b"reply") == b"reply"


@pytest.mark.parametrize("line", ["{", "[]", '{"unit": 1}', '{"at_s": 0, "unit": 1, "read": [1]}'])
def test_a_line_that_is_no_exchange_is_named(line: str) -> None:
    with pytest.raises(DriveError, match=r"own\.jsonl, line 2: this is not a line of a bus trace"):
        parse_trace([EXCHANGES[0].line(), line], "own.jsonl")
    with pytest.raises(DriveError, match="contains no exchange"):
        parse_trace(["", " "], "own.jsonl")
