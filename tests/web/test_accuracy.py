"""The accuracy of the algorithms as a page and over the API, worked out in the worker process."""

import re
from collections.abc import AsyncIterator
from html import unescape

import httpx
import numpy as np
import pytest

from app.sun.algorithms import PUBLISHED, Algorithm
from app.web.charts.logchart import BOX, LABEL_GAP, log_chart
from tests.fakes import FakeMachine, FakeReader, fake_app, serving

HTMX = {"HX-Request": "true", "HX-Request-Type": "partial"}
QUICK = {"place": "site", "from": "2026", "to": "2026", "samples": "1000"}
WRONG = [
    ({"from": "2049", "to": "2000"}, "must not be before the first year"),
    ({"samples": "many"}, "Samples: type a number"),
    ({"place": "moon"}, "or choose the globe"),
]


@pytest.fixture
async def client() -> AsyncIterator[httpx.AsyncClient]:
    app = fake_app(FakeMachine(), FakeReader())
    async with serving(app) as browser:
        yield browser
    app.state.panel.simulations.close()


async def test_page_and_api_tell_the_same(client: httpx.AsyncClient) -> None:
    first = (await client.get("/accuracy")).text
    assert 'hx-get="/accuracy?place=site&amp;from=2000&amp;to=2049&amp;samples=20000"' in first
    assert "logchart" not in first, "it is asked for by itself"
    query = {"start_year": 2026, "end_year": 2026, "samples": 1000}
    told = (await client.get("/api/v1/sun/accuracy", params=query)).json()
    shown = (await client.get("/accuracy", params=QUICK, headers=HTMX)).text
    assert told["location"]["latitude_deg"] == pytest.approx(41.2867)
    assert told["title"] in shown
    (file,) = re.findall(r'href="(/api/[^"]+)" download="accuracy.json"', shown)
    assert (await client.get(unescape(file))).json() == told
    assert len(told["errors"]) == 9
    for error in told["errors"]:
        most_deg = error["spreads"]["true"]["max_deg"]
        assert f"<b>{most_deg:.4f}°</b>" in shown
        over_year_deg = max(value or 0.0 for value in error["max_over_year_deg"])
        assert over_year_deg == pytest.approx(most_deg, abs=1e-6)
    assert shown.count('class="logchart"') == 2
    assert "<html" not in shown


async def test_a_question_that_cannot_be_keeps_what_was_typed(client: httpx.AsyncClient) -> None:
    for wrong, words in WRONG:
        answer = await client.get("/accuracy", params=QUICK | wrong)
        assert answer.status_code == 422
        assert words in answer.text
        assert all(f'value="{text}"' in answer.text for name, text in wrong.items() if name != "place")
    answer = await client.get("/api/v1/sun/accuracy", params={"start_year": 2049, "end_year": 2000})
    assert answer.status_code == 422
    assert "the first not after the last" in answer.json()["detail"]


async def test_every_algorithm_has_a_card_and_a_sun_and_can_be_chosen(client: httpx.AsyncClient) -> None:
    cards = (await client.get("/api/v1/sun/algorithms")).json()["items"]
    assert [card["algorithm"] for card in cards] == list(Algorithm)
    assert all(card["max_deg"] == PUBLISHED[Algorithm(card["algorithm"])].max_deg for card in cards)
    for card in cards:
        query = {"algorithm": card["algorithm"], "at": "2026-06-21T09:30:00Z"}
        sun = (await client.get("/api/v1/sun", params=query)).json()
        assert sun["elevation_deg"] == pytest.approx(72.1, abs=card["max_deg"] + 0.01)
    text = (await client.get("/trackers/T1/settings")).text
    assert all(f'<option value="{one}"' in text for one in Algorithm)
    assert "PSA+ (2020), error up to 0.0085°" in text


def test_names_of_curves_do_not_overlap_and_a_curve_breaks_where_nothing_was_measured() -> None:
    ends = [(f"curve {number}", np.array([0.01, 0.001 * number])) for number in (3, 1, 2)]
    drawn = log_chart("Title", "across", ((0.0, "0"), (1.0, "1")), np.array([0.0, 1.0]), ends)
    places = [line.label_at for line in drawn.lines]
    assert [line.label for line in drawn.lines] == ["curve 3", "curve 2", "curve 1"]
    assert [line.dashes for line in drawn.lines] == [1, 3, 2]
    assert np.diff(places).min() >= LABEL_GAP - 0.2
    assert BOX.top <= places[0] < places[-1] <= BOX.bottom + 0.1
    gap = np.array([0.1, np.nan, 0.1, 0.1])
    broken = log_chart("Title", "across", ((0.0, "0"), (3.0, "3")), np.arange(4.0), [("one", gap)])
    assert (broken.lines[0].path.count("M"), broken.lines[0].path.count("L")) == (2, 1)
