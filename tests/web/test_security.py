"""Nobody else's page moves a tracker: every changing route stands behind the guard."""

import functools
from collections.abc import Iterator

import httpx
import pytest
from fastapi import FastAPI
from starlette.routing import BaseRoute

from app.web.http.security import CONTENT_SECURITY_POLICY
from tests.fakes import FakeMachine, fake_app

OWN = {"host": "127.0.0.1:8010"}
FOREIGN = (
    {"sec-fetch-site": "cross-site"},
    {"origin": "http://elsewhere.example"},
    {"origin": "http://127.0.0.1:9999"},
    {"origin": "null"},
    {"host": "attacker.example:8010"},
    {"host": "[bad"},
    {"host": ""},
)


def routes(app: FastAPI) -> Iterator[tuple[str, str]]:
    """Yield method and path of every route, whoever added it."""
    for context in app.routes:
        yield from _flat(context)


def _flat(route: BaseRoute) -> Iterator[tuple[str, str]]:
    for inner in getattr(route, "routes", None) or ():
        yield from _flat(inner)
    for method in getattr(route, "methods", None) or ():
        yield method, getattr(route, "path", "")


@functools.cache
def changing() -> list[tuple[str, str]]:
    app = fake_app()
    documented = {
        (method.upper(), path)
        for path, operations in app.openapi()["paths"].items()
        for method in operations
        if method in {"post", "put", "patch", "delete"}
    }
    walked = {(method, path) for method, path in routes(app) if method not in {"GET", "HEAD", "OPTIONS"}}
    return sorted(documented | walked)


@pytest.mark.parametrize("headers", FOREIGN, ids=str)
@pytest.mark.fault(70)
async def test_no_changing_route_obeys_a_foreign_page(
    client: httpx.AsyncClient, machine: FakeMachine, headers: dict[str, str]
) -> None:
    for method, path in changing():
        answer = await client.request(method, path.replace("{", "").replace("}", ""), headers=OWN | headers)
        assert answer.status_code == 403, (method, path)
        assert answer.headers["content-type"] == "application/problem+json"
    assert machine.orders == []


@pytest.mark.parametrize(
    "headers",
    [
        {},
        {"sec-fetch-site": "same-origin", "origin": "http://127.0.0.1:8010"},
        {"sec-fetch-site": "none"},
        {"host": "localhost:8022", "origin": "http://localhost:8022"},
        {"host": "[::1]:8010", "origin": "http://[::1]:8010"},
    ],
    ids=str,
)
async def test_own_pages_and_programs_are_obeyed(client: httpx.AsyncClient, headers: dict[str, str]) -> None:
    answer = await client.post("/api/v1/trackers/T1/stop", headers=OWN | headers)
    assert answer.status_code == 202


@pytest.mark.parametrize("path", ["/api/v1/site", "/api/v1/nothing", "/health", "/nothing"])
async def test_every_answer_carries_the_headers(client: httpx.AsyncClient, path: str) -> None:
    headers = (await client.get(path)).headers
    assert headers["content-security-policy"] == CONTENT_SECURITY_POLICY
    assert "unsafe" not in CONTENT_SECURITY_POLICY
    assert headers["x-content-type-options"] == "nosniff"
    assert headers["x-frame-options"] == "DENY"
    assert headers["cache-control"] == "no-store"


async def test_own_mistake_carries_the_headers_and_tells_no_secrets(machine: FakeMachine) -> None:
    app = fake_app(machine)

    @app.get("/api/v1/broken")
    def broken() -> None:
        raise RuntimeError("secret")

    async with app.router.lifespan_context(app):
        transport = httpx.ASGITransport(app, raise_app_exceptions=False)
        async with httpx.AsyncClient(transport=transport, base_url="http://127.0.0.1") as client:
            answer = await client.get("/api/v1/broken")
    assert answer.status_code == 500
    assert answer.headers["connection"] == "close", "a client that was not told lost its next request"
    assert "secret" not in answer.text
    assert answer.headers["content-security-policy"] == CONTENT_SECURITY_POLICY


async def test_static_files_are_kept_for_ever_under_their_hash_only(client: httpx.AsyncClient) -> None:
    assets = fake_app().state.panel.assets
    right = await client.get(assets.url("css/frame.css"))
    assert right.status_code == 200
    assert "immutable" in right.headers["cache-control"]
    wrong = await client.get("/s/0000/css/frame.css")
    assert wrong.headers["cache-control"] == "no-cache"
    assert (await client.get(f"/s/{assets.digest}/../pyproject.toml")).status_code == 404


async def test_body_beyond_a_megabyte_is_refused(client: httpx.AsyncClient) -> None:
    answer = await client.patch("/api/v1/site", content=b" " * 2_000_000)
    assert answer.status_code == 413
    assert answer.headers["content-type"] == "application/problem+json"
