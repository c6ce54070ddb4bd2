"""What opens a webhook is told to who may set it, and to nobody and nothing else."""

import io
import zipfile
from dataclasses import replace
from pathlib import Path

import pytest

from app.access.accounts import TokenWish
from app.access.roles import Role
from app.access.tokens import Scope
from app.audit.entry import told
from app.base.addresses.masking import masked
from app.tracker.values.notifications import Notifications
from tests.fault_result import FaultResult
from tests.web.desk import Desk
from tests.web.office import HERE, Office

HOOK = "http://bob:SEKRET1@127.0.0.1:9/SEKRET2?key=SEKRET3#SEKRET4"
SHOWN = "http://***@127.0.0.1:9/***"
ADDRESSES = ["/api/v1/site/notifications", "/site/notifications"]
ADDRESS_CASES = [
    (HOOK, SHOWN),
    ("https://example.org", "https://example.org"),
    ("https://example.org/", "https://example.org/"),
    ("https://example.org:8443/hooks/SEKRET", "https://example.org:8443/***"),
    ("https://example.org?SEKRET", "https://example.org/***"),
    ("http://[::1]:80/SEKRET", "http://[::1]:80/***"),
    ("http://host:SEKRET/x", "***"),
    ("", ""),
]


@pytest.fixture
async def office(tmp_path: Path) -> Office:
    office = Office(tmp_path)
    await office.hire(Role.VIEWER, Role.OPERATOR, Role.ENGINEER)
    office.machine.site = replace(office.machine.site, notifications=Notifications(HOOK))
    return office


@pytest.mark.parametrize(("address", "shown"), ADDRESS_CASES)
def test_of_an_address_the_host_is_left(address: str, shown: str) -> None:
    assert masked(address) == shown


@pytest.mark.fault(94)
@pytest.mark.parametrize("role", [Role.OPERATOR])
@pytest.mark.parametrize("address", ADDRESSES)
async def test_who_may_not_set_the_webhook_is_shown_its_host(
    office: Office, address: str, role: Role, fault: FaultResult
) -> None:
    async with office.browser(await office.session(role)) as browser:
        text = (await browser.get(address)).text
    assert "SEKRET" not in text
    assert SHOWN in text
    fault.prevented("the address is masked before it leaves")
    fault.shows_nothing("the host alone is shown")
    fault.recovers("nothing was lost")


@pytest.mark.parametrize("address", ADDRESSES)
async def test_who_may_set_it_is_shown_it_whole(office: Office, address: str) -> None:
    async with office.browser(await office.session(Role.ENGINEER)) as browser:
        assert "SEKRET2?key=SEKRET3" in (await browser.get(address)).text


@pytest.mark.fault(94)
@pytest.mark.parametrize(
    ("scopes", "trackers"), [({Scope.READ}, None), ({Scope.MOTION}, None), ({Scope.CONFIG}, {"T1"})]
)
async def test_a_token_that_may_not_set_it_is_shown_its_host(
    office: Office, scopes: set[Scope], trackers: set[str] | None
) -> None:
    wish = TokenWish("scada", frozenset(scopes), None if trackers is None else frozenset(trackers))
    text = await office.keeper.do(lambda: office.keeper.accounts.mint(HERE, wish, office.clock.now()))
    async with office.browser() as browser:
        answer = await browser.get(ADDRESSES[0], headers={"authorization": f"Bearer {text}"})
    assert answer.json()["webhook_url"] == SHOWN


@pytest.mark.fault(94)
async def test_neither_diagnostics_nor_audit_have_it(tmp_path: Path) -> None:
    async with Desk(tmp_path) as desk:
        put = await desk.ask("PUT", "/api/v1/site/notifications", json={"webhook_url": HOOK})
        assert put.json()["webhook_url"] == HOOK, put.text
        audit = (await desk.ask("GET", "/api/v1/audit")).text
        journal = (await desk.ask("GET", "/api/v1/journal")).text
        zipped = await desk.ask("GET", "/api/v1/diagnostics.zip")
    archive = zipfile.ZipFile(io.BytesIO(zipped.content))
    texts = {name: archive.read(name).decode() for name in archive.namelist()}
    assert SHOWN in audit
    assert SHOWN in texts["site.json"]
    for text in (audit, journal, *texts.values()):
        assert "SEKRET" not in text


def test_what_the_audit_is_given_by_path_is_masked_too() -> None:
    assert told({"notifications.webhook_url": HOOK}) == f'{{"notifications.webhook_url":"{SHOWN}"}}'
