"""Whether a drive can be told often enough that it goes on: that is reckoned before anything is connected."""

from app.base.message import N_, say, with_format
from app.drives.drive import line_turn
from app.site.loop.line_pace import FULL, short_watchdog
from app.site.state.model import SiteModel
from app.tracker.commands.commands import CommandRejected
from app.tracker.settings.config import DriveKind, TrackerConfig
from app.tracker.values.reason import Reason


def refuse_starved_drive(model: SiteModel, config: TrackerConfig) -> None:
    """Raise `CommandRejected` if the drive would stop by itself between two commands."""
    against = short_watchdog(model.make_drive(config).capabilities.watchdog_s, model.period.total_seconds())
    if against is not None:
        raise CommandRejected(against)
    _refuse_full_line(model, config)


def _refuse_full_line(model: SiteModel, config: TrackerConfig) -> None:
    """Raise `CommandRejected` if a line cannot reach all of its drives before a watchdog stops one."""
    serial = config.drive.serial
    if config.drive.kind is not DriveKind.MODBUS_RTU:
        return
    fresh = model.make_drive(config)
    drives = [fresh] + [
        loop.drive
        for name, loop in model.loops.items()
        if name != config.tracker_id and loop.config.drive.line == config.drive.line
    ]
    watchdogs_s = [one.capabilities.watchdog_s for one in drives if one.capabilities.watchdog_s is not None]
    parts_s = [turn.reckoned_s for turn in map(line_turn, drives) if turn is not None]
    if not watchdogs_s or sum(parts_s) <= FULL * min(watchdogs_s):
        return
    most = int(FULL * min(watchdogs_s) / parts_s[0])
    raise CommandRejected(
        Reason(
            "line_full",
            say(
                "Line {port} supports at most {most} such drives at {baud_rate} baud: each takes "
                "{parts_s} ms and stops automatically after {watchdogs_s} s without a command.",
                port=serial.port,
                most=most,
                baud_rate=serial.baud_rate,
                parts_s=with_format(parts_s[0] * 1000.0, ".0f"),
                watchdogs_s=with_format(min(watchdogs_s), "g"),
            ),
            N_("Raise the baud rate, increase the watchdog times, or move the drive to another line."),
        )
    )
