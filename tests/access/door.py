"""A keeper of the door on a virtual clock, and who comes to it."""

from datetime import UTC, datetime
from pathlib import Path

import pytest

from app.access.accounts import TokenWish
from app.access.authenticator import Credentials, Keeper
from app.access.events import AccessEvent
from app.access.opening import open_keeper
from app.access.principal import Principal, Via, this_computer
from app.access.roles import Role
from app.access.sign_in_errors import WrongPassword
from app.base.clock import VirtualClock
from app.base.settings import Settings
from tests.access.fake_hasher import FakeHasher

START = datetime(2026, 11, 21, 12, tzinfo=UTC)
PASSWORD = "violet-anvil-harbour-9"  # noqa: S105 - of people who do not exist
HERE = this_computer("127.0.0.1")
ADDRESS = "10.0.0.9"


class Door:
    """A keeper with quick hashes on a clock that stands until it is moved."""

    def __init__(
        self,
        folder: Path,
        database: str | None = None,
        *,
        host: str = "127.0.0.1",
        begins_at: datetime = START,
    ) -> None:
        self.clock = VirtualClock(begins_at)
        self.hasher = FakeHasher()
        self.settings = Settings(data_dir=folder, database_url=database).model_copy(update={"host": host})
        self.keeper: Keeper = open_keeper(self.settings, self.clock, self.hasher)

    async def add(self, name: str, *roles: Role) -> None:
        now = self.clock.now()
        await self.keeper.do(lambda: self.keeper.accounts.add(HERE, name, roles, PASSWORD, now))

    async def tries(self, name: str, password: str, address: str = ADDRESS) -> str:
        return await self.keeper.log_in(name, password, address, "test")

    async def fails(self, name: str, address: str = ADDRESS) -> None:
        """Try a wrong password, and be told that it is wrong."""
        with pytest.raises(WrongPassword):
            await self.tries(name, "wrong wrong wrong", address)

    def via(self, session_id: str) -> Via:
        return self.keeper.identify(Credentials(ADDRESS, session_id)).via

    def who(self, session_id: str, address: str = ADDRESS) -> Principal:
        return self.keeper.identify(Credentials(address, session_id))

    async def mint(self, wish: TokenWish, by: Principal = HERE) -> str:
        now = self.clock.now()
        return await self.keeper.do(lambda: self.keeper.accounts.mint(by, wish, now))

    async def recorded(self) -> list[AccessEvent]:
        """Return what was recorded, the oldest first."""
        return [one.event for one in reversed(await self.keeper.events(None, 1000))]
