"""What is done to a running service again and again, by tests a few times and by benchmarks often."""

import asyncio
import random
import signal
from datetime import UTC, datetime, timedelta

from app.link.messages import RenameSite
from app.tracker.commands.commands import GoToStart, RunShow
from app.tracker.memory.recording import RecordingKind
from app.tracker.programs.show import ShowPlan
from app.tracker.state.snapshot import ActivityName, EventKind, ShowPhase
from tests.machine.service import SAMSUN, DriveSimulator, Service
from tests.patience import eventually

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
    starts, shows = len(service.journal(EventKind.CONTROLLER_STARTED)), _shows(service)
    await service.until(lambda seen: not seen.actions["go_to_start"])
    await service.ask_until_taken(GoToStart(PLAN))
    await service.until(lambda seen: seen.show is not None and seen.show.phase is ShowPhase.READY)
    boot_id = (await service.ask(RunShow(PLAN))).boot_id
    await asyncio.sleep(random.uniform(0.0, 0.5))
    name = f"Run {number}"
    await service.ask(RenameSite(name))
    service.signal("controller", signal.SIGKILL)
    stopped_after_s = await drive.rests(within_s=WATCHDOG_AND_RAMP_S + 2.0)
    await eventually(lambda: service.boot_id() not in {"", boot_id})
    await eventually(lambda: len(service.journal(EventKind.CONTROLLER_STARTED)) > starts)
    check_nothing_lost(service, name)
    assert len(service.journal(EventKind.CONTROLLER_STARTED)) == starts + 1, service.deaths()
    assert _shows(service) == shows + 1
    seen = service.tracker()
    assert seen is not None
    assert seen.activity is not ActivityName.SHOWING
    return stopped_after_s


async def kill_panel(service: Service) -> None:
    """Kill the panel and wait until it serves again."""
    panels = len(service.starts("web"))
    service.signal("web", signal.SIGKILL)
    await eventually(lambda: len(service.starts("web")) > panels)
    await service.until_served()


def _shows(service: Service) -> int:
    """Return how many shows were recorded."""
    with service.reader() as reader:
        return len(reader.recordings(kind=RecordingKind.SHOW))


def check_nothing_lost(service: Service, name: str) -> None:
    """Fail unless the name that was acknowledged last is kept, the kill is told, and shows are closed."""
    with service.reader() as reader:
        site, shows = reader.site(), reader.recordings(kind=RecordingKind.SHOW)
    assert site is not None
    assert site.name == name
    assert [event for event in service.journal() if event.message == f"The site is now called {name}."]
    newest = service.journal(EventKind.CONTROLLER_STARTED)[0]
    assert newest.data["clean"] is False
    assert "unexpectedly" in newest.message
    assert all(show.ended_at is not None for show in shows)
