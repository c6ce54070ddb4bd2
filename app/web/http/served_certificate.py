"""The certificate that the panel serves: renewed where it is Heliopanel's own, and taken over when replaced.

Nothing is renewed by a clock that may be wrong: what is certain then is that this software has been built.
"""

import asyncio
import ssl
from collections.abc import Callable
from datetime import datetime, timedelta
from pathlib import Path

from app.base.build import BUILT_AT
from app.base.clock import Clock
from app.base.logs import get_logger
from app.base.settings import Settings
from app.base.startup import late
from app.link.messages import Machine

LOOK_EVERY = timedelta(seconds=10)

log = get_logger()


class ServedCertificate:
    """Looks every 10 s; `context` is what new connections are served with, once the panel is served."""

    def __init__(self, settings: Settings, machine: Machine, clock: Clock) -> None:
        self.context: Callable[[], ssl.SSLContext | None] = lambda: None
        self._files = settings.certificate
        self._own = settings.tls_dir if settings.tls_cert_file is None else None
        self._machine = machine
        self._clock = clock
        self._served: tuple[tuple[int, int], ...] = ()
        self._served = self._written()
        self._told = ""

    async def run(self) -> None:
        """Look after the certificate until cancelled; at once where there is none."""
        while self._files is not None:
            await self.look()
            await self._clock.sleep_until(self._clock.now() + LOOK_EVERY)

    async def look(self) -> None:
        """Renew the certificate if that is due, serve it if it is new, and log what is wrong with it."""
        if self._files is None:
            return
        try:
            wrong, about = await asyncio.to_thread(self._renew_if_due, self._files[0])
            if (written := self._written()) != self._served:
                await asyncio.to_thread(_tried, self._files)
                self._serve(self._files)
                self._served = written
        except (OSError, ValueError) as error:
            wrong, about = "certificate_unusable", {"reason": str(error)}
        if wrong and wrong != self._told:
            log.warning(wrong, **about)
        self._told = wrong

    def _renew_if_due(self, path: Path) -> tuple[str, dict[str, str]]:
        """Return what is wrong with the certificate that is served, nothing once it is renewed."""
        certificates = late("app.base.certificates")
        found, certain = certificates.read(path), self._certain()
        validity = found.validity(certain or self._clock.system_time())
        is_valid = validity is certificates.Validity.VALID
        due = found.not_after < BUILT_AT if certain is None else not is_valid
        if due and self._own is not None and certificates.is_own(self._own):
            renewed = certificates.renew(self._own, certain or BUILT_AT)
            log.info("certificate_renewed", until=renewed.not_after.isoformat(), was=validity.value)
            is_valid = True
        begin, end = found.not_before.isoformat(), found.not_after.isoformat()
        wrong = "" if is_valid else f"certificate_{validity}"
        return wrong, {"certificate": str(path), "valid_from": begin, "until": end}

    def _certain(self) -> datetime | None:
        """Return the time where the site's clock is trusted or NTP keeps the system's, None elsewhere.

        It is never before this software was built, which NTP may show: what was made then would never be
        valid, and be made anew at every look.
        """
        site = self._machine.latest()
        if site is None or not (site.clock.trusted or site.clock.ntp_synchronised):
            return None
        at = site.at if site.clock.trusted else self._clock.system_time()
        return max(at, BUILT_AT)

    def _written(self) -> tuple[tuple[int, int], ...]:
        try:
            found = [path.stat() for path in self._files or ()]
        except OSError:
            return self._served
        return tuple((one.st_ino, one.st_mtime_ns) for one in found)

    def _serve(self, files: tuple[Path, Path]) -> None:
        """Serve new connections with these files; in no thread, as connections are made of the context."""
        if (context := self.context()) is not None:
            context.load_cert_chain(*files, password="")
            log.info("certificate_served")


def _tried(files: tuple[Path, Path]) -> None:
    """Raise `OSError` for files that do not fit together: they would spoil the context."""
    ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER).load_cert_chain(*files, password="")
