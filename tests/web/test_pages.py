"""Pages and forms without a browser: what they answer, keep, refuse and send to the machine."""

import re
from dataclasses import replace

import httpx
import pytest

from app.base.instants import duration
from app.link.messages import ConfigureTracker, SetClock, SetLocation
from app.tracker.commands.commands import GoToStart, Move, SelectMode, SetHome, Step
from app.tracker.settings.config import MountConfig, MountKind
from app.tracker.state.snapshot import ActivityName
from app.tracker.values.mode import Mode
from app.tracker.values.reason import Reason
from app.web.shell.formats import compass, shown
from tests.fakes import FakeMachine
from tests.web.filled import confirmed_in, filled

T1 = "/trackers/T1"
HTMX = {"HX-Request": "true", "HX-Request-Type": "partial"}
PAGES = (
    "/", T1, f"{T1}/commissioning/location", f"{T1}/commissioning/clock",
    f"{T1}/commissioning/clock/shadow", f"{T1}/commissioning/homing",
    f"{T1}/commissioning/mode", f"{T1}/commissioning/mode/orientation", f"{T1}/commissioning/run",
    f"{T1}/sun-check", f"{T1}/record", f"{T1}/settings", f"{T1}/drive", f"{T1}/drive-tests", f"{T1}/show",
    "/recordings", "/recordings/show-1", "/recordings/show-1?with=day-1", "/simulate", "/studies",
    "/studies/program", "/accuracy", "/papers", "/journal", "/journal?tracker=T1",
)  # fmt: skip


def sent(machine: FakeMachine, kind: type) -> list:
    return [order.command for order in machine.orders if isinstance(order.command, kind)]


@pytest.mark.parametrize("path", PAGES)
async def test_every_page_is_whole_has_stop_and_nothing_inline(path: str, client: httpx.AsyncClient) -> None:
    answer = await client.get(path)
    assert answer.status_code == 200
    assert answer.headers["cache-control"] == "no-store"
    assert answer.text.count("<h1") == 1
    assert 'id="stop-key"' in answer.text
    assert "not an emergency stop" in answer.text
    assert "HX-Request" in answer.headers["vary"]
    assert not re.search(r"\sstyle=|<style|\son[a-z]+=|hx-on|javascript:", answer.text)
    assert not re.search(r"<script(?![^>]*(?:src=|type=\"application/json\"))", answer.text)
    assert not re.search(r"(?:src|href|action)=\"https?:", answer.text)


async def test_pages_answer_while_the_machine_is_away(
    machine: FakeMachine, client: httpx.AsyncClient
) -> None:
    machine.cut()
    answer = await client.get(T1)
    assert answer.status_code == 503
    assert "controller service does not answer" in answer.text
    assert 'id="stop-key"' in answer.text


async def test_location_is_saved_and_leads_on(machine: FakeMachine, client: httpx.AsyncClient) -> None:
    typed = {
        "latitude": "33° 55' 12\"",
        "latitude_side": "S",
        "longitude": "18,4233",
        "longitude_side": "E",
        "sun_there": "yes",
    }
    answer = await client.post(
        f"{T1}/commissioning/location", data=await filled(client, f"{T1}/commissioning/location", typed)
    )
    assert answer.status_code == 303
    assert answer.headers["location"] == f"{T1}/commissioning/clock"
    (order,) = sent(machine, SetLocation)
    assert order.location.latitude_deg == pytest.approx(-33.92)
    assert order.location.longitude_deg == pytest.approx(18.4233)
    assert order.time_zone == "Africa/Johannesburg"


async def test_clock_is_kept_copied_or_typed(machine: FakeMachine, client: httpx.AsyncClient) -> None:
    root, sure = f"{T1}/commissioning/clock", {"confirmed": "yes"}
    machine.rest()
    await client.post(root, data={"source": "keep"})
    device = {"source": "device", "at": "2026-06-21T09:00:00.000Z"}
    question = (await client.post(root, data=device)).text
    await client.post(root, data=device | confirmed_in(question))
    typed = {"date": "2026-06-21", "time": "12:00:30", "time_zone": "Europe/Istanbul"} | sure
    await client.post(f"{root}/shadow", data=typed)
    system, device, manual = sent(machine, SetClock)
    assert (system.source, system.at) == ("system", None)
    assert device.at.isoformat() == "2026-06-21T09:00:00+00:00"
    assert manual.at.isoformat() == "2026-06-21T12:00:30+03:00"


async def test_zero_and_steps_go_to_the_machine(machine: FakeMachine, client: httpx.AsyncClient) -> None:
    await client.post(f"{T1}/zero", data={"key": "press-1", "confirmed": "180.0 45.0"})
    await client.post(f"{T1}/step", data={"increment": "elevation -0.1"})
    assert sent(machine, SetHome)
    assert sent(machine, Step)[0].delta_deg == pytest.approx(-0.1)
    assert machine.orders[0].key == "press-1"


async def test_step_of_another_size_is_refused(machine: FakeMachine, client: httpx.AsyncClient) -> None:
    answer = await client.post(f"{T1}/step", data={"increment": "azimuth +90"})
    assert answer.status_code == 422
    assert not machine.orders


async def test_orientation_beyond_the_limits_is_refused(
    machine: FakeMachine, client: httpx.AsyncClient
) -> None:
    await client.post(f"{T1}/commissioning/mode", data={"mode": "fixed"})
    typed = {"azimuth": "170", "elevation": "95"}
    answer = await client.post(f"{T1}/commissioning/mode/orientation", data=typed, headers=HTMX)
    assert (answer.status_code, "between 0 and 90" in answer.text) == (422, True)
    assert not sent(machine, Move)


async def test_refusal_names_every_reason_below_the_key(
    machine: FakeMachine, client: httpx.AsyncClient
) -> None:
    machine.rejects["set_home"] = (
        Reason("a", "The axes move.", "Wait."),
        Reason("b", "The drive is silent."),
    )
    answer = await client.post(f"{T1}/zero", data={"confirmed": "180.0 45.0"}, headers=HTMX)
    assert answer.status_code == 409
    assert "Not done." in answer.text
    assert "The axes move." in answer.text
    assert "The drive is silent." in answer.text


async def test_fixed_mode_saves_and_goes(machine: FakeMachine, client: httpx.AsyncClient) -> None:
    answer = await client.post(f"{T1}/commissioning/mode", data={"mode": "fixed"})
    assert answer.headers["location"] == f"{T1}/commissioning/mode/orientation"
    await client.post(f"{T1}/commissioning/mode/orientation", data={"azimuth": "170", "elevation": "30,5"})
    assert sent(machine, SelectMode)[-1].mode is Mode.FIXED
    assert sent(machine, Move)[0].orientation.elevation_deg == pytest.approx(30.5)


async def test_show_goes_to_its_start(machine: FakeMachine, client: httpx.AsyncClient) -> None:
    plan = {"date": "2026-06-21", "start": "05:07", "end": "20:10", "minutes": "3"}
    answer = await client.post(f"{T1}/show/go-to-start", data=plan)
    (order,) = sent(machine, GoToStart)
    assert answer.headers["location"] == f"{T1}/shows/{order.plan.show_id}"
    assert order.plan.begin_at.isoformat() == "2026-06-21T05:07:00+03:00"
    assert order.plan.duration.total_seconds() == 180


async def test_show_across_midnight_ends_on_the_next_day(
    machine: FakeMachine, client: httpx.AsyncClient
) -> None:
    plan = {"date": "2026-06-21", "start": "18:00", "end": "08:00", "minutes": "5"}
    await client.post(f"{T1}/show/go-to-start", data=plan)
    assert sent(machine, GoToStart)[0].plan.end_at.isoformat() == "2026-06-22T08:00:00+03:00"


async def test_settings_are_saved_whole_or_not_at_all(
    machine: FakeMachine, client: httpx.AsyncClient
) -> None:
    page = (await client.get(f"{T1}/settings")).text
    typed = dict(re.findall(r'name="([a-z0-9_]+)"[^>]*?value="([^"]*)"', page))
    typed |= {"drive": "modbus-tcp", "algorithm": "koblick", "night": "park", "host": "10.0.0.5"}
    wrong = typed | {"azimuth_minimum_deg": "300", "azimuth_maximum_deg": "60"}
    assert (await client.post(f"{T1}/settings", data=wrong)).status_code == 422
    assert not machine.orders
    await client.post(f"{T1}/settings", data=typed)
    (order,) = sent(machine, ConfigureTracker)
    assert order.config.drive.host == "10.0.0.5"
    assert order.config.algorithm == "koblick"


async def test_tracker_is_removed_only_after_its_id_was_typed(
    machine: FakeMachine, client: httpx.AsyncClient
) -> None:
    assert (await client.post(f"{T1}/settings/remove", data={"typed_id": "T2"})).status_code == 422
    assert (await client.post(f"{T1}/settings/remove", data={"typed_id": "T1"})).status_code == 303
    assert "T1" not in machine.trackers


@pytest.mark.parametrize("back", ["//elsewhere.example", "https://elsewhere.example", "/\\elsewhere"])
async def test_no_form_leads_to_another_site(back: str, client: httpx.AsyncClient) -> None:
    for path, chosen in (("/theme", {}), ("/language", {"language": "de"})):
        assert (await client.post(path, data={"back": back} | chosen)).headers["location"] == "/", path


async def test_step_bar_opens_forward_only_as_far_as_steps_are_done(client: httpx.AsyncClient) -> None:
    await client.post("/trackers", data={"tracker_id": "T3", "name": "New"})
    text = (await client.get("/trackers/T3/commissioning/homing")).text
    assert 'href="/trackers/T3/commissioning/clock"' in text
    assert 'class="step-link" href="/trackers/T3/commissioning/run"' not in text


def test_values_read_the_same_everywhere() -> None:
    assert shown(-0.001, "angle2", "UTC") == "0.00°"
    assert shown(-1.5, "angle1", "UTC") == "−1.5°"
    assert shown(None, "angle2", "UTC") == "–"
    assert duration(180) == "3 min"
    assert duration(185) == "3 min 05 s"
    assert duration(54720) == "15 h 12 min"
    assert [compass(angle) for angle in (0, 191, 359)] == ["N", "S", "N"]


async def test_live_ends_tracking_where_it_is_on_and_starts_it_where_it_is_not(
    client: httpx.AsyncClient, machine: FakeMachine
) -> None:
    tracker = machine.trackers["T1"]
    for is_on in (True, False):
        tracker.memory = replace(tracker.memory, tracking_on=is_on)
        machine.emit()
        text = (await client.get(T1)).text
        assert ('action="/trackers/T1/stop" hx-post="/trackers/T1/stop"' in text) is True
        assert ('data-when="tracking_on=true" hidden' in text) is not is_on
        assert ('data-when="tracking_on=false" hidden' in text) is is_on


async def test_a_tracker_that_tracks_says_so_instead_of_offering_it(
    client: httpx.AsyncClient, machine: FakeMachine
) -> None:
    for activity in (ActivityName.TRACKING, ActivityName.HOLDING):
        machine.trackers["T1"].activity = activity
        machine.emit()
        text = (await client.get(f"{T1}/commissioning/run")).text
        offered = activity is not ActivityName.TRACKING
        assert ('data-when="activity=tracking" hidden' in text) is offered
        assert ('data-when="activity!=tracking" hidden' in text) is not offered


async def test_the_mast_page_tells_the_speed_and_the_angles_of_each_axis(
    client: httpx.AsyncClient, machine: FakeMachine
) -> None:
    tracker = machine.trackers["T1"]
    config = tracker.config
    tracker.config = replace(config, elevation=replace(config.elevation, jog_slow_dps=0.25))
    machine.emit()
    page = (await client.get("/trackers/T1/mast")).text
    assert "Slow 0.5 / 0.25°/s" in page
    assert "Axes:" not in page
    assert "keep everyone clear of the tracker" in page
    tracker.config = replace(config, mount=MountConfig(MountKind.EQUATORIAL))
    machine.emit()
    page = (await client.get("/trackers/T1/mast")).text
    assert "Axes:" in page
