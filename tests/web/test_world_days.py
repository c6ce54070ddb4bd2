"""Dates as programs write them over the API: year, month, and day, or refused with a sentence."""

import httpx
import pytest

from tests.fakes import fake_app
from tests.golden.table import rows
from tests.web.api_texts import every_place, request_with

DOCUMENT = fake_app().openapi()
ROWS = rows("world/days.csv")


@pytest.mark.parametrize("row", ROWS, ids=[row["why"] for row in ROWS])
async def test_a_date_is_taken_or_refused_with_a_sentence(
    row: dict[str, str], client: httpx.AsyncClient
) -> None:
    answer = await client.get("/api/v1/sun/day", params={"date": row["text"]})
    assert answer.status_code == (200 if row["taken"] == "yes" else 422), answer.text
    assert row["taken"] == "yes" or "a day of the calendar" in answer.json()["errors"][0]["detail"]


async def test_no_body_takes_a_wrong_date(client: httpx.AsyncClient) -> None:
    wrong = next(row["text"] for row in ROWS if row["taken"] == "no")
    places = [place for place in every_place(DOCUMENT) if place.where == "json" and place.name == ("date",)]
    assert len(places) == 4
    for place in places:
        answer = await client.send(request_with(place, wrong, client))
        assert answer.status_code == 422, (place, answer.text)
