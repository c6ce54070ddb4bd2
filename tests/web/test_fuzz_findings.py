"""What the fuzzer of the API found once and must not find again: one small case each."""

from collections.abc import AsyncIterator
from dataclasses import replace

import httpx
import pytest
from pydantic import TypeAdapter, ValidationError

from app.base.instants import Instant
from tests.fake_data import commissioned
from tests.fake_tracker import FakeTracker
from tests.fakes import FakeMachine, fake_app, serving

V1 = "/api/v1"
INSTANT: TypeAdapter[object] = TypeAdapter(Instant)


@pytest.fixture
async def api(machine: FakeMachine) -> AsyncIterator[httpx.AsyncClient]:
    async with serving(fake_app(machine)) as client:
        yield client


@pytest.mark.parametrize("number", ["0.0", "37301", " 12 ", "-1461807020419.533", "1.36e-63", 0, 37301, 0.5])
def test_a_number_is_no_instant(number: object) -> None:
    with pytest.raises(ValidationError, match="ISO 8601"):
        INSTANT.validate_python(number)


@pytest.mark.parametrize("given", ["2026-06-21T12:00:00+03:00", "2026-06-21T23:59:60Z"])
def test_an_instant_with_its_offset_is_one(given: str) -> None:
    assert INSTANT.validate_python(given) is not None


@pytest.mark.parametrize("path", ["/audit?start=0.0", "/sun?at=-1461807020419.5", "/journal?end=12"])
async def test_a_number_in_the_place_of_an_instant_is_refused(api: httpx.AsyncClient, path: str) -> None:
    answer = await api.get(V1 + path)
    assert answer.status_code == 422
    assert "Write the instant in ISO 8601" in answer.json()["errors"][0]["detail"]


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


async def test_too_few_points_are_refused(api: httpx.AsyncClient) -> None:
    for points in (1, 18, 21):
        answer = await api.get(f"{V1}/recordings/show-1/samples", params={"points": points})
        assert answer.status_code == 422, points


async def test_examples_of_a_tracker_that_is_not_there_are_documented_as_missing(
    api: httpx.AsyncClient,
) -> None:
    assert (await api.get(f"{V1}/trackers/T9/program/examples")).status_code == 404
    described = (await api.get(f"{V1}/openapi.json")).json()["paths"]
    assert "404" in described[f"{V1}/trackers/{{tracker_id}}/program/examples"]["get"]["responses"]


@pytest.mark.parametrize("path", ["/api/v1/site", "/journal", "/api/v1/nothing"])
async def test_an_address_of_very_many_fields_is_refused(api: httpx.AsyncClient, path: str) -> None:
    answer = await api.get(f"{path}?" + "&".join(f"a{number}={number}" for number in range(51)))
    assert answer.status_code == 422
    assert "at most 50 fields" in answer.text


async def test_two_points_of_the_horizon_in_one_direction_are_refused(api: httpx.AsyncClient) -> None:
    point = {"azimuth_deg": 90.0, "elevation_deg": 3.0}
    answer = await api.put(f"{V1}/site/horizon", json={"points": [point, point]})
    assert answer.status_code == 422
    assert "ascending order" in answer.json()["detail"]


@pytest.mark.parametrize(
    "given",
    [{"degree_wh": 1.7e307}, {"start_wh": 1e5}, {"standby_w": 1e300}, {"power_w": 1e308}, {"power_w": 1e-9}],
)
async def test_a_study_whose_energy_is_beyond_all_numbers_is_not_begun(
    api: httpx.AsyncClient, given: dict[str, float]
) -> None:
    answer = await api.post(f"{V1}/studies", json={"date": "2026-06-21", "span": "day", **given})
    assert answer.status_code == 422
    (told,) = answer.json()["errors"]
    assert next(iter(given)) in str(told)
    assert (await api.get(f"{V1}/studies")).json()["items"] == []


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


async def test_a_paper_that_is_not_there_is_documented_as_missing(api: httpx.AsyncClient) -> None:
    assert (await api.get(f"{V1}/papers", params={"paper": "none"})).status_code == 404
    described = (await api.get(f"{V1}/openapi.json")).json()["paths"]
    assert "404" in described[f"{V1}/papers"]["get"]["responses"]


async def test_a_step_program_is_documented_in_each_of_its_forms(api: httpx.AsyncClient) -> None:
    table = "clock_time,azimuth_deg,elevation_deg\n06:00,90,20\n12:00,180,60\n"
    assert (await api.put(f"{V1}/trackers/T1/program.csv", content=table)).status_code == 200
    described = (await api.get(f"{V1}/openapi.json")).json()["paths"][f"{V1}/trackers/{{tracker_id}}/program"]
    documented = described["get"]["responses"]["200"]["content"]
    for form in ("json", "csv"):
        answer = await api.get(f"{V1}/trackers/T1/program", params={"format": form})
        assert answer.headers["content-type"].partition(";")[0] in documented
    assert documented["application/json"]["schema"]
