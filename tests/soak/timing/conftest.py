"""The product and a simulated drive, started once for each file of tests and ended by their ids."""

from collections.abc import Iterator

import pytest

from tests.e2e.conftest import integrator, product
from tests.e2e.product import DriveSim
from tests.soak.rigs.eyes import Eyes

__all__ = ["drive", "eyes", "integrator", "product"]


@pytest.fixture(scope="module")
def drive() -> Iterator[DriveSim]:
    started = DriveSim.start()
    yield started
    started.stop()


@pytest.fixture
def eyes(drive: DriveSim) -> Iterator[Eyes]:
    watching = Eyes(drive.port)
    yield watching
    watching.close()
