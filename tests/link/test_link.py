"""The link over a real Unix socket: orders in, updates out, and what happens when one side is gone."""

import asyncio
import stat
from collections import Counter
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest

from app.base.clock import VirtualClock
from app.link.client import LinkClient
from app.link.codec import (
    Ask,
    Execute,
    Measured,
    Refused,
    Request,
    Telling,
    Told,
    decode_telling,
    encode_request,
    read_body,
    stop_path,
)
from app.link.conversation import MOST_AT_ONCE, MOST_REQUESTS
from app.link.lanes import Lanes
from app.link.messages import (
    MachineUnreachable,
    Order,
    SavePlan,
    SiteDetail,
    StopAll,
    UnknownRecording,
    UnknownTracker,
    Update,
)
from app.link.metrics import MachineMetrics
from app.link.outlet import MOST_EVENTS_WAITING, Listener, Outlet
from app.link.server import LinkServer
from app.sun.position import Location
from app.tracker.commands.commands import CommandRejected, Jog, Stop, Track
from app.tracker.memory.memory import SiteState
from app.tracker.programs.show import ShowPlan
from app.tracker.settings.axes import Axis
from app.tracker.state.snapshot import ClockState, Event, EventKind, SiteSnapshot, Snapshot
from app.tracker.values.reason import Reason
from tests.captured_logs import capture_logs
from tests.patience import eventually

NOON = datetime(2026, 6, 21, 12, tzinfo=UTC)
MOST_AHEAD = 20
"""Of 500 orders in the sockets so many may begin while a stop is carried from one process to the other."""


def snapshot(sequence: int) -> SiteSnapshot:
    clock = ClockState("system", 0.0, True, True, NOON)
    return SiteSnapshot("boot", sequence, NOON, "Site", Location(41.0, 36.0), "UTC", clock, None, ())


def event(number: int) -> Event:
    return Event(NOON, EventKind.MOVE_STARTED, "T1", f"Move {number} started.", data={"number": number})


@dataclass
class ScriptedMachine:
    """Answers orders with what the test put there and remembers them."""

    outlet: Outlet = field(default_factory=Outlet)
    orders: list[Order] = field(default_factory=list)
    failure: Exception | None = None
    gate: asyncio.Event | None = None
    answer: SiteSnapshot | None = None
    watched: list[frozenset[str]] = field(default_factory=list)
    turn: int = 0
    measured: Counter[int] = field(default_factory=Counter)
    stop_gate: asyncio.Event | None = None
    stops: int = 0

    async def execute(self, order: Order) -> SiteSnapshot:
        self.stops += isinstance(order.command, Stop)
        if self.stop_gate is not None and isinstance(order.command, Stop):
            await self.stop_gate.wait()
        if self.gate is not None and not isinstance(order.command, Stop):
            await self.gate.wait()
        self.orders.append(order)
        if self.failure is not None:
            raise self.failure
        return self.answer or snapshot(len(self.orders))

    async def detail(self) -> SiteDetail:
        return SiteDetail(SiteState(name="Samsun"))

    async def metrics(self) -> MachineMetrics:
        self.measured[self.turn] += 1
        return MachineMetrics("boot", 1.0)

    async def count_turns(self) -> None:
        """Count the turns of the loop: what else the machine has to do runs once in each."""
        while True:
            self.turn += 1
            await asyncio.sleep(0)

    def latest(self) -> SiteSnapshot | None:
        return self.outlet.latest

    async def tracker(self, tracker_id: str) -> Snapshot:
        raise UnknownTracker(tracker_id)

    async def watch(self, tracker_ids: frozenset[str], who: object = None) -> None:
        self.watched.append(tracker_ids)

    def listen(self) -> Listener:
        return self.outlet.listen()

    def updates(self) -> AsyncIterator[Update]:
        return self.outlet.subscribe()


@dataclass
class Link:
    machine: ScriptedMachine
    server: LinkServer
    client: LinkClient
    path: Path

    async def until_up(self) -> None:
        async with asyncio.timeout(3):
            async for _ in self.client.updates():
                return


@asynccontextmanager
async def linked(machine: ScriptedMachine, folder: Path) -> AsyncIterator[Link]:
    """Connect a panel with a machine over a socket in a folder."""
    path = folder / "machine.sock"
    server = LinkServer(machine, path)
    await server.start()
    async with LinkClient(path) as client:
        made = Link(machine, server, client, path)
        await made.until_up()
        yield made
    await made.server.close()


@pytest.fixture
async def link(tmp_path: Path) -> AsyncIterator[Link]:
    machine = ScriptedMachine()
    machine.outlet.publish(snapshot(1))
    async with linked(machine, tmp_path) as made:
        yield made


async def test_an_order_arrives_as_it_was_given(link: Link) -> None:
    plan = ShowPlan(
        "s1", NOON, NOON + timedelta(hours=3), timedelta(minutes=3), Location(41.2867, 36.33, 4.0)
    )
    given = Order(SavePlan("T1", plan), "technician", key="k1", issued_at=NOON)

    assert await link.client.execute(given) == snapshot(1)
    assert link.machine.orders == [given]
    assert (await link.client.metrics()).link_clients == 1


@pytest.mark.parametrize(
    "failure",
    [
        CommandRejected(Reason("not_homed", "T1 has no zero.", "Set it."), Reason("night", "It is night.")),
        UnknownTracker("No tracker is called T9."),
        UnknownRecording("No recording is called r9."),
        ValueError("Latitude must be between -90 and 90 degrees."),
    ],
    ids=lambda failure: type(failure).__name__,
)
async def test_an_error_crosses_as_the_same_error(link: Link, failure: Exception) -> None:
    link.machine.failure = failure

    with pytest.raises(type(failure)) as caught:
        await link.client.execute(Order(Track(), "technician", "T1"))

    assert str(caught.value) == str(failure)
    assert getattr(caught.value, "reasons", None) == getattr(failure, "reasons", None)


async def test_an_unexpected_error_says_so_without_its_text(link: Link) -> None:
    link.machine.failure = KeyError("secret")

    with pytest.raises(MachineUnreachable, match="unexpected error") as caught:
        await link.client.execute(Order(Track(), "technician", "T1"))

    assert "secret" not in str(caught.value)


async def told_to(writer: asyncio.StreamWriter, *requests: Request) -> None:
    for request in requests:
        writer.write(encode_request(request))
    await writer.drain()


@pytest.mark.fault(97)
async def test_a_stop_on_its_lane_overtakes_500_orders_that_are_on_their_way(link: Link) -> None:
    """Ordered, not timed: all 500 are in the panel's own stream before the stop is; each takes a turn."""
    far = asyncio.get_running_loop().time() + 60.0
    for number in range(10_000, 10_500):
        link.client._main.send(Execute(number, Track(), "a", "T1", None, None, far))
    await link.client.execute(Order(Stop(), "technician", "T1"))
    ahead = [type(order.command) for order in link.machine.orders].index(Stop)
    await eventually(lambda: len(link.machine.orders) == 501)
    assert ahead <= MOST_AHEAD


async def test_orders_tell_when_they_were_given_on_both_ways(link: Link) -> None:
    """The machine tells by it what a stop has overtaken."""
    link.machine.gate = asyncio.Event()
    moving = asyncio.create_task(link.client.execute(Order(Track(), "technician", "T1")))
    await asyncio.sleep(0.01)
    await link.client.execute(Order(Stop(), "technician", "T1"))
    link.machine.gate.set()
    await moving
    await asyncio.sleep(0.01)
    stop, track = link.machine.orders
    assert isinstance(stop.command, Stop)
    assert track.given_s < stop.given_s < asyncio.get_running_loop().time()


async def test_a_stop_is_answered_though_nothing_is_taken_from_the_machine(link: Link) -> None:
    _, writer = await asyncio.open_unix_connection(link.path)
    await eventually(lambda: link.server.client_count == 2)
    link.client._main._writer.transport.pause_reading()
    link.machine.outlet.publish(snapshot(2), tuple(event(one) for one in range(9_000)))
    site = await link.client.execute(Order(StopAll(), "technician"))
    assert isinstance(link.machine.orders[0].command, StopAll)
    assert site.sequence == 1, "what was not heard yet cannot be shown"
    writer.close()


@pytest.mark.parametrize(
    "request_",
    [Execute(1, Track(), "a", "T1", None, None, 1e12), Ask(2, "metrics")],
    ids=["order", "question"],
)
async def test_nothing_but_stops_comes_by_the_lane(link: Link, request_: Request) -> None:
    reader, writer = await asyncio.open_unix_connection(stop_path(link.path))
    await told_to(writer, request_)
    assert await reader.read() == b""
    assert link.machine.orders == []
    for path in (link.path, stop_path(link.path)):
        assert stat.S_IMODE(path.stat().st_mode) == 0o600
    writer.close()


async def test_a_stop_goes_with_everything_else_while_its_lane_is_down(link: Link) -> None:
    link.machine.stop_gate = asyncio.Event()
    for lane in link.server._lanes:
        lane.cancel()
    await eventually(lambda: not link.client._stop_lane.up)
    asked = asyncio.create_task(link.client.execute(Order(Stop(), "technician", "T1")))
    await eventually(lambda: link.machine.stops == 1)
    link.machine.stop_gate.set()
    await asked
    await eventually(lambda: link.client._stop_lane.up)


async def test_a_stop_whose_lane_breaks_is_sent_again_with_everything_else(link: Link) -> None:
    gate = link.machine.stop_gate = asyncio.Event()
    asked = asyncio.create_task(link.client.execute(Order(Stop(), "technician", "T1")))
    await eventually(lambda: link.machine.stops == 1)
    link.client._stop_lane._writer.transport.abort()
    await eventually(lambda: link.machine.stops == 2)
    gate.set()
    await asked


async def test_a_mistake_with_what_was_heard_is_logged_and_the_link_comes_back(
    link: Link, monkeypatch: pytest.MonkeyPatch
) -> None:
    heard = link.client._main._hear
    mistakes = iter([KeyError("unforeseen")])

    def hear(told: Told) -> None:
        for mistake in mistakes:
            raise mistake
        heard(told)

    monkeypatch.setattr(link.client._main, "_hear", hear)
    with capture_logs() as logs:
        link.machine.outlet.publish(snapshot(2))
        await eventually(lambda: link.client.latest() is None)
        await eventually(lambda: link.client.latest() == snapshot(2))
    assert [line["event"] for line in logs if line["log_level"] == "error"] == ["link_dropped"]


async def test_what_cannot_be_told_is_logged_and_the_panel_begins_anew(
    link: Link, monkeypatch: pytest.MonkeyPatch
) -> None:
    encode = link.server._encode
    mistakes = iter([TypeError("no JSON")])

    def encode_or_fail(update: Update) -> bytes:
        for mistake in mistakes:
            raise mistake
        return encode(update)

    monkeypatch.setattr(LinkServer, "_encode", lambda self, update: encode_or_fail(update))
    again = LinkServer(link.machine, link.path)
    with capture_logs() as logs:
        await link.server.close()
        await again.start()
        await link.until_up()
        await eventually(lambda: link.client.latest() == snapshot(1))
    assert [line["event"] for line in logs if line["log_level"] == "error"] == ["link_not_told"]
    await again.close()


async def test_stops_of_one_person_never_pile_up_and_those_of_another_wait_for_none(link: Link) -> None:
    gate = link.machine.stop_gate = asyncio.Event()
    link.client._stops = Lanes(VirtualClock(NOON))
    asked = [asyncio.create_task(link.client.execute(Order(Stop(), "a", "T1"))) for _ in range(100)]
    asked.append(asyncio.create_task(link.client.execute(Order(Stop(), "b", "T1"))))
    await eventually(lambda: link.machine.stops >= 2)
    begun = link.machine.stops
    gate.set()
    answers = await asyncio.gather(*asked)
    assert (begun, link.machine.stops, len(answers)) == (2, 3, 101)


async def test_a_stop_is_carried_out_however_many_orders_wait(link: Link) -> None:
    link.machine.gate = asyncio.Event()
    orders = [link.client.execute(Order(Track(), "a", "T1")) for _ in range(MOST_REQUESTS + 10)]
    waiting = [asyncio.create_task(order) for order in orders]
    await asyncio.sleep(0.1)

    await link.client.execute(Order(Stop(), "technician", "T1"))

    assert [type(order.command) for order in link.machine.orders] == [Stop]
    link.machine.gate.set()
    await asyncio.gather(*waiting, return_exceptions=True)


async def tellings(reader: asyncio.StreamReader, count: int) -> list[Telling]:
    """Return so many answers, without the updates in between."""
    answers: list[Telling] = []
    async with asyncio.timeout(10):
        while len(answers) < count:
            telling = decode_telling(await read_body(reader))
            if not isinstance(telling, Told):
                answers.append(telling)
    return answers


async def test_a_flood_of_questions_is_answered_one_in_a_turn_and_refused_beyond_its_budget(
    tmp_path: Path,
) -> None:
    machine = ScriptedMachine()
    machine.outlet.publish(snapshot(1))
    server = LinkServer(machine, tmp_path / "machine.sock", VirtualClock(NOON))
    await server.start()
    reader, writer = await asyncio.open_unix_connection(tmp_path / "machine.sock")
    for number in range(MOST_AT_ONCE + 100):
        writer.write(encode_request(Ask(number, "metrics")))
    stop = Execute(9999, Stop(), "technician", "T1", None, None, 0.0)
    writer.write(encode_request(stop))
    counting = asyncio.create_task(machine.count_turns())
    answers = await tellings(reader, MOST_AT_ONCE + 101)
    counting.cancel()
    assert max(machine.measured.values()) <= 2
    assert sum(isinstance(one, Measured) for one in answers) == MOST_AT_ONCE
    assert sum(isinstance(one, Refused) for one in answers) == 100
    assert [order.command for order in machine.orders] == [Stop()], "a stop has no budget"
    writer.close()
    await server.close()


@pytest.mark.fault(88)
async def test_a_client_that_takes_no_updates_is_cut_off(tmp_path: Path) -> None:
    machine = ScriptedMachine()
    machine.outlet.publish(snapshot(1))
    server = LinkServer(machine, tmp_path / "machine.sock", take_within_s=0.2)
    await server.start()
    _, writer = await asyncio.open_unix_connection(tmp_path / "machine.sock")
    await eventually(lambda: server.client_count)

    def tell_more() -> bool:
        machine.outlet.publish(snapshot(2), tuple(event(one) for one in range(200)))
        return not server.client_count

    await eventually(tell_more)
    writer.close()
    await server.close()


async def test_an_order_is_given_up_in_time(link: Link) -> None:
    link.machine.gate = asyncio.Event()

    with pytest.raises(MachineUnreachable, match="may or may not"):
        await link.client.execute(Order(Jog("p1", Axis.AZIMUTH, 1), "technician", "T1"))

    link.machine.gate.set()


async def test_without_a_machine_an_order_fails_at_once_and_is_not_kept(tmp_path: Path) -> None:
    path = tmp_path / "machine.sock"
    async with LinkClient(path) as client:
        with pytest.raises(MachineUnreachable, match="nothing was done"):
            await client.execute(Order(Track(), "technician", "T1"))
        assert client.latest() is None
        machine = ScriptedMachine()
        machine.outlet.publish(snapshot(7))
        server = LinkServer(machine, path)
        await server.start()
        await Link(machine, server, client, path).until_up()

        assert client.latest() == snapshot(7)
        assert machine.orders == []
        await server.close()


async def test_when_the_machine_dies_the_page_knows_at_once_and_finds_it_again(link: Link) -> None:
    await link.server.close()
    async with asyncio.timeout(1):
        async for _ in link.client.updates():
            pass
    assert link.client.latest() is None
    with pytest.raises(MachineUnreachable):
        await link.client.detail()

    again = LinkServer(link.machine, link.path)
    await again.start()
    await link.until_up()

    assert (await link.client.execute(Order(Track(), "technician", "T1"))).boot_id == "boot"
    await again.close()


async def test_events_all_arrive_and_the_last_snapshot_is_the_newest(link: Link) -> None:
    updates = link.client.updates()
    await anext(updates)
    for number in range(2, 1002):
        link.machine.outlet.publish(snapshot(number), (event(number),))
    seen: list[int] = []
    async with asyncio.timeout(5):
        while len(seen) < 1000:
            update = await anext(updates)
            seen.extend(e.data["number"] for e in update.events)
    assert seen == list(range(2, 1002))
    assert update.snapshot.sequence == 1001


async def test_a_reader_that_falls_too_far_behind_is_ended() -> None:
    outlet = Outlet()
    outlet.publish(snapshot(1))
    updates = outlet.subscribe()
    await anext(updates)
    outlet.publish(snapshot(2), tuple(event(n) for n in range(MOST_EVENTS_WAITING + 1)))

    assert [update async for update in updates] == []
    assert len(outlet) == 0


async def test_rubbish_on_the_socket_ends_only_that_connection(link: Link) -> None:
    reader, writer = await asyncio.open_unix_connection(link.path)
    writer.write((5).to_bytes(4, "big") + b"hello")
    async with asyncio.timeout(2):
        while await reader.read(65536):
            pass
    writer.close()

    assert (await link.client.detail()).site.name == "Samsun"


def test_the_way_to_the_machine_takes_time_from_a_jogs_lease() -> None:
    jog = Jog("p1", Axis.AZIMUTH, 1, lease=timedelta(milliseconds=200))
    request = Execute(1, jog, "operator", "T1", None, None, good_until_s=100.2)
    assert request.order(at_s=100.0).command == jog
    late = request.order(at_s=100.06).command
    assert isinstance(late, Jog)
    assert late.lease == timedelta(milliseconds=140)
    assert request.order(at_s=99.0).command == jog
