"""Every form takes whatever is sent: no form breaks the panel, none gives hostile text back unescaped.

A form that comes back with what is wrong finds its place on the page; `errors.js` says where that is.
"""

import random

import httpx
import pytest
import pytest_asyncio

from app.web.http.security import TOO_LARGE
from app.web.languages.script_texts import script_texts
from tests.amount import amount
from tests.fakes import fake_app, serving
from tests.web.forms import PageForm, bad_values, every_form, hostile_in
from tests.web.tree import tree

pytestmark = pytest.mark.asyncio(loop_scope="module")
ROUNDS = amount(1, 3)
HTMX = {"HX-Request": "true", "HX-Request-Type": "partial"}


async def walked() -> list[PageForm]:
    """Return every form of a panel whose machine is commissioned."""
    async with serving(fake_app()) as client:
        found = await every_form(client)
    assert len(found) > 120, [form.action for form in found]
    return found


@pytest_asyncio.fixture(scope="module", loop_scope="module")
async def forms() -> list[PageForm]:
    return await walked()


async def send(
    client: httpx.AsyncClient, form: PageForm, values: dict[str, str], headers: dict[str, str] | None = None
) -> httpx.Response:
    if form.method == "GET":
        return await client.get(form.action.split("?")[0], params=values, headers=headers)
    return await client.post(form.action, data=values, headers=headers)


async def fuzz(rounds: int, seed: int, forms: list[PageForm] | None = None) -> int:
    """Send bad values into every form, each round to a new panel, and return how many were sent."""
    forms, chance = forms or await walked(), random.Random(seed)
    for number in range(rounds):
        async with serving(fake_app()) as client:
            for place, form in enumerate(forms):
                values = bad_values(form, number + place, chance)
                answer = await send(client, form, values)
                assert answer.status_code < 500 or answer.status_code == 503, (form, values, answer.text)
                assert not hostile_in(answer.text), (form, values)
    return rounds * len(forms)


@pytest.mark.fault(69)
async def test_every_form_takes_hostile_text(forms: list[PageForm]) -> None:
    assert await fuzz(ROUNDS, 3, forms) > 120 * ROUNDS


async def test_a_form_that_comes_back_with_what_is_wrong_finds_its_place(forms: list[PageForm]) -> None:
    found, renewed = [], 0
    async with serving(fake_app()) as client:
        for form in forms:
            reply = await send(client, form, dict.fromkeys(form.values, "x"), HTMX)
            is_part = "text/html" in reply.headers.get("content-type", "") and "<!doctype" not in reply.text
            if reply.status_code < 400 or not is_part:
                continue
            part = tree(reply.text)
            top = {one.given.get("id", "") for one in part.below} - {""}
            places = top & form.ids
            renewed += bool(places)
            fields = part.named("input", "select", "textarea")
            if not places and any(one.given.get("type") != "hidden" for one in fields):
                found.append(f"{form.page} {form.action}: {top}")
    assert found == []
    assert renewed > 20
    assert str(TOO_LARGE) in script_texts(), "what the script says of a form that is too large is translated"
