"""What the fuzzer of the API found once and must not find again: one small case each."""

from collections.abc import AsyncIterator
from dataclasses import replace
from typing import Any

import httpx
import pytest
from pydantic import TypeAdapter, ValidationError

from app.base.instants import Instant
from tests.fake_data import commissioned
from tests.fake_tracker import FakeTracker
from tests.fakes import FakeMachine, fake_app, serving

V1 = "/api/v1"
INSTANT: TypeAdapter[object] = TypeAdapter(Instant)
NORTH = {"azimuth_deg": 90.0, "elevation_deg": 3.0}
MANY_FIELDS = "?" + "&".join(f"a{number}={number}" for number in range(51))
NO_INSTANT = "Write the instant in ISO 8601"
TOO_MANY = "at most 50 fields"
STUDY = {"date": "2026-06-21", "span": "day"}


@pytest.fixture
async def api(machine: FakeMachine) -> AsyncIterator[httpx.AsyncClient]:
    async with serving(fake_app(machine)) as client:
        yield client


@pytest.mark.parametrize("number", ["0.0", "37301", " 12 ", "-1461807020419.533", "1.36e-63", 0, 0.5])
def test_a_number_is_no_instant(number: object) -> None:
    with pytest.raises(ValidationError, match="ISO 8601"):
        INSTANT.validate_python(number)


@pytest.mark.parametrize("given", ["2026-06-21T12:00:00+03:00", "2026-06-21T23:59:60Z"])
def test_an_instant_with_its_offset_is_one(given: str) -> None:
    assert INSTANT.validate_python(given) is not None


REFUSED: list[tuple[str, dict[str, Any] | None, str]] = [
    ("/api/v1/audit?start=0.0", None, NO_INSTANT),
    ("/api/v1/sun?at=-1461807020419.5", None, NO_INSTANT),
    ("/api/v1/recordings/show-1/samples?points=1", None, "points"),
    ("/api/v1/recordings/show-1/samples?points=21", None, ""),
    (f"/api/v1/site{MANY_FIELDS}", None, TOO_MANY),
    (f"/journal{MANY_FIELDS}", None, TOO_MANY),
    (f"/api/v1/nothing{MANY_FIELDS}", None, TOO_MANY),
    ("/api/v1/site/horizon", {"points": [NORTH, NORTH]}, "ascending order"),
    ("/api/v1/studies", STUDY | {"degree_wh": 1.7e307}, "degree_wh"),
    ("/api/v1/studies", STUDY | {"start_wh": 1e5}, "start_wh"),
    ("/api/v1/studies", STUDY | {"standby_w": 1e300}, "standby_w"),
    ("/api/v1/studies", STUDY | {"power_w": 1e308}, "power_w"),
    ("/api/v1/studies", STUDY | {"power_w": 1e-9}, "power_w"),
]


@pytest.mark.parametrize(("path", "body", "sentence"), REFUSED)
async def test_what_cannot_be_is_refused_before_anything_is_begun(
    api: httpx.AsyncClient, path: str, body: dict[str, Any] | None, sentence: str
) -> None:
    method = "GET" if body is None else "POST" if "studies" in path else "PUT"
    answer = await api.request(method, path, json=body)
    assert answer.status_code == 422
    assert sentence in answer.text
    assert (await api.get(f"{V1}/studies")).json()["items"] == []


async def test_the_place_of_a_show_is_told_whatever_its_tracker_is_called(
    api: httpx.AsyncClient, machine: FakeMachine
) -> None:
    name = "Çatı/\U000b4e39"
    state = commissioned("T1", "North field", tracking=False)
    config = replace(state.config, tracker_id=name)
    machine.trackers[name] = FakeTracker(replace(state, config=config), machine.trackers["T1"].position)
    answer = await api.post(f"{V1}/recordings/show-1/rerun", json={"tracker_id": name, "duration_s": 9000})
    assert answer.status_code == 202, answer.text
    assert answer.headers["location"].startswith("/api/v1/trackers/%C3%87at%C4%B1%2F%F2%B4%B8%B9/shows/")


@pytest.mark.parametrize(
    ("path", "described"),
    [
        ("/trackers/T9/program/examples", "/trackers/{tracker_id}/program/examples"),
        ("/papers?paper=none", "/papers"),
    ],
)
async def test_what_is_not_there_is_documented_as_missing(
    api: httpx.AsyncClient, path: str, described: str
) -> None:
    assert (await api.get(V1 + path)).status_code == 404
    documented = (await api.get(f"{V1}/openapi.json")).json()["paths"]
    assert "404" in documented[V1 + described]["get"]["responses"]


async def test_measured_values_are_kept_as_a_file_whatever_their_tracker_is_called(
    api: httpx.AsyncClient,
) -> None:
    asked = {"start": "2026-06-21T00:00:00Z", "end": "2026-06-22T00:00:00Z", "format": "csv"}
    answer = await api.get(f"{V1}/telemetry", params={**asked, "tracker_id": 'Çatı"\r\nX-Forged: 1'})
    assert answer.status_code == 200, answer.text
    assert "x-forged" not in answer.headers
    named = answer.headers["content-disposition"]
    assert named.startswith('attachment; filename="-at-X-Forged-1-20260621T000000Z.csv"; filename*=UTF-8')
    described = (await api.get(f"{V1}/openapi.json")).json()["paths"][f"{V1}/telemetry"]["get"]
    assert answer.headers["content-type"].partition(";")[0] in described["responses"]["200"]["content"]


async def test_a_step_program_is_documented_in_each_of_its_forms(api: httpx.AsyncClient) -> None:
    table = "clock_time,azimuth_deg,elevation_deg\n06:00,90,20\n12:00,180,60\n"
    assert (await api.put(f"{V1}/trackers/T1/program.csv", content=table)).status_code == 200
    described = (await api.get(f"{V1}/openapi.json")).json()["paths"][f"{V1}/trackers/{{tracker_id}}/program"]
    documented = described["get"]["responses"]["200"]["content"]
    for form in ("json", "csv"):
        answer = await api.get(f"{V1}/trackers/T1/program", params={"format": form})
        assert answer.headers["content-type"].partition(";")[0] in documented
    assert documented["application/json"]["schema"]
