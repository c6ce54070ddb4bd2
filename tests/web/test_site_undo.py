"""The key that brings back the last change of the site stands where the site is set, and returns there."""

import httpx
import pytest

from app.link.settings_orders import UndoSiteSettings
from tests.fakes import FakeMachine, fake_app, serving


@pytest.mark.parametrize("path", ["/site", "/site/horizon", "/site/notifications"])
async def test_the_key_stands_there_orders_it_and_returns(machine: FakeMachine, path: str) -> None:
    async with serving(fake_app(machine)) as panel:
        assert 'action="/site/undo"' in (await panel.get(path)).text
        answer = await panel.post("/site/undo", data={"back": path})
    assert answer.headers["location"] == path
    assert machine.orders[-1].command == UndoSiteSettings()


async def test_the_api_orders_it(machine: FakeMachine) -> None:
    async with serving(fake_app(machine)) as panel:
        assert (await panel.post("/api/v1/site/settings/undo")).status_code == httpx.codes.OK
    assert machine.orders[-1].command == UndoSiteSettings()
