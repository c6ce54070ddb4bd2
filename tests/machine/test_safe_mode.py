"""A damaged database: the service says so, moves nothing, stops what is asked, and offers a backup."""

import sqlite3
from contextlib import closing
from datetime import UTC, datetime
from pathlib import Path

import httpx
import pytest

from app.link.messages import RenameSite
from app.store.backup.backup import backup
from app.tracker.commands.commands import CommandRejected, Jog, Park, SetHome, Stop, Track
from app.tracker.settings.axes import Axis
from tests.fault_result import FaultResult
from tests.machine.field import noon_place, prepare
from tests.machine.service import Service
from tests.patience import eventually

PAGE_BYTES = 4096


def damage(data_dir: Path, table: str) -> None:
    """Put rubbish over the first page of a table."""
    path = data_dir / "heliopanel.db"
    with closing(sqlite3.connect(path)) as connection:
        asked = "SELECT rootpage FROM sqlite_master WHERE name = ?"
        (page,) = connection.execute(asked, (table,)).fetchone()
    with path.open("r+b") as file:
        file.seek((page - 1) * PAGE_BYTES)
        file.write(b"\xa5" * PAGE_BYTES)


def kept(data_dir: Path) -> str:
    """Store a site that tracks, and its backup; return the backup's name."""
    prepare(data_dir, 1, noon_place(datetime.now(UTC)))
    file = data_dir / "backups" / "before.backup"
    file.parent.mkdir()
    backup(f"sqlite:///{data_dir / 'heliopanel.db'}", file)
    return file.name


@pytest.mark.fault(51)
async def test_a_damaged_database_moves_nothing_and_offers_the_backup(
    tmp_path: Path, fault: FaultResult
) -> None:
    data_dir = tmp_path / "data"
    file = kept(data_dir)
    damage(data_dir, "trackers")
    service = await Service.start(data_dir)
    try:
        await eventually(lambda: "store_damaged" in service.alarms())
        await service.until_holding()
        for command in (Jog("hand", Axis.AZIMUTH, 1), Park(), Track(), SetHome()):
            with pytest.raises(CommandRejected) as refused:
                await service.ask(command)
            assert [reason.code for reason in refused.value.reasons] == ["safe_mode"]
        fault.shows(str(refused.value).replace(str(data_dir), "DIR"))
        with pytest.raises(CommandRejected, match=r"in safe mode.*is damaged.*Restore a backup"):
            await service.ask(RenameSite("Lost"))
        await service.ask(Stop())
        await service.until_served()
        async with httpx.AsyncClient(base_url=f"http://127.0.0.1:{service.port}") as client:
            page = await client.get("/restore")
            assert page.status_code == 200
            assert "The database is damaged" in page.text
            assert file in page.text
            assert (await client.post("/api/v1/backups/x/restore")).status_code == 404
            begun = await client.post(f"/api/v1/backups/{file}/restore")
            assert begun.status_code == 202, begun.text
            assert begun.json()["site_name"] == "Field"
        await eventually(lambda: restored(service))
        assert len(service.starts("controller")) == 2
        await service.ask(RenameSite("Goes on"))
    finally:
        code = await service.stop()
    assert code == 0


def restored(service: Service) -> bool:
    latest = service.link.latest()
    return latest is not None and latest.site_name == "Field" and "store_damaged" not in service.alarms()
