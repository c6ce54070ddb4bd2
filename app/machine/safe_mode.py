"""Safe mode: the database is damaged; nothing moves, drives can be stopped, and a backup is offered."""

import asyncio
from collections.abc import Sequence
from dataclasses import replace
from datetime import timedelta
from pathlib import Path
from uuid import uuid4

from app.alarms.conditions import SITE, Condition
from app.base.addresses.sqlite_url import sqlite_url
from app.base.clock import Clock, SystemClock
from app.base.logs import get_logger
from app.base.message import N_, say
from app.base.settings import Settings
from app.link.server import LinkServer
from app.machine.drive_factory import DriveFactory
from app.machine.process import on_signals, raise_priority
from app.machine.supervised import tell_ready
from app.machine.systemd import notify
from app.machine.watchdog import LoopWatchdog
from app.simulation.kept_positions import KeptPositions
from app.site.clock.ntp import kernel_clock
from app.site.clock.timekeeping import Timekeeper
from app.site.site import Site, SiteOptions
from app.store.backup.backups import backups
from app.store.backup.restore import PENDING_NAME
from app.store.engine import open_reader
from app.store.store import StoreDamaged, StoreFailed
from app.tracker.memory.memory import SiteState, TrackerMemory, TrackerState
from app.tracker.state.snapshot import EventKind
from app.tracker.values.actors import CONTROLLER
from app.tracker.values.reason import Reason

LOOK_EVERY = timedelta(seconds=1)
HINT = N_("An administrator can restore a backup on the Restore page, or with: heliopanel restore FILE.")

log = get_logger()


def safe_mode(damage: StoreDamaged) -> Reason:
    """Return why nothing may be moved or changed."""
    return Reason("safe_mode", say("Heliopanel runs in safe mode: {damage}", damage=damage), HINT)


def rescued(url: str, data_dir: Path) -> tuple[SiteState, tuple[TrackerState, ...]]:
    """Return site and trackers as far as they can be read, from the damaged database or the newest backup.

    Only what is needed to stop the drives is believed: no zero is trusted, nothing tracks.
    """
    sources = (url, *(sqlite_url(one.path) for one in backups(data_dir)))
    for source in sources:
        found = _read(source)
        if found is not None:
            log.info("rescued", source=source, trackers=len(found[1]))
            return found
    return SiteState(), ()


def _read(url: str) -> tuple[SiteState, tuple[TrackerState, ...]] | None:
    reader = open_reader(url)
    try:
        site, trackers = reader.site(), reader.trackers()
    except (StoreFailed, ValueError):
        return None
    finally:
        reader.close()
    if site is None or not trackers:
        return None
    return site, _untrusted(trackers)


def _untrusted(trackers: Sequence[TrackerState]) -> tuple[TrackerState, ...]:
    memory = TrackerMemory(home_lost=N_("the database is damaged."))
    return tuple(replace(one, memory=memory) for one in trackers)


async def serve_safely(
    settings: Settings, clock: SystemClock, damage: StoreDamaged, positions: KeptPositions
) -> None:
    """Serve what is left until told to end, or until a backup was handed over: the next start restores it."""
    raise_priority(settings)
    why = safe_mode(damage)
    log.critical("safe_mode", reason=str(damage))
    site = _site(settings, clock, why, positions)
    server = LinkServer(site, settings.link_path)
    stopped = on_signals()
    site.trouble("store", Condition("store_damaged", None, SITE, why.message, why.hint))
    event = site.model.event(EventKind.CONTROLLER_STARTED, why.message, CONTROLLER, clean=False)
    await site.start(event)
    await server.start()
    watching = asyncio.create_task(
        LoopWatchdog(clock, alive=lambda: site.alive, stop_drives=site.stop_drives).run()
    )
    waiting = asyncio.create_task(_restore_handed_over(clock, settings.data_dir, stopped))
    notify("READY=1")
    tell_ready()
    await stopped.wait()
    notify("STOPPING=1")
    await site.stop_drives()
    for task in (watching, waiting):
        task.cancel()
    await asyncio.gather(watching, waiting, return_exceptions=True)
    await site.close()
    await server.close()
    log.info("controller_stopped")


def _site(settings: Settings, clock: SystemClock, why: Reason, positions: KeptPositions) -> Site:
    """Return a site that keeps nothing and refuses every motion."""
    state, trackers = rescued(settings.url, settings.data_dir)
    options = SiteOptions(boot_id=uuid4().hex, period=timedelta(milliseconds=settings.tick_ms), safe_mode=why)
    factory = DriveFactory(clock, settings.data_dir, positions=positions)
    timekeeper = Timekeeper(clock, state.clock, drift=clock.drift, kernel=kernel_clock)
    return Site(clock, factory.make, state, trackers, timekeeper=timekeeper, options=options)


async def _restore_handed_over(clock: Clock, data_dir: Path, stopped: asyncio.Event) -> None:
    while not (data_dir / PENDING_NAME).exists():
        await clock.sleep_until(clock.now() + LOOK_EVERY)
    stopped.set()
