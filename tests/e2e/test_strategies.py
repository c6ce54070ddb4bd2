"""Strategies on the served product: programs by hand and from CSV, and a cable that wraps.

Angles are small, so that a real axis is there in seconds; the sun plays no part in a step program.
"""

from collections.abc import Iterator
from datetime import UTC, datetime, timedelta
from typing import Any

import httpx
import numpy as np
import pytest

from tests.e2e.integrator import Integrator
from tests.e2e.product import Product
from tests.e2e.sky import columns

PAGE = "/trackers/T1/strategy"
PLACES = ((2.0, 2.0), (5.0, 4.0), (8.0, 6.0))
SHOWN = {"start": "2027-06-21T06:00:00+03:00", "end": "2027-06-21T07:30:00+03:00"}
STEPS_AT = ("00:00", "06:30", "07:00")
SWITCH_IN = timedelta(seconds=4)


@pytest.fixture(scope="module")
def tracker(product: Product) -> Iterator[Integrator]:
    """Give a tracker in Samsun whose zero is trusted and that moves without a warning."""
    calling = Integrator(product.url)
    calling.http.timeout = httpx.Timeout(90.0)
    calling.call("PATCH", "", json={"protection": {"warning_s": 0.0}})
    calling.place_and_time()
    calling.until_allowed("set_home")
    calling.zero()
    calling.command("set_mode", mode="dual")
    yield calling
    calling.close()


@pytest.fixture
def service(tracker: Integrator) -> Iterator[Integrator]:
    """Give the tracker, which stands again after each test."""
    yield tracker
    tracker.post("/stop")
    tracker.until(lambda seen: seen["activity"] == "holding", "the panel stands")


def stands_at(seen: dict[str, Any], place: tuple[float, float]) -> bool:
    measured = seen["measured"]
    off = abs(measured["azimuth_deg"] - place[0]), abs(measured["elevation_deg"] - place[1])
    return max(off) < 0.06 and not seen["azimuth"]["moving"]


def as_typed(times: tuple[str, ...]) -> dict[str, Any]:
    """Return what the table on the page holds after somebody has typed three rows."""
    head = {
        "program_name": "Manual values",
        "base": "clock",
        "offset": "3",
        "angles": "horizon",
        "do": "save",
    }
    angles = {
        "first": [f"{first:g}" for first, _ in PLACES],
        "second": [f"{second:g}" for _, second in PLACES],
    }
    return head | {"at": list(times)} | angles


def as_csv(times: tuple[str, ...]) -> str:
    rows = [f"{at},{first:g},{second:g}" for at, (first, second) in zip(times, PLACES, strict=True)]
    return "\n".join(["# From CSV", "clock_time_utc+03:00,azimuth_deg,elevation_deg", *rows])


def give(service: Integrator, how: str, times: tuple[str, ...]) -> None:
    """Have the tracker follow the program that was made by hand on its page, or imported over the API."""
    if how == "by hand":
        answer = service.http.post(f"{PAGE}/program", data=as_typed(times))
        assert answer.is_success or answer.is_redirect, answer.text
    else:
        service.call("PUT", "/program.csv", content=as_csv(times), headers={"Content-Type": "text/csv"})
    name = "Manual values" if how == "by hand" else "From CSV"
    assert service.get("/program")["name"] == name


@pytest.mark.parametrize("how", ["by hand", "from CSV"])
def test_a_program_runs_on_the_machine(service: Integrator, how: str) -> None:
    local = datetime.fromisoformat(service.snapshot()["at"]).astimezone(UTC) + timedelta(hours=3)
    switch = local + SWITCH_IN
    give(service, how, ("00:00", f"{switch:%H:%M:%S}", "23:00"))
    service.command("track")
    seen = service.until(
        lambda seen: seen["program"] and seen["program"]["step"] == 2 and stands_at(seen, PLACES[1]),
        "the panel stands where the second step has it",
    )
    assert datetime.fromisoformat(seen["at"]) > switch - timedelta(hours=3, seconds=1)
    assert "step 2 of 3" in seen["activity_text"]


@pytest.mark.parametrize("how", ["by hand", "from CSV"])
def test_a_program_runs_in_a_simulation(service: Integrator, how: str) -> None:
    give(service, how, STEPS_AT)
    info = service.post("/api/v1/simulations", {"tracker_id": "T1", "step_s": 10, **SHOWN})
    frames = columns(service.get(f"/api/v1/recordings/{info['recording_id']}/samples"))
    azimuth, elevation = frames["measured_azimuth_deg"], frames["measured_elevation_deg"]
    assert_visited(azimuth, elevation)
    switched = np.flatnonzero(np.abs(np.diff(azimuth)) > 1.0) + 1
    assert frames["elapsed_s"][switched].tolist() == pytest.approx([1800.0, 3600.0], abs=10.0)


def assert_visited(azimuth: Any, elevation: Any) -> None:
    for first, second in PLACES:
        off = np.maximum(np.abs(azimuth - first), np.abs(elevation - second))
        assert off.min() < 0.06, (first, second)


def test_a_wrapped_cable_unwinds_at_night_and_not_at_noon(service: Integrator) -> None:
    """From a morning in the upper part of 540 degrees to the place of the next sunrise in the lower one."""
    wide = {"minimum_deg": -270.0, "maximum_deg": 270.0}
    service.call("PATCH", "", json={"azimuth": wide, "strategy": {"kind": "deadband"}})
    span = {"start": "2026-12-21T11:30:00+03:00", "end": "2026-12-21T19:00:00+03:00"}
    info = service.post("/api/v1/simulations", {"tracker_id": "T1", "step_s": 10, "mode": "dual", **span})
    frames = columns(service.get(f"/api/v1/recordings/{info['recording_id']}/samples"))
    turned_deg = np.abs((np.diff(frames["measured_azimuth_deg"]) + 180.0) % 360.0 - 180.0)
    up = frames["sun_elevation_deg"][1:] > 0.0
    noon = np.abs(frames["sun_azimuth_deg"][1:] - 180.0) < 10.0
    assert noon.sum() > 100
    assert turned_deg[up].max() < 2.0, "no way round while the sun is up"
    assert turned_deg[~up].sum() == pytest.approx(480.0, abs=5.0), "from 240 degrees down to -240"
