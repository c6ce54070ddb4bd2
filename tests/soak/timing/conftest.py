"""The product, a simulated drive, and a browser: started once for each file of tests, ended by their ids."""

from collections.abc import Callable, Iterator

import pytest

from tests.e2e.chromium import Chromium, Tab, chromium
from tests.e2e.conftest import integrator, product
from tests.e2e.product import DriveSim, Product
from tests.e2e.proxy import Network, network
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


@pytest.fixture
def cable(product: Product) -> Iterator[Network]:
    """A network between browser and panel."""
    with network(product.port) as laid:
        yield laid


@pytest.fixture(scope="module")
def browser() -> Iterator[Chromium]:
    with chromium() as started:
        yield started


@pytest.fixture
def opened(product: Product, browser: Chromium) -> Iterator[Callable[..., Tab]]:
    """What opens a page in a tab of its own, which is closed at the end if it is still there."""
    tabs: list[Tab] = []

    def open_page(path: str, url: str = product.url) -> Tab:
        tabs.append(browser.tab(url + path))
        return tabs[-1]

    yield open_page
    left = {one["targetId"] for one in browser.send("Target.getTargets")["targetInfos"]}
    for tab in tabs:
        if tab.target in left:
            tab.close()
