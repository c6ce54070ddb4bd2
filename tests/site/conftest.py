"""Plants and stores for the stories of this folder, and proof that no plant leaves a task behind."""

import asyncio
import shutil
from collections.abc import AsyncIterator, Iterator
from pathlib import Path
from typing import Any

import pytest

from app.store.engine import open_writer
from app.store.migrations import upgrade
from app.store.writer import DatabaseWriter
from tests.patient_loop import loops
from tests.site.plant import Begun, Plant, make_plant
from tests.site.tracking_field import homed


def pytest_asyncio_loop_factories(item: pytest.Item) -> Any:
    """Return the loop that a test runs on: time-outs of the loop are judged on the patient one."""
    return loops(patient=item.path.name == "test_waiting.py")


@pytest.fixture
async def begun() -> AsyncIterator[Begun]:
    """Begin plants as `make_plant` makes them, or made ones; they are closed after the test."""
    plants: list[Plant] = []

    async def begin(made: Plant | None = None, **given: Any) -> Plant:
        plants.append(made or make_plant(**given))
        await plants[-1].start()
        return plants[-1]

    yield begin
    for one in plants:
        await one.close()


@pytest.fixture
async def plant(begun: Begun) -> Plant:
    return await begun()


@pytest.fixture
async def ready(begun: Begun) -> Plant:
    """A site whose place and time are set, with a tracker that is homed."""
    return await begun(homed())


@pytest.fixture
async def tracked(begun: Begun) -> Plant:
    """A site whose tracker tracks."""
    plant = await begun(homed(tracks=True))
    await plant.until(lambda seen: seen.in_position)
    return plant


@pytest.fixture(scope="session")
def made_store(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A file with tables and nothing in them, to be copied."""
    path = tmp_path_factory.mktemp("made") / "heliopanel.db"
    upgrade(f"sqlite:///{path}")
    return path


@pytest.fixture
def store(made_store: Path, tmp_path: Path) -> Iterator[DatabaseWriter]:
    shutil.copy(made_store, tmp_path / "heliopanel.db")
    opened = open_writer(f"sqlite:///{tmp_path / 'heliopanel.db'}")
    yield opened
    opened.close()


@pytest.fixture(autouse=True)
async def no_task_is_left() -> AsyncIterator[None]:
    before = asyncio.all_tasks()
    yield
    left = asyncio.all_tasks() - before - {asyncio.current_task()}
    assert not [task for task in left if not task.done()]
