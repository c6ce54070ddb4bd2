"""`heliopanel web`: the panel alone."""

import socket
from typing import Annotated

import typer

from app.machine.process import raise_priority_of_panel
from app.machine.supervisor import end_with_parent
from app.settings import Settings, SettingsWrong, read_settings
from app.web.main import run

Supervised = Annotated[int | None, typer.Option(hidden=True, help="Process id of the supervisor.")]


def web(supervised: Supervised = None) -> None:
    """Run the panel alone, for a system service of its own."""
    if supervised is not None:
        end_with_parent(supervised)
    settings = read_settings()
    _check_port(settings)
    run(settings, on_answer=_answers)


def _answers(settings: Settings) -> None:
    """Be punctual from now on, and say where a browser finds the panel."""
    raise_priority_of_panel()
    host = f"[{settings.host}]" if ":" in settings.host else settings.host
    typer.echo(f"Heliopanel answers: open {settings.scheme}://{host}:{settings.port}")


def _check_port(settings: Settings) -> None:
    """Raise `SettingsWrong` if another program listens where the panel shall listen."""
    family = socket.AF_INET6 if ":" in settings.host else socket.AF_INET
    with socket.socket(family) as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((settings.host, settings.port))
        except OSError as error:
            raise SettingsWrong(
                f"The panel cannot listen on {settings.host} port {settings.port}: {error.strerror}. "
                "Stop the program that uses it, or choose another port with HELIOPANEL_PORT."
            ) from error
