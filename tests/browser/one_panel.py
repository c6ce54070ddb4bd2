"""One panel and one tab for the tests of many files; each test finds both as new.

A page in a tab that was open before costs half the processor time of a page in a new one. A file says
`from tests.browser.one_panel import opened, plant`, and names them in `__all__`.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from threading import Event

import pytest
from playwright.sync_api import Browser, Page

from tests.browser.conftest import SIZES, Opened, Plant, listen, visitor_of
from tests.e2e.chromium import PAGE_READY
from tests.fake_store import FakeReader
from tests.fakes import FakeMachine
from tests.patience import PATIENCE_S

BEGUN_MS = 50
"""After this time of a page all of its scripts have begun."""
EMPTY = "/health"
"""What has no script, and so can forget what the panel's pages keep in this browser."""


def renew(machine: FakeMachine) -> None:
    """Have a machine as it was at first; what holds it, and who reads it, goes on."""
    fresh = vars(FakeMachine(machine.clock))
    kept = {name: vars(machine)[name] for name in ("_outlet", "store", "sequence")}
    vars(machine.store).update(vars(FakeReader()))
    vars(machine).update(fresh | kept)
    machine.emit()


def now(plant: Plant, work: Callable[[], object]) -> None:
    """Do something in the server's own thread, and wait until it is done."""
    ready = Event()
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
