"""Drives are tested on a loop that does not state how busy the computer is, unless a test says otherwise."""

from typing import Any

import pytest

from tests.patient_loop import loops


def pytest_asyncio_loop_factories(item: pytest.Item) -> Any:
    """Return the loop that a test runs on."""
    return loops(patient=item.get_closest_marker("real_time") is None)
