"""How soon the axes rest and how many ticks are missed when a process of the service dies or freezes."""

import asyncio
import os
import signal
from collections.abc import AsyncIterator
from contextlib import suppress
from pathlib import Path
from struct import pack

import httpx
import pytest
import pytest_asyncio

from app.drives.profile import load_profile
from app.link.messages import MachineUnreachable, RenameSite
from app.tracker.commands.commands import Jog, Move
from app.tracker.settings.axes import Axis, JogSpeed
from app.tracker.settings.config import Orientation
from app.tracker.state.snapshot import ActivityName
from tests.e2e.product import COMMAND
from tests.fault_result import REAL, FaultResult
from tests.machine.service import DriveSimulator, Service
from tests.machine.stories import WATCHDOG_AND_RAMP_S, kill_mid_show
from tests.machine.test_process import drive, service

KILLS = int(os.environ.get("HELIOPANEL_TEST_KILLS", "2"))
SETPOINT = load_profile("simulated-plc").registers["azimuth_setpoint"].address

__all__ = ["drive", "service"]

pytestmark = pytest.mark.asyncio(loop_scope="module")


@pytest_asyncio.fixture(scope="module", loop_scope="module")
async def running(tmp_path_factory: pytest.TempPathFactory, drive: DriveSimulator) -> AsyncIterator[Service]:
    """A service in front of the drive, for all stories of this module that do not end it."""
    started = await Service.start(tmp_path_factory.mktemp("service") / "data")
    try:
        await started.commission(drive)
        yield started
    finally:
        await started.stop()


async def test_the_panel_moves_and_the_machine_misses_no_tick(service: Service) -> None:
    async with httpx.AsyncClient(base_url=f"http://127.0.0.1:{service.port}") as browser:
        before, processes = await service.link.metrics(), started(service)
        change = {
            "host": "127.0.0.1",
            "port": service.port,
            "tls": False,
            "allowed_hosts": ["tracker.example"],
        }
        tried = await browser.put("/api/v1/network", json=change)
        assert tried.status_code == 202, tried.text
        kept = 0
        while kept != 200:
            await asyncio.sleep(0.1)
            with suppress(httpx.TransportError):
                ticket = {"ticket": tried.json()["ticket"]}
                kept = (await browser.post("/api/v1/network/confirmation", json=ticket)).status_code
        foreign = {"host": "tracker.example"}
        assert (await browser.get("/health", headers=foreign)).status_code == 200
    after = await service.link.metrics()
    assert after.boot_id == before.boot_id
    ticks = after.trackers["T1"].ticks - before.trackers["T1"].ticks
    assert ticks >= int((after.uptime_s - before.uptime_s) * 10) - 1
    assert started(service) == processes


def started(service: Service) -> tuple[int, int]:
    """Return how often panel and machine have been started."""
    return len(service.starts("web")), len(service.starts("controller"))


@pytest.mark.timeout(60 + 15 * KILLS)
@pytest.mark.fault(43)
async def test_killed_at_any_instant_of_a_show_nothing_is_lost_and_the_axes_stop(
    service: Service, drive: DriveSimulator
) -> None:
    for number in range(KILLS):
        assert await kill_mid_show(service, drive, number) <= WATCHDOG_AND_RAMP_S + 1.0


@pytest.mark.fault(45)
async def test_a_frozen_machine_moves_nothing_and_does_not_catch_up(
    service: Service, drive: DriveSimulator, fault: FaultResult
) -> None:
    processes = started(service)
    await service.until(lambda seen: not seen.actions["jog"])
    jogging = asyncio.create_task(_hold(service))
    await service.until(lambda seen: jogging.done() or seen.activity is ActivityName.JOGGING)
    if jogging.done():
        jogging.result()
    service.signal("controller", signal.SIGSTOP)

    fault.noticed(await drive.rests(within_s=WATCHDOG_AND_RAMP_S + 1.0), REAL)
    stood_at = (await drive.look()).azimuth.position_deg
    await asyncio.sleep(1.5)
    assert service.link.latest() is None
    jogging.cancel()
    service.signal("controller", signal.SIGCONT)
    await service.until(lambda seen: seen.activity is not ActivityName.JOGGING)
    await asyncio.sleep(1.0)

    assert (await drive.look()).azimuth.position_deg == pytest.approx(stood_at, abs=0.1)
    assert started(service) == processes
    fault.recovers("automatic: the jog is over; nothing is caught up")


async def _hold(service: Service) -> None:
    sequence = 0
    while True:
        with suppress(MachineUnreachable):
            await service.ask(Jog("held", Axis.AZIMUTH, 1, JogSpeed.FAST, sequence))
        sequence += 1
        await asyncio.sleep(0.05)


@pytest.mark.fault(8)
async def test_another_master_stops_the_move_and_is_named(
    service: Service, drive: DriveSimulator, fault: FaultResult
) -> None:
    await service.until(lambda seen: not seen.actions["move"])
    there_deg = 300.0 if (await drive.look()).azimuth.position_deg < 150.0 else 20.0
    await service.ask(Move(Orientation(there_deg, 20.0)))
    await service.until(lambda seen: seen.azimuth is not None and seen.azimuth.moving)
    loop = asyncio.get_running_loop()
    reader, writer = await asyncio.open_connection("127.0.0.1", drive.port)
    began, told = loop.time(), ""
    while not told or is_moving(service):
        writer.write(pack(">HHHBBHHBHH", 1, 0, 11, 1, 16, SETPOINT, 2, 4, 0, 5000))
        await reader.readexactly(12)
        assert loop.time() - began < 2.0
        if not told and (told := named(service)):
            fault.noticed(loop.time() - began, REAL)
    fault.shows(told)
    writer.close()
    await drive.rests(within_s=WATCHDOG_AND_RAMP_S + 1.0)
    await service.until(lambda seen: not seen.tracking_on and seen.activity is ActivityName.HOLDING)
    await service.until(lambda seen: not seen.actions["move"])
    fault.recovers("automatic: once the other master is silent; the operator commands the next motion")


def is_moving(service: Service) -> bool:
    """Return whether the tracker is still on its way."""
    seen = service.tracker()
    return seen is not None and seen.activity is ActivityName.MOVING


def named(service: Service) -> str:
    """Return the sentence that names another master, empty while there is none."""
    seen = service.tracker()
    told = () if seen is None else (*seen.notices, *seen.waiting)
    return next((one.message for one in told if "Another master commands" in one.message), "")


async def test_a_backup_is_restored_while_the_service_runs(service: Service, tmp_path: Path) -> None:
    kept = tmp_path / "kept.db"
    first = await service.ask(RenameSite("Samsun"))
    assert await _command(service, "backup", str(kept)) == 0
    await service.ask(RenameSite("Bafra"))

    assert await _command(service, "restore", str(kept)) == 0
    await service.until(lambda _: service.boot_id() not in {"", first.boot_id})

    assert (await service.link.detail()).site.name == "Samsun"


async def _command(service: Service, *words: str) -> int:
    environment = os.environ | {"HELIOPANEL_DATA_DIR": str(service.data_dir)}
    process = await asyncio.create_subprocess_exec(
        COMMAND, *words, env=environment, stdout=asyncio.subprocess.DEVNULL
    )
    return await process.wait()
