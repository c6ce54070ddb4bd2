"""Who changes settings that have changed since they were read learns of it, and changes nothing."""

import asyncio
from collections.abc import AsyncIterator
from pathlib import Path
from typing import Any

import pytest

from tests.web.desk import Desk
from tests.web.test_openapi_lint import document

API = "/api/v1"
POINTS = {"points": [{"azimuth_deg": 135, "elevation_deg": 8}]}


def program(elevation_deg: float) -> dict[str, Any]:
    return {"name": "One step", "steps": [{"from_h": 6, "first_deg": 180, "second_deg": elevation_deg}]}


def place(latitude_deg: float) -> dict[str, Any]:
    return {
        "latitude_deg": latitude_deg,
        "longitude_deg": 33.0,
        "time_zone": "Europe/Istanbul",
        "confirmed": True,
    }


SETTINGS: dict[str, tuple[str, dict[str, Any], dict[str, Any]]] = {
    "/trackers/T1": ("PATCH", {"deadband_deg": 0.7}, {"deadband_deg": 0.8}),
    "/trackers/T1/program": ("PUT", program(70), program(60)),
    "/site": ("PATCH", {"name": "North"}, {"name": "South"}),
    "/site/location": ("PUT", place(37.0), place(37.5)),
    "/site/clock": ("PUT", {"source": "system"}, {"source": "system", "time_zone": "UTC"}),
    "/site/horizon": ("PUT", POINTS, {"points": [{"azimuth_deg": 90, "elevation_deg": 5}]}),
    "/site/notifications": ("PUT", {"mail_to": ["a@b.c"]}, {"mail_to": ["d@e.f"]}),
    "/site/weather/station": ("PUT", {"host": "127.0.0.1"}, {"host": "127.0.0.2"}),
    "/site/weather/simulation": ("PUT", {"scenario": "storm"}, {"scenario": "calm"}),
    "/site/weather/windows": ("PUT", {"gust_s": 4.0}, {"gust_s": 5.0}),
    "/trackers/T1/settings-lock": ("PUT", {"locked": True}, {"locked": False, "reason": "service"}),
}


@pytest.fixture
async def desk(tmp_path: Path) -> AsyncIterator[Desk]:
    async with Desk(tmp_path) as made:
        yield made


async def tag_at(desk: Desk, path: str) -> str:
    return str((await desk.ask("GET", API + path)).headers["ETag"])


async def test_a_lost_update_is_refused(desk: Desk) -> None:
    await desk.ask("PUT", f"{API}/trackers/T1/program", json=program(50))
    for path, (method, mine, yours) in SETTINGS.items():
        read = await tag_at(desk, path)
        assert await tag_at(desk, path) == read
        first = await desk.ask(method, API + path, json=mine, headers={"If-Match": f'"other", {read}'})
        assert first.status_code == 200, first.text
        before = (await desk.ask("GET", API + path)).json()
        second = await desk.ask(method, API + path, json=yours, headers={"If-Match": read})
        assert (second.status_code, second.json()["code"]) == (412, "precondition_failed"), path
        assert (await desk.ask("GET", API + path)).json() == before
        anyway = await desk.ask(method, API + path, json=yours, headers={"If-Match": "*"})
        assert anyway.status_code == 200, anyway.text
        assert await tag_at(desk, path) != read or path.endswith("settings-lock")
        await desk.forward(0.1)


async def test_of_two_at_the_same_time_one_is_refused(desk: Desk) -> None:
    read = {"If-Match": await tag_at(desk, "/trackers/T1")}
    changes = ({"deadband_deg": 0.5 + number / 10} for number in range(1, 5))
    asked = [desk.ask("PATCH", f"{API}/trackers/T1", json=one, headers=read) for one in changes]
    statuses = [one.status_code for one in await asyncio.gather(*asked)]
    assert sorted(statuses) == [200, 412, 412, 412]


async def test_removing_needs_what_was_read_too(desk: Desk) -> None:
    answer = await desk.ask("DELETE", f"{API}/trackers/T1", headers={"If-Match": '"other"'})
    assert answer.status_code == 412


UNTAGGED = {
    "/site/weather": "a measurement, not a setting",
    "/trackers/{tracker_id}/sightings": "measurements, of which those are kept that are named",
}
"""What is read and replaced without a tag, and why."""


def test_every_setting_that_is_read_and_replaced_has_a_tag() -> None:
    untagged, tagged = set(), 0
    for path, calls in document()["paths"].items():
        changes = [calls[method] for method in ("put", "patch") if method in calls]
        if "get" not in calls or not changes:
            continue
        reads = "ETag" in calls["get"]["responses"]["200"].get("headers", {})
        checks = [
            "412" in one["responses"] and "If-Match" in {given["name"] for given in one["parameters"]}
            for one in changes
        ]
        assert set(checks) == {reads}, path
        tagged += reads
        untagged |= set() if reads else {path.removeprefix(API)}
    assert untagged == set(UNTAGGED)
    assert tagged == len(SETTINGS) + 1, "and where Heliopanel listens"
