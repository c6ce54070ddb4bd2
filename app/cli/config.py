"""`heliopanel config check`: whether the settings are right, before anything starts with them."""

import os
from difflib import get_close_matches
from pathlib import Path
from typing import Any

import typer

from app.base.settings import FILE_VARIABLE, PREFIX, Settings, SettingsWrong
from app.cli.options import Config, DataDir, Host, Port, settle
from app.machine.lock import holder
from app.machine.starting import check_certificate, check_data_dir, check_port
from app.store.connections import reading_engine, revision_of, transaction
from app.store.connections import sqlite_path as file_of
from app.store.tables import REVISION
from app.web.features.operations.diagnostics import without_passwords

config = typer.Typer(name="config", help="The settings.", no_args_is_help=True)


@config.callback()
def settings_of() -> None:
    """Look at the settings."""


@config.command()
def check(config: Config = None, data_dir: DataDir = None, host: Host = None, port: Port = None) -> None:
    """Print every setting that is not as it comes, and check all of them; nothing is started."""
    settings = settle(config, data_dir, host, port)
    for name, value in changed(settings).items():
        typer.echo(f"{name} = {value}")
    refuse_unknown()
    _check_folder(settings.data_dir)
    if holder(settings.data_dir) is None:
        check_port(settings)
    check_certificate(settings)
    typer.echo(_database(settings))
    typer.echo("The settings are right.")


def changed(settings: Settings) -> dict[str, Any]:
    """Return the settings that differ from what they are by default, without passwords."""
    usual = Settings.model_construct()
    shown = without_passwords(settings)
    return {name: value for name, value in shown.items() if getattr(settings, name) != getattr(usual, name)}


def refuse_unknown() -> None:
    """Raise `SettingsWrong` for a variable of our name that is no setting: it was mistyped."""
    known = {PREFIX + name.upper() for name in Settings.model_fields} | {FILE_VARIABLE}
    for name in sorted(os.environ):
        if name.startswith(PREFIX) and name not in known:
            nearest = get_close_matches(name, known, 1)
            hint = f" Do you mean {nearest[0]}?" if nearest else ""
            raise SettingsWrong(f"{name} is no setting and has no effect.{hint}")


def _check_folder(folder: Path) -> None:
    """Check that a data folder can be written, and leave none behind that was not there."""
    was_there = folder.exists()
    check_data_dir(folder)
    if not was_there:
        folder.rmdir()


def _database(settings: Settings) -> str:
    """Return how the database is found, or raise `StoreFailed`."""
    path = file_of(settings.url)
    if path is not None and not path.exists():
        return "There is no database yet; the first start makes it."
    engine = reading_engine(settings.url)
    try:
        with transaction(engine) as connection:
            found = revision_of(connection)
    finally:
        engine.dispose()
    return f"The database is at revision {found}; this version of Heliopanel uses {REVISION}."
