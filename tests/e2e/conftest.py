"""The product, started once for each file of tests and ended by its id."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.e2e.integrator import Integrator
from tests.e2e.product import Product


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
