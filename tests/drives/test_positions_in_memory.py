"""Simulated drives keep positions in memory that outlives the controller, and on the disk with samples."""

import os
import shutil
from collections.abc import Callable
from datetime import timedelta
from pathlib import Path
from typing import cast

import pytest

from app.base import outliving
from app.base.clock import VirtualClock
from app.base.outliving import OutlivingTwins, memory_beside
from app.machine.drive_factory import DriveFactory
from app.simulation.faults import Fault, FaultKind
from app.simulation.kept_positions import KeptPositions
from app.simulation.position_memory import AxisMemory, PositionMemory
from app.simulation.simulated import SimulatedDrive
from app.tracker.values.motion import DriveCommand, DriveRequest, Position, RequestKind
from tests.drives.rigs import CONFIG, START, Rig

HOME = DriveCommand(request=DriveRequest(1, RequestKind.HOME))
SET_HOME = DriveCommand(request=DriveRequest(2, RequestKind.SET_HOME_AZIMUTH))
MOVE = DriveCommand(Position(120.0, 6.0), Position(50.0, 4.0))


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return tmp_path / "data" / "drives"


@pytest.fixture
def memory(tmp_path: Path) -> Path:
    (tmp_path / "memory").mkdir()
    return tmp_path / "memory"


def stands_at(angle_deg: float, *, offset_deg: float = 0.0, boots: int = 1) -> PositionMemory:
    axis = AxisMemory(angle_deg, offset_deg, homed=True)
    return PositionMemory(axis, axis, boots, trusted=True)


def found_in(folder: Path, memory: Path | None = None) -> PositionMemory | None:
    """Return what the next life of a controller recalls."""
    return KeptPositions(folder, memory).of("T1").recall()


def kept(folder: Path, memory: Path | None, *angles_deg: float) -> KeptPositions:
    """A life that has kept these positions of T1, one after the other."""
    positions = KeptPositions(folder, memory)
    for angle_deg in angles_deg:
        positions.of("T1").keep(stands_at(angle_deg))
    return positions


def left_in(memory: Path) -> list[Path]:
    return sorted(memory.iterdir())


def refusing(*_: object, **__: object) -> None:
    raise OSError("no space left")


async def test_axes_that_turn_write_to_memory_alone_and_what_a_zero_is_worth_goes_to_the_disk(
    folder: Path, memory: Path
) -> None:
    clock, positions = VirtualClock(START), KeptPositions(folder, memory)
    drive = cast(SimulatedDrive, DriveFactory(clock, positions=positions).make(CONFIG))
    rig, key = Rig(drive, drive, clock), CONFIG.tracker_id

    def on_disk() -> PositionMemory:
        found = KeptPositions(folder).of(key).recall()
        assert found is not None
        return found

    await rig.until_rest(HOME)
    homed = on_disk()
    assert homed.azimuth.homed
    await rig.until_rest(MOVE)
    clock.advance(timedelta(seconds=2))
    await drive.read()
    assert on_disk() == homed
    here = KeptPositions(folder, memory).of(key).recall()
    assert here is not None
    assert (here.azimuth.true_deg, here.azimuth.homed) != (homed.azimuth.true_deg, False)
    await drive.write(SET_HOME)
    clock.advance(timedelta(seconds=2))
    await drive.read()
    again = on_disk()
    assert again.azimuth.offset_deg == pytest.approx(-here.azimuth.true_deg)
    drive.inject(Fault(FaultKind.POWER_LOSS))
    await drive.write(DriveCommand())
    lost = on_disk()
    assert (lost.azimuth.homed, lost.boot_count) == (False, homed.boot_count + 1)


def test_a_kill_loses_nothing_and_a_power_cut_what_is_newer_than_the_samples(
    folder: Path, memory: Path
) -> None:
    positions = kept(folder, memory, 10.0, 20.0)
    positions.flush()
    for angle_deg in (30.0, 40.0):
        positions.of("T1").keep(stands_at(angle_deg))
    assert found_in(folder, memory) == stands_at(40.0)
    shutil.rmtree(memory)
    memory.mkdir()
    assert found_in(folder, memory) == stands_at(20.0)


def test_each_life_goes_on_where_the_last_one_was_killed(folder: Path, memory: Path) -> None:
    for life in range(5):
        positions = KeptPositions(folder, memory)
        assert positions.of("T1").recall() == (stands_at(life - 1.0) if life else None)
        positions.of("T1").keep(stands_at(float(life)))
        positions.of("T2").keep(stands_at(100.0 + life))
        assert len(left_in(memory)) == 1
    assert KeptPositions(folder, memory).of("T2").recall() == stands_at(104.0)
    assert (folder / "positions").stat().st_size <= 3 * 2 * 65


def test_a_life_that_keeps_nothing_leaves_what_it_found(folder: Path, memory: Path) -> None:
    kept(folder, memory, 1.0)
    kept(folder, memory, 2.0, 3.0)
    for _ in range(3):
        assert found_in(folder, memory) == stands_at(3.0)
    KeptPositions(folder, memory).close()
    assert (found_in(folder), left_in(memory)) == (stands_at(3.0), [])


def test_what_a_kill_left_goes_to_the_disk_with_the_next_samples(folder: Path, memory: Path) -> None:
    kept(folder, memory, 1.0, 2.0)
    called: list[Callable[[], None]] = []
    positions = KeptPositions(folder, memory)
    positions.when_stale(lambda: called.append(positions.flush))
    assert found_in(folder) == stands_at(1.0)
    called.pop()()
    assert found_in(folder) == stands_at(2.0)
    KeptPositions(folder, memory).when_stale(lambda: called.append(positions.flush))
    assert called == []


def test_an_orderly_end_leaves_all_on_the_disk_and_nothing_in_memory(folder: Path, memory: Path) -> None:
    positions = kept(folder, memory, 1.0, 2.0)
    positions.close()
    assert (found_in(folder), left_in(memory)) == (stands_at(2.0), [])
    positions.of("T1").keep(stands_at(3.0))
    assert found_in(folder, memory) == stands_at(3.0)


def test_a_controller_without_simulated_drives_writes_nothing(folder: Path, memory: Path) -> None:
    positions = KeptPositions(folder, memory)
    positions.flush()
    positions.close()
    assert (folder.exists(), left_in(memory)) == (False, [])


def test_a_folder_made_anew_a_copy_and_a_life_without_memory_find_nothing_of_another(
    folder: Path, memory: Path, tmp_path: Path
) -> None:
    kept(folder, memory, 1.0, 2.0)
    copy = tmp_path / "copy"
    shutil.copytree(folder, copy)
    assert found_in(copy, memory) == stands_at(1.0)
    kept(copy, memory, 7.0, 8.0)
    assert (found_in(folder, memory), found_in(copy, memory)) == (stands_at(2.0), stands_at(8.0))
    kept(folder, None, 5.0)
    assert found_in(folder, memory) == stands_at(5.0)
    shutil.rmtree(folder)
    folder.mkdir()
    assert found_in(folder, memory) is None


def test_what_somebody_else_could_have_put_into_memory_is_not_believed(
    folder: Path, memory: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    kept(folder, memory, 1.0, 2.0)
    (own,) = left_in(memory)
    assert (own.stat().st_mode & 0o777, (own / "records").stat().st_mode & 0o777) == (0o700, 0o600)
    another = os.geteuid() + 1
    with monkeypatch.context() as changed:
        changed.setattr(os, "geteuid", lambda: another)
        assert found_in(folder, memory) == stands_at(1.0), "it is of another user"
    own.chmod(0o755)
    assert found_in(folder, memory) == stands_at(1.0)
    own.chmod(0o700)
    aside = own.rename(memory / "aside")
    own.symlink_to(aside)
    assert found_in(folder, memory) == stands_at(1.0)
    OutlivingTwins(memory, own.name.removeprefix("heliopanel-"), 55).drop()
    assert (aside / "records").exists()


@pytest.mark.parametrize("when", ["at the start", "removed"])
def test_memory_that_fails_leaves_the_disk(
    folder: Path, memory: Path, monkeypatch: pytest.MonkeyPatch, when: str
) -> None:
    if when == "at the start":
        monkeypatch.setattr(OutlivingTwins, "make", refusing)
    positions = KeptPositions(folder, memory)
    positions.of("T2").keep(stands_at(9.0))
    for angle_deg in (1.0, 2.0):
        positions.of("T1").keep(stands_at(angle_deg))
    if when == "removed":
        shutil.rmtree(left_in(memory)[0])
    positions.of("T2").keep(stands_at(10.0))
    assert (found_in(folder), left_in(memory)) == (stands_at(2.0), [])
    assert KeptPositions(folder).of("T2").recall() == stands_at(10.0)


def test_a_disk_that_fails_is_tried_again_and_memory_stays(
    folder: Path, memory: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    positions, called = KeptPositions(folder, memory), list[int]()
    positions.of("T1").keep(stands_at(1.0))
    positions.when_stale(lambda: called.append(1))
    with monkeypatch.context() as failing:
        failing.setattr(positions._file, "write", refusing, raising=False)
        positions.of("T1").keep(stands_at(2.0))
        positions.flush()
        positions.close()
        assert (len(called), found_in(folder)) == (3, stands_at(1.0))
        assert found_in(folder, memory) == stands_at(2.0)
    positions.flush()
    assert found_in(folder) == stands_at(2.0)


def test_a_life_that_cannot_give_its_name_uses_no_memory(
    folder: Path, memory: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    kept(folder, memory, 1.0, 2.0).flush()
    positions = KeptPositions(folder, memory)
    with monkeypatch.context() as failing:
        failing.setattr(positions._file, "write", refusing, raising=False)
        positions.of("T1").keep(stands_at(3.0))
    assert left_in(memory) == []
    positions.of("T1").keep(stands_at(4.0))
    assert found_in(folder, memory) == stands_at(4.0)


def test_a_place_in_memory_is_another_one_than_the_disk(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("RUNTIME_DIRECTORY", "")
    monkeypatch.setattr(outliving, "SHARED_MEMORY", tmp_path / "nowhere")
    assert memory_beside(tmp_path) is None
    monkeypatch.setattr(outliving, "SHARED_MEMORY", tmp_path)
    assert memory_beside(tmp_path) is None
    assert memory_beside(Path("/proc/self")) == tmp_path
    monkeypatch.setenv("RUNTIME_DIRECTORY", f"{tmp_path}/one:{tmp_path}/two")
    assert memory_beside(Path("/proc/self")) == tmp_path
    (tmp_path / "one").mkdir()
    assert memory_beside(Path("/proc/self")) == tmp_path / "one"
    monkeypatch.setattr(os, "access", lambda *_: False)
    assert memory_beside(Path("/proc/self")) is None
