"""What is done to a running service again and again, by tests a few times and by benchmarks often."""

import asyncio
import random
import signal
from collections.abc import Sequence
from contextlib import suppress
from datetime import UTC, datetime, timedelta

import httpx

from app.link.messages import RenameSite
from app.store.engine import open_reader
from app.store.store import JournalFilter
from app.tracker.commands.commands import GoToStart, RunShow
from app.tracker.memory.recording import RecordingInfo, RecordingKind
from app.tracker.programs.show import ShowPlan
from app.tracker.state.snapshot import ActivityName, Event, EventKind, ShowPhase
from tests.machine.service import SAMSUN, DriveSimulator, Service
from tests.patience import PATIENCE_S, eventually, pause

WATCHDOG_AND_RAMP_S = 0.5 + 1.2
PLAN = ShowPlan(
    "solstice",
    datetime(2026, 6, 21, 2, 10, tzinfo=UTC),
    datetime(2026, 6, 21, 17, 20, tzinfo=UTC),
    timedelta(minutes=3),
    SAMSUN,
)


async def kill_mid_show(service: Service, drive: DriveSimulator, number: int) -> float:
    """Kill the machine somewhere in a show; return after how long the axes stood, all else checked."""
    starts, shows = len(_starts(service)), len(_shows(service))
    boot_id = await _show_running(service)
    await asyncio.sleep(random.uniform(0.0, 0.5))
    name = f"Run {number}"
    await service.ask(RenameSite(name))
    service.signal("controller", signal.SIGKILL)
    stopped_after_s = await drive.rests(within_s=WATCHDOG_AND_RAMP_S + 2.0)
    await _until_restarted(service, boot_id)
    await eventually(lambda: len(_starts(service)) > starts)
    _check_nothing_lost(service, name)
    assert len(_starts(service)) == starts + 1, service.deaths()
    assert len(_shows(service)) == shows + 1
    seen = service.tracker()
    assert seen is not None
    assert seen.activity is not ActivityName.SHOWING
    return stopped_after_s


async def kill_panel(service: Service) -> None:
    """Kill the panel and wait until it serves again."""
    panels = len(service.starts("web"))
    service.signal("web", signal.SIGKILL)
    await eventually(lambda: len(service.starts("web")) > panels)
    await until_served(service.port)


async def until_served(port: int) -> None:
    """Return once the panel answers."""
    async with httpx.AsyncClient() as client, asyncio.timeout(PATIENCE_S):
        while True:
            with suppress(httpx.TransportError):
                if (await client.get(f"http://127.0.0.1:{port}/health")).status_code == 200:
                    return
            await pause()


async def _show_running(service: Service) -> str:
    await service.until(lambda seen: not seen.actions["go_to_start"])
    await service.ask_until_taken(GoToStart(PLAN))
    await service.until(lambda seen: seen.show is not None and seen.show.phase is ShowPhase.READY)
    seen = await service.ask(RunShow(PLAN))
    return seen.boot_id


async def _until_restarted(service: Service, boot_id: str) -> None:
    def is_new() -> bool:
        latest = service.link.latest()
        return latest is not None and latest.boot_id != boot_id

    await eventually(is_new)


def _starts(service: Service) -> list[Event]:
    """Return the starts that the journal tells of, newest first; one is told shortly after it happened."""
    reader = open_reader(f"sqlite:///{service.data_dir / 'heliopanel.db'}")
    found = reader.journal(JournalFilter(limit=1000, kinds=(EventKind.CONTROLLER_STARTED,)))
    reader.close()
    return [entry.event for entry in found]


def _shows(service: Service) -> Sequence[RecordingInfo]:
    """Return the recordings of shows, newest first."""
    reader = open_reader(f"sqlite:///{service.data_dir / 'heliopanel.db'}")
    found = reader.recordings(kind=RecordingKind.SHOW)
    reader.close()
    return found


def _check_nothing_lost(service: Service, name: str) -> None:
    reader = open_reader(f"sqlite:///{service.data_dir / 'heliopanel.db'}")
    site = reader.site()
    journal = [entry.event for entry in reader.journal(JournalFilter(limit=1000))]
    reader.close()
    assert site is not None
    assert site.name == name
    assert [event for event in journal if event.message == f"The site is now called {name}."]
    newest = _starts(service)[0]
    assert newest.data["clean"] is False
    assert "unexpectedly" in newest.message
    assert all(show.ended_at is not None for show in _shows(service))
