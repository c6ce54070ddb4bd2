"""What must be right before anything starts: where it is not, one sentence and exit code 2, no new start."""

import os
import socket
import sys
import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from app.base.errors import AT_RUN_TIME, Foreseen
from app.base.message import say
from app.base.settings import Settings, SettingsWrong
from app.base.startup import late

WRITTEN = ("*.db", "machine.*")
"""What both processes write in the data folder; somebody who ran one as root left files that are root's."""


class CertificateUnusable(Foreseen):
    """Https cannot be served now; it can once the files are right, so the panel is started again."""


@contextmanager
def as_service() -> Iterator[None]:
    """End a service that failed with 1, so that it is started again: to it, no argument was wrong."""
    try:
        yield
    except (ValueError, OSError):
        traceback.print_exc()
        sys.exit(AT_RUN_TIME)


def check_data_dir(folder: Path) -> None:
    """Make the data folder if there is none; raise `SettingsWrong` if it cannot be written."""
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    except OSError as error:
        raise _unwritable(f"folder {folder} cannot be made ({error.strerror})") from error
    if not os.access(folder, os.R_OK | os.W_OK | os.X_OK):
        raise _unwritable(f"folder {folder} cannot be written")
    for path in (path for pattern in WRITTEN for path in folder.glob(pattern)):
        if not os.access(path, os.R_OK | os.W_OK):
            raise _unwritable(f"file {path} in the data folder cannot be written")


def _unwritable(what: str) -> SettingsWrong:
    return SettingsWrong(
        f"The {what}. Give it to the user who runs Heliopanel, or name another folder with --data-dir or "
        "HELIOPANEL_DATA_DIR."
    )


def check_port(settings: Settings) -> None:
    """Raise `SettingsWrong` if another program listens where the panel shall listen."""
    family = socket.AF_INET6 if ":" in settings.host else socket.AF_INET
    with socket.socket(family) as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((settings.host, settings.port))
        except OSError as error:
            raise SettingsWrong(
                f"The panel cannot listen on {settings.host} port {settings.port}: {error.strerror}. "
                "Stop the program that uses it, or choose another address or port (--host, --port, "
                "HELIOPANEL_HOST, HELIOPANEL_PORT)."
            ) from error


def check_certificate(settings: Settings) -> None:
    """Raise `CertificateUnusable` if the certificate and its key cannot be read, or do not go together."""
    if settings.certificate is None:
        return
    certificate, key = settings.certificate
    ssl = late("ssl")
    try:
        ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER).load_cert_chain(certificate, key, password="")
    except OSError as error:
        raise CertificateUnusable(
            say(
                "The certificate {certificate} and the key {key} cannot be used: {error}. Run heliopanel tls "
                "init if they are Heliopanel's own; otherwise replace both files.",
                certificate=certificate,
                key=key,
                error=error,
            )
        ) from error
