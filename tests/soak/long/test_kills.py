"""The machine killed again and again while its axes turn: nothing is lost, and the drive stops by itself."""

import os
import random
import re
from collections.abc import AsyncIterator
from contextlib import AsyncExitStack
from pathlib import Path
from time import monotonic

import pytest

from tests.e2e.product import DriveSim
from tests.fault_result import REAL, FaultResult
from tests.machine.lives import Machine
from tests.soak.rigs.eyes import Eyes
from tests.soak.rigs.killing_controller import Killing

KILLS = int(os.environ.get("HELIOPANEL_TEST_KILLS", "3"))
SEED = int(os.environ.get("HELIOPANEL_TEST_SEED", "1"))


@pytest.fixture
async def killing(tmp_path: Path) -> AsyncIterator[Killing]:
    machine = Machine.of(tmp_path / "data")
    async with AsyncExitStack() as started:
        drive = DriveSim.start()
        started.callback(drive.stop)
        eyes = Eyes(drive.port)
        started.push_async_callback(machine.stop)
        started.callback(eyes.close)
        killing = Killing(machine, eyes, random.Random(SEED))
        await killing.commission(drive.port)
        yield killing


@pytest.mark.timeout(60 + 15 * KILLS)
@pytest.mark.fault(43)
async def test_killed_in_motion_nothing_is_lost_and_nothing_moves_on(
    killing: Killing, fault: FaultResult
) -> None:
    begun, latest_s = monotonic(), 0.0
    for _ in range(KILLS):
        latest_s = max(latest_s, await killing.kill())
    counted = ", ".join(f"{motion} {times}" for motion, times in sorted(killing.counted.items()))
    print(f"{KILLS} kills in {monotonic() - begun:.0f} s ({counted}), at rest after at most {latest_s:.2f} s")
    fault.noticed(latest_s, REAL)
    fault.recovers("automatic: the controller starts again; tracking that was on resumes, nothing else moves")
    fault.shows(re.sub(r"\d{4}-\d\d-\d\d \d\d:\d\d:\d\d", "AT", killing.told))
