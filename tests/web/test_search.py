"""The search finds pages, fields and alarms by their names and by what technicians call them, best first."""

import re
from collections.abc import AsyncIterator

import httpx
import pytest
from fastapi.routing import APIRoute

from app.alarms.catalogue import ENTRIES
from app.web.features.guide.search_index import PARTS
from app.web.features.guide.search_score import nearness, plain, score, words_of
from tests.amount import amount
from tests.fakes import FakeMachine, FakeTracker, Pair, commissioned, fake_app, serving

HIT = re.compile(r'<a class="panel hit" href="([^"]+)"')
NO_PAGES = re.compile(
    r"^/(api|static|s|manifest|login|prove|setup|kiosk|search|components)\b|/preview$|/aim$|/orientation$|\.csv$"
    r"|/day$|/list$|\.crt$|/trial$|/compare$"
)
"""Files, parts of pages, and doors that nobody looks for."""
OTHER_WORDS = ("live", "trackers", "password")
T1, ALARM = "/trackers/T1", "/alarms/guide#alarm-"
WANTED: dict[str, dict[str, tuple[str, ...]]] = {
    "en": {
        "wrong sign": (f"{T1}/drive-tests", f"{ALARM}wrong_direction"),
        "wind limit": (f"{T1}/protections#f-wind_gust_mps", f"{T1}/protections#f-wind_mean_mps"),
        "Modbus unit": (f"{T1}/drive#f-unit",),
        "following_error": (f"{T1}/settings#f-following_error_deg",),
        "password": ("/account",),
        "set zero": (f"{T1}/commissioning/homing",),
        "emergency stop": (T1, f"{ALARM}stop_overdue"),
    },
    "de": {
        "Windgrenze": (f"{T1}/protections#f-wind_gust_mps",),
        "Achsen vertauscht": (f"{ALARM}axes_swapped",),
        "Passwort ändern": ("/account",),
    },
    "zh-Hans": {"限位": (f"{T1}/settings#f-azimuth_minimum_deg",), "急停": (T1,)},
    "tr": {"rüzgâr sınırı": (f"{T1}/protections#f-wind_gust_mps",)},
}
"""What technicians type, and what must come first."""


async def found(client: httpx.AsyncClient, words: str, language: str = "en") -> list[str]:
    answer = await client.get("/search", params={"q": words}, headers={"accept-language": language})
    assert answer.status_code == 200
    return HIT.findall(answer.text)


def pages() -> list[str]:
    """Return the paths of all pages that need nothing but a tracker to be opened."""
    routes = (
        route for route in fake_app().routes if isinstance(route, APIRoute) and "GET" in (route.methods or ())
    )
    paths = {route.path for route in routes if not NO_PAGES.search(route.path)}
    ready = (path.replace("{tracker_id}", "T1") for path in paths)
    return sorted(path for path in ready if "{" not in path)


@pytest.fixture
async def park() -> AsyncIterator[httpx.AsyncClient]:
    """Return a client of a site with ten trackers."""
    machine = FakeMachine()
    machine.trackers = {
        f"T{number}": FakeTracker(
            commissioned(f"T{number}", f"Row {number}", tracking=False), Pair(180.0, 45.0)
        )
        for number in range(1, 11)
    }
    machine.emit()
    async with serving(fake_app(machine)) as browser:
        yield browser


@pytest.mark.parametrize("language", WANTED)
async def test_what_technicians_type_finds_first_what_they_mean(
    language: str, park: httpx.AsyncClient
) -> None:
    wrong = {}
    for words, wanted in WANTED[language].items():
        hits = await found(park, words, language)
        if not hits or hits[0] not in wanted:
            wrong[words] = hits[:3]
    assert wrong == {}


async def test_alarms_are_found_first_by_their_codes(park: httpx.AsyncClient) -> None:
    coded = [entry.code for entry in ENTRIES if "_" in entry.code and entry.code != "following_error"]
    assert len(coded) > 30
    coded = coded[:: amount(6, 1)]
    hits = {code: (await found(park, code))[:1] for code in coded}
    assert {code: hit for code, hit in hits.items() if hit != [f"{ALARM}{code}"]} == {}


@pytest.mark.parametrize("words", ["T7", "TRACKER 7"])
async def test_a_tracker_is_found_by_id_name_and_number_with_all_its_pages(
    words: str, park: httpx.AsyncClient
) -> None:
    hits = await found(park, words)
    assert hits[0] == "/trackers/T7"
    assert {f"/trackers/T7{end}" for _, end, _ in PARTS} < set(hits)
    assert all(hit.startswith("/trackers/T7") for hit in hits)


async def test_a_tracker_among_the_words_narrows_the_search_to_it(park: httpx.AsyncClient) -> None:
    for words in ("gear ratio T7", "T7 gear ratio", "row 7 gear ratio"):
        assert (await found(park, words))[0] == "/trackers/T7/drive#f-azimuth_gear", words
    answer = await park.get("/search", params={"q": "T1 wind limit"})
    assert "/trackers/T10" not in answer.text
    assert (await found(park, "T7风速", "zh-Hans"))[0] == "/trackers/T7/protections#f-wind_gust_mps"


async def test_a_place_of_ten_trackers_is_one_hit_with_ways_to_all(park: httpx.AsyncClient) -> None:
    answer = await park.get("/search", params={"q": "wind limit"})
    place = "protections#f-wind_gust_mps"
    assert [hit for hit in HIT.findall(answer.text) if place in hit] == [f"{T1}/{place}"]
    for number in range(2, 11):
        assert f'<a class="key" href="/trackers/T{number}/{place}">T{number}</a>' in answer.text


async def test_where_nothing_has_all_the_words_the_nearest_comes(park: httpx.AsyncClient) -> None:
    answer = await park.get("/search", params={"q": "north pole"})
    assert "No result contains all these words. Closest results:" in answer.text
    assert HIT.findall(answer.text)[0] == f"{T1}/sun-check"
    assert (await found(park, "exchanging axes"))[0] == f"{ALARM}axes_swapped"
    assert (await found(park, "Windwächter", "de"))[0].startswith((T1, ALARM, "/site"))
    nothing = await park.get("/search", params={"q": "xyzzy"})
    assert "No result contains all these words." in nothing.text
    assert HIT.findall(nothing.text) == []


def test_a_name_counts_more_than_another_name_and_that_more_than_what_is_said() -> None:
    title, also, text = (
        words_of(("Wind gust",), (), ()),
        words_of(("Stow",), ("strong wind",), ()),
        words_of(("Stow",), (), ("in wind",)),
    )
    assert score(title, ["wind"]) > score(also, ["wind"]) > score(text, ["wind"]) > 0.0
    assert score(also, ["strong", "wind"]) > score(title, ["wind"]), "another name as a whole"
    assert score(text, ["wind", "snow"]) == 0.0 < nearness(text, ["wind", "snow"])
    assert plain("T7风速, Über-Wind") == "t7 风速 uber wind"


async def test_every_page_is_found(client: httpx.AsyncClient) -> None:
    paths = pages()
    assert len(paths) > 30
    paths = paths[:: amount(3, 1)]
    assert [path for path in paths if not await leads_to(client, path)] == []


async def leads_to(client: httpx.AsyncClient, path: str) -> bool:
    """Return whether a word of a page's heading or address, or one of a few others, leads to it."""
    text = (await client.get(path, follow_redirects=True)).text
    heading = re.search(r'id="heading"[^>]*>([^<]+)', text)
    words = [
        *re.findall(r"[a-z]+", path.replace("trackers/T1", "")),
        *(heading[1].split() if heading else ()),
    ]
    for word in (*words, *OTHER_WORDS):
        if path in await found(client, word):
            return True
    return False
