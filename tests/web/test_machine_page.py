"""The machine's protections as a page: limits, what follows each class of fault, forbidden regions."""

import re
from dataclasses import asdict, replace
from datetime import datetime

import httpx
import pytest

from app.base.message import N_
from app.tracker.memory.memory import Pointing, RejectedSetting, TrackerState
from app.tracker.settings.config import MountConfig, MountKind, TrackerConfig
from app.tracker.settings.mechanics import (
    GUARDED,
    Corner,
    MachineProtection,
    Recovery,
    RecoveryPolicy,
    Region,
)
from app.tracker.state.snapshot import Snapshot
from app.tracker.values.reason import Reason
from app.web.charts.region_picture import region_picture
from app.web.features.setup.machine_forms import texts
from tests.fake_tracker import FakeTracker
from tests.fakes import FakeMachine
from tests.web.filled import filled

ROOT = "/trackers/T1"
PAGE = f"{ROOT}/machine"
WALL = Region("Wall", (Corner(170.0, 0.0), Corner(190.0, 0.0), Corner(190.0, 30.0)))


def kept(machine: FakeMachine) -> MachineProtection:
    found = machine.trackers["T1"].config.machine
    assert isinstance(found, MachineProtection)
    return found


async def test_what_the_page_shows_is_what_it_saves(client: httpx.AsyncClient, machine: FakeMachine) -> None:
    assert (await client.post(PAGE, data=texts(GUARDED))).status_code == 303
    assert kept(machine) == GUARDED
    changed = {
        "overtravel_deg": "1,5",
        "supply_low_v": "21",
        "supply_high_v": "28",
        "recovery_link_kind": "limited",
        "recovery_link_times_per_hour": "5",
        "recovery_link_after_s": "30",
        "region0_name": "Wall",
        "region0_corners": "170 0; 190/0; 190,0 30°",
    }
    await client.post(PAGE, data=texts(GUARDED) | changed)
    saved = kept(machine)
    assert (saved.overtravel_deg, saved.supply_low_v, saved.supply_high_v) == (1.5, 21.0, 28.0)
    assert saved.recovery.link == RecoveryPolicy(Recovery.LIMITED, 5, 30.0)
    assert saved.regions == (WALL,)
    page = (await client.get(PAGE)).text
    assert 'value="170 0; 190 0; 190 30"' in page
    assert 'id="f-region1_name"' in page, "there is room for one more"
    await client.post(PAGE, data=texts(saved) | {"region0_name": "", "region0_corners": " "})
    assert kept(machine).regions == (), "empty fields remove a region"


@pytest.mark.parametrize(
    ("typed", "sentence"),
    [
        ({"creep_deg": "far"}, "Standstill monitoring limit: type a number"),
        ({"recovery_drive_kind": "pray"}, "Drive: Reset: choose one from the list"),
        ({"region0_name": "Gate", "region0_corners": "170 0; 190 0"}, "A region has 3 to 20 corners"),
        (
            {"region0_name": "Gate", "region0_corners": "1 2; 3 4; 5 six"},
            "type each as azimuth and elevation",
        ),
        (
            {
                "region0_name": "Gate",
                "region0_corners": "1 2; 3 4; 5 6",
                "region1_name": "Gate",
                "region1_corners": "1 2; 3 4; 5 6",
            },
            "needs a unique name",
        ),
    ],
)
async def test_what_cannot_be_is_refused_and_stays_in_the_form(
    client: httpx.AsyncClient, machine: FakeMachine, typed: dict[str, str], sentence: str
) -> None:
    answer = await client.post(PAGE, data=texts(GUARDED) | {"clear_for_s": "777"} | typed)
    assert answer.status_code == 422
    assert sentence in answer.text
    assert 'value="777"' in answer.text
    assert not machine.orders


async def test_regions_are_drawn_before_anything_is_saved(
    client: httpx.AsyncClient, machine: FakeMachine
) -> None:
    typed = {"region0_name": "Wall", "region0_corners": "170 0; 190 0; 190 30"}
    typed |= {"region1_name": "half", "region1_corners": ""}
    asked = {"HX-Request": "true", "HX-Request-Type": "partial"}
    drawn = await client.post(f"{PAGE}/picture", data=texts(GUARDED) | typed, headers=asked)
    assert drawn.status_code == 200
    assert drawn.text.count("rg-region") == 2, "the region, and its mark in the legend"
    assert 'value="half"' in drawn.text
    assert not machine.orders


def test_the_picture_has_one_scale_for_both_axes() -> None:
    picture = region_picture(TrackerConfig("T1", "North"), (WALL,), Pointing(), ((90.0, 10.0), (180.0, 60.0)))

    def place(azimuth_deg: float, elevation_deg: float) -> tuple[float, float]:
        return picture.x.at(azimuth_deg), picture.y.at(elevation_deg)

    numbers = [float(one) for one in re.findall(r"[\d.]+", picture.regions[0].path)]
    corners = [value for one in WALL.corners for value in place(one.azimuth_deg, one.elevation_deg)]
    assert numbers == pytest.approx(corners, abs=0.06)
    wide = float(numbers[2] - numbers[0]) / 20.0
    high = float(numbers[3] - numbers[5]) / 30.0
    assert wide == pytest.approx(high, rel=0.01)
    assert picture.sun.startswith("M{:.1f} {:.1f}".format(*place(90.0, 10.0)))


class RejectedTracker(FakeTracker):
    """One whose stored settings did not fit at the start."""

    def snapshot(self, at: datetime, tick: int) -> Snapshot:
        told = RejectedSetting("in position deg", "wide", "0.05", "It should be a number.")
        notice = Reason("config_rejected", N_("Stored settings were rejected."), N_("Correct them."))
        return replace(super().snapshot(at, tick), rejected=(told,), notices=(notice,))


@pytest.mark.fault(52)
async def test_rejected_settings_are_shown_beside_those_that_are_used(
    client: httpx.AsyncClient, machine: FakeMachine
) -> None:
    assert "Settings rejected at startup" not in (await client.get(f"{ROOT}/settings")).text
    sound = machine.trackers["T1"]
    state = TrackerState(sound.config, sound.memory)
    machine.trackers["T1"] = RejectedTracker(state, sound.position)
    machine.emit()
    page = (await client.get(f"{ROOT}/settings")).text
    assert "<td>In position deg</td><td>wide</td><td><b>0.05</b> <small>usual value</small></td>" in page
    assert "<td>It should be a number.</td>" in page
    assert 'data-code="config_rejected" data-priority="2"' in (await client.get(ROOT)).text


async def test_a_single_axis_keeps_its_regions_and_draws_none(
    client: httpx.AsyncClient, machine: FakeMachine
) -> None:
    tracker, mount = machine.trackers["T1"], MountConfig(MountKind.HORIZONTAL_SINGLE_AXIS)
    tracker.config = replace(tracker.config, mount=mount, machine=MachineProtection(regions=(WALL,)))
    page = (await client.get(PAGE)).text
    assert "This mount has one axis" in page
    assert "regions-picture" not in page
    assert (await client.post(PAGE, data=await filled(client, PAGE, {"creep_deg": "3"}))).status_code == 303
    assert (kept(machine).creep_deg, kept(machine).regions) == (3.0, (WALL,))


async def test_the_api_does_what_the_page_does(client: httpx.AsyncClient, machine: FakeMachine) -> None:
    region = {"name": "Wall", "corners": [asdict(one) for one in WALL.corners]}
    recovery = {"following": {"kind": "service"}}
    change = {"clear_for_s": 120, "recovery": recovery, "regions": [region]}
    answer = await client.patch("/api/v1/trackers/T1", json={"machine": change})
    assert answer.status_code == 200
    assert (kept(machine).clear_for_s, kept(machine).regions) == (120.0, (WALL,))
    assert kept(machine).recovery.following.kind is Recovery.SERVICE
