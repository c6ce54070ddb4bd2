"""The commands about what is stored: backup, restore, and the SunSpec map of the stored site."""

import os
import signal
from pathlib import Path
from typing import Annotated

import typer

from app.base.clock import SystemClock
from app.base.settings import read_settings
from app.gateway.sunspec_map import map_table, sunspec_map
from app.machine.lock import holder
from app.store.backup.backup import backup as back_up
from app.store.backup.restore import Restored, RestorePending, request_restore
from app.store.engine import open_reader


def backup(file: Annotated[Path, typer.Argument(help="File to write.")]) -> None:
    """Write everything that is stored into one file; the controller may run."""
    info = back_up(read_settings().url, file)
    typer.echo(f"The backup is in {file} ({info.size_bytes} bytes).")
    if info.audit_head:
        typer.echo(
            f"The audit's last entry is {info.audit_head}. Keep this elsewhere: "
            "`heliopanel audit verify --head` finds it again, or shows that entries were removed."
        )


def restore(
    file: Annotated[Path, typer.Argument(help="File that `backup` wrote.", exists=True, dir_okay=False)],
) -> None:
    """Bring back what a backup holds; a running controller stops its drives and starts again on it."""
    settings = read_settings()
    match request_restore(file, settings.url, settings.data_dir, SystemClock().now()):
        case Restored(backup=found):
            typer.echo(f"The backup of {found.site_name} is restored.")
        case RestorePending(backup=found):
            running = holder(settings.data_dir)
            if running is not None:
                os.kill(running, signal.SIGTERM)
            typer.echo(
                f"The backup of {found.site_name} is handed over: the controller service stops its drives "
                "now and restores it when it starts again."
            )


def print_sunspec_map(
    *,
    weather: Annotated[
        bool, typer.Option("--weather", help="With model 307, which comes with weather.")
    ] = False,
) -> None:
    """Print the SunSpec map of the present site as a table."""
    reader = open_reader(read_settings().url)
    try:
        tracker_ids = [state.config.tracker_id for state in reader.trackers()]
    finally:
        reader.close()
    typer.echo(map_table(sunspec_map(tracker_ids, weather=weather)), nl=False)
