"""The name heliopanel.local, announced on the local network where the setting asks for it."""

import ipaddress
import socket
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

import structlog

from app.certificates import own_names
from app.settings import Settings, SettingsWrong

log = structlog.get_logger()

NAME = "heliopanel.local."


@asynccontextmanager
async def announced(settings: Settings) -> AsyncIterator[None]:
    """Announce the panel for as long as this lasts, or raise `SettingsWrong` without the library for it."""
    try:
        from zeroconf import ServiceInfo  # noqa: PLC0415 - an extra that need not be installed
        from zeroconf.asyncio import AsyncZeroconf  # noqa: PLC0415 - as above
    except ImportError as error:
        raise SettingsWrong(
            "HELIOPANEL_MDNS needs the extra mdns: run `pip install zeroconf`, or leave it unset."
        ) from error
    kind = f"_{settings.scheme}._tcp.local."
    info = ServiceInfo(
        kind, f"Heliopanel.{kind}", addresses=addresses(settings.host), port=settings.port, server=NAME
    )
    async with AsyncZeroconf() as announcing:
        await announcing.async_register_service(info, allow_name_change=True)
        log.info("announced", name=NAME.rstrip("."), port=settings.port)
        yield


def addresses(host: str) -> list[bytes]:
    """Return the addresses to announce: the one that the panel listens on, or all that this computer has."""
    wanted = own_names() if host in ("0.0.0.0", "::") else (host,)
    found = []
    for one in wanted:
        try:
            address = ipaddress.ip_address(one)
        except ValueError:
            continue
        if not address.is_loopback or one == host:
            family = socket.AF_INET6 if address.version == 6 else socket.AF_INET
            found.append(socket.inet_pton(family, one))
    return found
