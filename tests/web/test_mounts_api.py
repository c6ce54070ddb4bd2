"""Mounts over REST: kinds, rows, actuators, abilities and reach."""

import httpx
import pytest

TRACKER = "/trackers/T1"


@pytest.fixture
def api(client: httpx.AsyncClient) -> httpx.AsyncClient:
    client.base_url = httpx.URL("http://127.0.0.1:8010/api/v1")
    return client


async def test_rows_come_with_a_number_and_go_with_null(api: httpx.AsyncClient) -> None:
    rows = {"ground_coverage_ratio": 0.4, "cross_axis_tilt_deg": 3.0}
    change = {"mount": {"kind": "horizontal-single-axis", "rows": rows}}
    assert (await api.patch(TRACKER, json=change)).json()["mount"]["rows"] == rows
    assert (await api.patch(TRACKER, json={"mount": {"rows": None}})).json()["mount"]["rows"] is None
    refused = await api.patch(TRACKER, json={"mount": {"kind": "equatorial", "rows": rows}})
    assert refused.status_code == 422
    assert "remove the rows" in refused.json()["detail"]


async def test_an_actuator_is_taken_by_its_points_and_given_up_with_null(api: httpx.AsyncClient) -> None:
    actuator = (await api.get("/actuator-presets")).json()["alexandru-diurnal"]
    await api.patch(TRACKER, json={"mount": {"kind": "equatorial"}})
    axis = {"minimum_deg": -60, "maximum_deg": 60, "speed_dps": 3, "actuator": actuator}
    too_wide = await api.patch(TRACKER, json={"azimuth": axis | {"maximum_deg": 80}})
    assert too_wide.status_code == 422
    assert "The actuator's stroke turns the axis from -60.01 to 60.00 degrees" in too_wide.json()["detail"]
    assert (await api.patch(TRACKER, json={"azimuth": axis})).json()["azimuth"]["actuator"] == actuator
    freed = (await api.patch(TRACKER, json={"azimuth": {"actuator": None}})).json()
    assert freed["azimuth"]["actuator"] is None


async def test_capabilities_and_reach_tell_what_the_mount_can_do(api: httpx.AsyncClient) -> None:
    await api.patch(TRACKER, json={"mount": {"kind": "tilted-single-axis"}})
    can = (await api.get(f"{TRACKER}/capabilities")).json()["mount"]
    assert can["second"] is None
    assert list(can["modes"]) == ["fixed", "azimuth"]
    got = (await api.get(f"{TRACKER}/mount")).json()
    assert got["abilities"] == can
    assert 20.0 < got["reach"]["beyond_percent"] < 60.0
    assert len(got["reach"]["months_percent"]) == 12
    assert set((await api.get("/mounts")).json()) >= {"equatorial", "vertical-single-axis"}


async def test_another_kind_brings_its_usual_axis_and_limits(api: httpx.AsyncClient) -> None:
    latitude_deg = (await api.get("/site")).json()["location"]["latitude_deg"]
    got = (await api.patch(TRACKER, json={"mount": {"kind": "equatorial"}})).json()
    assert got["mount"]["axis_tilt_deg"] == pytest.approx(abs(latitude_deg))
    assert got["mount"]["axis_azimuth_deg"] == (180.0 if latitude_deg >= 0 else 0.0)
    assert (got["azimuth"]["minimum_deg"], got["elevation"]["maximum_deg"]) == (-105.0, 24.0)
