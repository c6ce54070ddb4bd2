"""Memory that grows: an alarm in time, and a planned restart that waits until every tracker stands still."""

import asyncio
from collections.abc import AsyncIterator
from dataclasses import dataclass
from datetime import timedelta

import pytest

from app.alarms.conditions import MEGABYTE
from app.machine.memory import EARLIEST, LOOK_EVERY, MemoryGuard
from app.site.publishing.health import resident_bytes
from app.tracker.commands.commands import Stop
from app.tracker.state.snapshot import ActivityName
from tests.fault_result import VIRTUAL, FaultResult
from tests.site.plant import Plant, make_plant

LIMIT_MB = 400


@dataclass
class Process:
    """What the process holds, and what it is told when it shall start again."""

    held_mb: float = 90.0
    told: str = ""

    def resident(self) -> int:
        return int(self.held_mb * MEGABYTE)

    def restart(self, why: str) -> None:
        self.told = why


@pytest.fixture
def process() -> Process:
    return Process()


@pytest.fixture
async def plant(process: Process) -> AsyncIterator[Plant]:
    built = make_plant()
    await built.start()
    guard = MemoryGuard(
        built.clock, built.site, LIMIT_MB * MEGABYTE, process.restart, resident=process.resident
    )
    guarding = asyncio.create_task(guard.run())
    yield built
    guarding.cancel()
    await asyncio.gather(guarding, return_exceptions=True)
    await built.close()


def alarms(plant: Plant) -> dict[str, str]:
    seen = plant.latest()
    return {alarm.code: alarm.message for alarm in seen.alarms if alarm.returned_at is None}


@pytest.mark.fault(46)
async def test_growing_memory_is_told_and_the_restart_waits_for_standstill(
    plant: Plant, process: Process, fault: FaultResult
) -> None:
    plant.clock.advance(EARLIEST)
    await plant.track(until=lambda seen: seen.activity is ActivityName.TRACKING)
    assert "memory_high" not in alarms(plant)

    process.held_mb = 310.0
    since = plant.clock.now()
    while "memory_high" not in alarms(plant):
        assert plant.clock.now() - since <= LOOK_EVERY + timedelta(seconds=5)
        await plant.forward(seconds=0.5)
    fault.noticed((plant.clock.now() - since).total_seconds(), VIRTUAL)
    fault.shows(alarms(plant)["memory_high"])
    fault.recovers("automatic: with its cause, or with a restart while all trackers are at standstill")
    assert "310 MB" in alarms(plant)["memory_high"]

    process.held_mb = 401.0
    await plant.forward(seconds=30)
    assert plant.tracker().activity is ActivityName.TRACKING
    assert process.told == "", "what tracks is not interrupted"
    await plant.ask(Stop())
    await plant.forward(seconds=15)
    assert "401 MB" in process.told
    assert "restarts now" in process.told


async def test_a_machine_that_needs_so_much_from_the_start_does_not_start_again_and_again(
    plant: Plant, process: Process
) -> None:
    process.held_mb = 500.0
    await plant.forward(seconds=60)
    assert "memory_high" in alarms(plant)
    assert process.told == ""


async def test_the_alarm_ends_with_a_deadband(plant: Plant, process: Process) -> None:
    process.held_mb = 310.0
    await plant.forward(seconds=20)
    process.held_mb = 290.0
    await plant.forward(seconds=60)
    assert "memory_high" in alarms(plant)
    process.held_mb = 270.0
    await plant.forward(seconds=60)
    assert "memory_high" not in alarms(plant)


def test_the_gauge_is_what_the_system_says() -> None:
    assert (resident_bytes() or 0) > 10 * MEGABYTE
