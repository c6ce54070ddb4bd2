"""`heliopanel users`: add, list, change, remove and reset users, at the computer itself."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Annotated

import typer

from app.access.accounts import Accounts
from app.access.opening import open_store
from app.access.passwords import Argon, Passwords
from app.access.principal import Principal, this_computer
from app.access.roles import Role
from app.access.store import AccessStore
from app.access.users import AccessRefused
from app.base.clock import SystemClock
from app.base.settings import read_settings

users = typer.Typer(name="users", help="Users of the panel, on this computer.", no_args_is_help=True)

Name = Annotated[str, typer.Argument(help="Name of the user.")]
Roles = Annotated[list[Role], typer.Option("--role", help="May be given more than once.")]
FromStdin = Annotated[bool, typer.Option("--password-stdin", help="Read the password from standard input.")]


@users.command()
def add(name: Name, role: Roles, *, password_stdin: FromStdin = False) -> None:
    """Add a user; the first one must be an administrator."""
    password = _password(from_stdin=password_stdin)
    with _accounts() as (accounts, by):
        user = accounts.add(by, name, role, password, SystemClock().now())
    typer.echo(f"{user.name} is added: {_words(user.roles)}. A running panel knows it within a second.")


@users.command("list")
def show() -> None:
    """List all users with their roles."""
    with _store() as store:
        found = store.load().users
    if not found:
        typer.echo("There are no users: a local user at the controller's computer has full access.")
    for name in sorted(found):
        typer.echo(f"{name:32}  {_words(found[name].roles)}")


@users.command()
def role(name: Name, role: Roles) -> None:
    """Give a user other roles instead of the present ones."""
    with _accounts() as (accounts, by):
        accounts.set_roles(by, name, role, SystemClock().now())
    typer.echo(f"{name} is now: {_words(frozenset(role))}.")


@users.command()
def reset(name: Name, *, password_stdin: FromStdin = False) -> None:
    """Give a user another password and end all sessions of theirs."""
    password = _password(from_stdin=password_stdin)
    with _accounts() as (accounts, by):
        accounts.set_password(by, name, password, SystemClock().now())
    typer.echo(f"The password of {name} is changed and all sessions have ended.")


@users.command()
def remove(name: Name) -> None:
    """Remove a user with all sessions and tokens; without the last one this computer is open again."""
    with _accounts() as (accounts, by):
        accounts.remove(by, name, SystemClock().now(), last=True)
    typer.echo(f"{name} is removed, with all sessions and tokens.")


@contextmanager
def _store() -> Iterator[AccessStore]:
    store = open_store(read_settings())
    try:
        yield store
    finally:
        store.close()


@contextmanager
def _accounts() -> Iterator[tuple[Accounts, Principal]]:
    with _store() as store:
        try:
            yield Accounts(store, Passwords(Argon())), this_computer("console")
        except AccessRefused as error:
            raise ValueError(str(error)) from error


def _password(*, from_stdin: bool) -> str:
    if from_stdin:
        return sys.stdin.readline().rstrip("\r\n")
    found: str = typer.prompt("Password", hide_input=True, confirmation_prompt=True)
    return found


def _words(roles: frozenset[Role]) -> str:
    return ", ".join(sorted(roles))
