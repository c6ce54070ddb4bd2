"""Whether a drive can be told often enough that it goes on: that is reckoned before anything is connected."""

from app.drives.drive import line_turn
from app.site.line_pace import FULL, short_watchdog
from app.site.model import SiteModel
from app.tracker.commands import CommandRejected
from app.tracker.config import DriveKind, TrackerConfig
from app.tracker.reason import Reason


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
            f"Line {serial.port} supports at most {most} such drives at {serial.baud_rate} baud: "
            f"each takes {parts_s[0] * 1000.0:.0f} ms and stops automatically after "
            f"{min(watchdogs_s):g} s without a command.",
            "Raise the baud rate, increase the watchdog times, or move the drive to another line.",
        )
    )
