"""Both ends of the link are in one process: its time is the patient loop's, see `tests/patient_loop.py`."""

import asyncio
from collections.abc import Callable, Mapping

import pytest

from tests.patient_loop import PatientLoop


def pytest_asyncio_loop_factories(
    config: pytest.Config, item: pytest.Item
) -> Mapping[str, Callable[[], asyncio.AbstractEventLoop]]:
    """Return the loop that a test runs on."""
    if item.get_closest_marker("real_time"):
        return {"real": asyncio.new_event_loop}
    return {"patient": PatientLoop}
