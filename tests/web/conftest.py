"""The panel in front of a fake machine, as most tests of pages and calls want it."""

from collections.abc import AsyncIterator

import httpx
import pytest

from tests.fakes import FakeMachine, fake_app, serving


@pytest.fixture
def machine() -> FakeMachine:
    return FakeMachine()


@pytest.fixture
async def client(machine: FakeMachine) -> AsyncIterator[httpx.AsyncClient]:
    async with serving(fake_app(machine)) as browser:
        yield browser
