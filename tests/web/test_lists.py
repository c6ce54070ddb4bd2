"""Every list can be taken along as a file, and what a list's key leads to answers."""

import re
from collections.abc import AsyncIterator
from pathlib import Path

import pytest

from tests.web.desk import Desk

FILE = re.compile(r'href="(/api/[^"]+|/journal[^"]*)" download')
SIGNED = {"signatures": [{"role": "technician", "name": "Ayşe Yılmaz", "strokes": [[[10, 20], [400, 250]]]}]}


@pytest.fixture
async def desk(tmp_path: Path) -> AsyncIterator[Desk]:
    async with Desk(tmp_path) as one:
        yield one


@pytest.mark.parametrize(
    ("page", "starts"),
    [
        ("/recordings", "/api/v1/recordings?limit=1000"),
        ("/records", "/api/v1/records?limit=1000"),
        ("/alarms", "/api/v1/alarms/history?limit=1000"),
    ],
)
async def test_a_list_is_taken_along_as_a_file(page: str, starts: str, desk: Desk) -> None:
    assert (await desk.ask("POST", "/api/v1/trackers/T1/records", json=SIGNED)).status_code == 201
    shown = await desk.ask("GET", page)
    offered = FILE.findall(shown.text)
    assert starts in offered
    answer = await desk.ask("GET", starts)
    assert answer.status_code == 200
    assert answer.headers["content-type"] == "application/json"
