"""The horizon as lists, spreadsheets, and PVGIS have it: read right and told, or refused with the line."""

from collections.abc import AsyncIterator
from html import unescape

import httpx
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.sun.horizon import MOST_POINTS, Horizon, joined
from app.web.features.site.horizon import written
from app.web.features.site.horizon_text import NOTES, HorizonNote, read
from tests.fakes import FakeMachine, fake_app, serving
from tests.golden.table import rows

ROWS = rows("world/horizons.csv")
PAGE = "/site/horizon"
API = "/api/v1/site/horizon"
azimuths = st.floats(0.0, 360.0, exclude_max=True)


@pytest.fixture
async def panel(machine: FakeMachine) -> AsyncIterator[httpx.AsyncClient]:
    async with serving(fake_app(machine)) as browser:
        yield browser


def points_of(horizon: Horizon) -> str:
    return "; ".join(f"{azimuth_deg:g} {elevation_deg:g}" for azimuth_deg, elevation_deg in horizon.points)


@pytest.mark.parametrize("row", ROWS, ids=lambda row: f"{row['source']} {row['text'][:20]}")
async def test_the_page_reads_what_is_pasted_and_tells_what_was_changed(
    panel: httpx.AsyncClient, machine: FakeMachine, row: dict[str, str]
) -> None:
    answer = await panel.post(PAGE, data={"points": row["text"]})
    if row["refusal"]:
        assert answer.status_code == 422
        assert row["refusal"] in unescape(answer.text)
        assert machine.site.horizon == Horizon()
        return
    assert answer.status_code == 303, unescape(answer.text)
    assert points_of(machine.site.horizon) == row["points"]
    shown = unescape((await panel.get(answer.headers["location"])).text)
    told = {name for name, sentence in NOTES.items() if f'<p role="status">{sentence}</p>' in shown}
    assert told == set(map(HorizonNote, row["notes"].split()))


@pytest.mark.parametrize(
    ("points", "outcome"),
    [
        (((0, 5), (90, 8), (360, 5)), "0 5; 90 8"),
        (((360, 5), (90, 8)), "0 5; 90 8"),
        (((-90, 5), (90, 8)), "90 8; 270 5"),
        (((-180, 5), (180, 5)), "180 5"),
        (((0, 5), (360, 6)), "their elevations are 5 and 6"),
        (((90, 5), (90, 5)), "each azimuth only once"),
        (((-181, 5),), "greater than or equal to -180"),
        (tuple((azimuth, 1) for azimuth in range(MOST_POINTS + 1)), None),
        (tuple((azimuth / 2, 1) for azimuth in range(MOST_POINTS + 1)), "at most 360 points"),
    ],
)
async def test_the_api_takes_closed_lists(
    panel: httpx.AsyncClient, points: tuple[tuple[float, float], ...], outcome: str | None
) -> None:
    sent = [{"azimuth_deg": azimuth, "elevation_deg": elevation} for azimuth, elevation in points]
    answer = await panel.put(API, json={"points": sent})
    if answer.status_code == 422:
        assert outcome
        assert outcome in answer.text
        return
    kept = answer.json()["points"]
    if outcome is None:
        assert len(kept) == MOST_POINTS
    else:
        assert "; ".join(f"{one['azimuth_deg']:g} {one['elevation_deg']:g}" for one in kept) == outcome


@given(st.lists(st.tuples(azimuths, st.floats(0.0, 89.0)), max_size=30, unique_by=lambda one: one[0]))
def test_a_closed_list_is_the_same_horizon(points: list[tuple[float, float]]) -> None:
    horizon = joined(points)
    closed = [
        *points,
        *((azimuth_deg + 360.0, up_deg) for azimuth_deg, up_deg in points if azimuth_deg == 0.0),
    ]
    assert joined(closed) == horizon == Horizon(tuple(sorted(points)))


def test_the_smallest_negative_azimuth_is_north() -> None:
    assert joined([(-1e-20, 5.0)]).points == ((0.0, 5.0),)


def test_the_page_shows_what_it_reads_again() -> None:
    horizon = Horizon(tuple((azimuth / 3, azimuth / 20) for azimuth in range(MOST_POINTS)))
    assert read(written(horizon)).horizon == horizon


async def test_the_page_takes_what_the_api_stored(panel: httpx.AsyncClient, machine: FakeMachine) -> None:
    point = {"azimuth_deg": 359.96, "elevation_deg": 89.96}
    assert (await panel.put(API, json={"points": [point]})).status_code == 200
    stored = machine.site.horizon
    assert (await panel.post(PAGE, data={"points": written(stored)})).status_code == 303
    assert machine.site.horizon == stored
