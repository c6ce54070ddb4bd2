"""Instants as the world brings them: taken as they are meant, or refused with a sentence, everywhere."""

import httpx
import pytest

from app.link.messages import SetClock
from tests.fakes import FakeMachine
from tests.fault_result import FaultResult
from tests.golden.table import rows
from tests.web.filled import filled

ROWS = rows("world/instants.csv")
CLOCK = "/trackers/T1/commissioning/clock"
DAYS = ["0001-01-01", "1900-12-31", "2100-01-01", "9999-12-31"]
ENDS = ["1901-01-01", "2099-12-31"]
REFUSED = "Date: choose a day in the years 1901 to 2099."


def of_clock(machine: FakeMachine) -> list[SetClock]:
    return [order.command for order in machine.orders if isinstance(order.command, SetClock)]


@pytest.mark.fault(102)
@pytest.mark.parametrize("row", ROWS, ids=[row["text"] for row in ROWS])
async def test_an_instant_is_taken_or_refused_with_a_sentence(
    row: dict[str, str], machine: FakeMachine, client: httpx.AsyncClient, fault: FaultResult
) -> None:
    at, taken = row["text"], row["taken"] == "yes"
    asked = {"source": "manual", "at": at, "confirmed": True}
    by_api = await client.put("/api/v1/site/clock", json=asked)
    by_device = await client.post(f"{CLOCK}/device", data={"at": at})
    assert by_api.status_code == (200 if taken else 422), by_api.text
    assert by_device.status_code == (303 if taken else 422), by_device.text
    assert len(of_clock(machine)) == (2 if taken else 0)
    for path in ("/api/v1/journal?start=", "/api/v1/sun?at=", "/api/v1/audit?start="):
        answer = await client.get(path + at.replace("+", "%2B"))
        assert answer.status_code == (200 if taken else 422), (path, answer.text)
        assert taken or answer.json()["detail"], "a sentence says what to do"
    if not taken:
        fault.shows(by_api.json()["detail"])
        fault.recovers("with an instant of 1970 to 2099")


@pytest.mark.parametrize("day", [*DAYS, *ENDS])
@pytest.mark.parametrize("zone", ["Pacific/Kiritimati", "Etc/GMT+12", "UTC"])
async def test_a_typed_day_outside_the_years_of_the_sun_is_refused_at_its_field(
    day: str, zone: str, machine: FakeMachine, client: httpx.AsyncClient
) -> None:
    answer = await client.post(CLOCK, data={"date": day, "time": "12:00:00", "time_zone": zone})
    assert answer.status_code == (303 if day in ENDS else 422), answer.text
    assert day in ENDS or REFUSED in answer.text


@pytest.mark.parametrize("day", DAYS)
@pytest.mark.parametrize("weather", ["none", "storm", "steps"])
async def test_a_day_outside_the_years_of_the_sun_is_not_simulated(
    day: str, weather: str, client: httpx.AsyncClient
) -> None:
    typed = {"tracker": "T1", "date": day, "weather": weather, "steps": "08:00 4"}
    form = await filled(client, "/simulate", typed)
    answer = await client.post("/simulate", data=form)
    assert answer.status_code == 422
    assert REFUSED in answer.text
