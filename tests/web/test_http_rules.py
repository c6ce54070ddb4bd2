"""What HTTP itself asks of every address: one host, and an `Allow` that tells all methods."""

import asyncio

import httpx
import pytest

from app.access.roles import Role
from app.web.http.server import Connections
from tests.patience import PATIENCE_S
from tests.web.office import Office
from tests.web.route_table import ROUTES
from tests.web.test_server import serving


async def asked(port: int, head: str) -> bytes:
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    writer.write(head.format(port=port).replace("\n", "\r\n").encode() + b"\r\n\r\n")
    async with asyncio.timeout(PATIENCE_S):
        answer = await reader.read(4096)
    writer.close()
    return answer


async def test_two_hosts_are_refused_at_the_socket() -> None:
    async with serving(Connections(100)) as (_, port):
        one = "GET /health HTTP/1.1\nHost: 127.0.0.1:{port}"
        assert (await asked(port, one)).startswith(b"HTTP/1.1 200")
        for second in ("127.0.0.1:{port}", "rebound.example"):
            two = await asked(port, f"{one}\nHost: {second}")
            assert two.startswith(b"HTTP/1.1 400")
            assert b"Send one Host header." in two


def methods(path: str) -> set[str]:
    """Return what the table of permissions has for one path."""
    found = {method for method, _, told in (key.partition(" ") for key in ROUTES) if told == path} - {"WS"}
    return found | {"HEAD"} if "GET" in found else found


@pytest.mark.parametrize("method", ["OPTIONS", "TRACE"])
async def test_allow_tells_every_method_of_an_address(office: Office, method: str) -> None:
    session = await office.session(Role.ENGINEER)
    async with office.browser(session) as browser:
        browser.headers["x-csrf-token"] = office.keeper.csrf(session)
        for path in ("/api/v1/trackers", "/api/v1/trackers/{tracker_id}", "/api/v1/users"):
            answer: httpx.Response = await browser.request(method, path.format(tracker_id="T1"))
            assert answer.status_code == 405, path
            assert set(answer.headers["allow"].split(", ")) == methods(path), path
            assert len(methods(path)) > 1
