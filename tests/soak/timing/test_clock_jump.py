"""The computer's clock is set while the service tracks: it says so, waits, and its timers go on."""

import asyncio
from collections.abc import AsyncIterator
from functools import partial
from pathlib import Path

import pytest

from app.base.build import BUILT_AT
from app.link.messages import SetClock
from app.tracker.state.snapshot import ActivityName, EventKind
from tests.fault_result import FaultResult
from tests.machine.service import Service
from tests.patience import eventually

LIBRARIES = sorted(Path("/usr/lib").glob("*/faketime/libfaketime.so.1"))


@pytest.fixture
def shift(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A file that says by how much the clock of what is started now is off.

    It is read once a second, and not at every look at a clock: Python's threads look at one whenever they
    wait for the interpreter, and a controller that reads a file for each is too late for its own watchdog.
    """
    path = tmp_path / "shift"
    tell(path, "+0")
    monkeypatch.setenv("LD_PRELOAD", str(LIBRARIES[0]))
    monkeypatch.setenv("FAKETIME_TIMESTAMP_FILE", str(path))
    monkeypatch.setenv("FAKETIME_CACHE_DURATION", "1")
    monkeypatch.setenv("FAKETIME_DONT_FAKE_MONOTONIC", "1")
    return path


def tell(path: Path, shift: str) -> None:
    """Set the clock; a file that is half written would set it to the true time for an instant."""
    whole = path.with_suffix(".next")
    whole.write_text(f"{shift}\n")
    whole.replace(path)


@pytest.fixture
async def service(tmp_path: Path, shift: Path) -> AsyncIterator[Service]:
    started = await Service.start(tmp_path / "data")
    try:
        await started.commission()
        await started.track()
        yield started
    finally:
        await started.stop()


@pytest.mark.fault(26)
async def test_a_clock_that_is_set_under_the_service_moves_nothing(
    service: Service, shift: Path, fault: FaultResult
) -> None:
    before = await service.link.metrics()
    for number, told in enumerate(("-365d", "+1h"), 1):
        await asyncio.to_thread(tell, shift, told)
        await eventually(partial(has_jumped, service, number))
        await service.until(lambda seen: seen.activity_text.endswith("clock is trusted again"))
        await service.until(lambda seen: seen.azimuth is not None and not seen.azimuth.moving)
        seen = service.tracker()
        assert seen is not None
        assert seen.activity is ActivityName.TRACKING
        if told == "-365d":
            with pytest.raises(ValueError, match="The clock cannot be"):
                await service.ask(SetClock("system"))
    await eventually(lambda: shown_year(service) >= BUILT_AT.year)
    await service.ask(SetClock("system"))
    await eventually(lambda: trusted(service))
    after = await service.link.metrics()
    assert after.boot_id == before.boot_id
    assert after.trackers["T1"].ticks > before.trackers["T1"].ticks
    assert [round(seconds / 3600.0) for seconds in jumps(service)] == [-365 * 24, 365 * 24 + 1]
    assert len(service.starts("controller")) == 1
    fault.recovers("automatic: 60 s after the jump, or when the clock is confirmed")


def has_jumped(service: Service, times: int) -> bool:
    return len(jumps(service)) == times


def jumps(service: Service) -> list[float]:
    """Return the jumps that are journalled, seconds, the oldest first."""
    found = service.journal(EventKind.CLOCK_JUMPED)
    return [float(str(event.data["seconds"])) for event in reversed(found)]


def shown_year(service: Service) -> int:
    latest = service.link.latest()
    return 0 if latest is None else latest.at.year


def trusted(service: Service) -> bool:
    latest = service.link.latest()
    return latest is not None and latest.clock.trusted


@pytest.mark.fault(27)
@pytest.mark.parametrize(("wrong", "before_the_software"), [("-1h", False), ("-20780d", True)])
async def test_a_clock_that_shows_less_than_the_journal_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, wrong: str, before_the_software: bool, fault: FaultResult
) -> None:
    """A computer without a battery begins in 1970, one whose battery is low where it was switched off."""
    first = await Service.start(tmp_path / "data")
    try:
        await first.ask(SetClock("system"))
        await eventually(lambda: trusted(first))
    finally:
        await first.stop()
    monkeypatch.setenv("LD_PRELOAD", str(LIBRARIES[0]))
    monkeypatch.setenv("FAKETIME", wrong)
    monkeypatch.setenv("FAKETIME_DONT_FAKE_MONOTONIC", "1")
    again = await Service.start(tmp_path / "data")
    try:
        await eventually(lambda: again.link.latest() is not None)
        latest = again.link.latest()
        assert latest is not None
        assert [reason.code for reason in latest.clock.reasons] == ["clock_implausible"], latest
        fault.prevented("noticed at the start, before anything moves")
        fault.shows(latest.clock.reasons[0].message)
        assert (latest.at < BUILT_AT) is before_the_software
        if before_the_software:
            with pytest.raises(ValueError, match="The clock cannot be"):
                await again.ask(SetClock("system"))
    finally:
        await again.stop()
