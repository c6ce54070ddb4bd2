"""Every page as the panel renders it, in this process: no server, no browser, a clock that stands still."""

import re
import tempfile
from collections.abc import AsyncIterator, Iterable
from contextlib import asynccontextmanager
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from unittest.mock import patch

import httpx
from starlette.middleware import Middleware
from starlette.types import ASGIApp, Receive, Scope, Send

from app.base.clock import VirtualClock
from app.web.languages import CATALOGUE
from app.web.languages.catalogue import Catalogue
from app.web.languages.known import ENGLISH
from tests.browser.every_page import EVERY_PAGE, Leaf, Where
from tests.browser.panels import INVITED, built, furnish, home, session
from tests.fakes import PORT, FakeMachine, serving
from tests.web.filled import values_of

AT = datetime(2026, 6, 21, 9, 0, tzinfo=UTC)
TYPED = re.compile(r"<(?:input|textarea)\b[^>]*>")
PARTS = re.compile(r'hx-get="([^"]+)"\s+hx-trigger="load"')
HTMX = {"hx-request": "true", "hx-request-type": "partial"}


class Heard(dict[object, str]):
    """A catalogue without a text, which puts down what it is asked for."""

    def __init__(self) -> None:
        super().__init__()
        self.asked: set[str] = set()

    def __bool__(self) -> bool:
        return True

    def __missing__(self, key: object) -> str:
        self._put(key)
        raise KeyError(key)

    def get(self, key: object, default: object = None) -> object:
        self._put(key)
        return default

    def _put(self, key: object) -> None:
        self.asked.add(str(key[0] if isinstance(key, tuple) else key))


@dataclass(frozen=True, slots=True)
class Rendered:
    """What the panel answers for a page with its parts, and the texts of the catalogue that it asked for."""

    html: str
    texts: frozenset[str]


async def rendered(names: Iterable[str], at: datetime = AT) -> dict[str, Rendered]:
    """Return pages by their names, rendered in this order."""
    found: dict[str, Rendered] = {}
    wanted = list(names)
    kinds = dict.fromkeys(home(EVERY_PAGE[name].where) for name in wanted)
    for kind in kinds:
        async with _panel(kind, at) as panel:
            for name in wanted:
                if home(EVERY_PAGE[name].where) is kind:
                    found[name] = await panel.page(EVERY_PAGE[name])
    return found


async def everything() -> dict[str, Rendered]:
    """Return every page."""
    return await rendered(EVERY_PAGE)


@dataclass
class Ear:
    """Has the panel speak a catalogue that hears what is asked for."""

    heard: Heard = field(default_factory=Heard)
    catalogue: Catalogue | None = None

    def listen(self) -> None:
        """Begin anew; a new catalogue, as the panel keeps what it has made of one."""
        self.heard = Heard()
        self.catalogue = Catalogue(ENGLISH, read_blocks=lambda: self.heard)
        self.catalogue._catalog = self.heard

    def __call__(self, app: ASGIApp) -> ASGIApp:
        async def hear(scope: Scope, receive: Receive, send: Send) -> None:
            if self.catalogue is not None:
                CATALOGUE.set(self.catalogue)
            await app(scope, receive, send)

        return hear


@dataclass
class _Panel:
    client: httpx.AsyncClient
    ear: Ear
    sessions: dict[Where, str]

    async def page(self, leaf: Leaf) -> Rendered:
        """Return a page with the parts that it loads at once."""
        self.ear.listen()
        self.client.cookies.clear()
        if leaf.where in self.sessions:
            self.client.cookies.set(f"heliopanel-{PORT}", self.sessions[leaf.where])
        answer = await self.client.get(leaf.path, follow_redirects=True)
        if leaf.sends:
            fields = _wrong(answer.text, leaf.sends)
            answer = await self.client.post(leaf.sends, data=fields, follow_redirects=True)
        assert answer.status_code != 500, f"{leaf.path} cannot be shown"
        parts = [part.replace("&amp;", "&") for part in PARTS.findall(answer.text)]
        texts = [answer.text, *[(await self.client.get(part, headers=HTMX)).text for part in parts]]
        return Rendered("\n".join(texts), frozenset(self.ear.heard.asked))


def _wrong(page: str, action: str) -> dict[str, list[str]]:
    """Return a form as `SEND` of panels.py sends it: a wrong value in every field."""
    values = values_of(page, action)
    for tag in TYPED.findall(page):
        given = dict(re.findall(r'([\w-]+)="([^"]*)"', tag))
        kind = given.get("type", "text")
        if given.get("name") in values and kind in ("text", "password", "search", "number"):
            values[given["name"]] = ["" if kind == "number" else "x"]
    return values


@asynccontextmanager
async def _panel(kind: Where, at: datetime) -> AsyncIterator[_Panel]:
    with (
        tempfile.TemporaryDirectory(prefix="heliopanel-looks-") as folder,
        patch("app.web.features.security.network.addresses_here", lambda: ("192.0.2.7",)),
    ):
        machine = FakeMachine(VirtualClock(at))
        app = built(kind, Path(folder), machine)
        ear = Ear()
        app.user_middleware.append(Middleware(ear))
        async with serving(app) as client:
            await furnish(kind, app, machine, Path(folder))
            sessions = {one: await session(app, one) for one in INVITED} if kind is Where.STRANGER else {}
            yield _Panel(client, ear, sessions)
