"""Looking at a drive beside what it does: every register decoded, nothing changed, every failure told."""

from collections.abc import AsyncIterator
from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest

from app.base.clock import VirtualClock
from app.drives.connections.buses import Buses
from app.drives.connections.probe import DriveProbe
from app.drives.profile import PROFILES, load_profile
from app.drives.profile_library import ProfileLibrary
from app.modbus.server import ModbusServer
from app.simulation.servers.sim_server import serve
from app.simulation.simulated import SimulatedDrive
from app.tracker.memory.drive_check import CheckOutcome
from app.tracker.settings.config import DriveConfig, DriveKind, TrackerConfig
from app.tracker.values.motion import DriveCommand, Velocity

START = datetime(2026, 6, 21, 4, 0, tzinfo=UTC)


@dataclass
class Bench:
    """A simulated drive behind a socket, and somebody who looks at it."""

    machine: SimulatedDrive
    clock: VirtualClock
    server: ModbusServer
    drive: DriveConfig
    probe: DriveProbe


@pytest.fixture
async def bench(tmp_path: Path) -> AsyncIterator[Bench]:
    clock = VirtualClock(START)
    machine = SimulatedDrive(TrackerConfig("T1", "Tracker 1"), clock, watchdog=timedelta(milliseconds=400))
    server, port = await serve("127.0.0.1", 0, load_profile("simulated-plc"), machine, clock)
    drive = DriveConfig(DriveKind.MODBUS_TCP, port=port)
    yield Bench(machine, clock, server, drive, DriveProbe(Buses(clock), ProfileLibrary(tmp_path)))
    await server.close()


async def test_every_register_is_read_and_decoded_and_the_watchdog_read_back(bench: Bench) -> None:
    bench.machine.obey(DriveCommand(azimuth=Velocity(2.0)))
    before = bench.machine.command
    readings = await bench.probe.look(bench.drive)
    assert readings.outcome is CheckOutcome.ANSWERED, readings.message
    seen = {one.name: one for one in readings.registers}
    assert set(seen) == set(load_profile("simulated-plc").registers)
    assert (seen["identity"].shown, seen["identity"].trouble) == ("18512", "")
    assert seen["azimuth_position"].shown == "102.4"
    assert seen["azimuth_position"].unit == "deg"
    assert seen["azimuth_motion"].shown == "1 (velocity)"
    assert "azimuth_moving" in seen["status"].shown
    assert seen["year"].shown == "2026"
    assert readings.watchdog_s == 0.4
    assert readings.watchdog_action.startswith("Both axes ramp down")
    assert bench.machine.command == before, "nothing is changed by looking"


async def test_another_device_is_told_by_its_identity(bench: Bench, tmp_path: Path) -> None:
    text = (PROFILES / "simulated-plc.toml").read_text()
    other = tmp_path / "other.toml"
    other.write_text(text.replace("expect = 18512", "expect = 4711").replace("count = 6", "count = 100"))
    readings = await bench.probe.look(replace(bench.drive, profile="other"))
    assert readings.outcome is CheckOutcome.WRONG_DEVICE
    assert "18512 instead of 4711" in readings.message
    refused = [one for one in readings.registers if one.trouble]
    assert {one.name for one in refused} >= {"identity", "year"}
    assert "has no such register" in next(one.trouble for one in refused if one.name == "year")


async def test_a_device_without_what_its_profile_needs_is_not_called_an_answer(
    bench: Bench, tmp_path: Path
) -> None:
    other = await bench.probe.look(replace(bench.drive, profile="delta-dvp"))
    assert other.outcome is CheckOutcome.WRONG_DEVICE
    assert "is not a Delta DVP PLC, example layout: identity (4096) could not be read" in other.message
    text = (PROFILES / "simulated-plc.toml").read_text()
    (tmp_path / "other.toml").write_text(text.replace("count = 6", "count = 100"))
    older = await bench.probe.look(replace(bench.drive, profile="other"))
    assert older.outcome is CheckOutcome.WRONG_DEVICE
    assert "could not be read (year, month, day, hour and 2 more). Check the unit id" in older.message


async def test_each_way_of_no_answer_has_its_sentence(bench: Bench) -> None:
    silent = await bench.probe.look(replace(bench.drive, unit=9))
    assert silent.outcome is CheckOutcome.SILENT
    assert "did not answer within" in silent.message
    assert "its unit id 9" in silent.message
    await bench.server.close()
    refused = await bench.probe.look(bench.drive)
    assert refused.outcome is CheckOutcome.SILENT
    assert "nothing listens on port" in refused.message
    unknown = await bench.probe.look(replace(bench.drive, host="no-such-host.invalid"))
    assert "is not known" in unknown.message


async def test_settings_that_reach_no_drive_say_so(bench: Bench) -> None:
    for profile, why in (
        ("nonsense", "no drive profile"),
        ("kinco-cia402", "Give the elevation axis a different unit id"),
    ):
        unusable = await bench.probe.look(replace(bench.drive, profile=profile))
        assert unusable.outcome is CheckOutcome.UNUSABLE
        assert why in unusable.message
    assert "no connection to test" in (await bench.probe.look(DriveConfig())).message


def test_the_choices_are_the_profiles_that_come_with_the_program() -> None:
    choices = DriveProbe(Buses(VirtualClock(START)), ProfileLibrary()).choices()
    plc = next(one for one in choices.profiles if one.name == "simulated-plc")
    assert (plc.verified, plc.trouble, plc.unverified) == (True, "", ())
    assert plc.title
    assert plc.source
    assert "ramp down" in plc.watchdog
