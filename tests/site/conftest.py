"""Plants for the stories of this folder, and proof that none leaves a task behind."""

import asyncio
from collections.abc import AsyncIterator
from typing import Any

import pytest

from tests.patient_loop import loops
from tests.site.plant import Plant, make_plant


def pytest_asyncio_loop_factories(item: pytest.Item) -> Any:
    """Return the loop that a test runs on: time-outs of the loop are judged on the patient one."""
    return loops(patient=item.path.name == "test_waiting.py")


@pytest.fixture
async def plant() -> AsyncIterator[Plant]:
    built = make_plant()
    await built.start()
    yield built
    await built.close()


@pytest.fixture(autouse=True)
async def no_task_is_left() -> AsyncIterator[None]:
    before = asyncio.all_tasks()
    yield
    left = asyncio.all_tasks() - before - {asyncio.current_task()}
    assert not [task for task in left if not task.done()]
