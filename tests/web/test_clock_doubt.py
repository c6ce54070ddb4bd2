"""A clock that differs from that of the device at hand is asked about before step 2 is done."""

import re
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from html import unescape

import httpx
import pytest

from app.base.clock import VirtualClock
from app.link.messages import ConfirmStep, SetClock
from app.sun.position import Algorithm, Location, sun_position
from app.tracker.memory.memory import ClockSetting, StepName
from tests.fakes import FakeMachine, fake_app, serving
from tests.web.filled import confirmed_in, values_of

PAGE = "/trackers/T1/commissioning/clock"
SHADOW = f"{PAGE}/shadow"
CLOCK = "/api/v1/site/clock"
HTMX = {"HX-Request": "true"}
ASKED = re.compile(r'name="(asked_for|asked_at)"\s+value="([^"]+)"')
AHEAD = timedelta(hours=11, minutes=39)


def orders(machine: FakeMachine) -> list[SetClock]:
    return [order.command for order in machine.orders if isinstance(order.command, SetClock)]


async def test_the_system_clock_is_asked_about_with_the_difference(
    machine: FakeMachine, client: httpx.AsyncClient
) -> None:
    device = {"at": (machine.clock.now() - AHEAD).isoformat()}
    device["source"] = "keep"
    asked = await client.post(PAGE, data=device, headers=HTMX)
    assert asked.status_code == 422
    assert "The controller&#39;s clock is 11 h 39 min ahead of this device&#39;s clock." in asked.text
    assert not orders(machine)
    answer = await client.post(PAGE, data=device | confirmed_in(asked.text), headers=HTMX)
    assert answer.status_code == 204
    assert answer.headers["hx-redirect"].endswith("/commissioning/homing")
    assert [one.source for one in orders(machine)] == ["system"]


async def test_a_minute_is_not_asked_about(machine: FakeMachine, client: httpx.AsyncClient) -> None:
    for by_s, status in ((-55, 204), (55, 204), (-70, 422), (70, 422)):
        at = (machine.clock.now() + timedelta(seconds=by_s)).isoformat()
        device = {"source": "keep", "at": at}
        assert (await client.post(PAGE, data=device, headers=HTMX)).status_code == status, by_s


async def test_a_typed_time_is_asked_about_and_kept(machine: FakeMachine, client: httpx.AsyncClient) -> None:
    machine.rest()
    typed = {"date": "2026-06-21", "time": "12:00:30", "time_zone": "UTC"}
    device = {"at": "2026-06-21T21:00:30+00:00"}
    asked = await client.post(SHADOW, data=typed | device, headers=HTMX)
    assert asked.status_code == 422
    assert "9 h 00 min behind this device" in asked.text
    assert 'value="12:00:30"' in asked.text
    assert asked.text.index("Set the clock</button>") < asked.text.index("data-hold"), (
        "Enter must not confirm"
    )
    assert not orders(machine)
    sure = asked_about(asked.text) | {"confirmed": "yes"}
    done = await client.post(SHADOW, data=typed | device | sure, headers=HTMX)
    assert (done.status_code, len(orders(machine))) == (204, 1)


async def test_a_typed_clock_is_what_was_asked_about_and_not_late_by_the_question() -> None:
    clock = VirtualClock(datetime(2026, 6, 21, 9, tzinfo=UTC))
    machine = FakeMachine(clock)
    machine.rest()
    typed, other = ({"date": "2026-06-21", "time": time, "time_zone": "UTC"} for time in ("12:00", "13:00"))
    async with serving(fake_app(machine)) as client:

        async def answered(data: dict[str, str], after_s: float = 0.0) -> tuple[int, dict[str, str]]:
            """Return the status, and what the page sends with a yes to its question."""
            clock.advance(timedelta(seconds=after_s))
            machine.emit()
            answer = await client.post(SHADOW, data=data, headers=HTMX)
            return answer.status_code, asked_about(answer.text) | {"confirmed": "yes"}

        _, sure = await answered(typed)
        for data in (
            typed | {"confirmed": "yes"},
            other | sure,
            typed | sure | {"asked_at": "2026-06-21T12:00"},
            typed | sure | {"asked_at": "2026-06-21T12:00:00+00:00"},
        ):
            assert (await answered(data))[0] == 422
        status, sure = await answered(typed | sure, after_s=11 * 60.0)
        assert (status, orders(machine)) == (422, [])
        assert (await answered(typed | sure, after_s=45.0))[0] == 204
    assert [one.at for one in orders(machine)] == [datetime(2026, 6, 21, 12, 0, 45, tzinfo=UTC)]


def asked_about(page: str) -> dict[str, str]:
    """Return what the page sends with the answer to its question."""
    return {name: unescape(value) for name, value in ASKED.findall(page)}


async def test_a_program_confirms_a_clock_that_differs(
    machine: FakeMachine, client: httpx.AsyncClient
) -> None:
    machine.rest()
    late = (machine.clock.now() - AHEAD).isoformat()
    for asked in (
        {"source": "system", "device_at": late},
        {"source": "manual", "at": late},
        {"source": "manual", "at": late, "device_at": machine.clock.now().isoformat()},
    ):
        refused = await client.put(CLOCK, json=asked)
        assert refused.status_code == 422
        assert "11 h 39 min" in refused.json()["detail"]
        assert "confirmed" in refused.json()["detail"]
        assert (await client.put(CLOCK, json=asked | {"confirmed": True})).status_code == 200
    agreed = {"source": "manual", "at": late, "device_at": late}
    assert (await client.put(CLOCK, json=agreed)).status_code == 200
    assert len(orders(machine)) == 4


async def test_copying_a_device_asks_by_how_much_and_where_the_sun_stands(
    machine: FakeMachine, client: httpx.AsyncClient
) -> None:
    machine.rest()
    new, place = machine.clock.now() - AHEAD, machine.site.location
    assert place is not None
    device = {"source": "device", "at": new.isoformat()}
    asked = await client.post(PAGE, data=device, headers=HTMX)
    assert asked.status_code == 422
    assert "The controller&#39;s clock would be set back by 11 h 39 min." in asked.text
    suns = []
    for at in (machine.clock.now(), new):
        sun = sun_position(Algorithm.PSA, place, at)
        suns.append(f"{sun.azimuth_deg:.1f}°, {sun.apparent_elevation_deg:.1f}°")
    assert f"Sun: {suns[0]} to {suns[1]}." in asked.text.replace("−", "-")
    assert "Compare with a third clock." in asked.text
    assert "data-hold" in asked.text
    assert not orders(machine)
    other = {"source": "device", "at": (new - timedelta(hours=2)).isoformat()} | confirmed_in(asked.text)
    assert (await client.post(PAGE, data=other, headers=HTMX)).status_code == 422, "not asked"
    for wrong in ("yes", "", "1 2", "nan", "1e400"):
        refused = await client.post(PAGE, data=device | {"confirmed": wrong}, headers=HTMX)
        assert refused.status_code == 422, wrong
    done = await client.post(PAGE, data=device | confirmed_in(asked.text), headers=HTMX)
    assert (done.status_code, [one.at for one in orders(machine)]) == (204, [new])


async def test_without_a_location_nothing_is_told_of_the_sun(
    machine: FakeMachine, client: httpx.AsyncClient
) -> None:
    machine.rest()
    machine.site = replace(machine.site, location=None)
    device = {"source": "device", "at": (machine.clock.now() + AHEAD).isoformat()}
    asked = await client.post(PAGE, data=device, headers=HTMX)
    assert "would be set forward by 11 h 39 min." in asked.text
    assert "Sun:" not in asked.text


async def test_the_system_clock_is_asked_about_where_it_moves_the_clock_of_the_site(
    machine: FakeMachine, client: httpx.AsyncClient
) -> None:
    machine.rest()
    machine.site = replace(machine.site, clock=ClockSetting("manual", AHEAD.total_seconds()))
    machine.emit()
    data = {"source": "system", "at": machine.clock.now().isoformat()}
    asked = await client.post(PAGE, data=data, headers=HTMX)
    assert asked.status_code == 422
    assert "would be set back by 11 h 39 min." in asked.text
    assert re.search(rf"It would show [-\d]{{10}} [:\d]{{8}} \({machine.site.time_zone}\)\.", asked.text)
    assert "data-hold" in asked.text
    done = await client.post(PAGE, data=data | confirmed_in(asked.text), headers=HTMX)
    assert (done.status_code, [one.source for one in orders(machine)]) == (204, ["system"])


async def test_a_clock_that_was_set_manually_is_kept_as_it_is(
    machine: FakeMachine, client: httpx.AsyncClient
) -> None:
    machine.site = replace(machine.site, clock=ClockSetting("manual", AHEAD.total_seconds()))
    machine.emit()
    assert 'value="system"' in (await client.get(PAGE)).text
    site = machine.latest()
    assert site is not None
    kept = await client.post(PAGE, data={"source": "keep", "at": site.at.isoformat()}, headers=HTMX)
    assert kept.headers["hx-redirect"].endswith("/commissioning/homing")
    (order,) = (order.command for order in machine.orders)
    assert order == ConfirmStep("T1", StepName.CLOCK)
    asked = await client.post(
        PAGE, data={"source": "keep", "at": (site.at - AHEAD).isoformat()}, headers=HTMX
    )
    assert asked.status_code == 422
    assert "11 h 39 min ahead of this device" in asked.text
    assert "data-hold" not in asked.text
    assert len(machine.orders) == 1


async def test_the_clock_of_the_system_is_no_choice_while_it_is_in_use(
    machine: FakeMachine, client: httpx.AsyncClient
) -> None:
    page = (await client.get(PAGE)).text
    assert 'value="keep" checked' in page
    assert 'value="device"' in page
    assert 'value="system"' not in page
    for wrong in ({}, {"source": "sundial"}):
        assert (await client.post(PAGE, data=wrong, headers=HTMX)).status_code == 422
    assert not machine.orders


async def test_without_scripts_the_question_comes_with_the_whole_page(
    machine: FakeMachine, client: httpx.AsyncClient
) -> None:
    machine.rest()
    data = {"source": "device", "at": (machine.clock.now() - AHEAD).isoformat()}
    asked = await client.post(PAGE, data=data)
    assert asked.status_code == 422
    assert "<html" in asked.text
    sent = {name: text for name, [text] in values_of(asked.text, PAGE).items()}
    assert sent["source"] == "device"
    done = await client.post(PAGE, data=sent | confirmed_in(asked.text))
    assert (done.status_code, done.headers["location"]) == (303, "/trackers/T1/commissioning/homing")


async def test_the_sun_of_an_instant_of_a_device_is_that_over_the_site(
    machine: FakeMachine, client: httpx.AsyncClient
) -> None:
    machine.site = replace(machine.site, location=Location(37.87, 32.48))
    machine.emit()
    instants = ("2026-11-22T10:15:04Z", "2026-11-21T22:36:04Z")
    day, night = [(await client.get("/api/v1/sun", params={"at": at})).json() for at in instants]
    assert day["azimuth_deg"] == pytest.approx(190.6, abs=0.1)
    assert day["apparent_elevation_deg"] == pytest.approx(31.1, abs=0.5)
    assert night["apparent_elevation_deg"] == pytest.approx(-67.8, abs=0.5)


async def test_a_clock_is_refused_while_a_tracker_tracks_before_it_is_asked_about(
    machine: FakeMachine, client: httpx.AsyncClient
) -> None:
    late = machine.clock.now() - AHEAD
    typed = {"date": "2026-06-21", "time": "12:00:30", "time_zone": "UTC"}
    for answer in (
        await client.post(PAGE, data={"source": "device", "at": late.isoformat()}, headers=HTMX),
        await client.post(SHADOW, data=typed, headers=HTMX),
        await client.put(CLOCK, json={"source": "manual", "at": late.isoformat()}),
    ):
        assert answer.status_code == 409
        assert "T2 is tracking the sun by the present clock." in answer.text
        assert "End tracking of T2 first." in answer.text
        assert "confirmed" not in answer.text
    assert not orders(machine)
    near = {"source": "device", "at": (machine.clock.now() + timedelta(seconds=30)).isoformat()}
    assert (await client.post(PAGE, data=near, headers=HTMX)).status_code == 204
