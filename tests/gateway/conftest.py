"""SunSpec has both ends in one process: its time is the patient loop's. Brokers are other processes."""

from typing import Any

import pytest

from tests.patient_loop import loops

PATIENT = {"test_sunspec.py", "test_mqtt_lanes.py", "test_quiet_door.py"}


def pytest_asyncio_loop_factories(item: pytest.Item) -> Any:
    """Return the loop that a test runs on."""
    return loops(patient=item.path.name in PATIENT)
