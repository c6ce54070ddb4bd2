"""The panel in front of a fake machine, as most tests of pages and calls want it."""

from collections.abc import AsyncIterator, Iterator
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import httpx
import pytest

from app.access.roles import Role
from app.web.services import simulations, studies
from tests.fakes import FakeMachine, fake_app, serving
from tests.web.desk import Desk
from tests.web.in_process import work_here
from tests.web.office import Office

TOLD_BY_A_PROCESS = studies._told


@pytest.fixture(scope="package", autouse=True)
def no_processes() -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        work_here(patch)
        yield


@pytest.fixture
def real_processes(monkeypatch: pytest.MonkeyPatch) -> None:
    """Have the panel start its workers as in service."""
    monkeypatch.setattr(simulations, "ProcessPoolExecutor", ProcessPoolExecutor)
    monkeypatch.setattr(studies, "_told", TOLD_BY_A_PROCESS)


@pytest.fixture
def machine() -> FakeMachine:
    return FakeMachine()


@pytest.fixture
async def client(machine: FakeMachine) -> AsyncIterator[httpx.AsyncClient]:
    async with serving(fake_app(machine)) as browser:
        yield browser


@pytest.fixture
async def desk(tmp_path: Path) -> AsyncIterator[Desk]:
    async with Desk(tmp_path) as one:
        yield one


@pytest.fixture
async def office(tmp_path: Path) -> AsyncIterator[Office]:
    """A panel with a user of every role."""
    office = Office(tmp_path)
    async with office.app.router.lifespan_context(office.app):
        await office.hire(*Role)
        yield office
