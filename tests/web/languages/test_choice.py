"""A page speaks what its cookie says, else what its browser asks for, else English."""

from collections.abc import AsyncIterator

import httpx
import pytest

from app.web.languages.catalogue import offered
from app.web.languages.choice import asked_for
from tests.fakes import FakeMachine, FakeReader, fake_app, serving


@pytest.fixture
async def client(machine: FakeMachine) -> AsyncIterator[httpx.AsyncClient]:
    async with serving(fake_app(machine, FakeReader())) as browser:
        yield browser


@pytest.mark.parametrize(
    ("accepted", "code"),
    [
        ("de-AT,de;q=0.9,en;q=0.8", "de"),
        ("zh-CN,zh;q=0.9", "zh_Hans"),
        ("ja,ro;q=0.3,tr;q=0.7", "tr"),
        ("fr-FR, fr", "en"),
        ("de;q=0, es;q=0.1", "es"),
        ("de;q=much", "en"),
        ("," * 100_000, "en"),
    ],
)
def test_a_browser_is_asked_for_its_languages(accepted: str, code: str) -> None:
    assert asked_for(accepted) == code


async def test_a_page_tells_which_language_it_speaks(client: httpx.AsyncClient) -> None:
    page = await client.get("/", headers={"Accept-Language": "es-MX"})
    assert '<html lang="es"' in page.text
    assert {"Cookie", "Accept-Language"} <= set(page.headers["vary"].split(", "))
    assert '<html lang="en"' in (await client.get("/")).text


async def test_the_list_keeps_the_choice_for_a_year(client: httpx.AsyncClient) -> None:
    page, shown = await client.get("/journal"), [(one.code, one) for one in offered()]
    assert all(f'value="{code}" lang="{one.tag}"' in page.text for code, one in shown)
    answer = await client.post("/language", data={"language": "de", "back": "/journal"})
    assert (answer.status_code, answer.headers["location"]) == (303, "/journal")
    assert "Max-Age=31536000" in answer.headers["set-cookie"]
    assert '<html lang="de"' in (await client.get("/", headers={"Accept-Language": "es"})).text


async def test_a_language_that_is_not_spoken_is_refused(client: httpx.AsyncClient) -> None:
    answer = await client.post("/language", data={"language": "../etc"})
    assert answer.status_code == 422
    assert "set-cookie" not in answer.headers
    client.cookies.set("language", "../../etc")
    assert '<html lang="en"' in (await client.get("/")).text


async def test_programs_are_answered_in_english(client: httpx.AsyncClient) -> None:
    asked = {"Accept-Language": "de"}
    assert (await client.get("/api/v1/trackers/T9", headers=asked)).json()[
        "detail"
    ] == "There is no tracker T9."
