"""What ended in a 500: the ends of the calendar, a PIN where there is none; a 500 says that it hangs up."""

from pathlib import Path

import httpx
import pytest

from app.access.roles import Role
from tests.fault_result import FaultResult
from tests.web.office import Office

T1 = "/api/v1/trackers/T1"


@pytest.mark.fault(96)
@pytest.mark.parametrize("day", ["1900-12-31", "9999-12-31"])
async def test_a_day_outside_the_years_of_the_sun_is_refused_with_a_sentence(
    client: httpx.AsyncClient, day: str, fault: FaultResult
) -> None:
    sentence = f"Sun positions are available for the years 1901 to 2099, not for {day}."
    for answer in (
        await client.get("/api/v1/sun/day", params={"step_s": 3600, "date": day}),
        await client.post(f"{T1}/shows", json={"date": day, "duration_s": 600}),
        await client.post("/api/v1/simulations", json={"tracker_id": "T1", "date": day}),
    ):
        assert (answer.status_code, answer.json()["detail"]) == (422, sentence)
    fault.prevented("refused before it is used")
    fault.shows(sentence)
    fault.recovers("with values within their range")


@pytest.mark.fault(96)
async def test_a_pin_is_of_a_cabinets_page_alone(tmp_path: Path) -> None:
    office = Office(tmp_path)
    await office.hire(Role.ENGINEER)
    async with office.browser(await office.session(Role.ENGINEER)) as browser:
        answer = await browser.post("/kiosk/pin", data={"pin": "1234"})
    assert 300 <= answer.status_code < 500
