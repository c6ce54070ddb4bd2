"""Samples on the disk of the real service: how many a kill costs, and who may read them."""

import asyncio
import os
import random
import signal
from collections.abc import AsyncIterator, Sequence
from datetime import UTC, datetime, timedelta
from functools import partial
from pathlib import Path

import pytest
import pytest_asyncio

from app.link.messages import SetClock, SetLocation
from app.site.startup import CUT_OFF
from app.store.migrations import upgrade
from app.tracker.memory.recording import RecordingInfo, RecordingKind
from tests.amount import amount
from tests.fault_result import REAL, FaultResult
from tests.machine.service import SAMSUN, Service
from tests.patience import eventually

STORE_S = 2
KILLS = amount(2, 30)
SAMPLE_AND_COMMIT_S = 2.0
"""A sample a second, half a second until it is seen that it is time, and a busy computer."""


@pytest_asyncio.fixture
async def service(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> AsyncIterator[Service]:
    """The service with samples stored every 2 s, on files of an older version that everybody could read."""
    monkeypatch.setenv("HELIOPANEL_SAMPLE_STORE_S", str(STORE_S))
    data_dir = tmp_path / "data"
    data_dir.mkdir()
    upgrade(f"sqlite:///{data_dir / 'heliopanel.db'}")
    (data_dir / "heliopanel.db").chmod(0o644)
    (data_dir / "heliopanel.db.before-0005").touch(0o644)
    before = os.umask(0o022)
    started = await Service.start(data_dir)
    yield started
    await started.stop()
    os.umask(before)


def days(service: Service) -> Sequence[RecordingInfo]:
    with service.reader() as reader:
        return reader.recordings(kind=RecordingKind.DAY)


def more_days(service: Service, than: int) -> bool:
    return len(days(service)) > than


async def killed(service: Service) -> datetime:
    """Kill the controller at some instant and return which, once it runs again."""
    await asyncio.sleep(random.uniform(STORE_S + 1.0, 3.0 * STORE_S))
    starts, at = len(service.starts("controller")), datetime.now(UTC)
    service.signal("controller", signal.SIGKILL)
    await eventually(lambda: len(service.starts("controller")) > starts)
    await eventually(lambda: service.link.latest() is not None)
    return at


@pytest.mark.fault(86)
@pytest.mark.timeout(60 + 15 * KILLS)
async def test_a_kill_costs_at_most_the_set_seconds_of_samples_and_all_files_are_private(
    service: Service, fault: FaultResult
) -> None:
    await service.ask(SetLocation(SAMSUN, "Europe/Istanbul"))
    await service.ask(SetClock("system"))
    for number in range(1, KILLS + 1):
        at = await killed(service)
        await eventually(partial(more_days, service, number))
        cut = next(day for day in days(service) if day.outcome == CUT_OFF)
        assert cut.ended_at is not None
        lost = at - cut.ended_at
        assert lost <= timedelta(seconds=STORE_S + SAMPLE_AND_COMMIT_S)
        assert cut.sample_count == pytest.approx((cut.ended_at - cut.began_at).total_seconds() + 1, abs=1)
    fault.noticed(STORE_S + SAMPLE_AND_COMMIT_S, REAL)
    names = {path.name: path.stat().st_mode & 0o777 for path in service.data_dir.glob("*.db*")}
    assert names.keys() >= {"heliopanel.db", "heliopanel.db-wal", "heliopanel.db-shm"}
    assert set(names.values()) == {0o600}
    fault.shows(str(cut.outcome))
    fault.recovers("automatic: a new recording of the day begins")
