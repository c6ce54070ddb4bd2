"""The name heliopanel.local, announced on the local network where the setting asks for it."""

import ipaddress
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

from app.base.addresses.own_names import own_names
from app.base.logs import get_logger
from app.base.settings import Settings, SettingsWrong

log = get_logger()

NAME = "heliopanel.local."


@asynccontextmanager
async def announced(settings: Settings) -> AsyncIterator[None]:
    """Announce the panel for as long as this lasts, or raise `SettingsWrong` without the library for it."""
    try:
        from zeroconf import (  # noqa: PLC0415 - an extra that need not be installed
            InterfaceChoice,
            ServiceInfo,
        )
        from zeroconf.asyncio import AsyncZeroconf  # noqa: PLC0415 - as above
    except ImportError as error:
        raise SettingsWrong(
            "HELIOPANEL_MDNS needs the extra mdns: run `pip install zeroconf`, or leave it unset."
        ) from error
    kind = f"_{settings.scheme}._tcp.local."
    info = ServiceInfo(
        kind, f"Heliopanel.{kind}", addresses=addresses(settings.host), port=settings.port, server=NAME
    )
    where = InterfaceChoice.All if _everywhere(settings.host) else [settings.host]
    async with AsyncZeroconf(interfaces=where) as announcing:
        await announcing.async_register_service(info, allow_name_change=True)
        log.info("announced", name=NAME.rstrip("."), port=settings.port)
        yield


def addresses(host: str) -> list[bytes]:
    """Return the addresses to announce: the one that the panel listens on, or all that this computer has."""
    found = []
    for one in own_names() if _everywhere(host) else (host,):
        try:
            address = ipaddress.ip_address(one)
        except ValueError:
            continue
        if not address.is_loopback or one == host:
            found.append(address.packed)
    return found


def _everywhere(host: str) -> bool:
    """Return whether the panel listens on all addresses of this computer."""
    try:
        return ipaddress.ip_address(host).is_unspecified
    except ValueError:
        return False
