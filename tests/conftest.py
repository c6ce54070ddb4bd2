"""What all tests share: they stay on this computer; the same drawn examples in every run; none is timed."""

import gc
import os
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from hypothesis import settings

from app.base import outliving
from tests.fault_result import FaultResult
from tests.loopback import sitecustomize as guard
from tests.patience import TEST_S

pytest_plugins = ["tests.order"]
guard.stay_here()
sys.modules["sniffio"] = None  # type: ignore[assignment] # httpx looks for it on the disk at every request
os.environ.setdefault("PYTEST_TIMEOUT", str(TEST_S))
# A product under test must not take the processor from what judges it; tests/soak has it in real time.
os.environ["HELIOPANEL_REAL_TIME"] = "off"
settings.register_profile("same", derandomize=True, deadline=None, max_examples=40)
settings.register_profile("new", deadline=None)
settings.load_profile("new" if "HELIOPANEL_SOAK" in os.environ else "same")


@pytest.fixture(scope="session", autouse=True)
def runtime_directory() -> Iterator[Path | None]:
    """Give controllers that are killed a place in memory to leave something, and remove what they left."""
    if not outliving.SHARED_MEMORY.is_dir():
        yield None
        return
    with tempfile.TemporaryDirectory(dir=outliving.SHARED_MEMORY, prefix="tests-") as place:
        os.environ["RUNTIME_DIRECTORY"] = place
        yield Path(place)


def pytest_collection_finish() -> None:
    """Spare every later collection of garbage what was loaded with all tests: it stays."""
    gc.collect()
    gc.freeze()


@pytest.fixture
def fault(record_property: Callable[[str, object], None]) -> FaultResult:
    """Hand what a test of a row of the fault table measured to the page of faults."""
    return FaultResult(record_property)
