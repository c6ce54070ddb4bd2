"""Both ends of the link are in one process: its time is the patient loop's, see `tests/patient_loop.py`."""

from typing import Any

from tests.patient_loop import loops


def pytest_asyncio_loop_factories() -> Any:
    """Return the loop that a test runs on."""
    return loops(patient=True)
