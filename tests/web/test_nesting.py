"""JSON that is nested too deep is turned away with a sentence before anything reads it."""

import asyncio
from collections.abc import AsyncIterator

import httpx
import pytest

from app.web.http.nesting import DEEPEST, is_too_deep
from app.web.http.security import LARGEST_BODY
from tests.fakes import FakeMachine

JSON = {"content-type": "application/json"}


@pytest.mark.parametrize(
    ("text", "too_deep"),
    [
        ("[" * DEEPEST + "]" * DEEPEST, False),
        ("[" * (DEEPEST + 1) + "]" * (DEEPEST + 1), True),
        ('{"a":' * (DEEPEST + 1), True),
        ('{"name": "' + "[" * 1000 + '"}', False),
        ('["\\"", ' + "[" * DEEPEST, True),
        ("[" * 100 + '"' + "]" * 100, True),
        ('"\\' * (LARGEST_BODY // 3) + "[" * 100, False),
        ("[" * LARGEST_BODY, True),
    ],
    ids=lambda value: str(value)[:12],
)
def test_levels_are_counted_outside_of_strings(text: str, too_deep: bool) -> None:
    assert is_too_deep(text.encode()) is too_deep


@pytest.mark.parametrize("text", ["[" * 500_000, '{"a":' * 150_000])
async def test_deep_json_is_refused_with_a_sentence_and_does_no_harm(
    client: httpx.AsyncClient, text: str
) -> None:
    for path in ("/api/v1/site", "/api/v1/trackers/T1"):
        answer = await client.patch(path, content=text, headers=JSON)
        assert answer.status_code == 422
        assert answer.headers["content-type"] == "application/problem+json"
        assert f"at most {DEEPEST} levels deep" in answer.json()["detail"]
        assert answer.headers["x-content-type-options"] == "nosniff"
    assert (await client.get("/health")).status_code == 200


async def test_a_body_that_does_not_end_is_refused_with_a_sentence(client: httpx.AsyncClient) -> None:
    async def endless() -> AsyncIterator[bytes]:
        for _ in range(40):
            yield b" " * 65536
            await asyncio.sleep(0)

    answer = await client.patch("/api/v1/site", content=endless(), headers=JSON)
    assert answer.status_code == 413
    assert "at most one megabyte" in answer.json()["detail"]
    assert answer.headers["connection"] == "close"


async def test_what_is_not_deep_is_read_as_it_was_sent(
    client: httpx.AsyncClient, machine: FakeMachine
) -> None:
    async def in_parts() -> AsyncIterator[bytes]:
        for part in (b'{"na', b'me": "[[[ Upper', b' field"}'):
            yield part

    answer = await client.patch("/api/v1/site", content=in_parts(), headers=JSON)
    assert answer.status_code == 200, answer.text
    assert machine.site.name == "[[[ Upper field"
