"""The page Network: what it takes, what it refuses, what it writes down before anything changes."""

import re
import socket
from collections.abc import AsyncIterator
from dataclasses import replace
from datetime import timedelta
from pathlib import Path

import httpx
import pytest

from app.access.roles import Role
from app.access.store import AccessStore
from app.base.network import Network, read_network
from app.base.settings import Settings
from app.web.http.network import Stage, Trial, told, ways
from app.web.main import create_app
from tests.fakes import FakeMachine, FakeReader, serving
from tests.web.office import HERE, PORT, Office

FORM = {
    "host": "127.0.0.1",
    "port": "8443",
    "allowed_hosts": "tracker.example",
    "trusted_proxies": "",
    "tls": "off",
}


@pytest.fixture
async def office(tmp_path: Path) -> AsyncIterator[Office]:
    office = Office(tmp_path)
    async with office.app.router.lifespan_context(office.app):
        yield office


@pytest.fixture
async def here(office: Office) -> AsyncIterator[httpx.AsyncClient]:
    async with office.browser() as browser:
        yield browser


async def test_a_change_is_written_down_tried_and_tells_where_to_go(
    office: Office, here: httpx.AsyncClient, tmp_path: Path
) -> None:
    assert f'value="{PORT}"' in (await here.get("/network")).text
    answer = await here.post("/network", data=FORM)
    assert answer.status_code == 200
    assert re.search(r'href="http://127.0.0.1:8443/network/trial\?ticket=[\w-]{43}"', answer.text)
    assert read_network(tmp_path)["port"] == PORT
    following = office.app.state.panel.network.following
    assert following.settings.network == Network("127.0.0.1", 8443, ("tracker.example",), (), tls=False)
    assert following.trial.before.port == PORT
    assert (await here.post("/network", data=FORM)).status_code == 409
    event = AccessStore(f"sqlite:///{tmp_path}/access.db", b"").events()[-1][0]
    assert (event.actor, event.action) == ("local user", "network_tried")
    assert event.result == f"port {PORT} -> 8443, allowed_hosts none -> tracker.example"


@pytest.mark.parametrize(
    ("wrong", "sentence"),
    [
        ({"host": "somewhere"}, "somewhere is not an IP address"),
        ({"allowed_hosts": ", ".join(f"a{n}" for n in range(21))}, "Enter at most 20 names"),
        ({"host": "192.0.2.99"}, "The controller&#39;s computer cannot listen on 192.0.2.99"),
        ({"host": "0.0.0.0"}, "Add an administrator on the Users page first"),
        ({"port": "70000"}, "Port must be between 1 and 65535"),
        ({"allowed_hosts": "a b, under_score"}, "under_score is not a host name"),
        ({"trusted_proxies": "proxy"}, "HELIOPANEL_TRUSTED_PROXIES names"),
    ],
)
async def test_what_cannot_be_is_told_and_what_was_typed_stays(
    here: httpx.AsyncClient, tmp_path: Path, wrong: dict[str, str], sentence: str
) -> None:
    answer = await here.post("/network", data=FORM | wrong)
    assert answer.status_code == 422
    assert sentence in answer.text
    assert f'value="{next(iter(wrong.values()))}"' in answer.text
    if "proxies" not in next(iter(wrong)):
        assert read_network(tmp_path) == {}


async def test_a_port_that_another_program_has_is_refused(here: httpx.AsyncClient) -> None:
    with socket.create_server(("127.0.0.1", 0)) as other:
        answer = await here.post("/network", data=FORM | {"port": str(other.getsockname()[1])})
    assert answer.status_code == 422
    assert "cannot be used: address already in use" in answer.text


async def test_the_network_wants_an_administrator_and_the_password(office: Office) -> None:
    await office.hire(*Role)
    async with office.browser(await office.session(Role.ENGINEER)) as browser:
        assert (await browser.get("/network")).status_code == 403
    session = await office.session(Role.ADMINISTRATOR)
    async with office.browser(session) as browser:
        assert (await browser.get("/network")).status_code == 200
        office.clock.ahead = timedelta(minutes=6)
        asked = await browser.get("/network", headers={"referer": "http://127.0.0.1:8010/site"})
        assert asked.headers["location"] == "/prove?back=/network"


async def test_https_makes_its_certificate_and_the_old_state_is_kept(
    office: Office, here: httpx.AsyncClient, tmp_path: Path
) -> None:
    await here.post("/network", data=FORM | {"tls": "on"})
    stage = office.app.state.panel.network.following
    assert stage.settings.scheme == "https"
    back = stage.back("why")
    assert (back.settings.scheme, back.outcome.why) == ("http", "why")
    assert Settings(data_dir=tmp_path).scheme == "http"


async def test_what_the_environment_sets_is_not_changed(tmp_path: Path) -> None:
    stage = Stage(Settings(data_dir=tmp_path), frozenset({"port"}))
    app = create_app(stage.settings, machine=FakeMachine(), reader=FakeReader(), stage=stage)
    async with serving(app) as client:
        answer = await client.post("/network", data=FORM)
        assert answer.status_code == 422
        assert "This value is set by HELIOPANEL_PORT at the start of the service" in answer.text
        assert (await client.get("/api/v1/network")).json()["fixed"] == ["port"]


async def test_only_the_ticket_keeps_what_is_tried(tmp_path: Path) -> None:
    office = Office(tmp_path)
    async with office.app.router.lifespan_context(office.app), office.browser() as browser:
        nothing = await browser.post("/network/trial?ticket=x")
        assert nothing.status_code == 409
        assert "nothing to confirm" in nothing.text
        trial = await office.app.state.panel.network.propose(
            Network("127.0.0.1", 8443, (), (), tls=False), HERE
        )
    tried = create_app(
        office.app.state.panel.network.following.settings,
        machine=office.machine,
        reader=office.machine.store,
        clock=office.clock,
        stage=office.app.state.panel.network.following,
    )
    async with serving(tried) as client:
        assert "Keep address" in (await client.get(f"/network/trial?ticket={trial.ticket}")).text
        assert (await client.post("/network/trial?ticket=guessed")).status_code == 409
        assert read_network(tmp_path)["port"] == PORT
        kept = await client.post("/api/v1/network/confirmation", json={"ticket": trial.ticket})
        assert (kept.status_code, kept.json()["confirm_until"]) == (200, None)
        assert (await client.post(f"/network/trial?ticket={trial.ticket}")).status_code == 409
    assert read_network(tmp_path)["port"] == 8443
    assert Settings(data_dir=tmp_path).port == 8443


def test_the_ways_are_those_that_lead_there() -> None:
    inside = Network("127.0.0.1", 8000, (), (), tls=False)
    assert ways(inside, "localhost") == ("http://localhost:8000",)
    assert ways(inside, "10.0.0.5") == ("http://127.0.0.1:8000",)
    outside = replace(inside, host="10.0.0.5", port=443, tls=True, allowed_hosts=("tracker.example",))
    assert ways(outside, "localhost") == ("https://10.0.0.5", "https://tracker.example")
    assert ways(replace(outside, host="::", port=8443), "fd00::9")[0] == "https://[fd00::9]:8443"
    assert told(inside, replace(inside, tls=True)) == "tls false -> true"


async def test_what_cannot_be_written_is_not_kept(tmp_path: Path) -> None:
    before = Settings(data_dir=tmp_path, port=PORT)
    wanted = Network("127.0.0.1", 8443, (), (), tls=False)
    trial = Trial(wanted, before, HERE, "ticket")
    stage = Stage(before.model_copy(update={"port": 8443}), trial=trial)
    app = create_app(stage.settings, machine=FakeMachine(), reader=FakeReader(), stage=stage)
    async with serving(app) as client:
        (tmp_path / "network.toml.unfinished").mkdir()
        answer = await client.post("/api/v1/network/confirmation", json={"ticket": "ticket"})
        assert answer.status_code == 409
        assert "could not be written to the disk" in answer.json()["detail"]
    following = app.state.panel.network.following
    assert (following.settings.port, following.trial) == (PORT, None)
