"""Headless Chromium as a process of its own, driven over its DevTools socket: it can be frozen and killed."""

import json
import os
import signal
import subprocess
import tempfile
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from websockets.sync.client import ClientConnection, connect

from tests.e2e.letters import environment
from tests.loopback.sitecustomize import CHROMIUM_FLAGS
from tests.patience import PATIENCE_S
from tests.patience import until as eventually

PROGRAM = os.environ.get("HELIOPANEL_TEST_BROWSER", "/usr/bin/chromium-headless-shell")
"""Chromium without its windows: the same engine, at two thirds of the processor time for each page."""
QUIET = [
    "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-sync",
    "--disable-background-networking", "--disable-component-update", "--disable-dev-shm-usage",
    "--disable-features=WebUIOmniboxPopup,WebUIOmniboxAimPopup", *CHROMIUM_FLAGS,
]  # fmt: skip
"""The last but one: two hidden pages of the address bar, for every page of ours, took a third of a core."""
FLAGS = ["--headless", "--remote-debugging-port=0", "--window-size=1280,800", *QUIET]
PAGE_READY = 'html[data-link="live"]:not([data-keeping])'
"""A page whose values are live, and whose scripts have all come."""
LARGEST_ANSWER = 64 * 1024 * 1024


@dataclass
class Chromium:
    """One browser: its process group and the socket that drives it."""

    process: "subprocess.Popen[bytes]"
    folder: "tempfile.TemporaryDirectory[str]"
    socket: ClientConnection
    closing: ExitStack
    events: list[dict[str, Any]] = field(default_factory=list)
    asked: int = 0

    @classmethod
    def start(cls) -> "Chromium":
        """Return once it takes orders."""
        assert Path(PROGRAM).exists(), "These tests need Chromium: apt-get install -y chromium-headless-shell"
        folder = tempfile.TemporaryDirectory(prefix="e2e-chromium-", ignore_cleanup_errors=True)
        process = subprocess.Popen(
            [PROGRAM, *FLAGS, f"--user-data-dir={folder.name}", "about:blank"],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
            env=environment(),
        )
        told = Path(folder.name) / "DevToolsActivePort"
        eventually(lambda: told.exists() and len(told.read_text().splitlines()) == 2, "Chromium listens")
        port, path = told.read_text().splitlines()
        closing = ExitStack()
        link = connect(f"ws://127.0.0.1:{port}{path}", max_size=LARGEST_ANSWER, compression=None)
        return cls(process, folder, closing.enter_context(link), closing)

    def send(self, method: str, session: str | None = None, **params: Any) -> dict[str, Any]:
        """Give an order and return its answer."""
        self.asked += 1
        number = self.asked
        order: dict[str, Any] = {"id": number, "method": method, "params": params}
        self.socket.send(json.dumps(order | ({"sessionId": session} if session else {})))
        while (message := json.loads(self.socket.recv(PATIENCE_S))).get("id") != number:
            self.events.append(message)
        assert "error" not in message, message
        return dict(message["result"])

    def tab(self, url: str) -> "Tab":
        """Open a page in a new tab, in front, and return once it is live."""
        target = self.send("Target.createTarget", url="about:blank")["targetId"]
        session = self.send("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        tab = Tab(self, str(target), str(session))
        tab.goto(url)
        return tab

    def signal(self, number: signal.Signals) -> float:
        """Send a signal to every process of this browser and return when."""
        os.killpg(self.process.pid, number)
        return time.monotonic()

    def close(self) -> None:
        """End it, whatever state it is in."""
        with suppress(ProcessLookupError):
            os.killpg(self.process.pid, signal.SIGKILL)
        self.process.wait()
        self.closing.close()
        self.folder.cleanup()


@dataclass
class Tab:
    """One page."""

    browser: Chromium
    target: str
    session: str

    def send(self, method: str, **params: Any) -> dict[str, Any]:
        """Give this page an order."""
        return self.browser.send(method, self.session, **params)

    def goto(self, url: str) -> None:
        """Open a page and return once it is live."""
        self.send("Page.navigate", url=url)
        self.until("document.documentElement?.dataset.link === 'live'", "the page is live")

    def evaluate(self, expression: str) -> Any:
        """Return what an expression is worth on the page."""
        answer = self.send("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        assert "exceptionDetails" not in answer, answer
        return answer["result"].get("value")

    def until(self, expression: str, what: str, *, within_s: float = PATIENCE_S) -> None:
        """Return once an expression is true on the page, or fail."""
        eventually(lambda: self.evaluate(expression), what, within_s=within_s)

    def middle(self, selector: str) -> tuple[float, float]:
        """Return the middle of an element, which is scrolled into view."""
        x, y = self.evaluate(
            f"(() => {{ const found = document.querySelector({selector!r}); "
            "found.scrollIntoView({block: 'nearest'}); const box = found.getBoundingClientRect(); "
            "return [box.x + box.width / 2, box.y + box.height / 2]; })()"
        )
        return float(x), float(y)

    def mouse(self, kind: str, at: tuple[float, float]) -> None:
        """Move, press or release the left button of a real pointer."""
        pressed = {"button": "left", "clickCount": 1} if kind != "mouseMoved" else {}
        self.send("Input.dispatchMouseEvent", type=kind, x=at[0], y=at[1], **pressed)

    def click(self, selector: str) -> float:
        """Press and release the left button on an element; return when it was pressed."""
        at = self.middle(selector)
        self.mouse("mouseMoved", at)
        pressed_at = time.monotonic()
        self.mouse("mousePressed", at)
        self.mouse("mouseReleased", at)
        return pressed_at

    def fingers(self, kind: str, *points: tuple[float, float]) -> None:
        """Touch the page with these fingers."""
        touched = [{"x": x, "y": y, "id": number} for number, (x, y) in enumerate(points)]
        self.send("Input.dispatchTouchEvent", type=kind, touchPoints=touched)

    def key(self, kind: str, key: str, code: str, number: int) -> None:
        """Press or release a key of the keyboard."""
        text = {"text": key} if kind == "keyDown" and len(key) == 1 else {}
        self.send(
            "Input.dispatchKeyEvent", type=kind, key=key, code=code, windowsVirtualKeyCode=number, **text
        )

    def close(self) -> None:
        """Close this tab."""
        self.browser.send("Target.closeTarget", targetId=self.target)


@contextmanager
def chromium() -> Iterator[Chromium]:
    """Run a browser for a while."""
    started = Chromium.start()
    try:
        yield started
    finally:
        started.close()
