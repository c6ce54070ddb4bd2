"""What moves the target of a tracker is asked in numbers, confirmed as asked, and refused while it tracks."""

from dataclasses import replace
from datetime import timedelta
from html import unescape

import httpx

from app.link.messages import ApplySightings
from app.tracker.commands.commands import SelectMode, Track
from app.tracker.memory.memory import Pointing, Sighting
from app.tracker.mounts.capabilities import default_mode
from tests.fakes import FakeMachine
from tests.web.desk import Desk
from tests.web.filled import confirmed_in, values_of

HTMX = {"HX-Request": "true", "HX-Request-Type": "partial"}
API = "/api/v1/trackers/T1"
MOUNT = "/trackers/T1/mount"
TILTED = {"mount": {"kind": "tilted-single-axis", "axis_azimuth_deg": 180, "axis_tilt_deg": 41}}


async def ready(desk: Desk) -> None:
    """Put the tracker on a tilted axis, and have it commissioned so that it can track."""
    assert (await desk.ask("PATCH", API, json=TILTED)).status_code == 200
    await desk.plant.commission()
    await desk.plant.ask(SelectMode(default_mode(desk.plant.site.model.tracker("T1").config.mount)))


async def save(desk: Desk, **typed: str) -> httpx.Response:
    form = values_of((await desk.ask("GET", MOUNT)).text, MOUNT)
    return await desk.ask("POST", MOUNT, data=form | typed, headers=HTMX)


def axis_deg(desk: Desk) -> float:
    return desk.plant.site.model.tracker("T1").config.mount.axis_azimuth_deg


async def test_another_axis_is_asked_in_numbers_and_confirmed_as_it_was_asked(desk: Desk) -> None:
    await ready(desk)
    asked = unescape((await save(desk, axis_azimuth="150")).text)
    assert "Nothing is saved yet. Confirm these changes." in asked
    assert "Azimuth of the axis" in asked
    assert "axis of Tracker 1 moves by up to" in asked
    assert "At present, it is" in asked
    assert "data-hold" in asked
    assert axis_deg(desk) == 180.0
    other = await save(desk, axis_azimuth="120", **confirmed_in(asked))
    assert "Nothing is saved yet" in other.text, "this was not asked"
    assert axis_deg(desk) == 180.0
    assert (await save(desk, axis_azimuth="150", **confirmed_in(asked))).status_code == 204
    assert axis_deg(desk) == 150.0


async def test_taking_it_back_is_asked_as_well(desk: Desk) -> None:
    await ready(desk)
    asked = (await save(desk, axis_azimuth="150")).text
    await save(desk, axis_azimuth="150", **confirmed_in(asked))
    await desk.plant.commission()  # a simulated drive begins anew with another mount
    back = (await desk.ask("POST", "/trackers/T1/settings/undo", headers=HTMX)).text
    assert "Nothing is saved yet" in back
    assert axis_deg(desk) == 150.0
    answer = await desk.ask("POST", "/trackers/T1/settings/undo", data=confirmed_in(back), headers=HTMX)
    assert answer.status_code == 204
    assert axis_deg(desk) == 180.0


async def test_while_it_tracks_it_is_refused_before_it_is_asked(desk: Desk) -> None:
    await ready(desk)
    await desk.plant.ask(Track())
    await desk.forward(30)
    for answer in (
        await save(desk, axis_azimuth="150"),
        await desk.ask("PATCH", API, json={"mount": {"axis_azimuth_deg": 150}}),
        await desk.ask("POST", "/trackers/T1/settings/undo", headers=HTMX),
        await desk.ask("POST", "/trackers/T1/sun-check/forget", headers=HTMX),
    ):
        assert answer.status_code == 409
        assert "T1 is tracking." in unescape(answer.text)
        assert "Stop T1 first." in unescape(answer.text)
        assert "Nothing is saved yet" not in answer.text
    assert axis_deg(desk) == 180.0


async def test_a_program_can_ask_what_a_change_would_move(desk: Desk) -> None:
    await ready(desk)
    change = {"mount": {"axis_azimuth_deg": 150}}
    review = (await desk.ask("POST", f"{API}/review", json=change)).json()
    assert [one["code"] for one in review["doubts"]] == ["target_moves"]
    assert [one["after"] for one in review["differences"]] == ["150 °"]
    same = (await desk.ask("POST", f"{API}/review", json={"deadband_deg": 1})).json()
    assert same["doubts"] == []


async def test_before_it_is_commissioned_nothing_is_asked(desk: Desk) -> None:
    assert (await desk.ask("PATCH", API, json=TILTED)).status_code == 200
    assert (await save(desk, axis_azimuth="150")).status_code == 204


async def test_a_correction_is_forgotten_only_when_somebody_is_sure(
    machine: FakeMachine, client: httpx.AsyncClient
) -> None:
    machine.rest()
    tracker = machine.trackers["T1"]
    sighting = Sighting(machine.clock.now() - timedelta(hours=1), 120.0, 50.0, 125.0, 50.0)
    pointing = Pointing(azimuth_offset_deg=5.0, residual_deg=0.1)
    tracker.memory = replace(tracker.memory, pointing=pointing, sightings=(sighting,))
    page = "/trackers/T1/sun-check/forget"
    asked = await client.post(page, headers=HTMX)
    assert "moves by up to 5.0°" in unescape(asked.text)
    assert "data-hold" in asked.text
    assert not [order for order in machine.orders if isinstance(order.command, ApplySightings)]
    done = await client.post(page, data=confirmed_in(asked.text), headers=HTMX)
    assert done.status_code == 204
    (order,) = (one for one in machine.orders if isinstance(one.command, ApplySightings))
    assert order.command == ApplySightings("T1", ())


async def test_a_small_correction_is_applied_at_once(machine: FakeMachine, client: httpx.AsyncClient) -> None:
    machine.rest()
    tracker = machine.trackers["T1"]
    tracker.memory = replace(tracker.memory, pointing=Pointing(azimuth_offset_deg=0.5, residual_deg=0.1))
    assert (await client.post("/trackers/T1/sun-check/forget", headers=HTMX)).status_code == 204
