"""A frozen drive, a cut cable, a killed drive: it stops by itself, the page says why, and nothing resumes.

The simulated drive is a process of its own; homing is doubted exactly when it lost power in motion or forgot.
"""

import asyncio
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from app.base.clock import SystemClock
from app.machine.drive_factory import DriveFactory
from tests.e2e.integrator import Integrator
from tests.e2e.product import DriveSim
from tests.e2e.proxy import network
from tests.fault_result import REAL, FaultResult
from tests.machine.service import config_for
from tests.patience import until as eventually
from tests.soak.rigs.eyes import Eyes
from tests.soak.rigs.killing_product import LATEST_FEED_S, RAMP_S, WATCHDOG_S

SETTLED_S = 1.3
STEP_DEG = 0.06


@pytest.fixture
def sim() -> Iterator[DriveSim]:
    started = DriveSim.start()
    yield started
    started.process.send_signal(signal.SIGCONT)
    started.stop()


def turn_away(calling: Integrator) -> None:
    """Begin a long move at the rated speed."""
    calling.until_allowed("move")
    calling.command("move", azimuth_deg=150.0, elevation_deg=20.0)
    calling.until(lambda seen: seen["measured"] and seen["measured"]["azimuth_deg"] > 4.0, "the panel moves")


def lost(calling: Integrator, words: str) -> dict[str, Any]:
    """Return the tracker once it says that there is no contact, and why."""
    seen = calling.until(
        lambda seen: "No connection" in seen["activity_text"] and words in told(seen),
        f"the page says: {words}",
        within_s=15.0,
    )
    assert seen["measured"] is None
    return seen


def told(seen: dict[str, Any]) -> str:
    return " ".join(notice["message"] for notice in seen["notices"])


def back(calling: Integrator, words: str) -> dict[str, Any]:
    """Return the tracker once the drive answers again and the page says what it did meanwhile."""
    return calling.until(
        lambda seen: seen["measured"] and words in told(seen), f"the page says: {words}", within_s=15.0
    )


def assert_still(calling: Integrator, seen: dict[str, Any]) -> None:
    """Fail if anything has begun to move by itself after a while."""
    time.sleep(0.6)
    later = calling.snapshot()
    assert later["activity"] == "holding"
    assert later["tracking_on"] is False
    for axis in ("azimuth_deg", "elevation_deg"):
        assert abs(later["measured"][axis] - seen["measured"][axis]) < STEP_DEG


def test_a_frozen_drive_stops_by_its_watchdog_and_keeps_its_zero(
    integrator: Integrator, sim: DriveSim
) -> None:
    integrator.commission(sim.port)
    turn_away(integrator)
    before = integrator.snapshot()["measured"]["azimuth_deg"]
    sim.process.send_signal(signal.SIGSTOP)
    lost(integrator, "did not answer in time")
    time.sleep(1.0)
    sim.process.send_signal(signal.SIGCONT)
    seen = back(integrator, "its watchdog")
    assert seen["homed"] is True
    assert seen["measured"]["azimuth_deg"] - before < 6.0 * (WATCHDOG_S + LATEST_FEED_S + RAMP_S + 0.2)
    assert_still(integrator, seen)
    page = integrator.http.get("/trackers/T1/drive-tests").text
    assert "answers again" in page
    integrator.command("move", azimuth_deg=20.0, elevation_deg=10.0)
    assert "watchdog" not in told(integrator.snapshot())
    integrator.post("/stop")
    integrator.until(lambda seen: seen["activity"] == "holding", "the panel is at rest")
    integrator.until(lambda seen: seen["activity"] == "holding", "the axes rest")


@pytest.mark.fault(1)
def test_a_cut_cable_leaves_a_drive_that_stops_itself(
    integrator: Integrator, sim: DriveSim, fault: FaultResult
) -> None:
    with network(sim.port) as cable:
        integrator.commission(int(cable.url.rpartition(":")[2]))
        turn_away(integrator)
        eyes = Eyes(sim.port)
        cut_at = cable.freeze()
        rested_s = eyes.rest_after(cut_at)
        assert rested_s <= WATCHDOG_S + LATEST_FEED_S + RAMP_S
        seen = lost(integrator, "did not answer in time")
        fault.noticed(time.monotonic() - cut_at, REAL)
        fault.shows(seen["activity_text"])
        cable.thaw()
        seen = back(integrator, "its watchdog")
        assert seen["homed"] is True
        assert "answers again" in integrator.http.get("/trackers/T1/drive-tests").text
        assert_still(integrator, seen)
        assert not eyes.moved_after(time.monotonic() - 0.5)
        eyes.close()
        events = {event["data"].get("code") for event in integrator.journal("drive_found")}
        assert events & {"watchdog_tripped", "stopped_meanwhile"}
    print(f"at rest {rested_s:.2f} s after the cable was cut")
    integrator.command("move", azimuth_deg=20.0, elevation_deg=10.0)
    assert "watchdog" not in told(integrator.snapshot())
    integrator.post("/stop")
    fault.recovers("automatic: the drive is found again; the operator commands the next motion")


def test_a_drive_is_simulated_with_faults_from_the_start() -> None:
    program = "from app.simulation.servers.sim_server import Doors, run_drive_sim\n"
    program += "run_drive_sim(Doors('127.0.0.1:0'), 'simulated-plc', inject=['drive_fault::12'])\n"
    with subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE) as process:
        assert process.stdout is not None
        line = process.stdout.readline().decode()
        port = int(line.split("127.0.0.1:")[1].split(",")[0])
        assert asyncio.run(fault_code(port)) == 12
        process.send_signal(signal.SIGTERM)
        assert process.wait(10.0) == 0


async def fault_code(port: int) -> int | None:
    drive = DriveFactory(SystemClock()).make(config_for(port))
    code = (await drive.read()).fault_code
    await drive.close()
    return code


def test_a_killed_drive_loses_its_zero_exactly_when_it_lost_its_place(
    integrator: Integrator, tmp_path: Path
) -> None:
    memory = tmp_path / "drive.json"
    drive = DriveSim.start(memory=memory)
    integrator.commission(drive.port)
    time.sleep(SETTLED_S)
    drive = killed(integrator, drive, memory)
    seen = back(integrator, "answers again. The drive reports no restart")
    assert seen["homed"] is True
    assert_still(integrator, seen)

    turn_away(integrator)
    drive = killed(integrator, drive, memory)
    seen = back(integrator, "The drive has restarted and has lost its home reference")
    assert seen["homed"] is False
    assert_still(integrator, seen)
    steps = {step["name"]: step for step in integrator.get("/commissioning")["items"]}
    assert "has restarted" in steps["homing"]["reasons"][0]["message"]

    integrator.zero()
    drive = killed(integrator, drive, None)
    assert back(integrator, "The drive has restarted and has lost its home reference")["homed"] is False
    drive.stop()


def killed(calling: Integrator, drive: DriveSim, memory: Path | None) -> DriveSim:
    """Kill the drive, see that the page says that nothing listens, and start it again."""
    os.kill(drive.process.pid, signal.SIGKILL)
    eventually(lambda: drive.process.poll() is not None, "the drive is gone")
    drive.stop()
    lost(calling, f"nothing listens on port {drive.port}")
    return DriveSim.start(drive.port, memory)
