"""Two operators fight for a tracker: what the one who lost control had sent moves nothing, however late."""

import asyncio
import threading
from collections.abc import Callable, Coroutine, Iterator
from dataclasses import dataclass, field
from datetime import timedelta
from pathlib import Path
from typing import Any

import pytest
import uvicorn
from fastapi import FastAPI
from playwright.sync_api import Browser, Page, expect

from app.access.principal import this_computer
from app.access.roles import Role
from app.base.clock import SystemClock
from app.base.settings import Settings
from app.simulation.simulated import SimulatedDrive
from app.site.site import Site
from app.tracker.memory.memory import SiteState
from app.tracker.state.snapshot import ActivityName, Event, EventKind
from app.web.main import create_app
from tests.access.fake_hasher import FakeHasher
from tests.browser.conftest import PassingServer
from tests.browser.hands import LINK_MEASURED, LOOK_EVERY_MS, middle, until
from tests.e2e.chromium import PAGE_READY
from tests.e2e.proxy import network
from tests.fake_store import FakeReader
from tests.site.plant import FIRST

HOMING = "/trackers/T1/commissioning/homing"
KEY = '[data-jog="azimuth"][data-direction="1"]'
PASSWORD = "violet-anvil-harbour-9"  # noqa: S105 - of people who do not exist
PRESSES, LOOKS = 8, 30
PASSES_MS = 16_000
LOOK_EVERY = timedelta(milliseconds=20)


@dataclass
class Panel:
    """A panel with its real site, both in a thread of their own."""

    folder: Path
    ready: threading.Event = field(default_factory=threading.Event)
    events: list[Event] = field(default_factory=list)

    async def run(self) -> None:
        clock = SystemClock()
        self.loop = asyncio.get_running_loop()
        self.site = Site(clock, lambda config: SimulatedDrive(config, clock), SiteState(), (FIRST,))
        settings = Settings(data_dir=self.folder)
        self.app: FastAPI = create_app(
            settings, machine=self.site, reader=FakeReader(), clock=clock, hasher=FakeHasher()
        )
        config = uvicorn.Config(
            self.app, host="127.0.0.1", port=0, log_level="error", timeout_graceful_shutdown=1
        )
        self.server = PassingServer(config)
        await self.site.start()
        listening = asyncio.create_task(self._listen())
        waiting = asyncio.create_task(self._wait(clock))
        await self.server.serve()
        await waiting
        await self.site.close()
        await listening

    async def _wait(self, clock: SystemClock) -> None:
        for _ in range(1000):
            if self.server.started:
                break
            await clock.sleep_until(clock.now() + LOOK_EVERY)
        self.ready.set()

    async def _listen(self) -> None:
        async for update in self.site.updates():
            self.events.extend(update.events)

    def do(self, work: Coroutine[Any, Any, Any]) -> Any:
        return asyncio.run_coroutine_threadsafe(work, self.loop).result(20)

    @property
    def port(self) -> int:
        return int(self.server.servers[0].sockets[0].getsockname()[1])

    def session(self, name: str, *roles: Role) -> str:
        keeper, here = self.app.state.panel.keeper, this_computer("127.0.0.1")
        now = SystemClock().now()
        self.do(keeper.do(lambda: keeper.accounts.add(here, name, set(roles), PASSWORD, now)))
        return str(self.do(keeper.log_in(name, PASSWORD, "127.0.0.1", "test")))

    def tracker(self) -> Any:
        latest = self.site.latest()
        assert latest is not None
        return latest.trackers[0]


@pytest.fixture(scope="module")
def panel(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Panel]:
    started = Panel(tmp_path_factory.mktemp("panel"))
    thread = threading.Thread(target=lambda: asyncio.run(started.run()), daemon=True)
    thread.start()
    assert started.ready.wait(20), "the panel did not start"
    yield started
    started.server.should_exit = True
    thread.join(20)
    assert not thread.is_alive(), "the panel did not stop"


def opened(browser: Browser, url: str, port: int, session: str) -> Page:
    context = browser.new_context(viewport={"width": 1280, "height": 800})
    context.add_cookies([{"name": f"heliopanel-{port}", "value": session, "url": url}])
    context.set_default_timeout(25_000)
    page = context.new_page()
    page.goto(url + HOMING)
    page.wait_for_selector(PAGE_READY)
    return page


def hold(page: Page, panel: Panel) -> None:
    """Press the key until the axis moves; a busy computer ends a hold, as it must, and one presses again."""
    page.wait_for_selector(LINK_MEASURED)
    page.mouse.move(*middle(page.locator(KEY)))
    for _ in range(PRESSES):
        page.mouse.down()
        for _ in range(LOOKS):
            page.wait_for_timeout(LOOK_EVERY_MS)
            if panel.tracker().activity is ActivityName.JOGGING:
                return
        page.mouse.up()
    pytest.fail("The axis never moved while the key was held.")


@pytest.mark.fault(55)
@pytest.mark.fault(56)
def test_nothing_that_the_loser_sent_is_carried_out(
    browser: Browser, panel: Panel, picture: Callable[[Page, str], None]
) -> None:
    panel.session("root", Role.ADMINISTRATOR)
    sessions = [panel.session(name, Role.OPERATOR, Role.ENGINEER) for name in ("ada", "bo")]
    with network(panel.port) as slow:
        ada = opened(browser, slow.url, panel.port, sessions[0])
        bo = opened(browser, f"http://127.0.0.1:{panel.port}", panel.port, sessions[1])
        hold(ada, panel)
        ada.mouse.up()
        expect(ada.locator("#control")).to_have_attribute("data-state", "mine")
        expect(bo.locator("#control")).to_have_attribute("data-state", "held")
        bo.locator("#control > summary").click()
        bo.locator(".control-take summary").click()
        bo.fill("#control-reason", "I stand at the machine")
        picture(bo, "control-take")
        bo.get_by_role("button", name="Take over").click()
        expect(ada.locator("#control")).to_have_attribute("data-state", "wished")
        picture(ada, "control-wished")

        hold(ada, panel)
        before = panel.do(panel.site.metrics()).orders_refused
        slow.freeze()
        ada.wait_for_timeout(200)
        ada.mouse.up()
        ada.evaluate(LATE)
        expect(bo.locator("#control")).to_have_attribute("data-state", "mine", timeout=PASSES_MS)
        assert panel.tracker().activity is ActivityName.HOLDING
        place, told = panel.tracker().measured, len(panel.events)

        slow.thaw()
        until(bo, lambda: panel.do(panel.site.metrics()).orders_refused > before)
        bo.wait_for_timeout(800)
        assert panel.tracker().measured == place
        assert not [one for one in panel.events[told:] if one.kind is EventKind.JOG_STARTED]

        hold(bo, panel)
        bo.mouse.up()
        expect(ada.locator("#control")).to_have_attribute("data-state", "held")
        picture(ada, "control-held")


LATE = """() => {
  const epoch = document.querySelector('input[name="epoch"]').value;
  const headers = { "HX-Request": "true", "X-CSRF-Token": document.documentElement.dataset.csrf };
  const body = new URLSearchParams({ move: "azimuth-plus", size: "5", key: "late", epoch });
  fetch("/trackers/T1/step", { method: "POST", headers, body }).catch(() => {});
}"""
