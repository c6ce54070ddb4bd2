"""Secrets that the product hands out hold 128 bits or more, decoded as they come over the wire."""

import base64
from collections.abc import AsyncIterator, Awaitable, Callable
from pathlib import Path

import httpx
import pytest

from app.access.roles import Role
from tests.web.office import COOKIE, HERE, PASSWORD, Office

LEAST_BYTES = 16
DRAWN = 4
ID, CHECK = 8, 6
"""A token's text: `hp_`, its id, its secret, a checksum."""

BASE62 = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"


@pytest.fixture
async def office(tmp_path: Path) -> AsyncIterator[Office]:
    office = Office(tmp_path)
    async with office.app.router.lifespan_context(office.app):
        await office.hire(Role.ENGINEER)
        yield office


def url_safe(text: str) -> bytes:
    """Return the bytes behind a secret of letters, digits, - and _."""
    return base64.urlsafe_b64decode(text + "=" * (-len(text) % 4))


async def session_id(browser: httpx.AsyncClient) -> bytes:
    browser.cookies.clear()
    answer = await browser.post("/login", data={"name": "engineer-1", "password": PASSWORD})
    return url_safe(answer.cookies[COOKIE])


async def one_shot_ticket(browser: httpx.AsyncClient) -> bytes:
    return url_safe((await browser.post("/api/v1/tickets")).json()["ticket"])


async def token_secret(browser: httpx.AsyncClient) -> bytes:
    wish = {"name": "scada", "scopes": ["read"]}
    text = (await browser.post("/api/v1/tokens", json=wish)).json()["token"]
    assert text.startswith("hp_")
    return bytes(BASE62.index(sign) for sign in text[len("hp_") + ID : -CHECK])


@pytest.mark.parametrize("drawing", [session_id, one_shot_ticket, token_secret])
async def test_a_secret_holds_128_bits(
    office: Office, drawing: Callable[[httpx.AsyncClient], Awaitable[bytes]]
) -> None:
    async with office.browser(await office.session(Role.ADMINISTRATOR)) as browser:
        browser.headers["x-csrf-token"] = office.keeper.csrf(browser.cookies[COOKIE])
        drawn = [await drawing(browser) for _ in range(DRAWN)]
    assert len(set(drawn)) == DRAWN
    assert all(len(one) >= LEAST_BYTES for one in drawn)
    places = [set(place) for place in zip(*drawn, strict=True)]
    assert sum(len(place) > 1 for place in places) >= LEAST_BYTES, "no counter that is merely long"


async def test_what_signs_stop_tickets_and_pages_is_cut_nowhere(office: Office) -> None:
    session = await office.session(Role.ENGINEER)
    assert len(url_safe(office.keeper.csrf(session))) >= LEAST_BYTES
    _, signature = office.keeper.stop_ticket(HERE).split(".")
    assert len(url_safe(signature)) >= LEAST_BYTES
