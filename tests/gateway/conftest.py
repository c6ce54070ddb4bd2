"""SunSpec has both ends in one process: its time is the patient loop's. Brokers are other processes."""

import asyncio
from collections.abc import Callable, Mapping

import pytest

from tests.patient_loop import PatientLoop

PATIENT = {"tests.gateway.test_sunspec", "tests.gateway.test_mqtt_lanes", "tests.gateway.test_quiet_door"}


def pytest_asyncio_loop_factories(
    config: pytest.Config, item: pytest.Item
) -> Mapping[str, Callable[[], asyncio.AbstractEventLoop]]:
    """Return the loop that a test runs on."""
    assert isinstance(item, pytest.Function)
    if item.module.__name__ in PATIENT:
        return {"patient": PatientLoop}
    return {"real": asyncio.new_event_loop}
