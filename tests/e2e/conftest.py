"""The product and a simulated drive, started once for each file of tests and ended by their ids."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.e2e.eyes import Eyes
from tests.e2e.integrator import Integrator
from tests.e2e.product import DriveSim, Product


@pytest.fixture(scope="module")
def drive() -> Iterator[DriveSim]:
    started = DriveSim.start()
    yield started
    started.stop()


@pytest.fixture(scope="module")
def product(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Product]:
    folder: Path = tmp_path_factory.mktemp("e2e")
    started = Product.start(folder / "data")
    yield started
    started.stop()


@pytest.fixture
def integrator(product: Product) -> Iterator[Integrator]:
    calling = Integrator(product.url)
    yield calling
    calling.close()


@pytest.fixture
def eyes(drive: DriveSim) -> Iterator[Eyes]:
    watching = Eyes(drive.port)
    yield watching
    watching.close()
