"""The controller service: put together from settings to link server, and taken down again in order."""

import asyncio
import shutil
import sqlite3
import threading
from datetime import datetime, timedelta
from functools import partial
from pathlib import Path
from uuid import uuid4

from app.alarms.conditions import MEGABYTE, SITE, Condition
from app.audit.entry import Entry, told
from app.base.build import BUILT_AT, VERSION
from app.base.clock import SystemClock
from app.base.lasting import lasting
from app.base.logs import get_logger, set_up_logs
from app.base.message import N_, Message, say, told_by
from app.base.outliving import memory_beside
from app.base.settings import Settings, read_settings
from app.base.startup import settle
from app.base.zones import zones_missing
from app.drives.connections.met_station import met_reader
from app.drives.connections.probe import DriveProbe
from app.gateway.gateways import Gateways
from app.link.server import LinkServer
from app.machine.certificate_watch import CertificateWatch
from app.machine.drive_factory import DriveFactory
from app.machine.lock import only_instance
from app.machine.loop import run_loop
from app.machine.marker import mark_running, mark_stopped, version_before
from app.machine.memory import MemoryGuard
from app.machine.process import on_signals, raise_priority
from app.machine.safe_mode import serve_safely
from app.machine.starting import check_data_dir
from app.machine.supervised import tell_ready
from app.machine.systemd import notify
from app.machine.watchdog import LoopWatchdog
from app.simulation.kept_positions import KeptPositions
from app.site.clock.ntp import kernel_clock
from app.site.clock.timekeeping import Timekeeper
from app.site.retention import Limits
from app.site.site import Site, SiteOptions
from app.site.startup import Beginning, begin
from app.site.state.validation import NO_ZONES
from app.store.backup.restore import apply_pending_restore
from app.store.engine import open_writer
from app.store.files import keep_all_private
from app.store.integrity import sqlite_notice
from app.store.migrations import make_apart, upgrade
from app.store.store import StoreDamaged, StoreFailed, StoreUnreadable, Writer
from app.store.writer_thread import WriterThread
from app.tracker.state.snapshot import Event, EventKind
from app.tracker.values.actors import CONTROLLER

DOES_NOT_FIT = (StoreUnreadable, ValueError, TypeError, ArithmeticError, LookupError, AttributeError)
"""What a start with stored data that nobody foresaw ends in; everything else is tried again."""
CANNOT_START = N_("The controller cannot start with what is stored ({error}).")

log = get_logger()


def run(settings: Settings) -> None:
    """Run the controller service until it is told to stop.

    With a database that is damaged or that it cannot start with it runs in safe mode. Raises `SettingsWrong`
    if the data folder cannot be written, `AlreadyRunning` if another holds it, `StoreFailed` if the store
    cannot be opened otherwise.
    """
    set_up_logs("controller", log_format=settings.log_format, log_level=settings.log_level)
    check_data_dir(settings.data_dir)
    clock = SystemClock()
    with only_instance(settings.data_dir, clock.now()):
        keep_all_private(settings.data_dir)
        _restore_if_asked(settings, clock.now())
        positions = KeptPositions(settings.data_dir / "drives", memory_beside(settings.data_dir))
        writer = None
        try:
            make_apart(settings.url)
            upgrade(settings.url)
            writer = open_writer(settings.url)
            audit_version(settings.data_dir, writer, VERSION, clock.now())
            run_loop(_serve(settings, clock, writer, positions))
        except StoreDamaged as damage:
            run_loop(serve_safely(settings, clock, damage, positions))
        finally:
            positions.close()
            if writer is not None:
                writer.close()


def _note_zones(site: Site) -> None:
    """Raise an alarm where this computer cannot tell local time; tracking needs none."""
    if zones_missing():
        site.trouble("zones", Condition(NO_ZONES.code, None, SITE, NO_ZONES.message, NO_ZONES.hint))


def audit_version(data_dir: Path, writer: Writer, version: str, now: datetime) -> None:
    """Note in the database which version writes it from now on; the audit tells of another one."""
    noted = writer.software()
    before = noted or version_before(data_dir) or version
    if before != version:
        given = told({"before": before, "after": version})
        entry = Entry(now, 0, "", "unknown", "local user", "console", "", "change_version", "site", given)
        with writer.audited(entry):
            writer.save_software(version)
        log.warning("version_changed", before=before, after=version)
    elif noted is None:
        writer.save_software(version)


def _restore_if_asked(settings: Settings, now: datetime) -> None:
    """Bring back a backup that was handed over; one that cannot be used is put aside and logged."""
    try:
        restored = apply_pending_restore(settings.data_dir, settings.url, now)
    except StoreFailed as error:
        log.error("restore_refused", reason=str(error))
        return
    if restored is not None:
        log.info("restored", site=restored.backup.site_name)


async def _serve(settings: Settings, clock: SystemClock, writer: Writer, positions: KeptPositions) -> None:
    raise_priority(settings)
    background = WriterThread(writer, _on_store_failure)
    try:
        site, gateways = await _begun(settings, clock, background, writer, positions)
    except DOES_NOT_FIT as error:
        log.exception("not_started_with_what_is_stored")
        background.close()
        raise StoreDamaged(say(CANNOT_START, error=told_by(error))) from error
    server = LinkServer(gateways, settings.link_path)
    stopped = on_signals()
    await server.start()
    gateways.start()
    watching = asyncio.create_task(
        LoopWatchdog(clock, alive=lambda: site.alive, stop_drives=site.stop_drives).run()
    )
    guarding = asyncio.gather(
        _memory_guard(settings, clock, site, stopped).run(),
        lasting("certificates", CertificateWatch(clock, site, read_settings).run, clock),
    )
    log.info("machine_ready", version=VERSION, link=str(settings.link_path), sqlite=sqlite3.sqlite_version)
    notice = sqlite_notice()
    if notice is not None:
        log.warning("sqlite_is_old", notice=notice)
    notify("READY=1")
    tell_ready()
    await stopped.wait()
    notify("STOPPING=1")
    guarding.cancel()
    await asyncio.gather(guarding, return_exceptions=True)
    await _take_down(settings, site, gateways, server, watching, background)


async def _begun(
    settings: Settings,
    clock: SystemClock,
    background: WriterThread,
    writer: Writer,
    positions: KeptPositions,
) -> tuple[Site, Gateways]:
    """Return the site with what is stored, which ticks, and its gateways, which do not run yet."""
    beginning = begin(writer, clock.now(), unclean_since=mark_running(settings.data_dir, clock.now()))
    site = _site(settings, clock, background, writer, beginning, positions)
    gateways = Gateways(site, clock, settings, writer)
    _note_zones(site)
    settle(len(beginning.trackers))
    try:
        await site.start(*beginning.events)
    except Exception:
        await site.stop_drives()
        raise
    return site, gateways


async def _take_down(
    settings: Settings,
    site: Site,
    gateways: Gateways,
    server: LinkServer,
    watching: asyncio.Task[None],
    background: WriterThread,
) -> None:
    """Stop the drives first, then tell and keep what is left."""
    await site.stop_drives()
    await gateways.close()
    watching.cancel()
    await asyncio.gather(watching, return_exceptions=True)
    event = Event(
        site.model.now(), EventKind.CONTROLLER_STOPPED, None, N_("The controller service was stopped.")
    )
    await site.close(event)
    await server.close()
    if background.close():
        mark_stopped(settings.data_dir)
    log.info("controller_stopped")


def _memory_guard(settings: Settings, clock: SystemClock, site: Site, stopped: asyncio.Event) -> MemoryGuard:
    def restart(why: Message) -> None:
        site.note(site.model.event(EventKind.CONTROLLER_RESTARTS, why, CONTROLLER))
        stopped.set()

    return MemoryGuard(clock, site, settings.memory_limit_mb * MEGABYTE, restart)


def _site(
    settings: Settings,
    clock: SystemClock,
    background: WriterThread,
    writer: Writer,
    beginning: Beginning,
    positions: KeptPositions,
) -> Site:
    timekeeper = Timekeeper(
        clock,
        beginning.site.clock,
        drift=clock.drift,
        kernel=kernel_clock,
        not_before=max(BUILT_AT, writer.newest_entry_at() or BUILT_AT),
    )
    period = timedelta(milliseconds=settings.tick_ms)
    factory = DriveFactory(
        clock, settings.data_dir, positions=positions, sun=lambda: site.model.sun(), tick=period
    )
    site = Site(
        clock,
        factory.make,
        beginning.site,
        beginning.trackers,
        timekeeper=timekeeper,
        writer=background,
        options=SiteOptions(
            boot_id=uuid4().hex,
            period=period,
            retention=Limits(
                timedelta(days=settings.telemetry_retention_days),
                timedelta(days=settings.journal_retention_days),
                settings.recordings_max,
            ),
            samples_every=timedelta(seconds=settings.sample_store_s),
            weather_stale_after=timedelta(seconds=settings.weather_max_age_s),
            make_station=partial(met_reader, factory.buses),
            weather_file=settings.data_dir / "weather",
            disk_free=lambda: _disk_free(settings.data_dir),
            pause=threading.Event().wait,
        ),
        tools=DriveProbe(factory.buses, factory.profiles),
        alarms=beginning.alarms,
    )
    positions.when_stale(
        lambda: site.model.ledger.post_along("simulated positions", lambda _: positions.flush())
    )
    return site


def _disk_free(folder: Path) -> int | None:
    """Return how many bytes are free beside the database, None where that cannot be told."""
    try:
        return shutil.disk_usage(folder).free
    except OSError:
        return None


def _on_store_failure(error: Exception) -> None:
    log.error("not_stored", reason=str(error))
