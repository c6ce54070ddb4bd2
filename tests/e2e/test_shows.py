"""The shows that are promised, planned through the API and followed at show speed on a virtual clock."""

from collections.abc import Iterator
from dataclasses import dataclass
from datetime import timedelta
from typing import Any

import numpy as np
import pytest

from app.show.simulate import simulate_show
from app.store.engine import open_reader
from app.tracker.memory.memory import Pointing
from app.tracker.memory.recording import COLUMNS
from app.tracker.programs.plan import ShowPlan
from app.tracker.programs.show import ShowCourse
from app.tracker.settings.config import TrackerConfig
from tests.e2e.integrator import SAMSUN, SOLSTICE_MORNING, Integrator, Refused
from tests.e2e.product import Product
from tests.e2e.sky import Column, columns, off_spa_deg, off_sun_deg, separation_deg, spa_deg

SPA_LIMIT_DEG = 0.01
DEADBAND_DEG = 0.5
GATHERS_SPEED_S = 2.0
BELOW_THE_HORIZON = "limited"
"""Without refraction, which SPA is compared without, the sun's middle rises below the horizon."""
TRACKER = TrackerConfig("T1", "Tracker 1", refraction=False)
SVALBARD = {
    "latitude_deg": 78.0,
    "longitude_deg": 15.0,
    "altitude_m": 0.0,
    "time_zone": "Arctic/Longyearbyen",
}
SYDNEY = {"latitude_deg": -34.0, "longitude_deg": 151.0, "altitude_m": 0.0, "time_zone": "Australia/Sydney"}
TROPIC = {"latitude_deg": 23.0, "longitude_deg": 36.0, "altitude_m": 0.0, "time_zone": "Africa/Cairo"}


@dataclass(frozen=True)
class Promise:
    """A show that has to work: where, which stretch of the sun, in how long, and what is said about it."""

    place: dict[str, Any]
    stretch: dict[str, str]
    seconds: float
    notices: tuple[str, ...] = ()
    spans_of_sun: int = 1


SOLSTICE = {"date": "2026-06-21"}
PROMISES = {
    "solstice": Promise(SAMSUN, SOLSTICE, 180.0),
    "across midnight": Promise(
        SAMSUN,
        {"start": "2026-06-21T15:00:00+03:00", "end": "2026-06-22T12:00:00+03:00"},
        180.0,
        ("sun_down",),
        spans_of_sun=2,
    ),
    "sun partly down": Promise(
        SAMSUN,
        {"start": "2026-06-21T16:00:00+03:00", "end": "2026-06-21T23:00:00+03:00"},
        90.0,
        ("sun_down",),
    ),
    "polar day": Promise(
        SVALBARD,
        {"start": "2026-06-21T06:00:00+02:00", "end": "2026-06-22T06:00:00+02:00"},
        300.0,
        ("unwinding",),
    ),
    "34 south": Promise(SYDNEY, {"date": "2026-07-10"}, 300.0, ("unwinding",)),
    "through the zenith": Promise(TROPIC, {"date": "2026-07-02"}, 180.0, ("keyhole",)),
}


@pytest.fixture(scope="module")
def planner(product: Product) -> Iterator[Integrator]:
    calling = Integrator(product.url)
    calling.call("PATCH", "", json={"refraction": False})
    calling.until_allowed("set_home")
    calling.zero()
    yield calling
    calling.close()


def stand_at(planner: Integrator, place: dict[str, Any]) -> None:
    planner.call("PUT", "/api/v1/site/location", json={**place, "confirmed": True})


def kept_plan(product: Product, show_id: str) -> ShowPlan:
    reader = open_reader(f"sqlite:///{product.data_dir / 'heliopanel.db'}")
    planned = reader.show(show_id)
    reader.close()
    assert planned is not None
    return planned.plan


def codes(reasons: list[dict[str, str]]) -> tuple[str, ...]:
    return tuple(reason["code"] for reason in reasons)


def follow(plan: ShowPlan) -> dict[str, Column]:
    """Return what the tracker does in the show, with the drive's own ramps and speeds."""
    info, frames = simulate_show(TRACKER, Pointing(), "UTC", plan)
    assert info.outcome == "completed"
    assert info.duration_s == pytest.approx(plan.duration.total_seconds(), abs=0.3)
    return {name: frames.column(name) for name in COLUMNS}


def counted(plan: ShowPlan, frames: dict[str, Column]) -> Column:
    """Return which frames have to lie on the sun: it is up, and no repositioning was announced."""
    course = ShowCourse(plan, TRACKER)
    aims = [course.at(timedelta(seconds=elapsed_s)) for elapsed_s in frames["elapsed_s"].tolist()]
    follows = np.array([aim.sun.elevation_deg >= 0.0 and not aim.repositioning for aim in aims])
    moved = np.diff(follows.astype(int), prepend=0) == 1
    for begins_s in frames["elapsed_s"][moved]:
        gathers = (frames["elapsed_s"] >= begins_s) & (frames["elapsed_s"] < begins_s + GATHERS_SPEED_S)
        follows &= ~gathers
    return follows


@pytest.mark.parametrize("name", PROMISES)
def test_promised_show(name: str, planner: Integrator, product: Product) -> None:
    promise = PROMISES[name]
    stand_at(planner, promise.place)
    planned = planner.post("/shows", {**promise.stretch, "duration_s": promise.seconds})
    plan = kept_plan(product, planned["show_id"])

    assert planned["feasible"], planned["reasons"]
    assert set(codes(planned["notices"])) - {BELOW_THE_HORIZON} == set(promise.notices)
    assert len(planned["sun_up"]) == promise.spans_of_sun
    assert plan.location.latitude_deg == promise.place["latitude_deg"]
    check_on_the_sun(plan)


def check_on_the_sun(plan: ShowPlan) -> None:
    frames = follow(plan)
    follows = counted(plan, frames)
    assert follows.mean() > 0.4
    assert off_sun_deg(frames)[follows].max() < DEADBAND_DEG
    azimuth, elevation = spa_deg(
        plan.begin_at.timestamp() + frames["sun_time_s"],
        plan.location.latitude_deg,
        plan.location.longitude_deg,
        plan.location.altitude_m,
    )
    seen = separation_deg(frames["sun_azimuth_deg"], frames["sun_elevation_deg"], azimuth, elevation)
    assert seen.max() < SPA_LIMIT_DEG


def test_too_fast_show_is_refused_with_the_shortest_that_works(planner: Integrator, product: Product) -> None:
    stand_at(planner, SAMSUN)
    planned = planner.post("/shows", {**SOLSTICE, "duration_s": 20})
    shortest_s = planned["shortest_s"]
    with pytest.raises(Refused) as refused:
        planner.post(f"/shows/{planned['show_id']}/go-to-start")

    assert not planned["feasible"]
    assert refused.value.status == 409
    assert set(refused.value.codes) >= {"azimuth_too_fast", "elevation_too_fast"}
    assert "2 min 0 s" in str(refused.value)
    assert planner.snapshot()["activity"] == "holding"

    works = planner.post("/shows", {**SOLSTICE, "duration_s": shortest_s})
    too_short = planner.post("/shows", {**SOLSTICE, "duration_s": shortest_s - 1})
    assert works["feasible"]
    assert not too_short["feasible"]
    check_on_the_sun(kept_plan(product, works["show_id"]))


def test_a_simulated_day_is_on_the_sun_from_rise_to_set(planner: Integrator) -> None:
    stand_at(planner, SAMSUN)
    planner.call(
        "PUT", "/api/v1/site/clock", json={"source": "manual", "at": SOLSTICE_MORNING, "confirmed": True}
    )
    info = planner.post("/api/v1/simulations", {"tracker_id": "T1", "mode": "dual", **SOLSTICE})
    frames = columns(planner.get(f"/api/v1/recordings/{info['recording_id']}/samples"))

    up = frames["sun_elevation_deg"] > 0.5
    assert up.sum() > 14 * 3600
    assert off_spa_deg(info, frames).max() < SPA_LIMIT_DEG
    assert off_sun_deg(frames)[up].max() <= DEADBAND_DEG
