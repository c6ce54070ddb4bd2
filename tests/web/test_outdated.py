"""A page of another build or from before the machine's last start orders nothing but Stop, and is told so."""

import re
from typing import Any

import httpx
import pytest

from app.web.http.build_id import PageOutdated, edition, mark_of
from tests.fakes import FakeMachine, FakeReader, fake_app, serving
from tests.fault_result import FaultResult
from tests.web.sockets import connected

JOG = {
    "type": "jog",
    "tracker_id": "T1",
    "press_id": "p",
    "axis": "azimuth",
    "direction": 1,
    "speed": "slow",
    "rtt_ms": 5,
}


def mark_in(page: httpx.Response) -> str:
    found = re.search(r'data-page="([^"]+)"', page.text)
    assert found is not None
    assert page.text.count(f'name="page" value="{found[1]}"') > 3
    return found[1]


@pytest.mark.fault(61)
async def test_a_page_from_before_a_restart_orders_nothing_but_stop(
    fault: FaultResult,
) -> None:
    machine = FakeMachine()
    async with serving(fake_app(machine, FakeReader())) as client:
        mark = mark_in(await client.get("/trackers/T1"))
        assert mark == f"{edition()}.fake-boot"
        assert (await client.post("/trackers/T1/park", data={"page": mark})).status_code == 303
        machine.start_again()
        for sent in ({"data": {"page": mark}}, {"headers": {"X-Page": mark, "HX-Request": "true"}}):
            refused = await client.post("/trackers/T1/park", **sent)
            assert (refused.status_code, refused.headers["page-outdated"]) == (409, "1")
            assert str(PageOutdated()) in refused.text
        fault.shows(str(PageOutdated()))
        assert (await client.post("/trackers/T1/stop", data={"page": mark})).status_code == 303
        again = mark_in(await client.get("/trackers/T1"))
        assert (await client.post("/trackers/T1/park", data={"page": again})).status_code == 303
    assert [order.command.kind for order in machine.orders] == ["park", "stop", "park"]
    fault.prevented("refused at the first request")
    fault.recovers("automatic: the page is loaded again")


@pytest.mark.fault(61)
@pytest.mark.parametrize(
    ("mark", "status"),
    [
        ("0123456789ab.fake-boot", 409),
        ("0123456789ab.", 409),
        ("{build}.", 303),
        ("{build}.other", 409),
        ("", 303),
    ],
)
async def test_a_page_of_another_build_orders_nothing(mark: str, status: int) -> None:
    machine = FakeMachine()
    async with serving(fake_app(machine, FakeReader())) as client:
        sent = {"page": mark.format(build=edition())}
        assert (await client.post("/trackers/T1/park", data=sent)).status_code == status


@pytest.mark.fault(61)
async def test_an_outdated_page_moves_nothing_by_its_socket_and_is_told_the_build() -> None:
    machine = FakeMachine()
    app = fake_app(machine, FakeReader())
    async with app.router.lifespan_context(app):
        mark = mark_of(machine.latest())
        async with connected(app, f"tracker=T1&page={mark}") as socket:
            told: dict[str, Any] = await socket.next("state")
            assert (told["build"], told["boot"]) == (edition(), "fake-boot")
            machine.start_again()
            await socket.send(**JOG, sequence=0, tc=0)
            refused = await socket.next("jog")
            assert refused["reasons"][0]["code"] == "page_outdated"
            await socket.send(type="stop_all")
            await socket.next("stopped")
    assert [order.command.kind for order in machine.orders] == ["stop_all"]
