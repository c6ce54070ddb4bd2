"""The disk: what trackers that track cost an SD card, counted where the bytes arrive

A disk of its own (ext4 on a loop device, as an SD card has it) holds the data folder of the whole product,
started as its user starts it; a weather report comes every second. Where none can be mounted, what the
processes write is counted instead, without the file system's own journal, and the rows say so.
"""

import os
import subprocess
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

import httpx

from app.store.engine import open_writer
from app.store.migrations import upgrade
from app.sun.position import Location
from app.tracker.memory.memory import ClockSetting, SiteState, TrackerMemory, TrackerState
from app.tracker.settings.config import TrackerConfig
from bench.table import NotMeasured, Row, at_most
from tests.e2e.product import Product
from tests.patience import until as eventually

COMMAND = "python -m bench disk"
MOST_KIB = {1: 20.0, 100: 600.0}
DISK_BYTES = 2 << 30
SECTOR = 512
SECTORS_WRITTEN = 6
LONGEST_HOMING_S = 300.0


@dataclass(frozen=True, slots=True)
class Size:
    """How many trackers, for how many minutes, and how long before until the disk is as it stays."""

    trackers: tuple[int, ...] = (1, 100)
    minutes: float = 10.0
    settling_s: float = 310.0


SMALL = Size(trackers=(1,), minutes=0.1, settling_s=1.0)


def measure(size: Size = Size()) -> list[Row]:
    """Return how many KiB a minute reach the disk for each number of trackers."""
    return [_row(trackers, size) for trackers in size.trackers]


def _row(trackers: int, size: Size) -> Row:
    with tempfile.TemporaryDirectory() as folder, _disk(Path(folder)) as disk:
        a_minute, where = written_a_minute(disk, trackers, size)
    what = f"written in a minute, {trackers} tracking, a weather report a second"
    return at_most(f"{what}, {size.minutes:g} minutes, {where}", a_minute, MOST_KIB[trackers], "KiB", COMMAND)


@dataclass(frozen=True, slots=True)
class Disk:
    """A folder, and the block device that holds nothing else (empty: none of its own)."""

    folder: Path
    device: str

    def written(self, processes: list[int]) -> int:
        """Return how many bytes have reached the device, or have been written by these processes."""
        if self.device:
            counted = Path(f"/sys/block/{self.device}/stat").read_text(encoding="utf-8").split()
            return int(counted[SECTORS_WRITTEN]) * SECTOR
        return sum(written_by(process_id) for process_id in processes)


def written_by(process_id: int) -> int:
    """Return how many bytes a process has had written to a disk."""
    lines = Path(f"/proc/{process_id}/io").read_text(encoding="utf-8").splitlines()
    return int(next(line for line in lines if line.startswith("write_bytes")).split()[1])


def written_a_minute(disk: Disk, trackers: int, size: Size) -> tuple[float, str]:
    """Return the KiB written in a minute while so many trackers track, and where they were counted."""
    prepare(disk.folder / "data", trackers)
    product = Product.start(disk.folder / "data")
    try:
        children = [product.starts(child)[-1] for child in ("controller", "web")]
        with httpx.Client(base_url=product.url, timeout=30.0) as calling:
            track_all(calling, trackers)
            _report(calling, size.settling_s)
            before, begun_s = disk.written(children), time.monotonic()
            _report(calling, size.minutes * 60.0)
            written, took_s = disk.written(children) - before, time.monotonic() - begun_s
            still = sum(one["activity"] == "tracking" for one in _trackers(calling))
        if still != trackers:
            raise NotMeasured(f"only {still} of {trackers} trackers still track")
    finally:
        product.stop()
    where = "at the block device" if disk.device else "by the processes, as no disk could be mounted"
    return written / 1024.0 / took_s * 60.0, where


def prepare(data_dir: Path, trackers: int) -> None:
    """Make a database with so many simulated trackers where it is noon now."""
    data_dir.mkdir(mode=0o700)
    now = datetime.now(UTC)
    noon = Location(20.0, (12.0 - now.hour - now.minute / 60.0) * 15.0)
    url = f"sqlite:///{data_dir / 'heliopanel.db'}"
    upgrade(url)
    writer = open_writer(url)
    with writer.together():
        writer.save_site(SiteState(location=noon, time_zone="UTC", clock=ClockSetting("system", 0.0, now)))
        for number in range(1, trackers + 1):
            config = TrackerConfig(f"T{number}", f"Tracker {number}")
            writer.save_tracker(TrackerState(config, TrackerMemory()))
    writer.close()


def track_all(calling: httpx.Client, trackers: int) -> None:
    """Home every tracker and let it track."""
    names = [f"T{number}" for number in range(1, trackers + 1)]
    for name in names:
        _command(calling, name, type="home")
    eventually(
        lambda: all(one["homed"] and one["activity"] == "holding" for one in _trackers(calling)),
        "every tracker is homed",
        within_s=LONGEST_HOMING_S,
    )
    for name in names:
        _command(calling, name, type="set_mode", mode="dual")
        _command(calling, name, type="track")


def _trackers(calling: httpx.Client) -> list[dict[str, object]]:
    answer = calling.get("/api/v1/site")
    answer.raise_for_status()
    return list(answer.json()["trackers"])


def _command(calling: httpx.Client, name: str, **command: str) -> None:
    answer = calling.post(f"/api/v1/trackers/{name}/commands", json=command)
    if answer.is_error:
        raise NotMeasured(f"{name} refused {command['type']}: {answer.text}")


def _report(calling: httpx.Client, seconds: float) -> None:
    """Report the weather every second for so long."""
    begun_s = time.monotonic()
    number = 0
    while (number := number + 1) <= seconds:
        calling.put("/api/v1/site/weather", json={"wind_mps": 3.0 + number % 10 / 10}).raise_for_status()
        time.sleep(max(0.0, begun_s + number - time.monotonic()))


@contextmanager
def _disk(folder: Path) -> Iterator[Disk]:
    """Yield a disk of its own where one can be mounted, else the folder."""
    image, mounted = folder / "image", folder / "disk"
    mounted.mkdir()
    with image.open("wb") as file:
        file.truncate(DISK_BYTES)
    own = os.geteuid() == 0 and _run("mkfs.ext4", "-q", str(image))
    own = own and _run("mount", "-o", "loop", str(image), str(mounted))
    try:
        yield Disk(mounted, _device(mounted) if own else "")
    finally:
        if own:
            _run("umount", "--lazy", str(mounted))


def _run(*words: str) -> bool:
    with suppress(FileNotFoundError):
        return subprocess.run(words, capture_output=True, check=False).returncode == 0
    return False


def _device(mounted: Path) -> str:
    """Return the name of the device that is mounted there."""
    lines = Path("/proc/mounts").read_text(encoding="utf-8").splitlines()
    device = next(line.split()[0] for line in lines if line.split()[1] == str(mounted))
    return device.removeprefix("/dev/")
