"""What a network is offered: names, origins, certificates, shares of streams, and nothing without them."""

import re
import stat
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import httpx
import pytest
from pydantic import ValidationError
from typer.testing import CliRunner

from app.base.certificates import AUTHORITY, AUTHORITY_KEY, SERVER, SERVER_KEY, init, read
from app.base.settings import Settings
from app.cli import cli
from app.web.http.security import Guard, host_names
from app.web.live.viewers import Wanted
from app.web.main import create_app
from tests.fakes import FakeMachine, FakeReader, fake_app, serving
from tests.fault_result import FaultResult
from tests.web.sockets import connected

NOW = datetime(2027, 6, 21, 9, 40, tzinfo=UTC)


async def _nothing(scope: Any, receive: Any, send: Any) -> None:
    await send({"type": "http.response.start", "status": 200, "headers": []})
    await send({"type": "http.response.body", "body": b"there"})


async def asked(guard: Any, base: str, headers: dict[str, str], method: str = "GET") -> httpx.Response:
    transport = httpx.ASGITransport(guard, client=("10.0.0.7", 40000))
    async with httpx.AsyncClient(transport=transport, base_url=base) as client:
        return await client.request(method, "/", headers=headers)


@pytest.mark.fault(70)
@pytest.mark.parametrize(
    ("base", "headers", "method", "status"),
    [
        ("http://10.0.0.5:8000", {"host": "tracker.example:8000"}, "GET", 200),
        ("http://10.0.0.5:8000", {"host": "TRACKER.example"}, "GET", 200),
        ("http://10.0.0.5:8000", {}, "GET", 200),
        ("http://10.0.0.5:8000", {"host": "10.0.0.6"}, "GET", 403),
        ("http://10.0.0.5:8000", {"host": "rebound.example"}, "GET", 403),
        ("https://tracker.example", {"origin": "https://tracker.example"}, "POST", 200),
        ("https://tracker.example", {"origin": "http://tracker.example"}, "POST", 403),
        ("http://tracker.example", {"origin": "https://tracker.example"}, "POST", 200),
        ("http://tracker.example", {"origin": "https://[bad"}, "POST", 403),
        ("http://tracker.example", {"origin": "https://tracker.example.evil.example"}, "POST", 403),
    ],
)
async def test_only_own_names_and_origins_are_answered(
    base: str, headers: dict[str, str], method: str, status: int
) -> None:
    settings = Settings(host="0.0.0.0", insecure_lan=True, allowed_hosts="tracker.example, other.example")
    answer = await asked(Guard(_nothing, host_names(settings)), base, headers, method)
    assert answer.status_code == status


def test_a_network_is_not_listened_to_without_a_certificate(tmp_path: Path) -> None:
    with pytest.raises(ValidationError, match="passwords would cross the network in the clear"):
        Settings(host="0.0.0.0", data_dir=tmp_path)
    assert Settings(host="0.0.0.0", data_dir=tmp_path, insecure_lan=True).is_bare
    init(tmp_path / "tls", ("tracker.example",), NOW)
    settings = Settings(host="0.0.0.0", data_dir=tmp_path)
    assert (settings.scheme, settings.is_bare) == ("https", False)


@pytest.mark.parametrize(
    ("wrong", "sentence"),
    [
        ({"trusted_proxies": "10.0.0.1, proxy"}, "HELIOPANEL_TRUSTED_PROXIES names 'proxy'"),
        ({"tls_cert_file": "a.pem"}, "go together"),
    ],
)
def test_wrong_settings_are_named(wrong: dict[str, Any], sentence: str) -> None:
    with pytest.raises(ValidationError, match=sentence):
        Settings(**wrong)


def test_a_certificate_is_for_every_name_and_its_keys_are_private(tmp_path: Path) -> None:
    made = init(tmp_path, ("heliopanel.local", "10.0.0.5", "fd00::5", "heliopanel.local"), NOW)
    assert made.names == ("heliopanel.local", "10.0.0.5", "fd00::5")
    assert made.not_after == NOW + timedelta(days=397)
    for key in (AUTHORITY_KEY, SERVER_KEY):
        assert stat.S_IMODE((tmp_path / key).stat().st_mode) == 0o600
    assert (tmp_path / SERVER).read_text().count("BEGIN CERTIFICATE") == 2


def test_renewing_keeps_the_authority_that_tablets_trust(tmp_path: Path) -> None:
    init(tmp_path, ("a.local",), NOW)
    authority = read(tmp_path / AUTHORITY)
    renewed = init(tmp_path, ("a.local", "b.local"), NOW + timedelta(days=300))
    assert read(tmp_path / AUTHORITY) == authority
    assert renewed.names == ("a.local", "b.local")
    assert renewed.not_after == NOW + timedelta(days=697)


def test_the_command_makes_and_shows_certificates(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HELIOPANEL_DATA_DIR", str(tmp_path))
    runner = CliRunner()
    made = runner.invoke(cli, ["tls", "init", "--name", "tracker.example"])
    assert made.exit_code == 0, made.output
    told = runner.invoke(cli, ["tls", "show"])
    assert "tracker.example" in told.output
    fingerprint = re.search(r"fingerprint \(SHA-256\) is ([0-9A-F:]{95})\.", made.output)
    assert fingerprint is not None
    assert fingerprint[1] in told.output


async def test_a_tablet_gets_the_authority_and_can_compare_it(tmp_path: Path) -> None:
    init(tmp_path / "tls", ("heliopanel.local",), NOW)
    settings = Settings(data_dir=tmp_path)
    app = create_app(settings, machine=FakeMachine(), reader=FakeReader())
    async with serving(app) as client:
        page = await client.get("/certificate")
        told = (await client.get("/api/v1/certificate")).json()
        file = await client.get("/certificate/ca.crt")
    assert told["authority_fingerprint"] in page.text
    assert told["names"] == ["heliopanel.local"]
    assert file.text == told["authority"] == (tmp_path / "tls" / AUTHORITY).read_text()
    assert file.headers["content-type"] == "application/x-x509-ca-cert"
    assert "PRIVATE" not in page.text + file.text


async def test_without_a_certificate_the_page_says_how_to_make_one() -> None:
    async with serving(fake_app()) as client:
        assert "heliopanel tls init" in (await client.get("/certificate")).text
        assert (await client.get("/certificate/ca.crt")).status_code == 404


@pytest.mark.fault(67)
async def test_a_thousand_viewers_are_served_and_one_more_may_only_stop(fault: FaultResult) -> None:
    machine = FakeMachine()
    app = fake_app(machine)
    async with serving(app) as client:
        viewers = [app.state.panel.hub.join(Wanted()) for _ in range(1000)]
        async with connected(app) as late:
            await late.ended.wait()
        assert late.closed == 1013
        refused = await client.get("/api/v1/stream")
        assert refused.status_code == 503
        assert (await client.post("/api/v1/trackers/T1/stop")).status_code == 202
        fault.prevented("the 1,001st viewer is turned away; Stop is obeyed")
        fault.shows(refused.json()["detail"])
        app.state.panel.hub.leave(viewers.pop())
        async with connected(app) as page:
            await page.next("state")
    fault.recovers("automatic: once a viewer has left")


async def test_a_network_without_a_certificate_is_warned_of_on_every_page(tmp_path: Path) -> None:
    settings = Settings(host="0.0.0.0", data_dir=tmp_path, insecure_lan=True)
    app = create_app(settings, machine=FakeMachine(), reader=FakeReader())
    async with serving(app) as client:
        for path in ("/setup", "/certificate"):
            assert 'id="bare-banner"' in (await client.get(path)).text
    async with serving(fake_app()) as client:
        assert 'id="bare-banner"' not in (await client.get("/")).text
