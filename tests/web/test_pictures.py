"""Sun paths, the horizon, trends and the overview, on pages and over the API."""

import csv
import io
import re
from collections.abc import AsyncIterator
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
from app.web.charts.sunpath import hours_of, skyline
from app.web.shell.glances import bars
from app.web.shell.scene import scene_on, scene_recorded
from tests.fake_alarms import alarm
from tests.fake_data import NOON, SAMSUN, TIME_ZONE, commissioned, recording
from tests.fake_tracker import FakeTracker
from tests.fakes import FakeMachine, fake_app, serving

HILLS = Horizon(((100.0, 12.0), (250.0, 22.0)))
JUNE = date(2026, 6, 21)
CONFIG = TrackerConfig("T1", "North field")
LEFT, BOTTOM, PER_DEGREE, RISE = 56.0, 286.0, 2.0, 3.0


@pytest.fixture
async def panel(machine: FakeMachine) -> AsyncIterator[httpx.AsyncClient]:
    async with serving(fake_app(machine)) as client:
        yield client


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


def test_the_polar_picture_has_the_skyline_at_its_rim() -> None:
    drawn = skyline(HILLS)
    rim, ring = drawn.split("ZM")
    spots = [tuple(map(float, spot.split())) for spot in ring.removesuffix("Z").split("L")]
    heights = {round(90.0 - 0.9 * np.hypot(x, y), 1) for x, y in spots}
    assert rim.startswith("M0 -100A100 100 0 1 1")
    assert (min(heights), max(heights)) == (12.0, 22.0)
    assert skyline(Horizon()) == ""


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


@pytest.mark.parametrize("kind", [kind for kind in MountKind if kind is not MountKind.AZIMUTH_ELEVATION])
def test_other_mounts_have_an_outline_within_the_picture(kind: MountKind) -> None:
    drawn = cartesian(mounted(CONFIG, kind, 41.3), SAMSUN, TIME_ZONE, JUNE, HILLS)
    assert not drawn.fills
    xs, ys = zip(*points_of(drawn.reach), strict=True)
    assert LEFT - 0.1 <= min(xs) <= max(xs) <= LEFT + 720.1
    assert 15.9 <= min(ys) <= max(ys) <= BOTTOM + 0.1


def test_the_picture_is_told_mount_limits_hours_and_horizon() -> None:
    config = mounted(CONFIG, MountKind.EQUATORIAL, 41.3)
    scene = scene_on(config, SAMSUN, TIME_ZONE, JUNE, Algorithm.PSA, HILLS)
    assert (scene.first, scene.second) == ((-105.0, 105.0), (-24.0, 24.0))
    assert [hour for hour, *_ in scene.hours] == [str(hour) for hour in range(6, 20)]
    assert dict(scene.horizon)[250.0] == 22.0
    single = mounted(CONFIG, MountKind.HORIZONTAL_SINGLE_AXIS, 41.3)
    assert scene_on(single, SAMSUN, TIME_ZONE, JUNE, Algorithm.PSA, HILLS).second is None


def test_a_recording_is_shown_on_the_mount_it_was_made_on() -> None:
    mount = mounted(CONFIG, MountKind.EQUATORIAL, 41.3).mount
    info = recording("show-1", RecordingKind.SHOW, "A show", 15.0, 180.0)
    assert scene_recorded(info, JUNE).first is None, "from before mounts were recorded"
    shown = scene_recorded(replace(info, mount=mount, first_deg=(-105.0, 105.0)), JUNE)
    assert shown.mount.kind is MountKind.EQUATORIAL
    assert shown.first == (-105.0, 105.0)


async def test_the_horizon_is_kept_and_comes_back(panel: httpx.AsyncClient, machine: FakeMachine) -> None:
    typed = "250 22\n100,5° 12,5\n\n"
    answer = await panel.post("/site/horizon", data={"points": typed})
    assert answer.headers["location"] == "/site/horizon"
    assert machine.site.horizon.points == ((100.5, 12.5), (250.0, 22.0)), "sorted by azimuth"
    page = (await panel.get("/site/horizon")).text
    assert "100.5 12.5\n250 22</textarea>" in page
    assert "2 points entered" in page
    assert 'class="ct-skyline"' in (await panel.get("/trackers/T1/sun-path")).text
    read = (await panel.get("/api/v1/site/horizon")).json()
    assert read["points"][1] == {"azimuth_deg": 250.0, "elevation_deg": 22.0}


async def test_a_recording_is_replayed_behind_the_horizon_of_its_time(
    panel: httpx.AsyncClient, machine: FakeMachine
) -> None:
    head = machine.store.heads["day-1"]
    path = f"/recordings/{head.recording_id}"
    assert 'class="sp-skyline"' not in (await panel.get(path)).text
    machine.store.heads["day-1"] = replace(head, horizon=HILLS)
    assert 'class="sp-skyline"' in (await panel.get(path)).text
    assert scene_recorded(machine.store.heads["day-1"], JUNE).horizon == HILLS.outline()


@pytest.mark.parametrize(
    ("typed", "sentence"),
    [
        ("100", "Line 1: type azimuth and elevation with a space between, such as 135 8."),
        ("100 5\nx 5", "Line 2, azimuth: type a number, such as 0."),
        ("100 95", "Line 1, elevation must be between 0 and 90."),
        ("100 5\n100 6", "each azimuth only once"),
        ("\n".join(f"{one / 2:g} 1" for one in range(361)), "at most 360 points"),
    ],
)
async def test_what_is_wrong_stays_in_the_form(
    typed: str, sentence: str, panel: httpx.AsyncClient, machine: FakeMachine
) -> None:
    answer = await panel.post("/site/horizon", data={"points": typed})
    assert answer.status_code == 422
    assert sentence in answer.text
    assert f">{typed}</textarea>" in answer.text
    assert machine.site.horizon == Horizon()


async def test_the_api_sets_the_horizon_and_tells_when_the_sun_is_behind_it(
    panel: httpx.AsyncClient, machine: FakeMachine
) -> None:
    wall = [{"azimuth_deg": 300.0, "elevation_deg": 89.0}, {"azimuth_deg": 20.0, "elevation_deg": 89.0}]
    answer = (await panel.put("/api/v1/site/horizon", json={"points": wall})).json()
    assert [one["azimuth_deg"] for one in answer["points"]] == [20.0, 300.0]
    site = (await panel.get("/api/v1/site")).json()
    up = site["sun"]["apparent_elevation_deg"] >= 0.0
    assert site["sun_behind_horizon"] == answer["sun_behind_horizon"] == up
    assert (await panel.put("/api/v1/site/horizon", json={"points": []})).json()["points"] == []
    bad = await panel.put("/api/v1/site/horizon", json={"points": [{"azimuth_deg": 361, "elevation_deg": 1}]})
    assert bad.status_code == 422


async def test_a_tracker_without_a_location_has_no_sun_path_yet(
    panel: httpx.AsyncClient, machine: FakeMachine
) -> None:
    machine.site = replace(machine.site, location=None)
    machine.emit()
    for path in ("/trackers/T1/sun-path", "/site/horizon"):
        assert "The sun path appears when the location is saved" in (await panel.get(path)).text


@pytest.mark.parametrize(
    ("span", "seconds"), [("10min", 600), ("1h", 3600), ("8h", 28800), ("1d", 86400), ("7d", 604800)]
)
async def test_trends_go_back_as_far_as_is_asked(span: str, seconds: int, panel: httpx.AsyncClient) -> None:
    page = (await panel.get(f"/trackers/T1/trends?span={span}")).text
    assert f'data-seconds="{seconds}"' in page
    assert f'href="?span={span}" aria-current="true"' in page
    assert (await panel.get("/trackers/T1/trends?span=2h")).status_code == 422
    assert (await panel.get("/trackers/T9/trends")).status_code == 404


async def test_the_curves_can_be_taken_as_csv(panel: httpx.AsyncClient, machine: FakeMachine) -> None:
    head = replace(machine.store.heads["day-1"], recording_id="day-2", kind=RecordingKind.DAY, began_at=NOON)
    machine.store.heads["day-2"] = replace(head, ended_at=NOON + timedelta(days=1))
    asked = {
        "tracker_id": "T1",
        "start": (NOON + timedelta(hours=1)).isoformat(),
        "end": (NOON + timedelta(hours=2)).isoformat(),
        "points": "100",
    }
    answer = await panel.get("/api/v1/telemetry", params=asked | {"format": "csv"})
    assert answer.headers["content-type"].startswith("text/csv")
    rows = list(csv.DictReader(io.StringIO(answer.text)))
    assert 30 < len(rows) <= 100
    assert tuple(rows[0]) == ("time_utc", *COLUMNS[2:])
    assert rows[0]["time_utc"] == "2026-06-21T10:30:00.000Z"
    assert rows[0]["wind_mean_mps"] == "6.0"
    assert rows[0]["irradiance_wm2"] == "", "there was no light sensor"
    told = (await panel.get("/api/v1/telemetry", params=asked)).json()
    assert told["sample_count"] == len(rows)
    assert told["columns"]["supply_v"][0] == 24.1


def test_a_bar_shows_the_angle_on_its_range_also_a_turn_away() -> None:
    one = FakeTracker(commissioned("T1", "North", tracking=False), Pair(270.0, 45.0)).snapshot(NOON, 1)
    azimuth, elevation = bars(one, CONFIG)
    assert (azimuth.measured, elevation.measured) == (150.0, 100.0)
    turning = replace(CONFIG, azimuth=AxisConfig(-180.0, 180.0, 6.0, 3.0, 0.5, 2.0))
    assert bars(one, turning)[0].measured == 50.0, "270 degrees is 90 west of north"
    narrow = replace(CONFIG, azimuth=AxisConfig(60.0, 200.0, 6.0, 3.0, 0.5, 2.0))
    assert bars(one, narrow)[0].measured == 200.0, "beyond the limit it stays at the end"
    assert bars(replace(one, measured=None), CONFIG)[0].measured is None


async def test_a_field_stands_as_tiles_many_in_rows_and_few_as_cards(
    panel: httpx.AsyncClient, machine: FakeMachine
) -> None:
    assert "glances-cards" in (await panel.get("/")).text
    assert "glances-rows" in (await panel.get("/?layout=rows")).text
    for number in range(3, 7):
        name = f"T{number}"
        machine.trackers[name] = FakeTracker(commissioned(name, "Row", tracking=False), Pair(180.0, 45.0))
    machine.emit()
    page = (await panel.get("/")).text
    assert "glances-rows" in page
    assert page.count('class="glance-open"') == 6
    assert "glances-cards" in (await panel.get("/?layout=cards")).text
    for number in range(7, 10):
        name = f"T{number}"
        machine.trackers[name] = FakeTracker(commissioned(name, "Row", tracking=False), Pair(180.0, 45.0))
    machine.emit()
    page = (await panel.get("/")).text
    assert page.count("data-tile=") == 9
    assert "rotate(-45)" in page
    assert hidden_of(page, 'id="tile-urgent"') == [True]


def hidden_of(page: str, mark: str) -> list[bool]:
    return [" hidden" in tag for tag in re.findall(rf"<[^>]*{mark}[^>]*>", page)]


async def test_the_overview_counts_what_the_trackers_do_and_leads_to_what_is_urgent(
    panel: httpx.AsyncClient, machine: FakeMachine
) -> None:
    machine.trackers["T2"].activity = ActivityName.STOWED
    machine.emit()
    calm = (await panel.get("/")).text
    assert re.findall(r'data-doing="(\w+)"><b>(\d+)', calm) == [("holding", "1"), ("stowed", "1")]
    assert hidden_of(calm, "data-urgent") == [True, True]
    machine.alarms = tuple(alarm(code, NOON, "T2") for code in ("drive_lost", "not_stowed"))
    machine.emit()
    page = (await panel.get("/")).text
    assert hidden_of(page, "data-urgent") == [True, False], "the key of the tracker in danger leads to it"
    assert hidden_of(page, "data-calm") == [False, True], "and to nothing else"
    assert '<span class="glance-trouble">Not stowed</span>' in page, "the most urgent alarm is named"
