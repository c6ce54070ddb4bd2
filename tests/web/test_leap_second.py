"""23:59:60 comes in from clocks that count leap seconds: it is taken as 23:59:59, at every door."""

import httpx
import pytest

from app.base.instants import without_leap_second
from app.link.messages import SetClock
from tests.fakes import FakeMachine
from tests.fault_result import FaultResult

CLOCK = "/trackers/T1/commissioning/clock"


@pytest.mark.parametrize(
    ("text", "taken"),
    [
        ("2016-12-31T23:59:60Z", "2016-12-31T23:59:59Z"),
        ("2016-12-31T23:59:60.750+00:00", "2016-12-31T23:59:59+00:00"),
        ("2017-01-01T05:29:60+05:30", "2017-01-01T05:29:59+05:30"),
        ("2016-12-31T23:59:61Z", "2016-12-31T23:59:61Z"),
        ("23:59:60 o'clock", "23:59:60 o'clock"),
    ],
)
def test_only_a_second_60_is_clamped(text: str, taken: str) -> None:
    assert without_leap_second(text) == taken


@pytest.mark.fault(31)
async def test_the_api_and_the_pages_take_a_leap_second_as_the_second_before(
    machine: FakeMachine, client: httpx.AsyncClient, fault: FaultResult
) -> None:
    machine.rest()
    asked = {"source": "manual", "at": "2026-12-31T23:59:60Z", "confirmed": True}
    device = {"source": "device", "at": "2026-12-31T23:59:60Z", "confirmed": "yes"}
    assert (await client.put("/api/v1/site/clock", json=asked)).status_code == 200
    assert (await client.post(CLOCK, data=device)).status_code == 303
    typed = {"date": "2026-12-31", "time": "23:59:60", "time_zone": "UTC", "confirmed": "yes"}
    assert (await client.post(f"{CLOCK}/shadow", data=typed)).status_code == 303
    told = [order.command for order in machine.orders]
    assert [one.at.isoformat() for one in told if isinstance(one, SetClock) and one.at is not None] == [
        "2026-12-31T23:59:59+00:00"
    ] * 3

    no_second = {"source": "manual", "at": "2026-12-31T23:59:61Z"}
    assert (await client.put("/api/v1/site/clock", json=no_second)).status_code == 422
    sun = await client.get("/api/v1/sun", params={"at": "2026-12-31T23:59:60+00:00"})
    assert sun.json()["at"] == "2026-12-31T23:59:59Z"
    later = {"since": "2026-12-31T23:59:60Z", "until": "2027-01-01T00:00:00Z"}
    assert (await client.get("/api/v1/journal", params=later)).status_code == 200
    fault.prevented("it is taken as the second before")
    fault.shows_nothing("it is taken as the second before")
    fault.recovers("nothing was lost")
