"""The horizon as lists, spreadsheets, and PVGIS have it: read right and told, or refused with the line."""

import re
from html import unescape

import httpx
import pytest

from app.sun.horizon import MOST_POINTS, Horizon, joined
from app.web.features.site.horizon import written
from app.web.features.site.horizon_text import NOTES, HorizonNote, read
from app.web.shell.forms import Unreadable
from tests.fakes import FakeMachine
from tests.golden.table import rows

ROWS = rows("world/horizons.csv")
PAGE = "/site/horizon"
API = "/api/v1/site/horizon"


def points_of(horizon: Horizon) -> str:
    return "; ".join(f"{azimuth_deg:g} {elevation_deg:g}" for azimuth_deg, elevation_deg in horizon.points)


@pytest.mark.parametrize("row", ROWS, ids=lambda row: f"{row['source']} {row['text'][:20]}")
def test_what_is_pasted_is_read_and_what_was_changed_is_told(row: dict[str, str]) -> None:
    if row["refusal"]:
        with pytest.raises(Unreadable, match=re.escape(row["refusal"])):
            read(row["text"])
        return
    found = read(row["text"])
    assert points_of(found.horizon) == row["points"]
    assert set(found.notes) == set(map(HorizonNote, row["notes"].split()))


async def test_the_page_reads_so_and_says_it(client: httpx.AsyncClient, machine: FakeMachine) -> None:
    wrong = next(row for row in ROWS if row["refusal"])
    answer = await client.post(PAGE, data={"points": wrong["text"]})
    assert (answer.status_code, machine.site.horizon) == (422, Horizon())
    assert wrong["refusal"] in unescape(answer.text)
    assert f">{wrong['text']}</textarea>" in unescape(answer.text)
    for note, sentence in NOTES.items():
        row = next(row for row in ROWS if note in row["notes"].split())
        answer = await client.post(PAGE, data={"points": row["text"]})
        assert points_of(machine.site.horizon) == row["points"]
        shown = unescape((await client.get(answer.headers["location"])).text)
        assert f'<p role="status">{sentence}</p>' in shown


@pytest.mark.parametrize(
    ("points", "outcome"),
    [
        (((0, 5), (90, 8), (360, 5)), "0 5; 90 8"),
        (((-90, 5), (90, 8)), "90 8; 270 5"),
        (((-180, 5), (180, 5)), "180 5"),
        (((0, 5), (360, 6)), "their elevations are 5 and 6"),
        (((-181, 5),), "greater than or equal to -180"),
        (tuple((azimuth, 1) for azimuth in range(MOST_POINTS + 1)), None),
        (tuple((azimuth / 2, 1) for azimuth in range(MOST_POINTS + 1)), "at most 360 points"),
    ],
)
async def test_the_api_takes_closed_lists(
    client: httpx.AsyncClient, points: tuple[tuple[float, float], ...], outcome: str | None
) -> None:
    sent = [{"azimuth_deg": azimuth, "elevation_deg": elevation} for azimuth, elevation in points]
    answer = await client.put(API, json={"points": sent})
    if answer.status_code == 422:
        assert outcome
        assert outcome in answer.text
        return
    kept = answer.json()["points"]
    if outcome is None:
        assert len(kept) == MOST_POINTS
    else:
        assert "; ".join(f"{one['azimuth_deg']:g} {one['elevation_deg']:g}" for one in kept) == outcome


def test_the_smallest_negative_azimuth_is_north() -> None:
    assert joined([(-1e-20, 5.0)]).points == ((0.0, 5.0),)


async def test_the_page_takes_what_the_api_stored(client: httpx.AsyncClient, machine: FakeMachine) -> None:
    point = {"azimuth_deg": 359.96, "elevation_deg": 89.96}
    assert (await client.put(API, json={"points": [point]})).status_code == 200
    stored = machine.site.horizon
    assert (await client.post(PAGE, data={"points": written(stored)})).status_code == 303
    assert machine.site.horizon == stored
