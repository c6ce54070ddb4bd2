"""The panel moves to another address while it is used, over real sockets: kept if confirmed, else back."""

import json
import re
import signal
import socket
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import httpx
import pytest

from app.base.network import read_network
from app.base.settings import Settings
from app.web.http.network import NOT_CONFIRMED, NOT_SERVED
from tests.patience import PATIENCE_S, until
from tests.ports import free_port

ROOT = Path(__file__).resolve().parents[2]
MOMENTS = 10
"""A panel that goes back is gone within its farewell, 2 s of its clock: seven moments."""


@dataclass
class Moving:
    """A panel in a process of its own, and a browser on the same computer."""

    folder: Path
    port: int
    process: "subprocess.Popen[bytes]"
    told: Counter[str] = field(default_factory=Counter)
    """What its log is to tell of the tests that ran: each event, and how often."""

    @classmethod
    def start(cls, folder: Path) -> "Moving":
        port = free_port()
        command = [sys.executable, "-m", "tests.web.hasty_panel", str(folder), str(port)]
        moving = cls(folder, port, subprocess.Popen(command, cwd=ROOT, stderr=subprocess.PIPE))
        try:
            until(lambda: moving.is_there(port), f"the panel answers on {port}")
        except TimeoutError:
            moving.process.kill()
            raise AssertionError(f"The panel did not start: {moving.process.communicate()[1]!r}") from None
        return moving

    def ask(self, method: str, port: int, path: str, **more: Any) -> httpx.Response:
        return httpx.request(method, f"http://127.0.0.1:{port}{path}", timeout=PATIENCE_S, **more)

    def is_there(self, port: int) -> bool:
        with suppress(httpx.TransportError):
            return self.ask("GET", port, "/health").status_code == 200
        return False

    def until(self, port: int, *, there: bool = True) -> None:
        """Let moments pass until the panel answers at a port, or does not any more."""

        def is_so() -> bool:
            self.process.send_signal(signal.SIGUSR1)
            return self.is_there(port) is there

        until(is_so, f"the panel {'answers' if there else 'has left'} on {port}")

    def let_a_minute_pass(self) -> None:
        self.process.send_signal(signal.SIGUSR2)

    def propose(self, port: int) -> str:
        change = {"host": "127.0.0.1", "port": port, "tls": False}
        answer = self.ask("PUT", self.port, "/api/v1/network", json=change)
        assert answer.status_code == 202, answer.text
        return str(answer.json()["ticket"])

    def until_taken_back(self, why: str) -> None:
        """Let moments pass until the panel is where it was and says why."""
        until(lambda: self._says(why), f"the panel says: {why}")

    def _says(self, why: str) -> bool:
        self.process.send_signal(signal.SIGUSR1)
        with suppress(httpx.TransportError):
            return bool(self.state()["last_rollback"] == why)
        return False

    def state(self) -> dict[str, Any]:
        found: dict[str, Any] = self.ask("GET", self.port, "/api/v1/network").json()
        return found


@pytest.fixture(scope="module")
def moving(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Moving]:
    started = Moving.start(tmp_path_factory.mktemp("moving"))
    yield started
    started.process.terminate()
    _, log = started.process.communicate()
    events = [json.loads(line).get("event") for line in log.splitlines() if line.startswith(b"{")]
    assert {event: events.count(event) for event in started.told} == started.told


def test_what_nobody_confirms_is_taken_back(moving: Moving) -> None:
    tried = free_port()
    ticket = moving.propose(tried)
    moving.until(tried)
    assert not moving.is_there(moving.port)
    page = moving.ask("GET", tried, f"/network/trial?ticket={ticket}").text
    assert "Keep address" in page
    assert Settings(data_dir=moving.folder).port == moving.port
    moving.let_a_minute_pass()
    moving.until(moving.port)
    moving.told["network_rolled_back"] += 1
    assert not moving.is_there(tried)
    assert moving.state()["last_rollback"] == NOT_CONFIRMED
    assert "The last change was reverted." in moving.ask("GET", moving.port, "/network").text


def test_what_cannot_be_served_is_taken_back_at_once(moving: Moving) -> None:
    tried = free_port()
    moving.propose(tried)
    with socket.create_server(("127.0.0.1", tried)):
        moving.until_taken_back(NOT_SERVED)
    moving.told["network_rolled_back"] += 1


def test_what_is_confirmed_there_is_kept(moving: Moving) -> None:
    tried, before = free_port(), moving.port
    ticket = moving.propose(tried)
    moving.until(tried)
    page = moving.ask("GET", tried, f"/network/trial?ticket={ticket}").text
    action = re.search(r'action="(/network/trial[^"]+)"', page)
    assert action is not None
    assert "Network address confirmed" in moving.ask("POST", tried, action[1]).text
    moving.told["network_kept"] += 1
    moving.port = tried
    moving.let_a_minute_pass()
    for _ in range(MOMENTS):
        moving.process.send_signal(signal.SIGUSR1)
        assert moving.is_there(tried)
    assert not moving.is_there(before)
    assert (moving.state()["confirm_until"], moving.state()["last_rollback"]) == (None, "")
    assert read_network(moving.folder)["port"] == tried
