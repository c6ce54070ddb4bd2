"""The five papers as a page and over the API, computed in the worker process."""

from collections.abc import AsyncIterator

import httpx
import pytest

from app.research.library import LIBRARY
from tests.fakes import FakeMachine, FakeReader, fake_app, serving

HTMX = {"HX-Request": "true", "HX-Request-Type": "partial"}


@pytest.fixture
async def client() -> AsyncIterator[httpx.AsyncClient]:
    app = fake_app(FakeMachine(), FakeReader())
    async with serving(app) as browser:
        yield browser
    app.state.panel.simulations.close()


async def test_page_and_api_tell_the_same(client: httpx.AsyncClient) -> None:
    told = (await client.get("/api/v1/papers")).json()["items"]
    text = (await client.get("/papers?show=yes", headers=HTMX)).text
    assert [paper["key"] for paper in told] == list(LIBRARY)
    for paper in told:
        assert f'id="{paper["key"]}"' in text
        if paper["published"] > 1:
            assert f"{paper['agreeing']} of {paper['published']} published figures come out." in text
    differing = sum(
        figure["standing"] == "differs"
        for paper in told
        for group in paper["groups"]
        for figure in group["figures"]
    )
    assert text.count("<b>differs</b>") == differing > 10
    assert "<html" not in text
