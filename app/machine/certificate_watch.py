"""Raises an alarm for a certificate of the panel that is not valid, or will soon not be."""

import asyncio
from collections.abc import Callable, Iterator
from dataclasses import replace
from datetime import datetime, timedelta
from pathlib import Path

from app.alarms.conditions import SITE, Condition
from app.base.clock import Clock
from app.base.message import say, told_by, with_format
from app.base.settings import Settings, SettingsWrong
from app.base.startup import late
from app.machine.starting import CertificateUnusable, check_certificate
from app.site.site import Site

LOOK_EVERY = timedelta(seconds=20)
"""Below the delay of the alarms, so that what Heliopanel renews by itself raises none."""
CODES = ("certificate_invalid", "certificate_ends", "authority_ends")


class CertificateWatch:
    """Looks every 20 s; `settings` are read anew, as the page Network changes them."""

    def __init__(self, clock: Clock, site: Site, settings: Callable[[], Settings]) -> None:
        self._clock = clock
        self._site = site
        self._settings = settings

    async def run(self) -> None:
        """Look until cancelled."""
        while True:
            await self.look()
            await self._clock.sleep_until(self._clock.now() + LOOK_EVERY)

    async def look(self) -> None:
        """Compare the certificates with the site's time; while that may be wrong, it has its own alarms."""
        found: list[Condition] = []
        if not self._site.model.timekeeper.reasons():
            found = await asyncio.to_thread(self._found, self._site.model.now())
        for code in CODES:
            self._site.trouble(code, next((one for one in found if one.code == code), None))

    def _found(self, now: datetime) -> list[Condition]:
        try:
            return list(conditions(self._settings(), now))
        except SettingsWrong:
            return []


def conditions(settings: Settings, now: datetime) -> Iterator[Condition]:
    """Yield what is to be told of the certificate that is served, and of the authority behind it."""
    if settings.certificate is None:
        return
    try:
        check_certificate(settings)
    except CertificateUnusable as error:
        yield Condition("certificate_invalid", None, SITE, told_by(error))
        return
    certificates = late("app.base.certificates")
    if settings.tls_cert_file is None and certificates.is_own(settings.tls_dir):
        authority = settings.tls_dir / certificates.AUTHORITY
        yield from (replace(one, code="authority_ends") for one in _of(authority, now))
    yield from _of(settings.certificate[0], now)


def _of(path: Path, now: datetime) -> Iterator[Condition]:
    certificates = late("app.base.certificates")
    found = certificates.read(path)
    begin, end = with_format(found.not_before, "%Y-%m-%d"), with_format(found.not_after, "%Y-%m-%d")
    match found.validity(now):
        case certificates.Validity.EARLY:
            text = say("The certificate {path} is valid only from {begin}.", path=path, begin=begin)
            yield Condition("certificate_invalid", None, SITE, text)
        case certificates.Validity.ENDED:
            text = say("The certificate {path} expired on {end}.", path=path, end=end)
            yield Condition("certificate_invalid", None, SITE, text)
        case certificates.Validity.ENDS:
            text = say("The certificate {path} expires on {end}.", path=path, end=end)
            yield Condition("certificate_ends", None, SITE, text)
