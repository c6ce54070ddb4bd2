"""The panels that the pages are looked at on, each served once, and the visitors in front of them."""

import asyncio
import tempfile
import threading
from collections.abc import Callable, Coroutine, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from datetime import UTC, date, datetime, timedelta
from functools import partial
from pathlib import Path
from typing import Any

import httpx
from fastapi import FastAPI
from playwright.sync_api import Browser, BrowserContext, Page, expect

from app.access.accounts import TokenWish
from app.access.principal import this_computer
from app.access.roles import Role
from app.base.settings import Settings
from app.store.store import PlannedShow
from app.studies.compute import finished, work_out
from app.studies.folder import StudyFolder, StudyState, StudyStatus
from app.studies.light import clear_days
from app.studies.request import Span, StudyMode, StudyRequest, StudyStrategy
from app.tracker.programs.plan import ShowPlan
from app.tracker.settings.config import Orientation
from app.web.http.network import Stage, Trial
from app.web.main import create_app
from tests.access.fake_hasher import FakeHasher
from tests.browser.conftest import Served, listen, visitor_of
from tests.browser.every_page import SHOW_ID, STUDY_ID, Leaf, Where
from tests.browser.troubles import trouble
from tests.e2e.chromium import PAGE_READY
from tests.fake_alarms import alarm
from tests.fake_data import SAMSUN, TIME_ZONE
from tests.fakes import FakeMachine
from tests.patience import PATIENCE_MS, PATIENCE_S

PASSWORD = "violet-anvil-harbour-9"  # noqa: S105 - of people who do not exist
HERE = this_computer("127.0.0.1")
ALONE = (Where.CALM, Where.TROUBLED, Where.UNHEARD, Where.LOST, Where.DAMAGED, Where.CLOSED, Where.TRIAL)
LIVE = (Where.CALM, Where.LOST, Where.TROUBLED, Where.DAMAGED, Where.ADMINISTRATOR, Where.VIEWER, Where.KIOSK)
INVITED = (Where.ADMINISTRATOR, Where.VIEWER, Where.KIOSK)
PEOPLE = {"ada": Role.ADMINISTRATOR, "bartholomew-van-der-aa": Role.OPERATOR, "vera": Role.VIEWER}
NOON = datetime(2026, 6, 21, 12, tzinfo=UTC)
ALLOWED = ("Failed to load resource", "WebSocket connection", "htmx:error")
"""What a browser says of an answer that is a problem, and of a machine that is not heard."""
DRAWN = """document.fonts.ready
  .then(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))))"""
SEND = """action => {
  const form = [...document.forms].find(one => new URL(one.action, location).pathname === action);
  for (const one of form.elements) {
    if (['text', 'password', 'search', 'number'].includes(one.type) || one.tagName === 'TEXTAREA') {
      one.type === 'number' ? one.removeAttribute('value') : (one.value = 'x');
    }
  }
  form.submit();
}"""


def home(where: Where) -> Where:
    """Return the panel of whoever looks: people and the stranger share one."""
    return where if where in ALONE else Where.STRANGER


def keep_study(data: Path) -> None:
    """Work out a small study and keep it as the panel does."""
    request = StudyRequest(
        "Twelve days", SAMSUN, TIME_ZONE, Span.TWELVE_DAYS, date(2026, 6, 21),
        (StudyMode.AZIMUTH, StudyMode.DUAL), (StudyStrategy.CONTINUOUS,), Orientation(180.0, 48.7), 60,
    )  # fmt: skip
    days = clear_days(request)
    folder = StudyFolder(data)
    folder.open(StudyState(STUDY_ID, request.title, NOON, StudyStatus.DONE), request)
    folder.keep(STUDY_ID, finished(request, days, work_out(request, days, lambda *_: None), 0.2))


@dataclass
class Panel:
    """A panel that is served, and the machine behind it."""

    served: Served
    data: Path

    @property
    def url(self) -> str:
        return f"http://127.0.0.1:{self.port}"

    @property
    def port(self) -> int:
        assert self.served.server is not None
        port: int = self.served.server.servers[0].sockets[0].getsockname()[1]
        return port

    def do(self, work: Callable[[], object]) -> None:
        """Do something in the server's own thread, and wait until it is done."""
        done = threading.Event()
        assert self.served.loop is not None
        self.served.loop.call_soon_threadsafe(lambda: (work(), done.set()))
        assert done.wait(PATIENCE_S)


@contextmanager
def serving(where: Where) -> Iterator[Panel]:
    """Serve the panel of a kind on a free port for as long as the block lasts."""
    with tempfile.TemporaryDirectory(prefix="heliopanel-pages-") as folder:
        machine = FakeMachine()
        served = Served(machine, built(where, Path(folder), machine))
        thread = threading.Thread(target=lambda: asyncio.run(served.run()), daemon=True)
        thread.start()
        assert served.ready.wait(PATIENCE_S), "the panel did not start"
        panel = Panel(served, Path(folder))
        assert served.app is not None
        wait(panel, lambda: furnish(where, served.app, machine, panel.data))
        yield panel
        assert served.server is not None
        served.server.should_exit = True
        thread.join(PATIENCE_S)
        assert not thread.is_alive(), "the panel did not stop"


def built(where: Where, data: Path, machine: FakeMachine) -> FastAPI:
    """Return the panel's application, reachable from elsewhere or on trial where that is looked at."""
    settings = Settings(data_dir=data)
    if where is Where.CLOSED:
        settings = settings.model_copy(update={"host": "0.0.0.0"})
    if where is Where.STRANGER:
        notice = "Only for those who run this plant. Everything that is done is recorded."
        settings = settings.model_copy(update={"login_banner": notice})
    stage = None
    if where is Where.TRIAL:
        tried = Trial(settings.network, settings, HERE, "that-of-the-test")
        stage = Stage(settings, trial=tried)
    app = create_app(
        settings, machine=machine, reader=machine.store, clock=machine.clock, hasher=FakeHasher(), stage=stage
    )
    app.state.panel.simulations._pool = ThreadPoolExecutor(1)  # no process that loads everything once more
    return app


async def furnish(where: Where, app: FastAPI, machine: FakeMachine, data: Path) -> None:
    """Give a panel what its pages can show."""
    if where is Where.CALM:
        keep_study(data)
        plan = ShowPlan(
            SHOW_ID, NOON - timedelta(hours=8), NOON + timedelta(hours=7), timedelta(minutes=3), SAMSUN
        )
        machine.store.shows[SHOW_ID] = PlannedShow("T1", plan)
        await sign_records(app)
    elif where is Where.TROUBLED:
        trouble(machine)
    elif where is Where.UNHEARD:
        machine.cut()
    elif where is Where.DAMAGED:
        damage(machine)
    elif where is Where.STRANGER:
        await hire(app)


async def sign_records(app: FastAPI) -> None:
    """Sign two records, so that they can be compared."""
    signed = {
        "signatures": [{"role": "technician", "name": "Ada", "strokes": [[[9, 9], [500, 200]]]}],
        "confirmed": True,
    }
    async with httpx.AsyncClient(transport=httpx.ASGITransport(app), base_url="http://127.0.0.1") as client:
        for remark in ("Frost on the ground.", "After the sun check."):
            answer = await client.post("/api/v1/trackers/T1/records", json=signed | {"remark": remark})
            answer.raise_for_status()


def damage(machine: FakeMachine) -> None:
    machine.alarms = (alarm("store_damaged", machine.clock.now(), None),)
    machine.emit()


async def hire(app: FastAPI) -> None:
    """Add a user of every kind; others then stand before a door."""
    keeper = app.state.panel.keeper
    for name, role in PEOPLE.items():
        await keeper.do(partial(keeper.accounts.add, HERE, name, {role}, PASSWORD, keeper._clock.now()))


def wait(panel: Panel, work: Callable[[], Coroutine[Any, Any, Any]]) -> Any:
    """Return what a coroutine of the panel comes to."""
    assert panel.served.loop is not None
    return asyncio.run_coroutine_threadsafe(work(), panel.served.loop).result(PATIENCE_S)


async def session(app: FastAPI, where: Where) -> str:
    """Return the id of a new session of whoever looks."""
    keeper = app.state.panel.keeper
    if where is Where.KIOSK:
        wish = TokenWish("Cabinet north", pin="471108", lifetime=timedelta(days=90))
        token = await keeper.do(lambda: keeper.accounts.mint(HERE, wish, keeper._clock.now()))
        return str(await keeper.log_in_kiosk(token, "127.0.0.1", "test"))
    names = {Where.ADMINISTRATOR: "ada", Where.VIEWER: "vera"}
    return str(await keeper.log_in(names[where], PASSWORD, "127.0.0.1", "test"))


@dataclass
class Panels:
    """Every panel that has been asked for, and one browser in front of each."""

    browser: Browser
    stack: ExitStack
    scripts: tuple[str, ...] = ()
    known: dict[Where, Panel] = field(default_factory=dict)
    visitors: dict[Where, BrowserContext] = field(default_factory=dict)
    tabs: dict[Where, Page] = field(default_factory=dict)
    complaints: list[str] = field(default_factory=list)

    def at(self, where: Where) -> Panel:
        """Return the panel, served when it is first asked for; people and the stranger share one."""
        kind = home(where)
        if kind not in self.known:
            self.known[kind] = self.stack.enter_context(serving(kind))
        return self.known[kind]

    def visitor(self, where: Where) -> BrowserContext:
        """Return the browser of whoever looks."""
        if where not in self.visitors:
            panel = self.at(where)
            context = visitor_of(self.browser)
            for script in self.scripts:
                context.add_init_script(script)
            if where in INVITED:
                assert panel.served.app is not None
                cookie = {
                    "name": f"heliopanel-{panel.port}",
                    "value": wait(panel, lambda: session(panel.served.app, where)),
                    "url": panel.url,
                }
                context.add_cookies([cookie])
            self.visitors[where] = context
            self.stack.callback(context.close)
        return self.visitors[where]

    def tab(self, where: Where) -> Page:
        """Return the tab of whoever looks; to open another for every page takes twice as long."""
        if where not in self.tabs:
            self.tabs[where] = self.visitor(where).new_page()
            listen(self.tabs[where], self.complaints)
        return self.tabs[where]

    @contextmanager
    def shown(self, leaf: Leaf, language: str = "en", width: int = 390, height: int = 844) -> Iterator[Page]:
        """Show a page in a language until the block ends; nothing may be complained of in its console."""
        panel, page = self.at(leaf.where), self.tab(leaf.where)
        page.context.add_cookies([{"name": "language", "value": language, "url": panel.url}])
        self.complaints.clear()
        try:
            page.set_viewport_size({"width": width, "height": height})
            if leaf.where is Where.LOST:
                panel.do(panel.served.machine.mend)
            answer = page.goto(panel.url + leaf.path)
            assert answer is not None
            assert answer.status != 500, f"{leaf.path} cannot be shown"
            settle(page, leaf)
            if leaf.where is Where.LOST:
                panel.do(panel.served.machine.cut)
                page.wait_for_selector("#link-banner:visible")
            yield page
            page.evaluate("sessionStorage.clear()")
            page.goto("about:blank")
        except BaseException:
            self.tabs.pop(leaf.where).close()
            raise
        assert [one for one in self.complaints if not any(words in one for words in ALLOWED)] == []


def settle(page: Page, leaf: Leaf) -> None:
    """Do what is done to a page first, and wait until it is whole."""
    if leaf.sends:
        with page.expect_navigation():
            page.evaluate(SEND, leaf.sends)
    if leaf.where in LIVE:
        page.wait_for_selector(PAGE_READY)
    expect(page.locator('[hx-trigger="load"]:not(:has(dl))')).to_have_count(0, timeout=PATIENCE_MS)
    if leaf.unfolds:
        page.locator(leaf.unfolds).evaluate("list => { list.open = true; }")
    page.evaluate(DRAWN)


def resize(page: Page, width: int, height: int) -> None:
    """Give a page another size, its letters time to come, and its scripts two frames to follow."""
    page.set_viewport_size({"width": width, "height": height})
    page.evaluate(DRAWN)
