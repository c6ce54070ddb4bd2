"""Plants for the stories of this folder, and proof that none leaves a task behind."""

import asyncio
from collections.abc import AsyncIterator, Callable, Mapping

import pytest

from tests.patient_loop import PatientLoop
from tests.site.plant import Plant, make_plant


def pytest_asyncio_loop_factories(
    config: pytest.Config, item: pytest.Item
) -> Mapping[str, Callable[[], asyncio.AbstractEventLoop]]:
    """Return the loop that a test runs on: time-outs of the loop are judged on the patient one."""
    assert isinstance(item, pytest.Function)
    if item.module.__name__ == "tests.site.test_waiting":
        return {"patient": PatientLoop}
    return {"real": asyncio.new_event_loop}


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
