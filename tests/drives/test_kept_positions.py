"""Simulated drives of a controller outlive it: they count on, and their watchdogs stop the axes."""

from dataclasses import replace
from datetime import timedelta
from pathlib import Path
from typing import cast

import pytest

from app.base.clock import VirtualClock
from app.machine.drive_factory import DriveFactory
from app.simulation import kept_positions
from app.simulation.faults import Fault, FaultKind
from app.simulation.position_memory import AxisMemory, PositionFile, PositionMemory
from app.simulation.simulated import SimulatedDrive
from app.tracker.values.motion import DriveCommand, DriveRequest, Feedback, Position, RequestKind, Velocity
from tests.drives.rigs import CONFIG, START, Rig
from tests.fault_result import BY_ITSELF, FaultResult

MOVE = DriveCommand(Position(120.0, 6.0), Position(50.0, 4.0))
HOME = DriveCommand(request=DriveRequest(1, RequestKind.HOME))
WATCHDOG_S = 0.5


def born(clock: VirtualClock, folder: Path, tracker_id: str = "T1") -> SimulatedDrive:
    """Return a drive as the next life of a controller makes it."""
    drive = DriveFactory(clock, folder).make(replace(CONFIG, tracker_id=tracker_id))
    return cast(SimulatedDrive, drive)


async def homed(clock: VirtualClock, folder: Path) -> SimulatedDrive:
    drive = born(clock, folder)
    await Rig(drive, drive, clock).until_rest(HOME)
    return drive


async def rested(drive: SimulatedDrive, clock: VirtualClock) -> Feedback:
    """Return where the axes come to rest that nobody speaks to."""
    clock.advance(timedelta(seconds=10))
    return await drive.read()


def places(seen: Feedback) -> tuple[float, float]:
    return seen.azimuth.position_deg, seen.elevation.position_deg


@pytest.mark.fault(82)
@pytest.mark.parametrize("ticks", [1, 23, 400])
async def test_a_drive_cut_off_in_mid_move_has_counted_to_where_it_stopped(
    tmp_path: Path, ticks: int, fault: FaultResult
) -> None:
    clock = VirtualClock(START)
    drive = await homed(clock, tmp_path)
    for _ in range(ticks):
        await drive.write(MOVE)
        clock.advance(timedelta(milliseconds=100))
        last = await drive.read()
    found = await born(clock, tmp_path).read()
    assert places(found) == pytest.approx(places(await rested(drive, clock)), abs=0.011)
    assert (found.boot_count, found.azimuth.homed, found.elevation.homed) == (last.boot_count, True, True)
    assert not found.azimuth.moving
    assert places(found) != places(last) or ticks == 400
    fault.prevented("the home position holds, and the angle is the one that the axis has reached")
    fault.recovers(BY_ITSELF)
    fault.shows_nothing("the tracker is where its axes are")


async def test_a_homing_that_is_cut_off_sets_no_zero(tmp_path: Path) -> None:
    clock = VirtualClock(START)
    drive = born(clock, tmp_path)
    await drive.write(HOME)
    clock.advance(timedelta(milliseconds=300))
    await drive.write(HOME)
    found = await born(clock, tmp_path).read()
    assert (found.azimuth.homed, found.boot_count) == (False, 1)
    assert places(found) == pytest.approx(places(await rested(drive, clock)), abs=0.011)


async def test_a_power_loss_that_is_played_is_one(tmp_path: Path) -> None:
    clock = VirtualClock(START)
    drive = await homed(clock, tmp_path)
    drive.inject(Fault(FaultKind.POWER_LOSS))
    await drive.write(DriveCommand())
    found = await born(clock, tmp_path).read()
    assert (found.azimuth.homed, found.boot_count) == (False, 2)


async def test_nothing_is_written_while_nothing_changes(tmp_path: Path) -> None:
    clock = VirtualClock(START)
    drive = await homed(clock, tmp_path)
    clock.advance(timedelta(seconds=2))
    await drive.write(DriveCommand())
    before = (tmp_path / "drives" / "positions").read_bytes()
    for _ in range(100):
        clock.advance(timedelta(milliseconds=100))
        await drive.read()
        await drive.write(DriveCommand())
    assert (tmp_path / "drives" / "positions").read_bytes() == before


async def test_what_an_older_version_kept_is_found(tmp_path: Path) -> None:
    axis = AxisMemory(33.0, 1.0, homed=True)
    PositionFile(tmp_path / "drives" / "T1.json").keep(PositionMemory(axis, axis, 7, trusted=True))
    clock = VirtualClock(START)
    drive = born(clock, tmp_path)
    seen = await drive.read()
    assert (seen.boot_count, seen.azimuth.homed) == (7, True)
    assert places(seen) == pytest.approx((34.0, 34.0), abs=0.011)
    await Rig(drive, drive, clock).until_rest(MOVE)
    assert places(await born(clock, tmp_path).read()) == pytest.approx((120.0, 50.0), abs=0.011)


async def test_a_damaged_record_is_a_drive_that_is_new(tmp_path: Path) -> None:
    clock = VirtualClock(START)
    await (await homed(clock, tmp_path)).close()
    (tmp_path / "drives" / "positions").write_bytes(b"\xff" * 77)
    assert not (await born(clock, tmp_path).read()).azimuth.homed


async def test_a_disk_that_fails_stops_no_drive(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object, **__: object) -> None:
        raise OSError("no space left")

    monkeypatch.setattr(kept_positions.Twins, "write", refuse)
    drive = await homed(VirtualClock(START), tmp_path)
    assert (await drive.read()).azimuth.homed


async def test_what_is_kept_is_told_and_a_later_life_writes_into_the_same_record(tmp_path: Path) -> None:
    """A tracker's name may hold what a file's name must not; it is none of an older version's."""
    folder = tmp_path / "drives"
    axis = AxisMemory(33.0, 1.0, homed=True)
    first, second = PositionMemory(axis, axis, 7, trusted=True), PositionMemory(axis, axis, 8, trusted=False)
    (folder / "row").mkdir(parents=True)
    PositionFile(folder / "row%2F6.json").keep(first)
    positions = kept_positions.KeptPositions(folder)
    assert positions.of("row/6").recall() == first
    positions.of("T1").keep(first)
    positions.of("T2").keep(second)
    assert (positions.of("T1").recall(), positions.of("T2").recall()) == (first, second)
    size = (folder / "positions").stat().st_size
    for _ in range(3):
        later = kept_positions.KeptPositions(folder)
        assert (later.of("T1").recall(), later.of("T2").recall()) == (first, second)
        later.of("T2").keep(second)
        later.of("T1").keep(first)
    assert (folder / "positions").stat().st_size == size


async def test_drives_share_one_small_file(tmp_path: Path) -> None:
    clock = VirtualClock(START)
    factory = DriveFactory(clock, tmp_path)
    ids = [f"T{number}" for number in range(100)]
    for number, name in enumerate(ids):
        drive = cast(SimulatedDrive, factory.make(replace(CONFIG, tracker_id=name)))
        await drive.write(DriveCommand(azimuth=Velocity(1.0 + number / 100.0)))
    assert (tmp_path / "drives" / "positions").stat().st_size <= 4 * 4096
    found = [places(await born(clock, tmp_path, name).read())[0] for name in ids]
    assert found == sorted(found)
    assert found[0] < found[-1]
