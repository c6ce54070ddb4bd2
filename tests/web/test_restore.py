"""A backup is offered while the database is damaged, on the page and over the API, and only then."""

from collections.abc import AsyncIterator
from pathlib import Path
from urllib.parse import quote

import httpx
import pytest
from fastapi import FastAPI

from app.store.backup.backup import backup
from app.store.backup.restore import PENDING_NAME
from app.store.engine import open_writer
from app.store.migrations import upgrade
from tests.fake_alarms import alarm
from tests.fakes import FakeMachine, fake_app, serving
from tests.store.samples import NOON, SITE, tracker

NAME = "heliopanel-20261121-120000-000000.backup"


@pytest.fixture
def app(machine: FakeMachine) -> FastAPI:
    return fake_app(machine)


@pytest.fixture
async def client(app: FastAPI) -> AsyncIterator[httpx.AsyncClient]:
    async with serving(app) as client:
        yield client


@pytest.fixture
def data_dir(app: FastAPI, tmp_path: Path) -> Path:
    """The data folder, with one backup in it and a file that only calls itself one."""
    folder: Path = app.state.panel.settings.data_dir
    url = f"sqlite:///{tmp_path / 'source.db'}"
    upgrade(url)
    writer = open_writer(url)
    writer.save_site(SITE)
    writer.save_tracker(tracker())
    writer.close()
    backup(url, folder / "backups" / NAME)
    (folder / "backups" / "rubbish.backup").write_bytes(b"This is no database. " * 100)
    return folder


def damaged(machine: FakeMachine) -> None:
    machine.alarms = (alarm("store_damaged", NOON, None),)
    machine.emit()


async def test_while_the_database_is_in_order_nothing_is_restored(
    client: httpx.AsyncClient, data_dir: Path
) -> None:
    page = await client.get("/restore")
    assert "The database is intact" in page.text
    assert NAME in page.text
    assert "Restore this backup" not in page.text
    refused = await client.post(f"/api/v1/backups/{NAME}/restore")
    assert refused.status_code == 409
    assert refused.json()["reasons"][0]["code"] == "store_in_order"
    assert not (data_dir / PENDING_NAME).exists()


async def test_the_page_offers_every_backup_and_hands_the_chosen_one_over(
    machine: FakeMachine, client: httpx.AsyncClient, data_dir: Path
) -> None:
    damaged(machine)
    page = await client.get("/restore")
    assert page.text.count("Restore this backup") == 2
    done = await client.post("/restore", data={"file": NAME})
    assert done.status_code == 200
    assert SITE.name in done.text


async def test_the_api_lists_the_backups_and_refuses_what_is_none(
    machine: FakeMachine, client: httpx.AsyncClient, data_dir: Path
) -> None:
    damaged(machine)
    listed = (await client.get("/api/v1/backups")).json()["items"]
    assert {one["file"] for one in listed} == {NAME, "rubbish.backup"}
    for name in ("nowhere.backup", f"../backups/{NAME}", f"{data_dir}/backups/{NAME}"):
        assert (await client.post(f"/api/v1/backups/{quote(name, safe='')}/restore")).status_code == 404
    bad = await client.post("/api/v1/backups/rubbish.backup/restore")
    assert bad.status_code == 503
    assert "cannot be used" in bad.json()["detail"]
    begun = await client.post(f"/api/v1/backups/{NAME}/restore")
    assert begun.status_code == 202
    assert begun.json() == {"site_name": SITE.name, "trackers": 1, "events": 0, "recordings": 0}
