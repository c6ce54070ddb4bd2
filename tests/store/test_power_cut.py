"""The power fails at any instant: what was acknowledged is on the disk, and the database opens."""

import shutil
import sys
from pathlib import Path
from random import Random

import pytest

from app.store.engine import open_writer
from app.store.migrations import upgrade
from tests.amount import amount
from tests.fault_result import FaultResult
from tests.store.committing import ACKNOWLEDGED, RECORDINGS, check
from tests.store.power_cut import Disk, Recording, record
from tests.store.tracked_day import day_info

CUTS = amount(8, 300)
COMMITS = amount(30, 60)
AS_SHIPPED, OFTEN = 1000, 6
"""Pages after which the log is folded into the file: SQLite's own rule, and often enough to be cut in it."""


def recorded(folder: Path, *, checkpoint_pages: int, synchronous: str = "as_shipped") -> Recording:
    assert shutil.which("strace"), "Install strace to record file calls: apt-get install strace."
    data = folder / "data"
    data.mkdir()
    url = f"sqlite:///{data / 'heliopanel.db'}"
    upgrade(url)
    writer = open_writer(url)
    for recording_id in RECORDINGS:
        writer.begin_recording(day_info(recording_id))
    writer.close()
    words = [url, str(COMMITS), str(checkpoint_pages), synchronous]
    return record([sys.executable, "-m", "tests.store.committing", *words], data, folder / "strace.log")


def lost_after_cuts(recording: Recording, folder: Path, cuts: int) -> list[int]:
    """Return for each cut how many acknowledged commits were lost."""
    chance = Random(20261121)
    instants = sorted(chance.randrange(len(recording.calls) + 1) for _ in range(cuts))
    disk, done, acknowledged, lost = Disk(recording.before), 0, 0, []
    for number, instant in enumerate(instants):
        for call in recording.calls[done:instant]:
            acknowledged += call.file == ACKNOWLEDGED and call.name == "write"
            disk.do(call)
        done = instant
        lost.append(_lost(disk.cut(chance), folder / f"cut-{number}", acknowledged))
    return lost


def _lost(files: dict[str, bytes], folder: Path, acknowledged: int) -> int:
    folder.mkdir()
    for name, data in files.items():
        (folder / name).write_bytes(data)
    missing = check(f"sqlite:///{folder / 'heliopanel.db'}", acknowledged)
    shutil.rmtree(folder)
    return missing


@pytest.mark.fault(54)
@pytest.mark.parametrize("checkpoint_pages", [AS_SHIPPED, OFTEN])
def test_no_power_cut_loses_what_was_acknowledged(
    tmp_path: Path, checkpoint_pages: int, fault: FaultResult
) -> None:
    recording = recorded(tmp_path, checkpoint_pages=checkpoint_pages)
    assert sum(call.file == ACKNOWLEDGED and call.name == "write" for call in recording.calls) == COMMITS
    assert lost_after_cuts(recording, tmp_path, CUTS) == [0] * CUTS
    fault.prevented("what is acknowledged is on the disk")
    fault.shows_nothing("the start tells how the last run ended, as after a kill: row 43")
    fault.recovers("automatic: every database opens whole")


def test_the_same_cuts_find_the_loss_of_a_database_that_does_not_sync_every_commit(tmp_path: Path) -> None:
    recording = recorded(tmp_path, checkpoint_pages=AS_SHIPPED, synchronous="NORMAL")
    lost = lost_after_cuts(recording, tmp_path, CUTS)
    assert sum(count > 0 for count in lost) > CUTS // 3
    print(f"{sum(count > 0 for count in lost)} of {CUTS} cuts lost up to {max(lost)} commits")
