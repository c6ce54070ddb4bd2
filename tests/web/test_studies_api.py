"""Studies over the API, one of them by the real worker process; weather files; programs for a tracker."""

import asyncio
from collections.abc import AsyncGenerator, AsyncIterator
from pathlib import Path
from typing import Any

import httpx
import pytest

from app.base.settings import Settings
from app.studies.jobs import Job, Told
from app.tracker.settings.strategy import Stepped
from app.web.main import create_app
from app.web.services import studies
from app.web.services.studies import Studies
from tests.fakes import FakeMachine, FakeReader, serving
from tests.patience import PATIENCE_S, pause

V1 = "/api/v1"
# pvlib 0.16 asks pandas 3.1 for a name that pandas will drop.
pytestmark = pytest.mark.filterwarnings("ignore:DatetimeIndex.dayofyear is deprecated")
DAY = {"date": "2026-06-21", "span": "day", "step_min": 60}


@pytest.fixture
async def client(machine: FakeMachine, tmp_path: Path) -> AsyncIterator[httpx.AsyncClient]:
    app = create_app(Settings(data_dir=tmp_path), machine=machine, reader=FakeReader(), clock=machine.clock)
    async with serving(app) as browser:
        yield browser


async def ended(client: httpx.AsyncClient, study_id: str) -> dict[str, Any]:
    """Watch a study until it is under way no more."""
    async with asyncio.timeout(PATIENCE_S):
        while True:
            found = (await client.get(f"{V1}/studies/{study_id}")).json()
            if found["state"]["status"] not in ("waiting", "running"):
                return found
            await pause()


async def test_a_study_is_begun_watched_read_and_deleted(client: httpx.AsyncClient) -> None:
    begun = await client.post(f"{V1}/studies", json={**DAY, "modes": ["dual", "equatorial"]})
    assert begun.status_code == 202
    study_id = begun.json()["study_id"]
    assert begun.headers["location"].endswith(study_id)
    found = await ended(client, study_id)
    assert found["state"]["status"] == "done", found["state"]["message"]
    cases = {case["mode"]: case for case in found["result"]["cases"]}
    assert list(cases) == ["fixed", "dual", "equatorial"]
    assert cases["fixed"]["net_gain_percent"] == 0.0
    assert 30 < cases["dual"]["net_gain_percent"] < 80
    table = await client.get(f"{V1}/studies/{study_id}?format=csv")
    assert table.headers["content-type"].startswith("text/csv")
    assert len(table.text.splitlines()) == 4
    curves = await client.get(f"{V1}/studies/{study_id}?format=curves-csv")
    assert len(curves.text.splitlines()) == 1 + 3 * 24
    assert [one["study_id"] for one in (await client.get(f"{V1}/studies")).json()["items"]] == [study_id]
    assert (await client.delete(f"{V1}/studies/{study_id}")).status_code == 204
    assert (await client.get(f"{V1}/studies/{study_id}")).status_code == 404


@pytest.mark.usefixtures("real_processes")
async def test_a_study_under_way_is_cancelled_and_those_behind_it_go_on(client: httpx.AsyncClient) -> None:
    long = {
        **DAY,
        "span": "year",
        "step_min": 2,
        "modes": ["azimuth", "dual"],
        "strategies": ["continuous", "deadband"],
    }
    first, second = [
        (await client.post(f"{V1}/studies", json=body)).json()["study_id"] for body in (long, DAY)
    ]
    waiting = await client.get(f"{V1}/studies/{second}?format=csv")
    assert waiting.status_code == 404
    assert "no result yet" in waiting.json()["detail"]
    cancelled = await client.delete(f"{V1}/studies/{first}")
    assert cancelled.json()["status"] == "cancelled"
    found = await ended(client, second)
    assert found["state"]["status"] == "done", found["state"]["message"]


async def unending(_: Job) -> AsyncGenerator[Told, None]:
    """Be a worker that tells nothing yet."""
    await asyncio.Event().wait()
    for none in ():
        yield none


async def test_no_more_than_five_are_under_way(
    client: httpx.AsyncClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(studies, "_told", unending)
    answers = [await client.post(f"{V1}/studies", json=DAY) for _ in range(6)]
    assert [one.status_code for one in answers] == [202] * 5 + [429]
    assert "try again" in answers[5].json()["detail"]


@pytest.mark.parametrize(
    ("wrong", "sentence"),
    [
        ({"step_min": 7}, "one of 1, 2, 3"),
        ({"strategies": []}, "at least one strategy"),
        ({"strategies": ["program"]}, "needs a program"),
        ({"fidelity": "controller"}, "needs a tracker"),
        ({"fidelity": "controller", "tracker_id": "T1", "span": "year"}, "covers one day"),
        ({"fidelity": "controller", "tracker_id": "T1", "modes": ["equatorial"]}, "the tracker's own mount"),
        ({"light": "weather-file"}, "Enter a weather file if, and only if"),
        ({"date": "1890-01-01"}, "Choose a year"),
        ({"latitude_deg": 45.65, "longitude_deg": None}, "together"),
        ({"span": "year", "step_min": 1, "modes": ["azimuth", "elevation", "dual"],
          "strategies": ["continuous", "deadband", "interval", "program"]}, "too many"),
    ],
)  # fmt: skip
async def test_what_cannot_be_studied_is_refused_with_a_sentence(
    wrong: dict[str, Any], sentence: str, client: httpx.AsyncClient
) -> None:
    answer = await client.post(f"{V1}/studies", json={**DAY, **wrong})
    assert answer.status_code == 422
    assert sentence in answer.json()["detail"]
    assert (await client.get(f"{V1}/studies")).json()["items"] == []


async def test_programs_are_found_and_used_on_a_tracker(
    client: httpx.AsyncClient, machine: FakeMachine
) -> None:
    asked = {"date": "2026-06-21", "latitude_deg": 45.65, "longitude_deg": 25.6, "window": True}
    used = await client.post(f"{V1}/studies/programs", json={**asked, "steps": 8, "use_on": "T1"})
    assert used.status_code == 200, used.text
    assert used.json()["answer"]["rows"][12]["electric_wh"] >= 1932.59
    strategy = machine.trackers["T1"].config.strategy
    assert isinstance(strategy, Stepped)
    assert len(strategy.program.steps) == 9
    refused = await client.post(f"{V1}/studies/programs", json={**asked, "steps": 30})
    assert refused.status_code == 422
    assert "the maximum is 12" in refused.json()["detail"]


async def test_unknown_things_are_404(client: httpx.AsyncClient) -> None:
    for path in ("studies/20260101T000000-abcdef", "studies/..%2f..", "studies/nonsense"):
        assert (await client.get(f"{V1}/{path}")).status_code == 404
    assert (await client.delete(f"{V1}/weather-files/none.epw")).status_code == 404
    named = {"light": "weather-file", "weather_file": "../secret"}
    for unknown in ({"tracker_id": "T9"}, named):
        assert (await client.post(f"{V1}/studies", json=DAY | unknown)).status_code == 404


async def test_what_was_under_way_when_the_panel_ended_is_told(
    client: httpx.AsyncClient, machine: FakeMachine, tmp_path: Path
) -> None:
    begun = (await client.post(f"{V1}/studies", json=DAY)).json()["study_id"]
    other = Studies(tmp_path, machine.clock)
    assert other.state(begun).status == "failed"
    assert "restarted" in other.state(begun).message
