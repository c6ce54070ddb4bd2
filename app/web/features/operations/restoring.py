"""Bringing back a backup from the panel: offered only while the database is damaged."""

from dataclasses import dataclass
from datetime import datetime

from app.base.message import N_, say
from app.link.messages import MachineUnreachable
from app.store.backup.backup import BackupInfo
from app.store.backup.backups import BackupFile, backups
from app.store.backup.restore import request_restore
from app.tracker.commands.commands import CommandRejected
from app.tracker.state.snapshot import SiteSnapshot
from app.tracker.values.reason import Reason
from app.web.http.errors import NotFound
from app.web.shell.deps import Panel

DAMAGED = "store_damaged"
IN_ORDER = Reason(
    "store_in_order",
    N_("The database is intact, so no backup is restored from here."),
    N_("To restore a backup anyway, run on the controller's computer: heliopanel restore FILE"),
)


@dataclass(frozen=True, slots=True)
class Choice:
    """Whether the database is damaged (with what that says), and the backups to choose from."""

    damage: str
    backups: tuple[BackupFile, ...]


def choice(built: Panel) -> Choice:
    """Return what can be chosen now."""
    snapshot = built.machine.latest()
    return Choice("" if snapshot is None else damage_of(snapshot), backups(built.settings.data_dir))


def damage_of(snapshot: SiteSnapshot) -> str:
    """Return what is wrong with the database, nothing if it is in order."""
    return next((alarm.message for alarm in snapshot.alarms if alarm.code == DAMAGED), "")


def restore(built: Panel, name: str, now: datetime) -> BackupInfo:
    """Hand over a backup by its file name; the machine, in safe mode, starts again on it.

    Raises `NotFound`, `CommandRejected` while the database is in order, `StoreFailed` for a bad backup.
    """
    snapshot = built.machine.latest()
    if snapshot is None:
        raise MachineUnreachable
    if not damage_of(snapshot):
        raise CommandRejected(IN_ORDER)
    chosen = next((one for one in backups(built.settings.data_dir) if one.path.name == name), None)
    if chosen is None:
        raise NotFound(say("There is no backup {name} in the folder backups of the data folder.", name=name))
    return request_restore(chosen.path, built.settings.url, built.settings.data_dir, now).backup
