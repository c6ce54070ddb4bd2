"""A panel with one user of every role, a movable clock and quick hashes."""

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from datetime import datetime, timedelta
from pathlib import Path
from typing import Any

import httpx
from fastapi import FastAPI

from app.access.accounts import TokenWish
from app.access.authenticator import Keeper
from app.access.principal import this_computer
from app.access.roles import Role
from app.access.tokens import Scope
from app.base.clock import Clock, SystemClock
from app.web.main import create_app
from tests.access.fake_hasher import FakeHasher
from tests.fakes import PORT, FakeMachine, settings

PASSWORD = "violet-anvil-harbour-9"  # noqa: S105 - of people who do not exist
COOKIE = f"heliopanel-{PORT}"
ORIGIN = f"http://127.0.0.1:{PORT}"
HERE = this_computer("127.0.0.1")


class MovableClock(SystemClock):
    """The system's clock, set forward by `ahead`; waiting takes real time."""

    ahead = timedelta()

    def now(self) -> datetime:
        return super().now() + self.ahead


class Office:
    """A panel, its machine, and browsers in front of it."""

    def __init__(
        self, folder: Path, *, host: str = "127.0.0.1", clock: Clock | None = None, notice: str = ""
    ) -> None:
        self.clock = clock or MovableClock()
        self.machine = FakeMachine(self.clock)
        self.hasher = FakeHasher()
        self.settings = settings().model_copy(
            update={"data_dir": folder, "host": host, "login_banner": notice}
        )
        self.app: FastAPI = create_app(
            self.settings,
            machine=self.machine,
            reader=self.machine.store,
            clock=self.clock,
            hasher=self.hasher,
        )
        self.keeper: Keeper = self.app.state.panel.keeper

    async def hire(self, *roles: Role) -> None:
        """Add a user of each of these roles, named as the role, the administrator first."""
        for role in sorted(set(roles) | {Role.ADMINISTRATOR}):
            now = self.clock.now()
            await self.keeper.do(
                lambda role=role, now=now: self.keeper.accounts.add(HERE, role + "-1", {role}, PASSWORD, now)
            )

    async def session(self, name: str) -> str:
        """Return the id of a new session."""
        return await self.keeper.log_in(name + "-1", PASSWORD, "127.0.0.1", "test")

    async def mint(self, *scopes: Scope, name: str = "scada", **more: Any) -> str:
        """Return a new token for this, as a program sends it."""
        wish, now = TokenWish(name, frozenset(scopes), **more), self.clock.now()
        return await self.keeper.do(lambda: self.keeper.accounts.mint(HERE, wish, now))

    async def bearer(self, *scopes: Scope, **more: Any) -> dict[str, str]:
        """Return what a program with a new token for this sends."""
        return {"authorization": f"Bearer {await self.mint(*scopes, **more)}"}

    @asynccontextmanager
    async def browser(
        self, session_id: str = "", address: str = "127.0.0.1", app: Any = None
    ) -> AsyncIterator[httpx.AsyncClient]:
        """Give a browser that holds this session."""
        transport = httpx.ASGITransport(app or self.app, client=(address, 50000))
        cookies = {COOKIE: session_id} if session_id else None
        headers = {"origin": ORIGIN, "sec-fetch-site": "same-origin"}
        async with httpx.AsyncClient(
            transport=transport, base_url=ORIGIN, cookies=cookies, headers=headers
        ) as client:
            yield client
