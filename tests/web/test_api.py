"""REST as integrators see it: orders, errors with every reason, files, and what is refused."""

import inspect
import io
import json
import zipfile
from collections.abc import AsyncIterator, Iterator
from pathlib import Path

import httpx
import pyarrow.parquet as pq
import pytest

from app.link import messages
from app.store import store
from app.sun import position
from app.tracker.commands import commands
from app.tracker.commands.commands import CommandRejected, EndJog, Jog, Move, SelectMode, Stop
from app.tracker.settings.axes import Axis, JogSpeed
from app.tracker.settings.config import Orientation
from app.tracker.values.mode import Mode
from app.tracker.values.reason import Reason
from app.web.http import errors
from app.web.http.errors import problem_of
from tests.fakes import FakeMachine, fake_app, serving
from tests.fault_result import FaultResult
from tests.web.desk import Desk

NEAR = Reason("near", "The panel is near something.", "Move it away.")
FAR = Reason("far", "The panel is far from something.", "Move it there.")


@pytest.fixture
async def api(machine: FakeMachine) -> AsyncIterator[httpx.AsyncClient]:
    async with serving(fake_app(machine)) as client:
        client.base_url = httpx.URL("http://127.0.0.1:8010/api/v1")
        yield client


def domain_errors() -> Iterator[Exception]:
    for module in (messages, store, commands, position, errors):
        for _, kind in inspect.getmembers(module, inspect.isclass):
            if issubclass(kind, Exception) and kind.__module__ == module.__name__:
                yield kind(NEAR) if kind is CommandRejected else kind("Words.")


def test_every_domain_error_has_a_status_of_its_own() -> None:
    for error in domain_errors():
        problem = problem_of(error)
        assert problem.status in {404, 409, 422, 429, 503}, error
        assert problem.detail, error


async def test_a_refusal_has_every_reason(api: httpx.AsyncClient, machine: FakeMachine) -> None:
    machine.rejects["track"] = (NEAR, FAR)
    answer = await api.post("/trackers/T1/commands", json={"type": "track"})
    assert answer.status_code == 409
    assert answer.headers["content-type"] == "application/problem+json"
    body = answer.json()
    assert [reason["code"] for reason in body["reasons"]] == ["near", "far"]
    assert body["reasons"][0]["hint"] == "Move it away."
    assert body["detail"] == "The panel is near something. The panel is far from something."
    machine.rejects["track"] = (Reason("drive_unreachable", "The drive does not answer."),)
    answer = await api.post("/trackers/T1/commands", json={"type": "track"})
    assert (answer.status_code, answer.headers["retry-after"]) == (503, "1")
    assert answer.json()["reasons"][0]["code"] == "drive_unreachable"


async def test_without_the_machine_reading_says_so_and_no_order_is_kept(
    api: httpx.AsyncClient, machine: FakeMachine
) -> None:
    machine.cut()
    for path in ("/site", "/trackers", "/trackers/T1/snapshot", "/ready", "/sun"):
        answer = await api.get(path)
        assert answer.status_code == 503, path
        assert answer.json()["detail"].endswith("."), path
    assert (await api.get("/health")).status_code == 200
    assert "heliopanel_machine_up 0.0" in (await api.get("/metrics")).text
    assert (await api.post("/trackers/T1/stop")).status_code == 503
    machine.mend()
    assert machine.orders == []


@pytest.mark.parametrize(
    ("body", "command"),
    [
        ({"type": "move", "azimuth_deg": 10, "elevation_deg": 20}, Move(Orientation(10.0, 20.0))),
        (
            {"type": "set_mode", "mode": "azimuth", "elevation_deg": 30},
            SelectMode(Mode.AZIMUTH, Orientation(180.0, 30.0)),
        ),
    ],
)
async def test_a_command_is_one_order(
    api: httpx.AsyncClient, machine: FakeMachine, body: dict[str, object], command: object
) -> None:
    asked = body | {"issued_at": "2026-06-21T12:00:00+03:00"}
    answer = await api.post("/trackers/T1/commands", json=asked, headers={"Idempotency-Key": "k1"})
    assert answer.status_code == 202
    assert answer.json()["tracker_id"] == "T1"
    (order,) = machine.orders
    assert order.command == command
    assert order.key == "k1"
    assert order.issued_at is not None
    assert order.issued_at.isoformat() == "2026-06-21T12:00:00+03:00"


async def test_jog_is_a_lease_and_letting_go_ends_it(api: httpx.AsyncClient, machine: FakeMachine) -> None:
    body = {"press_id": "p1", "axis": "elevation", "direction": -1, "speed": "fast", "sequence": 3}
    assert (await api.post("/trackers/T1/jog", json=body)).status_code == 202
    assert (await api.delete("/trackers/T1/jog/p1")).status_code == 202
    refused = await api.post("/trackers/T1/jog", json=body | {"sequence": 4})
    assert refused.status_code == 409
    assert refused.json()["reasons"][0]["code"] == "press_dead"
    orders = [order.command for order in machine.orders]
    assert orders[:2] == [Jog("p1", Axis.ELEVATION, -1, JogSpeed.FAST, 3), EndJog("p1")]


async def test_stop_needs_no_body_and_bears_any(api: httpx.AsyncClient, machine: FakeMachine) -> None:
    assert (await api.post("/trackers/T2/stop")).status_code == 202
    assert (await api.post("/trackers/T2/stop", content=b"anything")).status_code == 202
    assert (await api.post("/stop")).status_code == 202
    assert [order.command.kind for order in machine.orders] == ["stop", "stop", "stop_all"]
    assert machine.orders[0].command == Stop()


@pytest.mark.parametrize(
    ("method", "path", "body"),
    [
        ("PUT", "/site/location", '{"latitude_deg": NaN, "longitude_deg": 0, "time_zone": "UTC"}'),
        ("PUT", "/site/location", '{"latitude_deg": 1, "longitude_deg": 0, "time_zone": "UTC", "lat": 1}'),
        ("PUT", "/site/location", '{"latitude_deg": 1, "longitude_deg": 0, "time_zone": "Mars/Base"}'),
        ("PUT", "/site/clock", '{"source": "manual", "at": "2026-06-21T12:00:00"}'),
        ("PATCH", "/trackers/T1", '{"azimuth": {"minimum_deg": 400}}'),
        ("POST", "/trackers", '{"tracker_id": "T1", "name": "Again"}'),
        ("POST", "/trackers/T1/commands", '{"type": "fly"}'),
        ("POST", "/trackers/T1/commands", "not json"),
    ],
)
async def test_wrong_values_are_422_and_change_nothing(
    api: httpx.AsyncClient, machine: FakeMachine, method: str, path: str, body: str
) -> None:
    before = machine.site, machine.trackers["T1"].config
    headers = {"Content-Type": "application/json"}
    answer = await api.request(method, path, content=body, headers=headers)
    assert answer.status_code == 422
    problem = answer.json()
    assert problem["detail"]
    assert all(fault["pointer"] and fault["detail"] for fault in problem.get("errors", []))
    assert (machine.site, machine.trackers["T1"].config) == before


@pytest.mark.parametrize(
    ("method", "path", "status"),
    [("DELETE", "/trackers/T9", 404), ("GET", "/recordings/none", 404), ("GET", "/nothing", 404),
     ("GET", "/trackers/T1/shows/none", 404), ("PUT", "/trackers", 405)],
)  # fmt: skip
async def test_what_does_not_exist_is_a_problem_too(
    api: httpx.AsyncClient, method: str, path: str, status: int
) -> None:
    answer = await api.request(method, path)
    assert answer.status_code == status
    assert answer.headers["content-type"] == "application/problem+json"


async def test_frames_come_as_columns_csv_and_parquet(api: httpx.AsyncClient) -> None:
    frames = "/recordings/show-1/samples"
    columns = (await api.get(frames, params={"points": 50, "start_s": 10, "end_s": 20})).json()["columns"]
    assert 18 <= len(columns["elapsed_s"]) <= 50
    assert 10 <= columns["elapsed_s"][0] <= columns["elapsed_s"][-1] <= 20
    lines = (await api.get(frames, params={"format": "csv", "end_s": 1})).text.splitlines()
    assert lines[0].startswith("time_utc,sun_time_utc,elapsed_s")
    table = pq.read_table(io.BytesIO((await api.get(frames, params={"format": "parquet"})).content))
    assert table.num_rows == 1800
    assert len(lines) == 12


@pytest.mark.fault(69)
async def test_names_are_text_in_the_record_not_markup(api: httpx.AsyncClient, fault: FaultResult) -> None:
    await api.patch("/trackers/T1", json={"name": "<script>alert(1)</script>"})
    page = (await api.get("/trackers/T1/record", params={"format": "html"})).text
    assert "<script>" not in page
    fault.prevented("what a user typed is text on every page")
    fault.shows_nothing("the name is shown as it was typed")
    fault.recovers("nothing was lost")


async def test_diagnostics_have_state_and_no_secrets(machine: FakeMachine) -> None:
    app = fake_app(machine)
    secret = app.state.panel.settings.model_copy(
        update={"database_url": "postgresql+psycopg://me:hidden@127.0.0.1/x"}
    )
    object.__setattr__(app.state.panel, "settings", secret)
    async with serving(app) as client:
        answer = await client.get("/api/v1/diagnostics.zip")
    archive = zipfile.ZipFile(io.BytesIO(answer.content))
    texts = {name: archive.read(name).decode() for name in archive.namelist()}
    assert "hidden" not in "".join(texts.values())
    assert json.loads(texts["site.json"])["site"]["name"] == "Samsun solar field"


async def test_sun_day_has_rise_transit_set_as_json_and_csv(api: httpx.AsyncClient) -> None:
    query = {"date": "2026-06-21", "step_s": "3600"}
    day = (await api.get("/sun/day", params=query)).json()
    assert day["rise"].startswith("2026-06-21T02:0")
    assert day["set"].startswith("2026-06-21T17:1")
    assert 71.9 < day["transit_elevation_deg"] < 72.3
    assert len(day["path"]) == 25
    table = (await api.get("/sun/day", params=query | {"format": "csv"})).text.splitlines()
    assert len(table) == 26


async def test_simulation_and_backups_against_the_real_store(tmp_path: Path) -> None:
    async with Desk(tmp_path) as desk:
        place = {"latitude_deg": 41.2867, "longitude_deg": 36.33, "time_zone": "Europe/Istanbul"}
        await desk.ask("PUT", "/api/v1/site/location", json=place | {"confirmed": True})
        span = {"start": "2027-06-21T12:00:00+03:00", "end": "2027-06-21T13:00:00+03:00"}
        new = {"tracker_id": "T1", "step_s": 60, **span}
        made = await desk.ask("POST", "/api/v1/simulations", json=new)
        assert made.status_code == 201, made.text
        frames = (await desk.ask("GET", f"{made.headers['location']}/samples")).json()
        backup = await desk.ask("POST", "/api/v1/backups")
        download = await desk.ask("GET", backup.headers["location"])
        missing = await desk.ask("GET", "/api/v1/backups/other.backup")
    assert frames["sample_count"] == made.json()["sample_count"] == 61
    assert (tmp_path / "backups" / backup.json()["file"]).stat().st_size == backup.json()["size_bytes"]
    assert backup.json()["recordings"] == 1
    assert backup.json()["audit_head"]
    assert len(download.content) == backup.json()["size_bytes"]
    assert missing.status_code == 404
    assert download.content.startswith(b"SQLite format 3")


async def test_an_axis_gets_a_unit_of_its_own_and_null_takes_it_back(api: httpx.AsyncClient) -> None:
    path = "/trackers/T1"
    line = {"kind": "modbus-rtu", "serial": {"port": "/dev/ttyNone", "parity": "none"}}
    await api.patch(path, json={"drive": {**line, "azimuth": {"unit": 5, "gear_ratio": 40.0}}})
    drive = (await api.get(path)).json()["drive"]
    assert (drive["serial"]["parity"], drive["serial"]["baud_rate"]) == ("none", 19200)
    assert (drive["azimuth"]["unit"], drive["azimuth"]["gear_ratio"]) == (5, 40.0)

    await api.patch(path, json={"drive": {"azimuth": {"unit": None}}})
    azimuth = (await api.get(path)).json()["drive"]["azimuth"]
    assert (azimuth["unit"], azimuth["gear_ratio"]) == (None, 40.0)
