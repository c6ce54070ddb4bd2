"""Who must leave is put out of every stream within a second, whoever revoked what let them in."""

import asyncio
from collections.abc import AsyncIterator, Callable
from contextlib import AbstractAsyncContextManager
from datetime import timedelta
from pathlib import Path
from typing import Any

import pytest

from app.access.accounts import Accounts
from app.access.opening import open_store
from app.access.passwords import Passwords
from app.access.roles import Role
from app.access.tokens import Scope
from app.base.clock import VirtualClock
from tests.access.fake_hasher import FakeHasher
from tests.fake_data import NOON
from tests.fault_result import VIRTUAL, FaultResult
from tests.patience import PATIENCE_S
from tests.web.asgi import Reading, streaming
from tests.web.office import COOKIE, HERE, ORIGIN, Office
from tests.web.sockets import Socket, connected

WITHIN = timedelta(milliseconds=900)
WAYS_IN = ("session", "token")
Opening = Callable[..., AbstractAsyncContextManager[Any]]


@pytest.fixture
def clock() -> VirtualClock:
    return VirtualClock(NOON)


@pytest.fixture
async def office(tmp_path: Path, clock: VirtualClock) -> AsyncIterator[Office]:
    office = Office(tmp_path, clock=clock)
    async with office.app.router.lifespan_context(office.app):
        await office.hire(Role.OPERATOR)
        yield office


async def way_in(office: Office, way: str) -> tuple[dict[str, str], Callable[[Accounts], None]]:
    """Return what opens a stream, and what takes just that away."""
    now = office.clock.now()
    if way == "session":
        session = await office.session(Role.OPERATOR)
        (digest,) = office.keeper.book.sessions
        headers = {"cookie": f"{COOKIE}={session}", "origin": ORIGIN}
        return headers, lambda accounts: accounts.end_session(HERE, digest, now)
    headers = await office.bearer(Scope.READ, Scope.STOP)
    (token_id,) = office.keeper.book.tokens
    return headers, lambda accounts: accounts.revoke(HERE, token_id, now)


async def first_of(stream: Reading | Socket) -> None:
    await stream.next("snapshot" if isinstance(stream, Reading) else "state")


@pytest.mark.fault(63)
@pytest.mark.parametrize("way", WAYS_IN)
@pytest.mark.parametrize("opening", [streaming, connected])
async def test_what_a_page_revokes_ends_at_once(office: Office, way: str, opening: Opening) -> None:
    headers, take_away = await way_in(office, way)
    async with opening(office.app, headers=headers) as stream:
        await first_of(stream)
        await office.keeper.do(lambda: take_away(office.keeper.accounts))
        await asyncio.wait_for(stream.ended.wait(), PATIENCE_S)
    assert office.clock.now() == NOON


@pytest.mark.fault(63)
@pytest.mark.parametrize("way", WAYS_IN)
@pytest.mark.parametrize("opening", [streaming, connected])
async def test_what_the_command_line_revokes_ends_within_a_second(
    office: Office, clock: VirtualClock, way: str, opening: Opening, fault: FaultResult
) -> None:
    headers, take_away = await way_in(office, way)
    elsewhere = open_store(office.settings)
    async with opening(office.app, headers=headers) as stream:
        await first_of(stream)
        take_away(Accounts(elsewhere, Passwords(FakeHasher())))
        elsewhere.close()
        clock.advance(WITHIN)
        await asyncio.wait_for(stream.ended.wait(), PATIENCE_S)
    fault.noticed(WITHIN.total_seconds(), VIRTUAL)
    fault.recovers("a new token is made, or the user signs in again")


@pytest.mark.fault(63)
async def test_a_token_that_expires_ends_its_stream_within_a_second(
    office: Office, clock: VirtualClock
) -> None:
    headers, _ = await way_in(office, "token")
    (token,) = office.keeper.book.tokens.values()
    async with streaming(office.app, headers=headers) as stream:
        await first_of(stream)
        clock.move_to(token.expires_at)
        await asyncio.wait_for(stream.ended.wait(), PATIENCE_S)
