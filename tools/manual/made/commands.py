"""Every command of the command line, from its parser."""

from collections.abc import Iterator

from typer._click.core import Command, Context  # typer carries a click of its own
from typer.core import TyperGroup
from typer.main import get_command

from app.cli import cli
from tools.manual.made.markdown import code, page, table, text

INTRODUCTION = """Exit code 0: done. Exit code 1: it failed, and may work another time. Exit code 2: what
was asked or set is wrong.

Every command has `--help`. `heliopanel --install-completion` has the shell complete names."""


def commands_page() -> str:
    """Return the page."""
    return page(
        "Commands", INTRODUCTION, *_parts(get_command(cli), Context(get_command(cli), info_name="heliopanel"))
    )


def _parts(command: Command, context: Context) -> Iterator[str]:
    yield _part(command, context)
    if isinstance(command, TyperGroup):
        for name in command.list_commands(context):
            inner = command.get_command(context, name)
            assert inner is not None
            yield from _parts(inner, Context(inner, info_name=name, parent=context))


def _part(command: Command, context: Context) -> str:
    usage = context.get_usage().removeprefix("Usage: ")
    records = [found for one in command.params if (found := one.get_help_record(context))]
    rows = [(code(words), text(told)) for words, told in records]
    said = text(" ".join((command.help or "").split()))
    parts = [f"## {context.command_path}", said, f"```\n{' '.join(usage.split())}\n```"]
    return "\n\n".join(filter(None, [*parts, table(("argument or option", "what"), rows) if rows else ""]))
