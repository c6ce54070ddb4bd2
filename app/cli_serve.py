"""`heliopanel serve`: the controller service and the panel, supervised."""

import os
from typing import Annotated

import typer

from app.build import VERSION
from app.machine.supervisor import supervise
from app.settings import read_settings


def serve(
    *,
    insecure_lan: Annotated[
        bool,
        typer.Option("--insecure-lan", help="Listen on a network without a certificate; every page warns."),
    ] = False,
) -> None:
    """Run the controller service and the panel, and start either again when it dies."""
    if insecure_lan:
        os.environ["HELIOPANEL_INSECURE_LAN"] = "1"
    settings = read_settings()
    typer.echo(f"Heliopanel {VERSION}: starting ... (Ctrl-C ends it)")
    raise typer.Exit(supervise(settings))


def version() -> None:
    """Print the version."""
    typer.echo(VERSION)
