"""Lists that grow are read a page at a time: nothing twice, nothing left out."""

from collections.abc import AsyncIterator
from pathlib import Path
from typing import Any

import httpx
import pytest

from app.tracker.memory.recording import RecordingKind
from tests.fake_data import recording
from tests.web.desk import Desk
from tests.web.test_lists import fill


@pytest.fixture
async def desk(tmp_path: Path) -> AsyncIterator[Desk]:
    async with Desk(tmp_path) as made:
        yield made


LISTS = ("journal", "audit", "records", "recordings", "alarms/history")


async def paged(ask: Any, path: str, limit: int) -> list[Any]:
    """Return everything that a list has, by its pages."""
    found: list[Any] = []
    cursor = None
    while True:
        asked = {"limit": limit} | ({"cursor": cursor} if cursor else {})
        page = (await ask(path, asked)).json()
        assert len(page["items"]) <= limit
        found += page["items"]
        cursor = page["next"]
        if cursor is None:
            return found


async def test_pages_have_everything_once(desk: Desk) -> None:
    await fill(desk)
    for name in ("a", "b", "c"):
        desk._writer.save_recording(recording(name, RecordingKind.SHOW, "", 1.0, 60.0), [])

    async def ask(path: str, asked: dict[str, Any]) -> httpx.Response:
        return await desk.ask("GET", f"/api/v1/{path}?" + "&".join(f"{k}={v}" for k, v in asked.items()))

    for path in LISTS:
        whole = (await ask(path, {"limit": 1000})).json()
        assert whole["next"] is None
        assert whole["items"] or path == "alarms/history"
        assert await paged(ask, path, 1) == await paged(ask, path, 2) == whole["items"]
