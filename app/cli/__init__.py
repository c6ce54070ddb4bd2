"""The command line: each command is loaded when it is called, so that none waits for the others."""

import sys
from collections.abc import Callable
from importlib import import_module
from typing import Annotated, NoReturn

import typer
from typer._click.core import Command, Context  # typer carries a click of its own
from typer.core import TyperGroup
from typer.main import get_command, get_group

from app.base.build import VERSION
from app.base.errors import AT_RUN_TIME, WRONG, Foreseen
from app.base.startup import hurry
from app.cli.options import Config, DataDir, take

COMMANDS = {
    "serve": "app.cli.serve:serve",
    "controller": "app.cli.controller:controller",
    "web": "app.cli.web:web",
    "status": "app.cli.status:status",
    "diagnostics": "app.cli.status:diagnostics",
    "config": "app.cli.config:config",
    "users": "app.cli.users:users",
    "audit": "app.cli.audit:audit",
    "tls": "app.cli.tls:tls",
    "backup": "app.cli.store:backup",
    "restore": "app.cli.store:restore",
    "drive": "app.cli.profiles:drive",
    "drive-sim": "app.cli.drives:drive_sim",
    "fault-proxy": "app.cli.drives:fault_proxy",
    "sunspec-map": "app.cli.store:print_sunspec_map",
    "sun": "app.cli.day:sun",
    "simulate": "app.cli.day:simulate",
    "strategies": "app.cli.strategies:strategies",
    "accuracy": "app.cli.sun:accuracy",
    "papers": "app.cli.sun:reproduce",
    "study": "app.cli.study:study",
    "compare": "app.cli.study:compare",
    "version": "app.cli.serve:version",
}


class Commands(TyperGroup):
    """The commands by name; the module behind one is imported when it is asked for."""

    def list_commands(self, ctx: Context) -> list[str]:
        """Return the names in the order of the table."""
        return list(COMMANDS)

    def get_command(self, ctx: Context, cmd_name: str) -> Command | None:
        """Return the command of this name, None if there is none."""
        if cmd_name not in COMMANDS:
            return None
        module, _, attribute = COMMANDS[cmd_name].partition(":")
        found = getattr(import_module(module), attribute)
        return get_group(found) if isinstance(found, typer.Typer) else get_command(_alone(cmd_name, found))


def _alone(name: str, function: Callable[..., None]) -> typer.Typer:
    """Return an application of one command."""
    one = typer.Typer(add_completion=False)
    one.command(name)(function)
    return one


cli = typer.Typer(
    name="heliopanel",
    cls=Commands,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
)


def _tell_version(asked: bool) -> None:
    if asked:
        typer.echo(f"Heliopanel {VERSION}")
        raise typer.Exit


@cli.callback()
def heliopanel(
    *,
    version: Annotated[
        bool, typer.Option("--version", is_eager=True, callback=_tell_version, help="Print the version.")
    ] = False,
    config: Config = None,
    data_dir: DataDir = None,
) -> None:
    """Commission a solar tracker in the browser and keep it on the sun."""
    take(config, data_dir)


def main() -> None:
    """Run the command line; what fails is one sentence.

    The exit code is 2 for what was asked or set wrongly, and 1 for what may work another time.
    """
    hurry()
    try:
        cli()
    except Foreseen as error:
        _end(error, error.exit_code)
    except ValueError as error:
        _end(error, WRONG)
    except OSError as error:
        _end(error, AT_RUN_TIME)


def _end(error: Exception, code: int) -> NoReturn:
    typer.echo(str(error) or type(error).__name__, err=True)
    sys.exit(code)
