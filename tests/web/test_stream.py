"""Server-sent events: a full snapshot first, every event once, resumed where a reader left."""

import asyncio
import json
from collections.abc import AsyncIterator
from datetime import timedelta

import pytest
from fastapi import FastAPI

from app.tracker.state.snapshot import Event, EventKind
from app.web.live.hub import EVENTS_KEPT
from tests.fake_data import NOON
from tests.fakes import FakeMachine, fake_app, serving
from tests.patience import PATIENCE_S
from tests.web.asgi import streaming


@pytest.fixture
async def app(machine: FakeMachine) -> AsyncIterator[FastAPI]:
    app = fake_app(machine)
    async with serving(app):
        yield app


def event(text: str, kind: EventKind = EventKind.STOPPED, tracker_id: str | None = "T1") -> Event:
    return Event(NOON, kind, tracker_id, text)


async def told(app: FastAPI, machine: FakeMachine, *events: Event) -> None:
    """Have the machine tell events and wait until the panel has heard them."""
    async with streaming(app) as reading:
        await reading.next("snapshot")
        machine.emit(*events)
        for _ in events:
            await reading.next("event")


async def test_whole_state_comes_first_and_events_follow(app: FastAPI, machine: FakeMachine) -> None:
    async with streaming(app) as reading:
        first = json.loads((await reading.next("snapshot"))["data"])
        assert reading.status == 200
        assert [one["tracker_id"] for one in first["snapshot"]["trackers"]] == ["T1", "T2"]
        machine.emit(event("T1 stopped."))
        assert json.loads((await reading.next("event"))["data"])["message"] == "T1 stopped."


async def test_reader_that_comes_back_gets_what_it_missed(app: FastAPI, machine: FakeMachine) -> None:
    async with streaming(app) as reading:
        await reading.next("snapshot")
        machine.emit(event("one"))
        mark = (await reading.next("event"))["id"]
    await told(app, machine, event("two"), event("three"))
    async with streaming(app, headers={"last-event-id": mark}) as reading:
        missed = [json.loads((await reading.next("event"))["data"])["message"] for _ in range(2)]
        await reading.next("snapshot")
    assert missed == ["two", "three"]


@pytest.mark.parametrize("mark", ["another-3", "nonsense", ""])
async def test_reader_whose_place_is_not_known_is_told_so(app: FastAPI, mark: str) -> None:
    async with streaming(app, headers={"last-event-id": mark}) as reading:
        await reading.next("resync")
        await reading.next("snapshot")


async def test_reader_that_was_away_too_long_is_told_so(app: FastAPI, machine: FakeMachine) -> None:
    async with streaming(app) as reading:
        mark = (await reading.next("snapshot"))["id"]
    for _ in range(5):
        await told(app, machine, *[event("again")] * (EVENTS_KEPT // 4))
    async with streaming(app, headers={"last-event-id": mark}) as reading:
        await reading.next("resync")


async def test_filters_hold_for_what_comes_and_for_what_was_missed(
    app: FastAPI, machine: FakeMachine
) -> None:
    async with streaming(app) as reading:
        mark = (await reading.next("snapshot"))["id"]
    mixed = (
        event("other tracker", tracker_id="T2"),
        event("other kind", EventKind.JOG_STARTED),
        event("wanted"),
    )
    await told(app, machine, *mixed)
    query = "tracker_id=T1&kind=stopped"
    async with streaming(app, query, {"last-event-id": mark}) as reading:
        assert json.loads((await reading.next("event"))["data"])["message"] == "wanted"
        state = json.loads((await reading.next("snapshot"))["data"])
        assert [one["tracker_id"] for one in state["snapshot"]["trackers"]] == ["T1"]
        machine.emit(*mixed)
        assert json.loads((await reading.next("event"))["data"])["message"] == "wanted"


async def test_lost_machine_is_told(app: FastAPI, machine: FakeMachine) -> None:
    async with streaming(app) as reading:
        await reading.next("snapshot")
        machine.cut()
        await reading.next("machine_lost")


async def test_stuck_reader_is_dropped(app: FastAPI, machine: FakeMachine) -> None:
    hub = app.state.panel.hub
    hub.patience = timedelta(milliseconds=20)
    async with streaming(app) as stuck:
        await stuck.next("snapshot")
        stuck.reads.clear()
        machine.emit(event("never read"))
        async with asyncio.timeout(PATIENCE_S):
            while len(hub):
                await machine.clock.sleep_until(machine.clock.now() + timedelta(milliseconds=5))
        stuck.reads.set()


async def test_panel_that_ends_ends_its_streams(machine: FakeMachine) -> None:
    app = fake_app(machine)
    async with serving(app), streaming(app) as reading:
        await reading.next("snapshot")
        app.state.panel.hub.closing.set()
        await asyncio.wait_for(reading.ended.wait(), PATIENCE_S)
