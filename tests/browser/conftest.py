"""The panel on a machine in memory, served on a free port, and Debian's Chromium in front of it."""

import asyncio
import contextlib
import os
import socket
import threading
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from datetime import timedelta
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
import uvicorn
from fastapi import FastAPI
from playwright.sync_api import Browser, BrowserContext, ConsoleMessage, Page, expect, sync_playwright

from tests.e2e.chromium import PAGE_READY
from tests.e2e.chromium import PROGRAM as CHROMIUM
from tests.e2e.chromium import QUIET as FLAGS
from tests.e2e.letters import environment
from tests.fake_store import FakeReader
from tests.fakes import FakeMachine, fake_app
from tests.patience import PATIENCE_MS, PATIENCE_S
from tests.web.in_process import be_patient

if TYPE_CHECKING:
    from tests.browser.page_clock import Stage

SCREENS = Path(__file__).resolve().parents[2] / "build" / "screens"
TAKES_PICTURES = "HELIOPANEL_SCREENS" in os.environ
"""Whether pages are photographed: `make browser` wants that, as it takes time."""
PICTURES = Path(__file__).resolve().parents[2] / "docs" / "pictures"
WRITES_DOCS = os.environ.get("HELIOPANEL_DOCS") == "1"
GUIDE = {
    "step-location": "location-1024",
    "step-clock": "clock-1024",
    "step-homing": "homing-1024",
    "step-mode": "mode-1024",
    "step-run": "run-1024",
    "log-in-wait": "log-in-1024",
    "kiosk-pin": "kiosk-1024",
    "session-ended": "session-ended-1280",
    "network": "network-1280",
    "network-try": "network-try-1280",
    "show-on-the-machine": "show-running-1280",
    "replay": "player-1280",
}
"""Which pictures of the guide the tests take where documents are written, by what the tests call them."""
SIZES = {"desk": (1280, 800), "tablet": (1024, 768), "phone": (390, 844)}
SOFTWARE_NOTE = "GPU stall due to ReadPixels"
"""Chromium's remark on WebGL without a graphics card, when a page is photographed; it says nothing of it."""
BEAT = timedelta(milliseconds=100)
BEGUN_MS = 1000
"""After this time of a page all of its scripts have begun, and its way forward saves."""
EMPTY = "/health"
"""What has no script, and so can forget what the panel's pages keep in this browser."""
CYCLES_OF_AN_ACCEPT = 5
"""So often a loop turns, at the most, between accepting a connection and closing it."""


@dataclass
class Plant:
    """A served panel and the machine behind it."""

    url: str
    machine: FakeMachine
    server: uvicorn.Server
    loop: asyncio.AbstractEventLoop

    def orders(self, kind: str) -> list[Any]:
        return [order.command for order in list(self.machine.orders) if order.command.kind == kind]

    def do(self, work: Callable[[], object]) -> None:
        """Do something in the server's own thread."""
        self.loop.call_soon_threadsafe(work)


class PassingServer(uvicorn.Server):
    """A server whose loop ends with it: no connection is left for a later test to be warned of.

    A browser connects in advance, and what connects while the server shuts down is no longer closed.
    """

    def __init__(self, config: uvicorn.Config, ready: threading.Event | None = None) -> None:
        super().__init__(config)
        self._ready = ready or threading.Event()

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        await super().startup(sockets)
        if self.started:
            self._ready.set()

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        await super().shutdown(sockets)
        for _ in range(CYCLES_OF_AN_ACCEPT):
            for connection in list(self.server_state.connections):
                connection.transport.abort()
            await asyncio.sleep(0)


@dataclass
class Served:
    machine: FakeMachine
    app: FastAPI | None = None
    ready: threading.Event = field(default_factory=threading.Event)
    server: uvicorn.Server | None = None
    loop: asyncio.AbstractEventLoop | None = None
    around: Callable[[Any], Any] = lambda app: app
    """What a test puts between the server and the panel."""

    async def run(self) -> None:
        self.loop = asyncio.get_running_loop()
        self.app = self.app or fake_app(self.machine)
        config = uvicorn.Config(
            self.around(self.app), host="127.0.0.1", port=0, log_level="error", timeout_graceful_shutdown=1
        )
        self.server = PassingServer(config, self.ready)
        moving = asyncio.create_task(self._move())
        try:
            await self.server.serve()
        finally:
            moving.cancel()
            with contextlib.suppress(asyncio.CancelledError):
                await moving

    async def _move(self) -> None:
        while True:
            if self.machine.reachable:
                self.machine.tick()
            await self.machine.clock.sleep_until(self.machine.clock.now() + BEAT)


@contextlib.contextmanager
def running(served: Served | None = None) -> Iterator[Plant]:
    """Serve a panel on a free port for as long as the block lasts."""
    served = served or Served(FakeMachine())
    thread = threading.Thread(target=lambda: asyncio.run(served.run()), daemon=True)
    thread.start()
    assert served.ready.wait(PATIENCE_S), "the panel did not start"
    assert served.server is not None
    assert served.loop is not None
    port = served.server.servers[0].sockets[0].getsockname()[1]
    yield Plant(f"http://127.0.0.1:{port}", served.machine, served.server, served.loop)
    served.server.should_exit = True
    thread.join(PATIENCE_S)
    assert not thread.is_alive(), "the panel did not stop"


@pytest.fixture(scope="package", autouse=True)
def patient() -> Iterator[None]:
    """Have the panel wait for its calculations as long as tests wait."""
    with pytest.MonkeyPatch.context() as patch:
        be_patient(patch)
        yield


@pytest.fixture(scope="package")
def browser() -> Iterator[Browser]:
    """Run one browser for this folder; Playwright's loop must have ended before other tests run theirs."""
    if not Path(CHROMIUM).exists():
        pytest.fail("These tests need Chromium: apt-get install -y chromium-headless-shell")
    expect.set_options(timeout=PATIENCE_MS)
    with sync_playwright() as playwright:
        started = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS, env=environment())
        yield started
        started.close()


Opened = Callable[..., Page]


def listen(page: Page, complaints: list[str]) -> None:
    """Put down every error and warning of a page's console, and what its scripts do not catch."""

    def complain(message: ConsoleMessage) -> None:
        if message.type in ("error", "warning") and SOFTWARE_NOTE not in message.text:
            complaints.append(f"{message.type}: {message.text} {message.location.get('url', '')}")

    page.on("console", complain)
    page.on("pageerror", lambda error: complaints.append(f"uncaught: {error}"))


def visitor_of(browser: Browser, size: str = "desk", *, touch: bool = False) -> BrowserContext:
    """Return a browser of somebody at the site, with such a screen."""
    width, height = SIZES[size]
    context = browser.new_context(
        viewport={"width": width, "height": height},
        has_touch=touch,
        locale="en-GB",
        timezone_id="Europe/Istanbul",
    )
    context.set_default_timeout(PATIENCE_MS)
    return context


def renew(machine: FakeMachine) -> None:
    """Have a machine as it was at first; what holds it, and who reads it, goes on."""
    fresh = vars(FakeMachine(machine.clock))
    kept = {name: vars(machine)[name] for name in ("_outlet", "store", "sequence")}
    vars(machine.store).update(vars(FakeReader()))
    vars(machine).update(fresh | kept)
    machine.emit()


def now(plant: Plant, work: Callable[[], object]) -> None:
    """Do something in the server's own thread, and wait until it is done."""
    ready = threading.Event()
    plant.do(lambda: (work(), ready.set()))
    assert ready.wait(PATIENCE_S)


@dataclass
class Tab:
    """A page that is used again, and what its console says."""

    page: Page
    complaints: list[str] = field(default_factory=list)

    def forget(self, url: str) -> None:
        """Have it as a new one: nothing kept, nothing intercepted."""
        self.page.unroute_all(behavior="ignoreErrors")
        self.page.goto(url + EMPTY)
        self.page.evaluate("localStorage.clear(); sessionStorage.clear()")
        self.page.context.clear_cookies()
        self.page.mouse.move(0, 0)
        self.complaints.clear()


@dataclass
class Home:
    """A panel, and the tabs in front of it: with and without a touch screen, a clock that stands still."""

    browser: Browser
    plant: Plant
    known: dict[tuple[bool, bool], Tab] = field(default_factory=dict)

    def tab(self, *, touch: bool, still: bool) -> Tab:
        if (touch, still) not in self.known:
            context = visitor_of(self.browser, touch=touch)
            if still:
                instant = self.plant.machine.clock.now()
                context.clock.install(time=instant)
                context.clock.pause_at(instant)
            tab = self.known[touch, still] = Tab(context.new_page())
            listen(tab.page, tab.complaints)
        return self.known[touch, still]

    def drop(self) -> None:
        """Close all tabs: what a failed test did to them is not undone."""
        while self.known:
            self.known.popitem()[1].page.context.close()


@pytest.fixture(scope="package")
def home(browser: Browser) -> Iterator[Home]:
    """One panel and tabs in front of it for the tests of many files; each test finds both as new.

    A page in a tab that was open before costs half the processor time of a page in a new one.
    """
    with running() as served:
        found = Home(browser, served)
        yield found
        found.drop()


@pytest.fixture
def plant(home: Home) -> Plant:
    now(home.plant, lambda: renew(home.plant.machine))
    return home.plant


@pytest.fixture
def opened(home: Home, plant: Plant, request: pytest.FixtureRequest) -> Iterator[Opened]:
    """Open a page in the tab; any console error, any uncaught error fails the test.

    With `still` the clock of the page stands but for what the test lets pass, by `page.clock.run_for`.
    """
    allowed: list[str] = []
    used: list[Tab] = []
    failed = request.session.testsfailed

    def open_page(
        path: str,
        size: str = "desk",
        *,
        touch: bool = False,
        still: bool = False,
        theme: str = "day",
        language: str = "en",
        allow: tuple[str, ...] = (),
    ) -> Page:
        allowed.extend(allow)
        tab = home.tab(touch=touch, still=still)
        if tab not in used:
            used.append(tab)
        width, height = SIZES[size]
        tab.page.set_viewport_size({"width": width, "height": height})
        cookies = {"theme": theme, "language": language}
        tab.page.context.add_cookies(
            [{"name": name, "value": value, "url": plant.url} for name, value in cookies.items()]
        )
        go(tab.page, plant.url + path)
        if still:
            tab.page.clock.run_for(BEGUN_MS)
        return tab.page

    yield open_page
    complaints = [one for tab in used for one in tab.complaints]
    if request.session.testsfailed > failed:
        home.drop()
    for tab in used:
        if tab in home.known.values():
            tab.forget(plant.url)
    assert [one for one in complaints if not any(words in one for words in allowed)] == []


def go(page: Page, url: str) -> None:
    """Open a page and wait until its values are live and its scripts have come."""
    page.goto(url)
    page.wait_for_selector(PAGE_READY)


def resize(page: Page, size: str) -> None:
    """Give a page another size; what follows the size has done so when this returns."""
    width, height = SIZES[size]
    page.set_viewport_size({"width": width, "height": height})
    page.evaluate("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")


@pytest.fixture
def stage(browser: Browser) -> "Iterator[Stage]":
    """A panel with a machine in memory, and pages before it, on a clock that only the test moves."""
    from tests.browser.page_clock import staged  # noqa: PLC0415 - it is built on what is here

    with staged(browser) as found:
        yield found


@pytest.fixture
def picture() -> Callable[[Page, str], None]:
    """Photograph a page where pictures are wanted; either way its letters have come."""

    def take(page: Page, name: str) -> None:
        if WRITES_DOCS and name in GUIDE:
            page.evaluate("document.fonts.ready.then(() => null)")
            page.screenshot(path=PICTURES / f"{GUIDE[name]}.png")
        elif TAKES_PICTURES:
            page.screenshot(path=SCREENS / f"{name}.png")
        else:
            page.evaluate("document.fonts.ready.then(() => null)")

    return take
