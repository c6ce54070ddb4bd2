"""The panel as the product serves it, over real sockets: https, a proxy in front, its name announced."""

import asyncio
import socket
import ssl
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import httpx
import pytest
from typer.testing import CliRunner
from zeroconf.asyncio import AsyncServiceInfo, AsyncZeroconf

from app.access.roles import Role
from app.access.store import AccessStore
from app.base.settings import Settings
from app.cli import cli
from app.web.http.mdns import NAME, announced
from app.web.http.security import HSTS
from app.web.http.server import PanelServer
from app.web.main import configured, create_app
from tests.access.fake_hasher import FakeHasher
from tests.fakes import FakeMachine, FakeReader
from tests.patience import PATIENCE_S, eventually
from tests.ports import free_port
from tests.web.office import HERE, PASSWORD


@contextmanager
def served(settings: Settings, on_answer: Callable[[], None] | None = None) -> Iterator[Any]:
    """Serve a panel in a thread for a while."""
    app = create_app(settings, machine=FakeMachine(), reader=FakeReader(), hasher=FakeHasher())
    server = PanelServer(configured(app, settings), app.state.panel.hub.closing.set, on_answer)
    thread = threading.Thread(target=server.run, daemon=True)
    thread.start()
    asyncio.run(eventually(lambda: server.started))
    yield app
    server.leave()
    thread.join(PATIENCE_S)
    assert not thread.is_alive()


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A data folder for which `heliopanel tls init` was run."""
    made: Path = tmp_path_factory.mktemp("served")
    told = CliRunner().invoke(
        cli, ["tls", "init", "--name", "tracker.example"], env={"HELIOPANEL_DATA_DIR": str(made)}
    )
    assert told.exit_code == 0, told.output
    return made


def test_the_address_is_told_when_a_browser_can_open_it_and_not_before(tmp_path: Path) -> None:
    settings, told = Settings(data_dir=tmp_path, port=free_port()), []

    def tell() -> None:
        with socket.create_connection(("127.0.0.1", settings.port), 5):
            told.append(settings.port)

    with served(settings, tell):
        asyncio.run(eventually(lambda: told))
    assert told == [settings.port]


def test_one_command_later_the_panel_is_served_over_https(folder: Path) -> None:
    settings = Settings(data_dir=folder, port=free_port())
    assert settings.scheme == "https"
    with served(settings) as app:
        url = f"https://127.0.0.1:{settings.port}"
        with pytest.raises(httpx.ConnectError, match="CERTIFICATE_VERIFY_FAILED"):
            httpx.get(f"{url}/health")
        distrusting = ssl.create_default_context()
        distrusting.check_hostname, distrusting.verify_mode = False, ssl.CERT_NONE
        authority = httpx.get(f"{url}/certificate/ca.crt", verify=distrusting)
        assert authority.headers["content-type"] == "application/x-x509-ca-cert"
        trusting = ssl.create_default_context(cadata=authority.text)
        with httpx.Client(base_url=url, verify=trusting) as tablet:
            page = tablet.get("/certificate")
            assert page.headers["strict-transport-security"] == HSTS
            assert "Install the CA on a tablet" in page.text
            assert "tracker.example" in page.text
            _hire(app)
            secret = {"name": "root", "password": PASSWORD}
            cookie = tablet.post("/login", data=secret, headers={"origin": url}).headers["set-cookie"]
        assert cookie.startswith("__Host-heliopanel=")
        assert {"Secure", "HttpOnly", "SameSite=strict", "Path=/"} <= set(cookie.split("; "))
        with pytest.raises(httpx.TransportError):
            httpx.get(f"http://127.0.0.1:{settings.port}/health")


def _hire(app: Any) -> None:
    keeper, now = app.state.panel.keeper, app.state.panel.clock.now()
    keeper.accounts.add(HERE, "root", {Role.ADMINISTRATOR}, PASSWORD, now)
    asyncio.run(eventually(lambda: bool(keeper.book.users)))


def wrong_log_in(port: int, come_from: str, **headers: str) -> httpx.Response:
    """Try a wrong password from one of this computer's loopback addresses."""
    transport = httpx.HTTPTransport(local_address=come_from)
    with httpx.Client(transport=transport, base_url=f"http://127.0.0.1:{port}") as browser:
        return browser.post("/api/v1/session", json={"name": "root", "password": "wrong"}, headers=headers)


@pytest.mark.parametrize(
    ("named", "believed"), [(("127.0.0.1",), True), (("10.0.0.0/8",), False), ((), False)]
)
def test_who_asks_is_taken_from_a_named_proxy_alone(
    tmp_path: Path, named: tuple[str, ...], *, believed: bool
) -> None:
    """A proxy on this computer ends https and tells who asked; another address claims to be one."""
    settings = Settings(data_dir=tmp_path, port=free_port(), trusted_proxies=named)
    told = {"X-Forwarded-For": "10.9.9.9", "X-Forwarded-Proto": "https"}
    with served(settings) as app:
        _hire(app)
        answer = wrong_log_in(settings.port, "127.0.0.1", **told)
        forged = wrong_log_in(settings.port, "127.0.0.3", **told)
    assert answer.status_code == forged.status_code == 401
    assert ("strict-transport-security" in answer.headers) is believed
    assert "strict-transport-security" not in forged.headers
    events = AccessStore(f"sqlite:///{tmp_path}/access.db", b"").events()
    asked = [event.address for event, _, _ in events if event.action == "log_in"]
    assert asked == ["10.9.9.9" if believed else "127.0.0.1", "127.0.0.3"]


async def test_the_name_is_announced_where_the_panel_listens() -> None:
    settings = Settings(port=free_port(), mdns=True)
    async with announced(settings), AsyncZeroconf(interfaces=["127.0.0.1"]) as tablet:
        kind = "_http._tcp.local."
        found = AsyncServiceInfo(kind, f"Heliopanel.{kind}")
        assert await found.async_request(tablet.zeroconf, 3000)
    assert (found.server, found.port) == (NAME, settings.port)
    assert found.addresses == [socket.inet_aton("127.0.0.1")]
