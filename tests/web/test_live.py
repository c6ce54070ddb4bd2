"""The live WebSocket: state for all, hold-to-run that ends by itself, a stop that waits for nothing."""

import asyncio
import gc
import tracemalloc
from collections.abc import AsyncIterator
from contextlib import AsyncExitStack
from datetime import timedelta

import pytest
from fastapi import FastAPI

from app.base.clock import VirtualClock
from app.link.messages import Order, StopAll
from app.tracker.commands.commands import EndJog, Jog, Stop
from app.tracker.state.snapshot import Event, EventKind, SiteSnapshot
from app.tracker.values.reason import Reason
from tests.fake_data import NOON
from tests.fakes import FakeMachine, fake_app, serving
from tests.fault_result import REAL, FaultResult
from tests.patience import PATIENCE_S
from tests.web.sockets import Socket, connected


@pytest.fixture
def clock() -> VirtualClock:
    return VirtualClock(NOON)


@pytest.fixture
def machine(clock: VirtualClock) -> FakeMachine:
    return FakeMachine(clock)


@pytest.fixture
async def app(machine: FakeMachine) -> AsyncIterator[FastAPI]:
    app = fake_app(machine)
    async with serving(app):
        yield app


def jogs(machine: FakeMachine) -> list[Order]:
    return [order for order in machine.orders if isinstance(order.command, Jog)]


async def settle() -> None:
    for _ in range(20):
        await asyncio.sleep(0)


async def until_heard(page: Socket) -> None:
    """Return once everything that was sent has been heard."""
    await page.send(type="ping", tc=1.0)
    await page.next("pong")
    await settle()


async def forward(clock: VirtualClock, seconds: float) -> None:
    for _ in range(round(seconds / 0.05)):
        clock.advance(timedelta(milliseconds=50))
        await settle()


async def test_first_message_is_the_whole_state(app: FastAPI, machine: FakeMachine) -> None:
    async with connected(app) as page:
        state = await page.next("state")
    assert state["boot"] == "fake-boot"
    assert state["rev"] == machine.sequence
    assert [one["tracker_id"] for one in state["snapshot"]["trackers"]] == ["T1", "T2"]
    async with connected(app, "tracker=T2") as page:
        state = await page.next("state")
    assert [one["tracker_id"] for one in state["snapshot"]["trackers"]] == ["T2"], "a page of one tracker"


async def test_state_is_told_again_within_half_a_second_though_nothing_changed(
    app: FastAPI, clock: VirtualClock
) -> None:
    async with connected(app) as page:
        await forward(clock, 1.0)
        first = await page.next("state")
        page.inbox = asyncio.Queue()
        await forward(clock, 0.6)
        second = await page.next("state")
    assert second["rev"] == first["rev"]
    assert second["age_ms"] >= 1000


async def test_a_change_is_told_and_many_changes_are_told_as_the_newest(
    app: FastAPI, machine: FakeMachine, clock: VirtualClock
) -> None:
    async with connected(app) as page:
        await forward(clock, 1.0)
        page.inbox = asyncio.Queue()
        for _ in range(20):
            for _ in range(10):
                machine.emit()
            await forward(clock, 0.05)
        await forward(clock, 0.2)
        assert 8 <= page.inbox.qsize() <= 11
        states = [await page.next("state") for _ in range(page.inbox.qsize())]
    assert states[-1]["rev"] == machine.sequence


async def test_lost_link_is_told_at_once_and_again_and_the_state_comes_back(
    app: FastAPI, machine: FakeMachine, clock: VirtualClock
) -> None:
    async with connected(app) as page:
        await page.next("state")
        machine.cut()
        await page.next("machine_lost")
        await forward(clock, 0.6)
        await page.next("machine_lost")
        machine.mend()
        await forward(clock, 0.2)
        assert (await page.next("state"))["rev"] == machine.sequence


async def test_events_go_to_the_pages_they_concern(app: FastAPI, machine: FakeMachine) -> None:
    async with connected(app, "tracker=T2") as page:
        await page.next("state")
        machine.emit(Event(NOON, EventKind.JOG_STARTED, "T1", "T1 jogs."))
        machine.emit(Event(NOON, EventKind.LOCATION_SET, None, "The site moved."))
        machine.emit(Event(NOON, EventKind.STOPPED, "T2", "T2 stopped.", data={"why": "asked"}))
        told = [await page.next("event") for _ in range(2)]
    assert [one["message"] for one in told] == ["The site moved.", "T2 stopped."]
    assert told[1]["data"] == {"why": "asked"}


async def test_held_key_moves_and_letting_go_ends_it(app: FastAPI, machine: FakeMachine) -> None:
    async with connected(app) as page:
        for sequence in range(3):
            await page.beat("p1", sequence, 1000.0 + 50 * sequence)
            assert (await page.next("jog"))["status"] == "ok"
        await page.send(type="end_jog", tracker_id="T1", press_id="p1")
        assert (await page.next("jog"))["status"] == "ended"
        await page.beat("p1", 3, 1200.0)
        assert (await page.next("jog"))["status"] == "dead"
    assert [order.command.sequence for order in jogs(machine)] == [0, 1, 2]
    assert machine.trackers["T1"].press is None


@pytest.mark.fault(59)
async def test_burst_after_a_frozen_link_does_not_start_motion(
    app: FastAPI, machine: FakeMachine, fault: FaultResult
) -> None:
    async with connected(app) as page:
        await page.send(type="ping", tc=100_000.0)
        await page.next("pong")
        for sequence in range(10):
            await page.beat("p1", sequence, 100_000.0 - 900.0 + 50 * sequence)
        answers = [await page.next("jog") for _ in range(10)]
    assert [answer["status"] for answer in answers] == ["refused"] + ["dead"] * 9
    assert answers[0]["reasons"][0]["code"] == "link_too_slow"
    assert jogs(machine) == []
    fault.prevented("what comes late counts as never sent")
    fault.shows(answers[0]["reasons"][0]["message"])
    fault.recovers("the button is released and pressed again")


@pytest.mark.fault(59)
async def test_a_key_pressed_before_the_link_was_measured_moves_nothing(
    app: FastAPI, machine: FakeMachine
) -> None:
    """On a link that is frozen from the start all messages come equally late, and none looks late."""
    async with connected(app) as page:
        await page.send(type="ping", tc=99_000.0)
        await page.next("pong")
        for sequence in range(4):
            await page.beat("p1", sequence, 99_300.0 + 50 * sequence, rtt_ms=None)
        answers = [await page.next("jog") for _ in range(4)]
    assert [answer["status"] for answer in answers] == ["refused"] + ["dead"] * 3
    assert answers[0]["reasons"][0]["code"] == "link_unmeasured"
    assert jogs(machine) == []


async def test_slow_round_trip_does_not_start_motion(app: FastAPI, machine: FakeMachine) -> None:
    async with connected(app) as page:
        await page.beat("p1", 0, 1000.0, rtt_ms=600.0)
        assert (await page.next("jog"))["status"] == "refused"
    assert jogs(machine) == []


async def test_two_people_at_one_key_the_second_is_told_busy(app: FastAPI, machine: FakeMachine) -> None:
    async with connected(app) as first, connected(app) as second:
        await first.beat("p1", 0, 1000.0)
        assert (await first.next("jog"))["status"] == "ok"
        await second.beat("p2", 0, 1000.0)
        answer = await second.next("jog")
        assert answer["status"] == "busy"
        assert answer["reasons"][0]["hint"]
        await first.beat("p1", 1, 1050.0)
        assert (await first.next("jog"))["status"] == "ok"


async def test_closing_the_page_ends_its_presses_at_once(app: FastAPI, machine: FakeMachine) -> None:
    async with connected(app) as page:
        await page.beat("p1", 0, 1000.0)
        await page.next("jog")
    await settle()
    assert EndJog("p1") in [order.command for order in machine.orders]


async def test_refused_press_is_dead_even_when_the_reason_is_gone(app: FastAPI, machine: FakeMachine) -> None:
    machine.rejects["jog"] = (Reason("fault", "The drive reports a fault.", "Reset it."),)
    async with connected(app) as page:
        await page.beat("p1", 0, 1000.0)
        answer = await page.next("jog")
        assert answer["status"] == "refused"
        assert answer["reasons"] == [
            {"code": "fault", "message": "The drive reports a fault.", "hint": "Reset it."}
        ]
        machine.rejects.clear()
        await page.beat("p1", 1, 1050.0)
        assert (await page.next("jog"))["status"] == "dead"


async def test_jog_while_the_machine_is_gone_is_refused_and_not_kept(
    app: FastAPI, machine: FakeMachine
) -> None:
    async with connected(app) as page:
        machine.cut()
        await page.beat("p1", 0, 1000.0)
        assert (await page.next("jog"))["status"] == "refused"
        machine.mend()
        await settle()
    assert jogs(machine) == []


async def test_stop_is_carried_out_and_told(app: FastAPI, machine: FakeMachine) -> None:
    async with connected(app) as page:
        await page.send(type="stop", tracker_id="T2")
        assert (await page.next("stopped"))["tracker_id"] == "T2"
        await page.send(type="stop_all")
        assert (await page.next("stopped"))["tracker_id"] is None
        await page.send(type="stop", tracker_id="T9")
        assert (await page.next("problem"))["status"] == 404
    assert machine.orders[0].command == Stop()
    assert not machine.trackers["T2"].memory.tracking_on


class Stuck(FakeMachine):
    """A machine whose answers to whoever ends motion wait for a gate."""

    def __init__(self, clock: VirtualClock) -> None:
        super().__init__(clock)
        self.gate = asyncio.Event()
        self.begun: list[Order] = []

    async def execute(self, order: Order) -> SiteSnapshot:
        self.begun.append(order)
        if isinstance(order.command, Stop | StopAll | EndJog):
            await self.gate.wait()
        return await super().execute(order)


@pytest.mark.fault(93)
async def test_stops_of_one_page_are_one_at_a_time_for_each_tracker(clock: VirtualClock) -> None:
    """3,000 stops killed the controller; now a second one waits for the first, and stands for all others."""
    machine = Stuck(clock)
    app = fake_app(machine)
    async with serving(app), connected(app) as page:
        for _ in range(200):
            await page.send(type="stop", tracker_id="T1")
        await page.send(type="stop", tracker_id="T2")
        await page.send(type="stop_all")
        await until_heard(page)
        assert [order.tracker_id for order in machine.begun] == ["T1", "T2", None]
        machine.gate.set()
        for _ in range(4):
            await page.next("stopped")
        await settle()
    assert sorted(str(order.tracker_id) for order in machine.begun) == ["None", "T1", "T1", "T2"]


@pytest.mark.fault(93)
async def test_ends_of_presses_that_never_began_here_are_one_at_a_time(clock: VirtualClock) -> None:
    machine = Stuck(clock)
    app = fake_app(machine)
    async with serving(app), connected(app) as page:
        await page.beat("mine", 0, 1000.0)
        await page.next("jog")
        for number in range(200):
            await page.send(type="end_jog", tracker_id="T1", press_id=f"p{number}")
        await page.send(type="end_jog", tracker_id="T1", press_id="mine")
        await until_heard(page)
        ends = [order.command.press_id for order in machine.begun if isinstance(order.command, EndJog)]
        assert sorted(ends) == ["mine", "p199"]
        machine.gate.set()
        await settle()
    ends = [order.command.press_id for order in machine.begun if isinstance(order.command, EndJog)]
    assert sorted(ends) == ["mine", "p199", "p199"]


async def test_stop_of_a_page_that_reads_nothing_is_carried_out(app: FastAPI, machine: FakeMachine) -> None:
    async with connected(app) as page:
        await page.next("state")
        page.reads.clear()
        machine.emit()
        await page.send(type="stop", tracker_id="T2")
        await settle()
        page.reads.set()
    assert machine.orders[0].tracker_id == "T2"


@pytest.mark.fault(66)
async def test_reader_that_takes_nothing_is_dropped_and_the_others_go_on(
    app: FastAPI, machine: FakeMachine, clock: VirtualClock, fault: FaultResult
) -> None:
    hub = app.state.panel.hub
    assert hub.patience == timedelta(seconds=5)
    hub.patience = timedelta(milliseconds=20)
    async with connected(app) as stuck, connected(app) as good:
        await stuck.next("state")
        await good.next("state")
        stuck.reads.clear()
        machine.emit()
        await forward(clock, 1.0)
        await asyncio.wait_for(stuck.ended.wait(), PATIENCE_S)
        assert len(hub) == 1
        machine.emit()
        await forward(clock, 0.2)
        states = [await good.next("state") for _ in range(good.inbox.qsize())]
    assert states[-1]["rev"] == machine.sequence
    fault.noticed(5.0, REAL)
    fault.shows_nothing("nobody reads it")
    fault.recovers("automatic: a page that comes back connects again")


@pytest.mark.fault(66)
async def test_fifty_readers_that_take_nothing_cost_no_memory(app: FastAPI, machine: FakeMachine) -> None:
    async with AsyncExitStack() as pages:
        for _ in range(50):
            page = await pages.enter_async_context(connected(app))
            await page.next("state")
            page.reads.clear()
        gc.collect()
        tracemalloc.start()
        for _ in range(200):
            machine.emit()
            await settle()
        gc.collect()
        held_bytes, _ = tracemalloc.get_traced_memory()
        tracemalloc.stop()
    assert held_bytes < 5_000_000


GARBAGE = (
    "",
    "{}",
    "[1",
    '{"type":"jog"}',
    '{"type":"stop","tracker_id":"T1","x":1}',
    '{"type":"ping","tc":NaN}',
)


@pytest.mark.parametrize("text", GARBAGE)
async def test_what_is_not_understood_is_answered_and_does_no_harm(
    app: FastAPI, machine: FakeMachine, text: str
) -> None:
    async with connected(app) as page:
        await page.outbox.put({"type": "websocket.receive", "text": text})
        assert (await page.next("problem"))["status"] == 422
        await page.outbox.put({"type": "websocket.receive", "bytes": b"\x00"})
        assert (await page.next("problem"))["status"] == 422
    assert machine.orders == []
