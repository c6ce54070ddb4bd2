"""HEAD of every address: status and headers as of GET, no body, and no stream that goes on for ever."""

import asyncio
import re
from pathlib import Path

import httpx

from app.access.roles import Role
from app.base.clock import VirtualClock
from app.web.http.limits import LASTING
from app.web.http.server import Connections
from tests.fake_data import NOON
from tests.patience import PATIENCE_S
from tests.web.office import Office
from tests.web.route_table import ROUTES
from tests.web.test_http_rules import asked
from tests.web.test_server import serving

GETS = sorted({path for method, _, path in (key.partition(" ") for key in ROUTES) if method == "GET"})
MORE = ["/s/favicon.svg", "/manual/index.html", "/nowhere", "/s/nowhere", "/stop", "/api/v1/stop"]
FILLED = {"tracker_id": "T1", "name": "viewer-1", "language": "en"}
ASKED = {"accept": "text/html", "accept-encoding": "identity"}


def address(path: str) -> str:
    return re.sub(r"\{(\w+)(?::\w+)?\}", lambda found: FILLED.get(found[1], "1"), path)


def plain(answer: httpx.Response) -> dict[str, str]:
    return {name: text for name, text in answer.headers.items() if name not in ("date", "etag")}


async def head(browser: httpx.AsyncClient, path: str) -> httpx.Response:
    async with asyncio.timeout(PATIENCE_S):
        return await browser.head(path, headers=ASKED)


async def test_head_is_get_without_a_body_everywhere(tmp_path: Path) -> None:
    office = Office(tmp_path, clock=VirtualClock(NOON))
    async with office.app.router.lifespan_context(office.app):
        await office.hire(Role.ENGINEER)
        async with office.browser(await office.session(Role.ENGINEER)) as browser:
            for path in (*map(address, GETS), *MORE):
                short = await head(browser, path)
                assert not short.content, path
                if path in LASTING:
                    assert short.status_code == 200, path
                    continue
                whole = await browser.get(path, headers=ASKED)
                assert (short.status_code, plain(short)) == (whole.status_code, plain(whole)), path
            orders = len(office.machine.orders)
            refused = await browser.head("/api/v1/stop")
            assert (refused.status_code, refused.headers["allow"]) == (405, "POST")
    assert not office.app.state.panel.hub, "no viewer is left"
    assert len(office.machine.orders) == orders, "nothing was stopped"


async def test_a_monitor_that_asks_for_the_head_sees_a_panel_that_lives() -> None:
    async with serving(Connections(100)) as (_, port):
        for path in ("/health", "/", "/api/v1/stream"):
            answer = await asked(port, f"HEAD {path} HTTP/1.1\nHost: 127.0.0.1:{{port}}\nConnection: close")
            assert answer.startswith(b"HTTP/1.1 200"), path
            assert answer.endswith(b"\r\n\r\n"), "no body follows the headers"
