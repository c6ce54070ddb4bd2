"""The API takes every text of the world, in each parameter and each part of a body, without a failure."""

import pytest

from tests.amount import amount
from tests.fakes import fake_app, serving
from tests.web.api_texts import every_place, send_texts

EACH = amount(1, 20)


@pytest.mark.fault(69)
async def test_every_text_of_the_api_takes_what_the_world_writes() -> None:
    app = fake_app()
    document = app.openapi()
    assert len(every_place(document)) > 400
    async with serving(app) as client:
        assert await send_texts(client, document, EACH, seed=3) > 400 * EACH
        assert (await client.get("/api/v1/health")).status_code == 200
