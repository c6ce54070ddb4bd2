"""What all tests share: they stay on this computer; the same drawn examples in every run; none is timed."""

import gc
import os
from collections.abc import Callable

import pytest
from hypothesis import settings

from tests.fault_result import FaultResult
from tests.loopback import sitecustomize as guard

pytest_plugins = ["tests.order"]
guard.stay_here()
settings.register_profile("same", derandomize=True, deadline=None)
settings.register_profile("new", deadline=None)
settings.load_profile("new" if "HELIOPANEL_SOAK" in os.environ else "same")


def pytest_collection_finish() -> None:
    """Spare every later collection of garbage what was loaded with all tests: it stays."""
    gc.collect()
    gc.freeze()


@pytest.fixture
def fault(record_property: Callable[[str, object], None]) -> FaultResult:
    """Hand what a test of a row of the fault table measured to the page of faults."""
    return FaultResult(record_property)
