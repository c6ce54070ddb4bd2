"""The controller killed in a storm: every tracker whose home position holds stows by itself afterwards."""

import os
import random
from collections.abc import Iterator
from datetime import UTC, datetime
from pathlib import Path

import pytest

from app.tracker.settings.config import DriveKind
from tests.e2e.product import DriveSim
from tests.fault_result import BY_ITSELF, REAL, FaultResult
from tests.machine.field import noon_place, prepare
from tests.soak.rigs.fieldwork import gateway
from tests.soak.rigs.storm import Storm

KILLS = int(os.environ.get("HELIOPANEL_TEST_KILLS", "3"))
TRACKERS = int(os.environ.get("HELIOPANEL_TEST_TRACKERS", "12"))
SEED = int(os.environ.get("HELIOPANEL_TEST_SEED", "1"))
ON_A_DRIVE = 2


@pytest.fixture
def storm(tmp_path: Path) -> Iterator[Storm]:
    line = gateway(ON_A_DRIVE, tmp_path, DriveKind.MODBUS_TCP)
    prepare(tmp_path / "unused", 0, noon_place(datetime.now(UTC)), line)
    drive = DriveSim.start(line.drive.port, line.memory, ON_A_DRIVE)
    yield Storm(tmp_path, TRACKERS, line, random.Random(SEED))
    drive.stop()


@pytest.mark.timeout(60 + 30 * KILLS)
@pytest.mark.fault(80)
async def test_killed_in_a_storm_every_homed_tracker_stows_by_itself(
    storm: Storm, fault: FaultResult
) -> None:
    for number in range(KILLS):
        await storm.kill(number)
    fault.noticed(storm.slowest_s, REAL)
    fault.shows(storm.text)
    fault.recovers(f"{BY_ITSELF} once the wind has been calm for the set time")
    counted = ", ".join(f"{when} {times}" for when, times in sorted(storm.counted.items()))
    print(
        f"seed {SEED}: {KILLS} kills of {TRACKERS} trackers ({counted} the report), all stowing at most "
        f"{storm.slowest_s:.2f} s after the restart"
    )
