"""Live sockets that flood a served product: they are closed, the controller lives, and Stop goes through."""

import httpx
import pytest

from app.web.live.live_protocol import FLOOD, FLOODED
from tests.e2e.integrator import Integrator
from tests.e2e.product import Product
from tests.fault_result import FaultResult
from tests.soak.rigs.flood import Flooding, ends, stops

SENT = 3000
SOCKETS = 200
ORDERS = "heliopanel_orders_total "


def orders(product: Product) -> float:
    """Return how many orders the controller has had."""
    text = httpx.get(f"{product.url}/metrics", timeout=20).text
    return next(float(line.split()[-1]) for line in text.splitlines() if line.startswith(ORDERS))


def reader(product: Product) -> str:
    """Return a new token that reads and stops, as a viewer does."""
    wish = {"name": "viewer", "scopes": ["read", "stop"]}
    answer = httpx.post(f"{product.url}/api/v1/tokens", json=wish, timeout=20)
    return str(answer.json()["token"])


@pytest.mark.fault(93)
@pytest.mark.parametrize("flood", [stops(SENT), ends(SENT)], ids=["stops", "ends"])
def test_a_socket_that_floods_is_closed_with_the_reason(
    product: Product, integrator: Integrator, flood: bytes, fault: FaultResult
) -> None:
    """It did end the controller; now next to none of it comes so far, and a Stop from elsewhere is obeyed."""
    token, before = reader(product), orders(product)
    page = Flooding.open(product.port, token)
    page.send(flood)
    assert integrator.call("POST", "/stop").status_code == 202
    assert page.closed() == (FLOODED, FLOOD)
    assert orders(product) - before <= 1 + 20
    assert len(product.starts("controller")) == 1
    fault.prevented("of 3,000 messages next to none is carried out")
    fault.shows(FLOOD)
    fault.recovers("the page is loaded again")


@pytest.mark.fault(93)
def test_two_hundred_sockets_that_flood_take_nobodys_stop(product: Product, integrator: Integrator) -> None:
    token, before = reader(product), orders(product)
    pages = []
    asked = 0
    for number in range(SOCKETS):
        page = Flooding.open(product.port, token)
        page.send(stops(SENT))
        pages.append(page)
        if number % 10 == 0:
            assert integrator.call("POST", "/stop").status_code == 202
            asked += 1
    assert {page.closed() for page in pages} == {(FLOODED, FLOOD)}
    assert orders(product) - before - asked <= SOCKETS * SENT // 100, "next to none of it is carried out"
    assert len(product.starts("controller")) == 1
    assert product.deaths() == []
