"""A panel and the pages before it on one clock, which only the test moves.

The panel has a `VirtualClock`, the pages have Playwright's `page.clock`; both show the same instant. What
they send each other arrives at the instant at which it was sent, however long the computer takes for it. An
answer over HTTP is waited for and takes no time. Transitions of CSS, painting, and workers are the browser's.
"""

import asyncio
import contextlib
from collections.abc import Callable, Coroutine, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

from playwright.sync_api import Browser, BrowserContext, Error, Page
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app.base.clock import VirtualClock
from tests.browser.conftest import Plant, Served, listen, running, visitor_of
from tests.e2e.chromium import PAGE_READY
from tests.fakes import FakeMachine
from tests.patience import PATIENCE_S

NOON = datetime(2027, 6, 21, 9, 40, tzinfo=UTC)
BEAT_MS = 50
"""The shortest interval of a page, that of a held key; a test's time goes on in such steps."""
LONG_MS = 60_000
IDLE_ROUNDS = 3
TAP = Path(__file__).with_name("socket_tap.js").read_text()
LEFT = "Execution context was destroyed"


@dataclass
class Line:
    """How much has gone over one live socket."""

    told: int = 0
    heard: int = 0
    over: bool = False


class Lines:
    """The panel's side of every live socket of tapped pages."""

    def __init__(self) -> None:
        self.known: dict[str, Line] = {}
        self._moved = asyncio.Event()

    def around(self, app: ASGIApp) -> ASGIApp:
        """Return an application that counts what goes over its live sockets."""

        async def counted(scope: Scope, receive: Receive, send: Send) -> None:
            name = _name(scope)
            if name is None:
                await app(scope, receive, send)
                return
            line = self.known[name] = Line()
            try:
                await app(scope, self._hearing(line, receive), self._telling(line, send))
            finally:
                line.over = True
                self._moved.set()

        return counted

    def _hearing(self, line: Line, receive: Receive) -> Receive:
        async def hear() -> Message:
            message = await receive()
            line.heard += message["type"] == "websocket.receive"
            line.over = line.over or message["type"] == "websocket.disconnect"
            self._moved.set()
            return message

        return hear

    def _telling(self, line: Line, send: Send) -> Send:
        async def tell(message: Message) -> None:
            line.told += message["type"] == "websocket.send"
            await send(message)

        return tell

    @property
    def told(self) -> dict[str, int]:
        """Return how many messages each open socket was given."""
        return {name: line.told for name, line in self.known.items() if not line.over}

    async def until_heard(self, sent: dict[str, int]) -> None:
        """Return once the panel has had this much of every socket that is open."""
        for name, number in sent.items():
            line = self.known[name]
            while line.heard < number and not line.over:
                self._moved.clear()
                await self._moved.wait()

    async def until_over(self, names: list[str]) -> None:
        """Return once the panel has done with these sockets."""
        while not all(self.known[name].over for name in names):
            self._moved.clear()
            await self._moved.wait()


def _name(scope: Scope) -> str | None:
    _, is_tapped, name = scope.get("query_string", b"").partition(b"tap=")
    return name.decode() if is_tapped and scope["type"] == "websocket" else None


class CountedThreads(ThreadPoolExecutor):
    """Threads that say whether one of them works."""

    at_work = 0

    def submit(self, *given: Any, **named: Any) -> Any:
        """Have one of them do something."""
        self.at_work += 1
        doing = super().submit(*given, **named)
        doing.add_done_callback(self._done)
        return doing

    def _done(self, _: object) -> None:
        self.at_work -= 1


@dataclass
class Stage:
    """The panel, its clock, and the browsers before it."""

    browser: Browser
    plant: Plant
    clock: VirtualClock
    lines: Lines
    contexts: list[BrowserContext] = field(default_factory=list)
    complaints: list[str] = field(default_factory=list)
    allowed: list[str] = field(default_factory=list)
    threads: CountedThreads = field(default_factory=CountedThreads)
    blocked: Page | None = None
    beat_ms: int = BEAT_MS
    """In such steps time goes on. Longer ones are quicker, but what is sent within one comes at its end."""

    def begin(self) -> None:
        """Know from now on of the panel's threads."""
        self.plant.loop.call_soon_threadsafe(self.plant.loop.set_default_executor, self.threads)
        self.settle()

    def visitor(
        self, size: str = "desk", *, touch: bool = False, theme: str = "day", language: str = ""
    ) -> BrowserContext:
        """Return a browser whose clock shows the panel's time."""
        context = visitor_of(self.browser, size, touch=touch)
        cookies = {"theme": theme, "language": language}
        context.add_cookies([{"name": n, "value": v, "url": self.plant.url} for n, v in cookies.items() if v])
        context.clock.install(time=self.clock.now())
        context.clock.pause_at(self.clock.now())
        context.add_init_script(TAP)
        self.contexts.append(context)
        return context

    def open(
        self,
        path: str,
        size: str = "desk",
        *,
        touch: bool = False,
        theme: str = "day",
        language: str = "",
        allow: tuple[str, ...] = (),
    ) -> Page:
        """Open a page in a browser of its own, and have it live; what it complains of fails the test."""
        self.allowed.extend(allow)
        return self.visit(self.visitor(size, touch=touch, theme=theme, language=language), path)

    def visit(self, visitor: BrowserContext, path: str) -> Page:
        """Open a page in a browser, and have it live."""
        page = visitor.new_page()
        listen(page, self.complaints)
        page.goto(self.plant.url + path)
        self.live(page)
        return page

    def live(self, page: Page) -> None:
        """Return once a page that was loaded is live, and its scripts have begun."""
        page.wait_for_selector(PAGE_READY)
        self.advance(self.beat_ms)
        while page.locator("[data-unseen]").count():
            self.advance(self.beat_ms)

    def advance(self, ms: int) -> None:
        """Let time pass for the panel and all pages, once what was done before has come to its end."""
        self.settle(hold=ms > 0)
        for begin_ms in range(0, ms, self.beat_ms):
            left_ms = ms - begin_ms
            self._beat(min(self.beat_ms, left_ms), more=left_ms > self.beat_ms)

    def until(self, reached: Callable[[], object], *, within_ms: int = LONG_MS) -> int:
        """Let time pass until something is so, and return how long that took in ms; or fail."""
        for passed_ms in range(0, within_ms + 1, self.beat_ms):
            if reached():
                return passed_ms
            self.advance(self.beat_ms)
        raise AssertionError(f"It did not become so within {within_ms} ms of the page's time.")

    def block(self, page: Page, ms: int) -> None:
        """Let time pass while the scripts of a page, alone in its browser, run on the spot and hear nothing.

        Afterwards all that was due is done once, as a browser does it.
        """
        self.settle(hold=True)
        self.blocked = page
        self.advance(ms)
        self.blocked = None
        page.clock.fast_forward(ms)
        self.settle()

    def leave(self, page: Page) -> None:
        """Close a page, and return once the panel knows that it has gone."""
        sockets = [one["id"] for one in page.evaluate("tap.places()")]
        page.close()
        self.ask(self.lines.until_over(sockets))
        self.settle()

    def do(self, work: Callable[[], object]) -> None:
        """Do something in the panel's thread, and have the pages hear what it tells of it."""

        async def done() -> None:
            work()

        self.ask(done())
        self.settle()

    def ask(self, work: Coroutine[Any, Any, Any]) -> Any:
        """Return what a coroutine of the panel comes to."""
        return asyncio.run_coroutine_threadsafe(work, self.plant.loop).result(PATIENCE_S)

    def settle(self, told: dict[str, int] | None = None, *, hold: bool = False) -> None:
        """Return once nothing is under way: all that was sent has come, and what it led to as well.

        With `hold`, what comes afterwards waits until it is settled again.
        """
        told = told or self.ask(self._quiet())
        while True:
            said = self._each("tap.settle", {"told": told, "hold": hold})
            sent = {one["id"]: one["sent"] for some in said for one in some}
            if told == (told := self.ask(self._answers(sent))):
                return

    def _beat(self, ms: int, *, more: bool) -> None:
        told = self.ask(self._step(timedelta(milliseconds=ms)))
        for context in self.contexts:
            if self.blocked is None or context is not self.blocked.context:
                context.clock.run_for(ms)
        self.settle(told, hold=more)

    async def _step(self, by: timedelta) -> dict[str, int]:
        end = self.clock.now() + by
        while self.clock.now() < end:
            self.clock.move_to(min(end, self.clock.next_wake or end))
            await self._quiet()
        return self.lines.told

    async def _answers(self, sent: dict[str, int]) -> dict[str, int]:
        await self.lines.until_heard(sent)
        return await self._quiet()

    async def _quiet(self) -> dict[str, int]:
        """Return, once the panel waits for nothing but time and pages, how much it has told each."""
        loop: Any = asyncio.get_running_loop()
        idle = 0
        while idle < IDLE_ROUNDS:
            await asyncio.sleep(0)
            idle = 0 if loop._ready or self.threads.at_work else idle + 1
        return self.lines.told

    def _each(self, work: str, given: object) -> list[Any]:
        """Return what every page that is open says to this."""
        pages = [one for context in self.contexts for one in context.pages if one is not self.blocked]
        return [_said(page, work, given) for page in pages]

    def close(self) -> None:
        """Close every browser; nothing may have been complained of in a console."""
        for context in self.contexts:
            context.close()
        said = [one for one in self.complaints if not any(words in one for words in self.allowed)]
        assert said == []


def _said(page: Page, work: str, given: object) -> Any:
    """Return what a page says; one that is just being loaded again says it afterwards."""
    while True:
        try:
            return page.evaluate(f"(given) => location.href === 'about:blank' ? [] : {work}(given)", given)
        except Error as error:
            if LEFT not in str(error):
                raise
            page.wait_for_load_state()


@contextlib.contextmanager
def staged(browser: Browser, served: Served | None = None) -> Iterator[Stage]:
    """Serve a panel on a clock that the test moves; a given one must be on a `VirtualClock`."""
    served = served or Served(FakeMachine(VirtualClock(NOON)))
    assert isinstance(served.machine.clock, VirtualClock)
    lines = Lines()
    served.around = lines.around
    with running(served) as plant:
        stage = Stage(browser, plant, served.machine.clock, lines)
        stage.begin()
        yield stage
        stage.close()
