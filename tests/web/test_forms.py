"""Every form takes whatever is sent: no form breaks the panel, none gives hostile text back unescaped."""

import random

import httpx
import pytest

from tests.amount import amount
from tests.fakes import fake_app, serving
from tests.web.forms import PageForm, bad_values, every_form, hostile_in

ROUNDS = amount(1, 3)


async def send(client: httpx.AsyncClient, form: PageForm, values: dict[str, str]) -> httpx.Response:
    if form.method == "GET":
        return await client.get(form.action.split("?")[0], params=values)
    return await client.post(form.action, data=values)


async def fuzz(rounds: int, seed: int) -> int:
    """Send bad values into every form, each round to a new panel, and return how many were sent."""
    chance, sent = random.Random(seed), 0
    async with serving(fake_app()) as client:
        forms = await every_form(client)
    assert len(forms) > 120, [form.action for form in forms]
    for number in range(rounds):
        async with serving(fake_app()) as client:
            for place, form in enumerate(forms):
                values = bad_values(form, number + place, chance)
                answer = await send(client, form, values)
                assert answer.status_code < 500 or answer.status_code == 503, (form, values, answer.text)
                assert not hostile_in(answer.text), (form, values)
        sent += len(forms)
    return sent


@pytest.mark.fault(69)
async def test_every_form_takes_hostile_text() -> None:
    assert await fuzz(ROUNDS, seed=3) > 120 * ROUNDS
