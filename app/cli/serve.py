"""`heliopanel serve`: the controller service and the panel, supervised."""

import os
from typing import Annotated

import typer

from app.base.build import VERSION
from app.cli.options import Config, DataDir, Host, Port, settle
from app.machine.starting import check_data_dir, check_port
from app.machine.supervisor import supervise


def serve(
    *,
    config: Config = None,
    data_dir: DataDir = None,
    host: Host = None,
    port: Port = None,
    insecure_lan: Annotated[
        bool,
        typer.Option("--insecure-lan", help="Listen on a network without a certificate; every page warns."),
    ] = False,
) -> None:
    """Run the controller service and the panel, and start either again when it dies."""
    if insecure_lan:
        os.environ["HELIOPANEL_INSECURE_LAN"] = "1"
    settings = settle(config, data_dir, host, port)
    check_data_dir(settings.data_dir)
    check_port(settings)
    typer.echo(f"Heliopanel {VERSION}: starting ... (Ctrl-C ends it)")
    supervise(settings.log_format, settings.log_level)


def version() -> None:
    """Print the version."""
    typer.echo(VERSION)
