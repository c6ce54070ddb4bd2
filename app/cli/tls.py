"""`heliopanel tls`: a certificate of one's own, so that the panel can be reached from a network."""

from typing import Annotated

import typer

from app.base.addresses.own_names import own_names
from app.base.certificates import AUTHORITY, SERVER, init, read
from app.base.clock import SystemClock
from app.base.settings import SettingsWrong, read_settings

tls = typer.Typer(name="tls", help="The panel's certificate.", no_args_is_help=True)

Names = Annotated[
    list[str] | None,
    typer.Option("--name", help="Another name or address by which the panel is opened; several are allowed."),
]


@tls.command("init")
def make(name: Names = None) -> None:
    """Make the panel's certificate, and the authority that signs it if there is none; also to renew it."""
    settings = read_settings()
    made = init(settings.tls_dir, (*own_names(), *settings.allowed_hosts, *(name or ())), SystemClock().now())
    typer.echo(
        f"The panel's certificate is valid until {made.not_after:%Y-%m-%d} for {', '.join(made.names)}.\n"
        f"The authority's fingerprint (SHA-256) is {read(settings.tls_dir / AUTHORITY).fingerprint}.\n"
        "A panel that serves https uses it within 10 s; start any other again. Then open /certificate on "
        "each tablet and install the authority there."
    )
    if settings.tls is False:
        typer.echo(
            "https is switched off on the page Network: switch it on there, instead of starting again."
        )


@tls.command()
def show() -> None:
    """Print until when and for which names the certificates are valid."""
    folder = read_settings().tls_dir
    for label, file in (("authority", AUTHORITY), ("panel", SERVER)):
        try:
            found = read(folder / file)
        except (OSError, ValueError) as error:
            raise SettingsWrong("There is no certificate yet. Make one with: heliopanel tls init") from error
        names = f" for {', '.join(found.names)}" if found.names else ""
        typer.echo(f"{label}: until {found.not_after:%Y-%m-%d}{names}, SHA-256 {found.fingerprint}")
