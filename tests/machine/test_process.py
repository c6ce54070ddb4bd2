"""That the real processes are wired: a button, a kill, a freeze, a cut cable. How soon: tests/soak."""

import asyncio
import os
import signal
from collections.abc import AsyncIterator, Iterator
from contextlib import suppress
from pathlib import Path
from uuid import uuid4

import httpx
import pytest
import pytest_asyncio

from app.link.messages import ReleaseControl, RenameSite
from app.machine import main
from app.machine.marker import MARKER_NAME
from app.tracker.commands.commands import Stop
from app.tracker.state.snapshot import ActivityName, EventKind, Snapshot
from tests.command_line import Run, run
from tests.e2e.proxy import Network, network
from tests.e2e.socket_page import LetGo, Page
from tests.fault_result import FaultResult
from tests.machine.service import DriveSimulator, Service
from tests.machine.stories import check_nothing_lost, kill_panel
from tests.patience import PATIENCE_S, eventually, pause

__all__ = ["run"]

pytestmark = pytest.mark.asyncio(loop_scope="module")


@pytest_asyncio.fixture(scope="module", loop_scope="module")
async def drive() -> AsyncIterator[DriveSimulator]:
    simulator = await DriveSimulator.start()
    yield simulator
    await simulator.stop()


@pytest.fixture(scope="module")
def cable(drive: DriveSimulator) -> Iterator[Network]:
    with network(drive.port) as laid:
        yield laid


@pytest_asyncio.fixture(scope="module", loop_scope="module")
async def running(
    tmp_path_factory: pytest.TempPathFactory, drive: DriveSimulator, cable: Network
) -> AsyncIterator[Service]:
    """A service in front of the drive, behind a cable; at last its supervisor is killed: its children end
    properly, so that the mark that they run is gone and the journal tells the end."""
    started = await Service.start(tmp_path_factory.mktemp("service") / "data")
    try:
        await started.commission(drive, port=cable.port)
        await started.ask(ReleaseControl("T1"))
        assert (started.data_dir / MARKER_NAME).exists()
        yield started
        started.product.process.kill()
        await eventually(lambda: not still_there(processes(started)))
        assert not (started.data_dir / MARKER_NAME).exists()
        assert started.journal()[0].kind is EventKind.CONTROLLER_STOPPED
    finally:
        for left in still_there(processes(started)):
            os.kill(left, signal.SIGTERM)
        await started.stop()


@pytest_asyncio.fixture(loop_scope="module")
async def service(running: Service) -> AsyncIterator[Service]:
    """The service, which moves nothing when a story begins, and whose panel answers."""
    await running.until_served()
    yield running
    await running.rest()


class Button:
    """A button on a page without a browser, held by heartbeats until it is let go."""

    def __init__(self, page: Page, drive: DriveSimulator) -> None:
        self.page = page
        self._drive = drive
        self.press_id = ""
        self._sequence = 0

    async def turns(self) -> None:
        """Hold until the axis turns; press anew where a busy computer was too late for one press."""
        async with asyncio.timeout(PATIENCE_S):
            while not (await self._drive.look()).azimuth.moving:
                if not self.press_id or self.page.ends or self._is_refused():
                    self.press_id, self._sequence = uuid4().hex, 0
                    self.page.ends.clear()
                await self.beat()
                await pause()

    def _is_refused(self) -> bool:
        return any(answer.text != "ok" for answer in self.page.answers.get(self.press_id, ()))

    async def beat(self) -> None:
        """Say once more that it is held."""
        await self.page.beat(self.press_id, 1, self._sequence)
        self._sequence += 1


@pytest_asyncio.fixture(loop_scope="module")
async def button(service: Service, drive: DriveSimulator) -> AsyncIterator[Button]:
    await service.until(lambda seen: not seen.actions["jog"])
    page = Page(service.port, "T1")
    await page.open()
    yield Button(page, drive)
    await page.close()


async def move_far(service: Service, drive: DriveSimulator) -> None:
    """Begin a long move as the user of the panel does, and return once the axis turns."""
    await service.until(lambda seen: not seen.actions["move"])
    there = 300.0 if (await drive.look()).azimuth.position_deg < 150.0 else 20.0
    order = {"type": "move", "azimuth_deg": there, "elevation_deg": 20.0}
    async with (
        httpx.AsyncClient(base_url=f"http://127.0.0.1:{service.port}", timeout=PATIENCE_S) as panel,
        asyncio.timeout(PATIENCE_S),
    ):
        answer = await panel.post("/api/v1/trackers/T1/commands", json=order)
        assert answer.is_success, answer.text
        while not (await drive.look()).azimuth.moving:
            await pause()


async def test_a_held_button_turns_the_axis_and_its_release_stops_it(
    button: Button, drive: DriveSimulator
) -> None:
    async with asyncio.timeout(PATIENCE_S):
        while not any("the button was released" in end.text for end in button.page.ends):
            await button.turns()
            await button.page.let_go(LetGo.RELEASED, button.press_id)
            await eventually(lambda: button.page.ends)
            await drive.rests()


@pytest.mark.fault(43)
async def test_a_killed_controller_stops_by_the_drive_and_nothing_is_lost_or_moves_on(
    service: Service, drive: DriveSimulator, fault: FaultResult
) -> None:
    name = f"Run {uuid4().hex}"
    await service.ask(RenameSite(name))
    await move_far(service, drive)
    before = service.boot_id()
    service.signal("controller", signal.SIGKILL)
    await drive.rests()
    await service.until(lambda _: service.boot_id() not in {"", before})
    await service.until_holding()
    await eventually(lambda: not service.journal(EventKind.CONTROLLER_STARTED)[0].data["clean"])
    check_nothing_lost(service, name)
    assert (await service.link.detail()).site.name == name
    await drive.rests()
    assert service.deaths()[-1] == f"controller {-signal.SIGKILL}"
    fault.recovers("automatic: the controller starts again; tracking that was on resumes, nothing else moves")


@pytest.mark.fault(44)
async def test_a_killed_panel_ends_the_press_and_comes_back_and_the_controller_lives(
    service: Service, drive: DriveSimulator, button: Button, fault: FaultResult
) -> None:
    before = service.boot_id()
    await button.turns()
    await kill_panel(service)
    await drive.rests()
    await service.until_holding()
    assert service.boot_id() == before
    fault.recovers("automatic: the web process is started again; tracking went on")


@pytest.mark.fault(45)
async def test_a_frozen_controller_catches_up_with_nothing(
    service: Service, drive: DriveSimulator, fault: FaultResult
) -> None:
    await move_far(service, drive)
    service.signal("controller", signal.SIGSTOP)
    await drive.rests()
    stood_deg = (await drive.look()).azimuth.position_deg
    await eventually(lambda: service.link.latest() is None)
    service.signal("controller", signal.SIGCONT)
    await eventually(lambda: service.link.latest() is not None)
    await service.until_holding()
    await service.ask_until_taken(Stop())
    assert (await drive.look()).azimuth.position_deg == pytest.approx(stood_deg, abs=0.1)
    fault.recovers("automatic: the motion is over; nothing is caught up")


@pytest.mark.fault(1)
async def test_a_cut_cable_leaves_a_drive_that_stops_itself_and_nothing_resumes(
    service: Service, drive: DriveSimulator, cable: Network, fault: FaultResult
) -> None:
    await move_far(service, drive)
    cable.freeze()
    await drive.rests()
    await service.until(lambda seen: "No connection" in seen.activity_text)
    seen = service.tracker()
    assert seen is not None
    fault.shows(seen.activity_text)
    cable.thaw()
    await service.until(lambda seen: seen.measured is not None and _is_at_rest(seen))
    await eventually(lambda: service.journal(EventKind.DRIVE_FOUND))
    await service.until(lambda seen: seen.homed)
    assert not (await drive.look()).azimuth.moving
    fault.recovers("automatic: the drive is found again; the operator commands the next motion")


def _is_at_rest(seen: Snapshot) -> bool:
    return seen.activity is ActivityName.HOLDING


@pytest.mark.fault(47)
async def test_a_second_machine_refuses_to_start_and_says_who_runs(
    service: Service, run: Run, monkeypatch: pytest.MonkeyPatch, fault: FaultResult
) -> None:
    monkeypatch.setattr(main, "set_up_logs", lambda *_, **__: None)
    code, _, told = run("controller", "--data-dir", str(service.data_dir))

    assert code == 2
    sentence = told.strip()
    assert sentence.startswith(f"The data folder {service.data_dir} is in use by process")
    assert str(service.starts("controller")[-1]) in sentence
    assert "\n" not in sentence
    fault.prevented("it does not start")
    fault.shows(sentence.replace(str(service.data_dir), "DIR"))
    fault.recovers("nothing was lost: the first one runs on")


def processes(service: Service) -> list[int]:
    return [service.starts(child)[-1] for child in ("controller", "web")]


def still_there(processes: list[int]) -> list[int]:
    """Return which processes still run; one that has ended and that nobody waited for does not."""
    found = []
    for process in processes:
        with suppress(FileNotFoundError, ProcessLookupError):
            if Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] != "Z":
                found.append(process)
    return found
