"""`heliopanel web`: the panel alone."""

from typing import Annotated

import typer

from app.machine.process import raise_priority_of_panel
from app.machine.starting import as_service, check_data_dir, check_port
from app.machine.supervisor import end_with_parent, tell_ready
from app.options import Config, DataDir, Host, Port, settle
from app.settings import Settings
from app.web.main import run

Supervised = Annotated[int | None, typer.Option(hidden=True, help="Process id of the supervisor.")]


def web(
    supervised: Supervised = None,
    config: Config = None,
    data_dir: DataDir = None,
    host: Host = None,
    port: Port = None,
) -> None:
    """Run the panel alone, for a system service of its own."""
    if supervised is not None:
        end_with_parent(supervised)
    settings = settle(config, data_dir, host, port)
    check_data_dir(settings.data_dir)
    check_port(settings)
    with as_service():
        run(settings, on_answer=_answers)


def _answers(settings: Settings) -> None:
    """Be punctual from now on, and say where a browser finds the panel."""
    raise_priority_of_panel()
    tell_ready()
    host = f"[{settings.host}]" if ":" in settings.host else settings.host
    typer.echo(f"Heliopanel answers: open {settings.scheme}://{host}:{settings.port}")
