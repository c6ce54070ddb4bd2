"""Options that say what a setting says: they count for this command and for the processes that it starts."""

import os
from pathlib import Path
from typing import Annotated

import typer

from app.base.settings import FILE_VARIABLE, PREFIX, Settings, read_settings

Config = Annotated[Path | None, typer.Option("--config", help="Settings file (TOML) to read.")]
DataDir = Annotated[Path | None, typer.Option("--data-dir", help="Folder of the database and all else kept.")]
Host = Annotated[str | None, typer.Option("--host", help="Address the panel listens on.")]
Port = Annotated[int | None, typer.Option("--port", min=1, max=65535, help="TCP port of the panel.")]


def take(
    config: Path | None, data_dir: Path | None, host: str | None = None, port: int | None = None
) -> None:
    """Let options count before the environment."""
    given = {
        FILE_VARIABLE: config,
        f"{PREFIX}DATA_DIR": data_dir,
        f"{PREFIX}HOST": host,
        f"{PREFIX}PORT": port,
    }
    os.environ.update({name: str(value) for name, value in given.items() if value is not None})


def settle(
    config: Path | None, data_dir: Path | None, host: str | None = None, port: int | None = None
) -> Settings:
    """Return the settings, options first."""
    take(config, data_dir, host, port)
    return read_settings()
