"""Drives are tested on a loop that does not state how busy the computer is, unless a test says otherwise."""

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
