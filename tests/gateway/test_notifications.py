"""Alarms by webhook and e-mail against real servers: sent once, in order, and again after a failure."""

import asyncio
import email
import json
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest
from pydantic import SecretStr

from app.alarms.conditions import Condition
from app.base.settings import Settings
from app.gateway.gateways import Gateways
from app.gateway.notices import DELIVERY, SIGNATURE, signature
from app.link.alarm_orders import SetNotifications, TestNotification
from app.link.metrics import GatewayStatus
from app.store.store import JournalFilter
from app.tracker.commands.commands import CommandRejected
from app.tracker.values.alarm_words import AlarmState
from app.tracker.values.notifications import Channel, Notifications
from tests.gateway.rigs import gateway, kept_plant, opened
from tests.patience import eventually
from tests.site.plant import Plant

ALL = JournalFilter()
SECRET = "seven green panels"  # noqa: S105 - of this test alone
FULL = Condition("disk_full", None, "Site", "12 MB are free.")
BAD = Condition("clock_jumped", None, "Site", "The clock jumped.")


@dataclass
class WebServer:
    """Takes posts and answers what it is told to."""

    status: int = 204
    heard: list[tuple[dict[str, str], bytes]] = field(default_factory=list)
    port: int = 0

    async def serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        lines = (await reader.readuntil(b"\r\n\r\n")).decode().split("\r\n")[1:-2]
        headers = dict(line.split(": ", 1) for line in lines)
        self.heard.append((headers, await reader.readexactly(int(headers["Content-Length"]))))
        writer.write(f"HTTP/1.1 {self.status} Said\r\nContent-Length: 0\r\n\r\n".encode())
        await writer.drain()
        writer.close()

    def told(self) -> list[dict[str, Any]]:
        return [json.loads(body) for _, body in self.heard]


@dataclass
class MailServer:
    """Speaks as much SMTP as is needed to take a message."""

    heard: list[str] = field(default_factory=list)
    refuses: bool = False
    port: int = 0

    async def serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        writer.write(b"220 here\r\n")
        while line := (await reader.readline()).decode().strip():
            if line.upper() == "DATA":
                writer.write(b"354 go on\r\n")
                self.heard.append((await reader.readuntil(b"\r\n.\r\n")).decode())
            refused = self.refuses and line.upper().startswith("RCPT")
            writer.write(b"550 nobody here\r\n" if refused else b"250 well\r\n")
            if line.upper() == "QUIT":
                break
        writer.close()


@asynccontextmanager
async def served(found: WebServer | MailServer) -> AsyncIterator[None]:
    """Serve whoever connects; nobody's conversation outlives the test."""
    conversations: set[asyncio.Task[None]] = set()

    async def converse(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        conversations.add(asyncio.current_task())  # type: ignore[arg-type]
        try:
            await found.serve(reader, writer)
        finally:
            writer.transport.abort()

    server = await asyncio.start_server(converse, "127.0.0.1", 0)
    found.port = server.sockets[0].getsockname()[1]
    try:
        yield
    finally:
        server.close()
        for conversation in conversations:
            conversation.cancel()
        await asyncio.gather(*conversations, return_exceptions=True)
        await asyncio.sleep(0)
        await server.wait_closed()


@dataclass
class Office:
    plant: Plant
    gateways: Gateways
    web: WebServer
    post: MailServer

    async def raise_(self, condition: Condition) -> None:
        self.plant.site.trouble(condition.code, condition)
        await self.plant.forward(seconds=4)

    async def set(self, **wanted: Any) -> None:
        await self.plant.ask(SetNotifications(Notifications(**wanted)))

    @property
    def hook(self) -> str:
        return f"http://127.0.0.1:{self.web.port}/alarms?site=north"


@pytest.fixture
async def office(tmp_path: Path) -> AsyncIterator[Office]:
    web, post = WebServer(), MailServer()
    async with served(web), served(post), kept_plant(tmp_path) as (plant, store):
        settings = Settings(
            data_dir=tmp_path,
            webhook_secret=SecretStr(SECRET),
            smtp_host="127.0.0.1",
            smtp_port=post.port,
            smtp_tls="none",
            smtp_from="panel@example.org",
        )
        async with opened(plant, settings, store) as gateways:
            begun = [tmp_path / f"{channel}-outbox.json" for channel in Channel]
            await eventually(lambda: all(path.exists() for path in begun))
            yield Office(plant, gateways, web, post)


async def test_a_webhook_hears_alarms_of_its_priorities_signed(office: Office) -> None:
    await office.set(webhook_url=office.hook, webhook_priorities=(2,))
    await office.raise_(BAD)
    await office.raise_(FULL)
    await eventually(lambda: any(one["data"]["code"] == "disk_full" for one in office.web.told()))
    headers, body = office.web.heard[-1]
    assert headers[SIGNATURE] == signature(SECRET, body)
    assert headers[SIGNATURE] != signature("another", body)
    told = json.loads(body)
    assert headers[DELIVERY] == f"{told['series']}-{told['sequence']}"
    assert (told["kind"], told["data"]["priority"]) == ("alarm_raised", 2)
    assert "12 MB are free." in told["message"]
    assert "clock_jumped" not in [one["data"]["code"] for one in office.web.told()]


async def test_a_channel_that_nobody_has_opened_writes_nothing_and_tells_no_old_alarms(
    office: Office, tmp_path: Path
) -> None:
    files = [tmp_path / f"{channel}-outbox.json" for channel in Channel]
    before = [(path.read_bytes(), path.stat().st_mtime_ns) for path in files]
    await office.raise_(FULL)
    outboxes = [notifier._outbox for notifier in office.gateways._notifiers]
    journal = outboxes[0]._reader
    await eventually(lambda: any(one.event.data.get("code") == "disk_full" for one in journal.journal(ALL)))
    await eventually(lambda: not any(outbox.waiting() for outbox in outboxes))
    assert [(path.read_bytes(), path.stat().st_mtime_ns) for path in files] == before
    await office.set(webhook_url=office.hook, webhook_priorities=(1, 2, 3))
    await office.raise_(BAD)
    await eventually(lambda: any(one["data"].get("code") == "clock_jumped" for one in office.web.told()))
    assert "disk_full" not in [one["data"].get("code") for one in office.web.told()]
    assert files[0].read_bytes() != before[0][0]
    assert files[1].read_bytes() == before[1][0]


async def test_what_fails_is_an_alarm_and_is_sent_again_once(office: Office) -> None:
    office.web.status = 500
    await office.set(webhook_url=office.hook)
    await office.raise_(FULL)
    await eventually(lambda: office.web.heard)
    await eventually(lambda: "Webhook" in office.plant.site._alarms.troubles)
    await office.plant.forward(seconds=1)
    site = office.plant.site.latest()
    assert site is not None
    failed = next(one for one in site.alarms if one.code == "notification_failed")
    assert (failed.priority, failed.state) == (4, AlarmState.UNACKNOWLEDGED)
    assert "answered 500" in failed.message
    found = await gateway(office.gateways, "Webhook")
    assert found.status is GatewayStatus.CONNECTING
    office.web.status = 200
    tried = len(office.web.heard)
    await eventually(lambda: "Webhook" not in office.plant.site._alarms.troubles)
    delivered = [headers[DELIVERY] for headers, _ in office.web.heard]
    assert delivered[tried] == delivered[0], "the one that failed comes first"
    assert delivered.count(delivered[0]) == tried + 1


async def test_mail_says_what_where_since_and_what_to_do(office: Office) -> None:
    await office.set(mail_to=("ayse@example.org", "night@example.org"))
    await office.raise_(FULL)
    await eventually(lambda: any("Disk is full" in one for one in office.post.heard))
    message = email.message_from_string(next(one for one in office.post.heard if "Disk is full" in one))
    assert message["Subject"] == "[P2] Disk is full, Site"
    assert message["To"] == "ayse@example.org, night@example.org"
    said = str(message.get_payload())
    for part in ("12 MB are free.", "Where: Site", "Since: 2027-06-21", "Do:    Delete recordings"):
        assert part in said


async def test_a_mail_server_that_refuses_is_told(office: Office) -> None:
    office.post.refuses = True
    await office.set(mail_to=("ayse@example.org",))
    await office.raise_(FULL)
    await eventually(lambda: "E-mail" in office.plant.site._alarms.troubles)
    assert "did not accept the message" in (await gateway(office.gateways, "E-mail")).error


async def test_a_test_message_goes_by_its_channel_alone_and_needs_an_address(office: Office) -> None:
    await office.set(mail_to=("ayse@example.org",))
    with pytest.raises(CommandRejected, match="no address for webhook"):
        await office.plant.ask(TestNotification(Channel.WEBHOOK))
    await office.set(webhook_url=office.hook, mail_to=("ayse@example.org",))
    await office.plant.ask(TestNotification(Channel.MAIL))
    await eventually(lambda: any("test message" in one for one in office.post.heard))
    assert "notification_tested" not in [one["kind"] for one in office.web.told()]


@pytest.mark.parametrize(
    "wrong",
    [
        {"webhook_url": "ftp://example.org"},
        {"webhook_url": "https://example.org/a b"},
        {"mail_to": ("nobody",)},
        {"mail_to": ("a@b\nBcc: c@d",)},
        {"mail_to": tuple(f"p{number}@example.org" for number in range(11))},
        {"mail_priorities": (5,)},
    ],
)
def test_addresses_that_cannot_be_are_refused(wrong: dict[str, Any]) -> None:
    with pytest.raises(ValueError, match=r"\.$|example"):
        Notifications(**wrong)
