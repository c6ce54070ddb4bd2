"""Sun paths, the horizon, trends and the overview, on pages and over the API."""

import csv
import io
import re
from dataclasses import replace
from datetime import date, timedelta
from itertools import pairwise

import httpx
import numpy as np
import pytest

from app.sun.horizon import Horizon
from app.sun.position import Algorithm
from app.tracker.memory.recording import COLUMNS, RecordingKind
from app.tracker.mounts.usual import mounted
from app.tracker.settings.axes import AxisConfig
from app.tracker.settings.config import MountKind, TrackerConfig
from app.tracker.state.snapshot import ActivityName, Pair
from app.web.charts.cartesian import cartesian
from app.web.charts.sunpath import hours_of
from app.web.shell.scene import scene_on, scene_recorded
from tests.fake_alarms import alarm
from tests.fake_data import NOON, SAMSUN, TIME_ZONE, commissioned, recording
from tests.fake_tracker import FakeTracker
from tests.fakes import FakeMachine

HILLS = Horizon(((100.0, 12.0), (250.0, 22.0)))
JUNE = date(2026, 6, 21)
CONFIG = TrackerConfig("T1", "North field")
LEFT, BOTTOM, PER_DEGREE, RISE = 56.0, 286.0, 2.0, 3.0


def points_of(path: str) -> list[tuple[float, float]]:
    return [(float(x), float(y)) for x, y in re.findall(r"[ML]([\d.]+) ([\d.]+)", path)]


def test_todays_curve_passes_where_the_sun_is_at_each_hour() -> None:
    drawn = cartesian(CONFIG, SAMSUN, TIME_ZONE, JUNE, HILLS)
    curve = np.array(points_of(drawn.today.path))
    for _, azimuth_deg, elevation_deg in hours_of(Algorithm.PSA, SAMSUN, JUNE, TIME_ZONE):
        at = np.array((LEFT + azimuth_deg * PER_DEGREE, BOTTOM - elevation_deg * RISE))
        assert np.hypot(*(curve - at).T).min() < 7.0, "no farther than half of ten minutes"
    noon = min(points_of(drawn.today.path), key=lambda one: one[1])
    assert noon == pytest.approx((LEFT + 360.0, BOTTOM - 72.15 * RISE), abs=4.0)


def test_the_skyline_is_as_high_as_the_horizon() -> None:
    drawn = cartesian(CONFIG, SAMSUN, TIME_ZONE, JUNE, HILLS)
    tops = dict(points_of(drawn.skyline))
    assert tops[LEFT + 250.0 * PER_DEGREE] == pytest.approx(BOTTOM - 22.0 * RISE)
    assert tops[LEFT + 175.0 * PER_DEGREE] == pytest.approx(BOTTOM - 17.0 * RISE, abs=0.1)
    assert cartesian(CONFIG, SAMSUN, TIME_ZONE, JUNE, Horizon()).skyline == ""


def test_south_of_the_equator_north_is_in_the_middle() -> None:
    drawn = cartesian(CONFIG, replace(SAMSUN, latitude_deg=-33.9), "Africa/Johannesburg", JUNE, HILLS)
    assert [tick.text for tick in drawn.columns][::6] == ["180° S", "0° N", "180° S"]
    noon = min(points_of(drawn.today.path), key=lambda one: one[1])
    assert noon[0] == pytest.approx(LEFT + 360.0, abs=12.0)
    for piece in drawn.months[6].path.split("M")[1:]:
        xs = [x for x, _ in points_of("M" + piece)]
        assert max(abs(a - b) for a, b in pairwise(xs)) < 60, "no line across the whole picture"


@pytest.mark.parametrize(
    ("least_deg", "most_deg", "rectangles"),
    [(0.0, 360.0, [(0, 360)]), (60.0, 300.0, [(60, 300)]), (-90.0, 200.0, [(270, 360), (0, 200)])],
)
def test_limits_are_rectangles_also_over_the_side(
    least_deg: float, most_deg: float, rectangles: list[tuple[float, float]]
) -> None:
    turning = AxisConfig(least_deg, most_deg, 6.0, 3.0, 0.5, 2.0)
    path = cartesian(replace(CONFIG, azimuth=turning), SAMSUN, TIME_ZONE, JUNE, HILLS).reach
    found = [(float(a), float(b)) for a, b in re.findall(r"M([\d.]+) [\d.]+H([\d.]+)", path)]
    assert found == [(LEFT + a * PER_DEGREE, LEFT + b * PER_DEGREE) for a, b in rectangles]


def test_the_scene_has_the_limits_of_the_mount_and_a_recording_those_it_was_made_with() -> None:
    config = mounted(CONFIG, MountKind.EQUATORIAL, 41.3)
    scene = scene_on(config, SAMSUN, TIME_ZONE, JUNE, Algorithm.PSA, HILLS)
    assert (scene.first, scene.second) == ((-105.0, 105.0), (-24.0, 24.0))
    single = mounted(CONFIG, MountKind.HORIZONTAL_SINGLE_AXIS, 41.3)
    assert scene_on(single, SAMSUN, TIME_ZONE, JUNE, Algorithm.PSA, HILLS).second is None
    info = recording("show-1", RecordingKind.SHOW, "A show", 15.0, 180.0)
    assert scene_recorded(info, JUNE).first is None, "from before mounts were recorded"
    shown = scene_recorded(replace(info, mount=config.mount, first_deg=(-105.0, 105.0)), JUNE)
    assert (shown.mount.kind, shown.first) == (MountKind.EQUATORIAL, (-105.0, 105.0))


async def test_the_horizon_is_kept_and_comes_back(client: httpx.AsyncClient, machine: FakeMachine) -> None:
    typed = "250 22\n100,5° 12,5\n\n"
    answer = await client.post("/site/horizon", data={"points": typed})
    assert answer.headers["location"] == "/site/horizon"
    assert machine.site.horizon.points == ((100.5, 12.5), (250.0, 22.0)), "sorted by azimuth"
    page = (await client.get("/site/horizon")).text
    assert "100.5 12.5\n250 22</textarea>" in page
    assert "2 points entered" in page
    assert 'class="ct-skyline"' in (await client.get("/trackers/T1/sun-path")).text
    read = (await client.get("/api/v1/site/horizon")).json()
    assert read["points"][1] == {"azimuth_deg": 250.0, "elevation_deg": 22.0}


async def test_a_recording_is_replayed_behind_the_horizon_of_its_time(
    client: httpx.AsyncClient, machine: FakeMachine
) -> None:
    head = machine.store.heads["day-1"]
    path = f"/recordings/{head.recording_id}"
    assert 'class="sp-skyline"' not in (await client.get(path)).text
    machine.store.heads["day-1"] = replace(head, horizon=HILLS)
    assert 'class="sp-skyline"' in (await client.get(path)).text
    assert scene_recorded(machine.store.heads["day-1"], JUNE).horizon == HILLS.outline()


async def test_the_api_sets_the_horizon_and_tells_when_the_sun_is_behind_it(
    client: httpx.AsyncClient, machine: FakeMachine
) -> None:
    wall = [{"azimuth_deg": 300.0, "elevation_deg": 89.0}, {"azimuth_deg": 20.0, "elevation_deg": 89.0}]
    answer = (await client.put("/api/v1/site/horizon", json={"points": wall})).json()
    assert [one["azimuth_deg"] for one in answer["points"]] == [20.0, 300.0]
    site = (await client.get("/api/v1/site")).json()
    up = site["sun"]["apparent_elevation_deg"] >= 0.0
    assert site["sun_behind_horizon"] == answer["sun_behind_horizon"] == up
    assert (await client.put("/api/v1/site/horizon", json={"points": []})).json()["points"] == []
    bad = await client.put(
        "/api/v1/site/horizon", json={"points": [{"azimuth_deg": 361, "elevation_deg": 1}]}
    )
    assert bad.status_code == 422


async def test_a_tracker_without_a_location_has_no_sun_path_yet(
    client: httpx.AsyncClient, machine: FakeMachine
) -> None:
    machine.site = replace(machine.site, location=None)
    machine.emit()
    for path in ("/trackers/T1/sun-path", "/site/horizon"):
        assert "The sun path appears when the location is saved" in (await client.get(path)).text


async def test_trends_go_back_as_far_as_is_asked(client: httpx.AsyncClient) -> None:
    page = (await client.get("/trackers/T1/trends?span=7d")).text
    assert 'data-seconds="604800"' in page
    assert 'href="?span=7d" aria-current="true"' in page
    assert (await client.get("/trackers/T1/trends?span=2h")).status_code == 422
    assert (await client.get("/trackers/T9/trends")).status_code == 404


async def test_the_curves_can_be_taken_as_csv(client: httpx.AsyncClient, machine: FakeMachine) -> None:
    head = replace(machine.store.heads["day-1"], recording_id="day-2", kind=RecordingKind.DAY, began_at=NOON)
    machine.store.heads["day-2"] = replace(head, ended_at=NOON + timedelta(days=1))
    asked = {
        "tracker_id": "T1",
        "start": (NOON + timedelta(hours=1)).isoformat(),
        "end": (NOON + timedelta(hours=2)).isoformat(),
        "points": "100",
    }
    answer = await client.get("/api/v1/telemetry", params=asked | {"format": "csv"})
    assert answer.headers["content-type"].startswith("text/csv")
    rows = list(csv.DictReader(io.StringIO(answer.text)))
    assert 30 < len(rows) <= 100
    assert tuple(rows[0]) == ("time_utc", *COLUMNS[2:])
    assert rows[0]["time_utc"] == "2026-06-21T10:30:00.000Z"
    assert rows[0]["wind_mean_mps"] == "6.0"
    assert rows[0]["irradiance_wm2"] == "", "there was no light sensor"
    told = (await client.get("/api/v1/telemetry", params=asked)).json()
    assert told["sample_count"] == len(rows)
    assert told["columns"]["supply_v"][0] == 24.1


async def test_few_trackers_stand_as_cards_and_a_field_as_tiles(
    client: httpx.AsyncClient, machine: FakeMachine
) -> None:
    assert "glances-cards" in (await client.get("/")).text
    assert "glances-rows" in (await client.get("/?layout=rows")).text
    for number in range(3, 10):
        name = f"T{number}"
        machine.trackers[name] = FakeTracker(commissioned(name, "Row", tracking=False), Pair(180.0, 45.0))
    machine.emit()
    assert "glances-cards" in (await client.get("/?layout=cards")).text
    page = (await client.get("/")).text
    assert page.count("data-tile=") == 9
    assert hidden_of(page, 'id="site-urgent"') == [True]


def hidden_of(page: str, mark: str) -> list[bool]:
    return [" hidden" in tag for tag in re.findall(rf"<[^>]*{mark}[^>]*>", page)]


async def test_the_overview_counts_what_the_trackers_do_and_leads_to_what_is_urgent(
    client: httpx.AsyncClient, machine: FakeMachine
) -> None:
    machine.trackers["T2"].activity = ActivityName.STOWED
    machine.emit()
    calm = (await client.get("/")).text
    counts = re.findall(r'data-state="(\w+)" data-priority="0" aria-pressed="false">\s*<b>(\d+)', calm)
    assert counts == [("at_standstill", "1"), ("stowed", "1")]
    assert hidden_of(calm, "data-urgent") == [True, True]
    machine.alarms = tuple(alarm(code, NOON, "T2") for code in ("drive_lost", "not_stowed"))
    machine.emit()
    page = (await client.get("/")).text
    assert hidden_of(page, "data-urgent") == [False, True], "the key of the tracker in danger leads to it"
    assert hidden_of(page, "data-calm") == [True, False], "and to nothing else"
    assert "</i><span>Not stowed</span></p>" in page, "the most urgent alarm is named"
