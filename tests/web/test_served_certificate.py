"""The panel's certificate is renewed under a clock that is certain, and served without a restart."""

import ssl
import threading
from contextlib import suppress
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import pytest
from cryptography import x509

from app.base import certificates
from app.base.build import BUILT_AT
from app.base.certificates import AUTHORITY, SERVER, SERVER_KEY, Validity, init, read
from app.base.clock import VirtualClock
from app.base.settings import Settings
from app.tracker.state.snapshot import SiteSnapshot
from app.web.http.served_certificate import LOOK_EVERY, ServedCertificate
from tests.captured_logs import capture_logs
from tests.fakes import FakeMachine
from tests.golden.table import ClockRow
from tests.web.test_clocks import NOON, rows

NAMES = ("heliopanel.local", "10.0.0.5")


class Told(FakeMachine):
    """A controller that says whether its clock is trusted, and whether NTP keeps it."""

    def __init__(self, clock: VirtualClock, *, trusted: bool, kept: bool | None = None) -> None:
        super().__init__(clock)
        self.trusted, self.kept, self.away = trusted, kept, False

    def latest(self) -> SiteSnapshot | None:
        site = super().latest()
        if site is None or self.away:
            return None
        return replace(
            site,
            at=self.clock.now(),
            clock=replace(site.clock, trusted=self.trusted, ntp_synchronised=self.kept),
        )


class Panel:
    """A certificate as it is served in a process whose clock is so far ahead."""

    def __init__(self, folder: Path, ahead: timedelta, *, trusted: bool = True, **given: object) -> None:
        self.settings = Settings(data_dir=folder, **given)
        self.clock = VirtualClock(NOON + ahead)
        self.machine = Told(self.clock, trusted=trusted)
        self.desk = ServedCertificate(self.settings, self.machine, self.clock)
        self.context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
        self.context.load_cert_chain(*(self.settings.certificate or ()))
        self.desk.context = lambda: self.context

    async def later(self, by: timedelta = LOOK_EVERY) -> None:
        self.clock.advance(by)
        await self.desk.look()

    def handed_out(self) -> datetime:
        """Return until when the certificate is valid that a new connection gets; it must be signed for it."""
        inward, outward = ssl.MemoryBIO(), ssl.MemoryBIO()
        trust = ssl.create_default_context(cafile=str(self.settings.tls_dir / AUTHORITY))
        trust.verify_flags |= ssl.VerifyFlags.VERIFY_X509_PARTIAL_CHAIN
        trust.check_hostname, trust.verify_mode = False, ssl.CERT_NONE
        client = trust.wrap_bio(inward, outward, server_hostname=NAMES[0])
        server = self.context.wrap_bio(outward, inward, server_side=True)
        for side in (client, server, client, server):
            try:
                side.do_handshake()
            except ssl.SSLWantReadError:
                continue
        given = client.getpeercert(binary_form=True)
        return x509.load_der_x509_certificate(given or b"").not_valid_after_utc


def served(folder: Path) -> tuple[bytes, bytes]:
    return (folder / SERVER).read_bytes(), (folder / SERVER_KEY).read_bytes()


@rows("certificate_unsure")
async def test_it_is_not_renewed_by_a_clock_that_may_be_wrong(tmp_path: Path, row: ClockRow) -> None:
    folder = tmp_path / "tls"
    init(folder, NAMES, NOON + row.stored)
    before = served(folder)
    panel = Panel(tmp_path, row.asked, trusted=False)
    await panel.later(row.later)
    assert (served(folder) == before) == (row.expected == "kept")


@rows("certificate")
@pytest.mark.parametrize("kept_by", ["site", "ntp"])
async def test_it_is_renewed_by_a_clock_that_is_certain(tmp_path: Path, row: ClockRow, kept_by: str) -> None:
    folder = tmp_path / "tls"
    init(folder, NAMES, NOON + row.stored)
    before, authority = served(folder), (folder / AUTHORITY).read_bytes()
    panel = Panel(tmp_path, row.asked)
    panel.machine.trusted, panel.machine.kept = kept_by == "site", kept_by == "ntp"
    await panel.later(row.later)
    after, now = served(folder), NOON + row.asked + row.later
    assert {True: "kept", False: "renewed"}[after[0] == before[0]] == row.expected
    assert (folder / AUTHORITY).read_bytes() == authority
    assert after[1] == before[1], "certificate and key fit at every instant"
    found = read(folder / SERVER)
    assert (found.names, found.validity(max(now, BUILT_AT))) == (NAMES, Validity.VALID)
    assert panel.handed_out() == found.not_after
    await panel.later()
    assert served(folder) == after, "it is renewed once"


async def test_it_is_renewed_once_the_clock_was_set(tmp_path: Path) -> None:
    init(tmp_path / "tls", NAMES, NOON + timedelta(days=400))
    panel = Panel(tmp_path, timedelta(), trusted=False)
    with capture_logs() as logs:
        await panel.later()
        await panel.later()
        assert [one["event"] for one in logs] == ["certificate_not_yet_valid"], "said once"
        panel.machine.trusted = True
        await panel.later()
    assert [one["event"] for one in logs][1:] == ["certificate_renewed", "certificate_served"]
    assert panel.handed_out() == panel.clock.now() + timedelta(days=397)


async def test_what_ended_before_this_software_was_built_is_renewed_by_any_clock(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with monkeypatch.context() as patch:
        patch.setattr(certificates, "BUILT_AT", BUILT_AT - timedelta(days=500))
        init(tmp_path / "tls", NAMES, BUILT_AT - timedelta(days=500))
    panel = Panel(tmp_path, timedelta(days=-20780), trusted=False)
    await panel.later()
    assert read(tmp_path / "tls" / SERVER).not_after == BUILT_AT + timedelta(days=397)


async def test_nothing_is_renewed_before_the_controller_tells_its_clock(tmp_path: Path) -> None:
    init(tmp_path / "tls", NAMES, NOON)
    panel = Panel(tmp_path, timedelta(days=500))
    before = served(tmp_path / "tls")
    panel.machine.away = True
    with capture_logs() as logs:
        await panel.later()
    assert served(tmp_path / "tls") == before
    assert [(one["event"], one["until"][:10]) for one in logs] == [("certificate_expired", "2027-12-30")]


async def test_a_certificate_of_somebody_else_is_told_of_and_taken_over_when_replaced(tmp_path: Path) -> None:
    other, own = tmp_path / "other", tmp_path / "tls"
    init(other, NAMES, NOON)
    own.mkdir()
    (own / AUTHORITY).write_bytes((other / AUTHORITY).read_bytes())
    files = (other / SERVER, other / SERVER_KEY)
    before = files[0].read_bytes()
    panel = Panel(tmp_path, timedelta(days=380), tls_cert_file=files[0], tls_key_file=files[1])
    with capture_logs() as logs:
        await panel.later()
    assert files[0].read_bytes() == before
    assert [one["event"] for one in logs] == ["certificate_ends_soon"]
    init(other, NAMES, panel.clock.now())
    await panel.later()
    assert panel.handed_out() == read(files[0]).not_after == NOON + timedelta(days=777) + LOOK_EVERY


async def test_a_pair_that_does_not_fit_leaves_what_is_served(tmp_path: Path) -> None:
    init(tmp_path / "tls", NAMES, NOON)
    panel = Panel(tmp_path, timedelta())
    before = panel.handed_out()
    init(tmp_path / "other", NAMES, NOON + timedelta(days=1))
    (tmp_path / "tls" / SERVER).write_bytes((tmp_path / "other" / SERVER).read_bytes())
    with capture_logs() as logs:
        await panel.later()
        await panel.later()
    assert panel.handed_out() == before
    assert [one["event"] for one in logs] == ["certificate_unusable"]


async def test_the_context_of_new_connections_is_changed_where_they_are_made(tmp_path: Path) -> None:
    """OpenSSL makes connections of a context in one thread only while no other changes it."""
    init(tmp_path / "tls", NAMES, NOON)
    panel = Panel(tmp_path, timedelta())
    threads: list[threading.Thread] = []

    class Context(ssl.SSLContext):
        def load_cert_chain(self, *files: object, **more: object) -> None:
            threads.append(threading.current_thread())

    panel.desk.context = lambda: Context(ssl.PROTOCOL_TLS_SERVER)
    init(tmp_path / "tls", NAMES, NOON + timedelta(days=1))
    await panel.later()
    assert threads == [threading.current_thread()]


@pytest.mark.parametrize("writes", range(3))
def test_a_panel_is_served_wherever_a_new_certificate_was_broken_off(
    tmp_path: Path, writes: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    init(tmp_path, NAMES, NOON)
    (tmp_path / SERVER_KEY).chmod(0o644)
    left = iter(range(writes))

    def finish(*given: Any) -> None:
        if next(left, None) is None:
            raise OSError("no space is left")
        finishing(*given)

    finishing = certificates._finish
    monkeypatch.setattr(certificates, "_finish", finish)
    with suppress(OSError):
        init(tmp_path, NAMES, NOON + timedelta(days=1))
    ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER).load_cert_chain(tmp_path / SERVER, tmp_path / SERVER_KEY)
    assert (tmp_path / SERVER_KEY).stat().st_mode & 0o777 == (0o600 if writes else 0o644)


@pytest.mark.parametrize("kept", [b"", b"no key", b"%bBEGIN PRIVATE KEY%b\nMIG\n" % (b"-----", b"-----")])
def test_a_key_that_cannot_be_used_is_made_anew(tmp_path: Path, kept: bytes) -> None:
    init(tmp_path, NAMES, NOON)
    (tmp_path / SERVER_KEY).write_bytes(kept)
    init(tmp_path, NAMES, NOON)
    ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER).load_cert_chain(tmp_path / SERVER, tmp_path / SERVER_KEY)


def test_no_wrong_clock_makes_an_authority_that_is_not_valid(tmp_path: Path) -> None:
    for number, days in enumerate((-20780, -500, 0, 400, 50700)):
        init(tmp_path / str(number), NAMES, NOON + timedelta(days=days))
        made = read(tmp_path / str(number) / AUTHORITY)
        for day in (BUILT_AT, datetime(2036, 11, 18, tzinfo=UTC) - timedelta(days=31)):
            assert made.validity(day) is Validity.VALID
