"""The disk fails under a running service: tracking goes on, everybody is told, nothing is half written."""

import asyncio
import os
import shutil
import signal
import sqlite3
import subprocess
import time
from collections.abc import AsyncIterator, Iterator
from contextlib import asynccontextmanager, closing, contextmanager, suppress
from enum import StrEnum
from pathlib import Path

import pytest
import pytest_asyncio

from app.link.messages import RenameSite
from app.tracker.commands.commands import CommandRejected, Stop, Track
from app.tracker.state.snapshot import ActivityName
from tests.amount import amount
from tests.fault_result import REAL, FaultResult
from tests.machine.service import Service
from tests.patience import eventually


class DiskFault(StrEnum):
    """What the calls of the writing thread suffer, as strace has it."""

    FULL = "pwrite64:error=ENOSPC"
    READ_ONLY = "pwrite64:error=EROFS"
    NO_SYNC = "fdatasync:error=EIO"
    STALLED = "fdatasync:delay_enter=2000000"


SMALL_DISK = "size=96m,mode=0700"
BLOCK = bytes(1 << 20)


@contextmanager
def small_disk(folder: Path) -> Iterator[Path]:
    """Yield a folder that is a disk of 96 MB where one can be mounted, else the folder as it is."""
    mounted = os.geteuid() == 0 and _run("mount", "-t", "tmpfs", "-o", SMALL_DISK, "tmpfs", str(folder))
    try:
        yield folder
    finally:
        if mounted:
            _run("umount", "--lazy", str(folder))


@contextmanager
def filled(disk: Path) -> Iterator[None]:
    """Have a disk full to the last byte while the block runs."""
    filler = disk / "filler"
    try:
        with filler.open("wb", buffering=0) as file, suppress(OSError):
            while file.write(BLOCK):
                pass
        yield
    finally:
        filler.unlink()


def _run(*words: str) -> bool:
    return subprocess.run(words, capture_output=True, check=False).returncode == 0


@asynccontextmanager
async def failing(process_id: int, fault: DiskFault, log: Path) -> AsyncIterator[None]:
    """Have the calls of a process fail while the block runs."""
    assert shutil.which("strace"), "Install strace to make calls fail: apt-get install strace."
    call = fault.partition(":")[0]
    tracer = await asyncio.create_subprocess_exec(
        "strace", "-f", "-p", str(process_id), "-o", str(log), "-e", f"trace={call}", "-e", f"inject={fault}",
        stderr=asyncio.subprocess.PIPE,
    )  # fmt: skip
    assert tracer.stderr is not None
    async with asyncio.timeout(10):
        told = (await tracer.stderr.readline()).decode()
    if "attached" not in told:
        await tracer.wait()
        pytest.fail(f"This computer lets no process be traced: {told.strip()}")
    try:
        yield
    finally:
        tracer.send_signal(signal.SIGINT)
        await tracer.communicate()


LATEST_TICK_S = 1.0
WATCHED_S = 1.5
LOCKED_ON_S = amount(0.0, 7.0)
"""How much longer than 3 s, for which a write waits, the database stays locked."""

pytestmark = pytest.mark.asyncio(loop_scope="module")


@pytest.fixture(scope="module")
def disk(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """A small disk of its own where this computer lets one be mounted, else a folder."""
    with small_disk(tmp_path_factory.mktemp("disk")) as folder:
        yield folder


@pytest_asyncio.fixture(scope="module", loop_scope="module")
async def service(disk: Path) -> AsyncIterator[Service]:
    """A service whose simulated tracker tracks, for all stories of this module, one after the other."""
    started = await Service.start(disk / "data")
    try:
        await started.commission()
        await started.track()
        yield started
    finally:
        await started.stop()


async def begin_to_track(service: Service) -> None:
    """Call the place where the axes stand zero, as often as the drive has lost it, and track."""
    await service.rest()
    await service.home()
    await service.track()


async def watch_ticks(service: Service) -> None:
    """Fail unless the machine ticks on as if nothing had happened, and tracks."""
    before = await service.link.metrics()
    await eventually_after(service, before.uptime_s + WATCHED_S)
    after = await service.link.metrics()
    ticked = after.trackers["T1"].ticks - before.trackers["T1"].ticks
    assert ticked >= (after.uptime_s - before.uptime_s) * 10 - LATEST_TICK_S * 10
    seen = service.tracker()
    assert seen is not None
    assert seen.activity is ActivityName.TRACKING
    assert after.boot_id == before.boot_id


async def eventually_after(service: Service, uptime_s: float) -> None:
    await asyncio.sleep(max(0.0, uptime_s - (await service.link.metrics()).uptime_s))


def check_database(service: Service, name: str) -> None:
    """Fail if the database is damaged, or holds half of a change."""
    path = service.data_dir / "heliopanel.db"
    with closing(sqlite3.connect(f"file:{path}?mode=ro", uri=True)) as connection:
        assert connection.execute("PRAGMA integrity_check").fetchall() == [("ok",)]
    with service.reader() as reader:
        site = reader.site()
    assert site is not None
    assert site.name == name
    told = [event.message for event in service.journal() if "The site is now called" in event.message]
    assert told[0] == f"The site is now called {name}."


async def refused(service: Service, name: str) -> str:
    with pytest.raises(CommandRejected) as rejected:
        await service.ask(RenameSite(name))
    assert [reason.code for reason in rejected.value.reasons] == ["not_stored"]
    return str(rejected.value)


@pytest.mark.fault(50)
async def test_a_stalled_card_delays_what_is_stored_and_no_tick(
    service: Service, tmp_path: Path, fault: FaultResult
) -> None:
    async with failing(service.starts("controller")[-1], DiskFault.STALLED, tmp_path / "log"):
        await service.ask(RenameSite("Slowly"))
        await watch_ticks(service)
    check_database(service, "Slowly")
    fault.prevented("no tick waits for the disk")


@pytest.mark.fault(49)
async def test_a_full_disk_stops_no_tracking_and_what_waited_is_stored_once_there_is_room(
    service: Service, disk: Path, tmp_path: Path, fault: FaultResult
) -> None:
    await service.ask(RenameSite("Before"))
    async with full(service, disk, tmp_path / "log"):
        began = time.monotonic()
        assert "The disk is full" in await refused(service, "Not stored")
        fault.noticed(time.monotonic() - began, REAL)
        await watch_ticks(service)
        await eventually(lambda: "store_behind" in service.alarms())
        await service.ask(Stop())
        check_database(service, "Before")
    await eventually(lambda: "store_behind" not in service.alarms())
    await service.ask(RenameSite("After"))
    check_database(service, "After")
    await service.until(lambda seen: not seen.actions["track"])
    await service.ask(Track())


@asynccontextmanager
async def full(service: Service, disk: Path, log: Path) -> AsyncIterator[None]:
    """Have the disk full: to the last byte where it is one of its own, else by the calls of the machine."""
    if await asyncio.to_thread(disk.is_mount):
        await asyncio.to_thread(fold_log, service)
        with filled(disk):
            yield
    else:
        async with failing(service.starts("controller")[-1], DiskFault.FULL, log):
            yield


def fold_log(service: Service) -> None:
    """Bring the write-ahead log into the database and shorten it, so that the next write needs room."""
    with closing(sqlite3.connect(service.data_dir / "heliopanel.db")) as connection:
        connection.execute("PRAGMA wal_checkpoint(TRUNCATE)")


@pytest.mark.fault(48)
async def test_a_database_that_is_locked_holds_up_no_tick_and_what_waited_is_stored(
    service: Service, fault: FaultResult
) -> None:
    await service.ask(RenameSite("Free"))
    path = service.data_dir / "heliopanel.db"
    with closing(sqlite3.connect(path, isolation_level=None)) as other:
        other.execute("BEGIN IMMEDIATE")
        began = time.monotonic()
        asking = asyncio.create_task(refused(service, "Not stored"))
        await watch_ticks(service)
        assert "locked by another program" in await asking
        fault.noticed(time.monotonic() - began, REAL)
        await asyncio.sleep(LOCKED_ON_S)
        other.execute("ROLLBACK")
    check_database(service, "Free")
    await eventually(lambda: "store_behind" not in service.alarms())
    await service.ask(RenameSite("Free again"))
    check_database(service, "Free again")


@pytest.mark.fault(50)
@pytest.mark.parametrize("broken", [DiskFault.NO_SYNC, DiskFault.READ_ONLY])
async def test_a_disk_that_fails_is_not_trusted_until_it_was_opened_and_checked_again(
    service: Service, tmp_path: Path, broken: DiskFault, fault: FaultResult
) -> None:
    await service.ask(RenameSite(f"Before {broken}"))
    async with failing(service.starts("controller")[-1], broken, tmp_path / "log"):
        began = time.monotonic()
        told = await refused(service, "Not stored")
        fault.noticed(time.monotonic() - began, REAL)
        assert "Check the disk or card, then restart Heliopanel" in told
        fault.shows(told)
        await watch_ticks(service)
        await eventually(lambda: "store_behind" in service.alarms())
    await refused(service, "Still not stored")
    service.signal("controller", signal.SIGKILL)
    await begin_to_track(service)
    await service.ask(RenameSite("Again"))
    check_database(service, "Again")
    fault.recovers("the disk or card is checked, and the controller started again")
