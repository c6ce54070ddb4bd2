"""What is told costs what changed: work is counted, not time, at the controller and at the link's socket."""

import asyncio
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

from app.link.codec import LENGTH_BYTES, Told, decode_telling, read_body
from app.link.messages import StopAll
from app.link.server import LinkServer
from app.site.publishing.publishing import MOST_AT_ONCE
from app.tracker.access.interlocks import Action
from app.tracker.memory.memory import TrackerMemory, TrackerState
from app.tracker.settings.config import TrackerConfig
from app.tracker.state.snapshot import EventKind
from tests.patience import PATIENCE_S
from tests.site.plant import Plant, make_plant, settle


def field_of(count: int) -> Plant:
    return make_plant(
        trackers=tuple(
            TrackerState(TrackerConfig(f"T{number:03}", f"Tracker {number:03}"), TrackerMemory())
            for number in range(count)
        )
    )


@dataclass
class Heard:
    """What came over the socket: how much, how often each tracker, how often with its actions."""

    sizes: list[int] = field(default_factory=list)
    trackers: Counter[str] = field(default_factory=Counter)
    asked: Counter[str] = field(default_factory=Counter)
    sequences: list[int] = field(default_factory=list)
    events: list[str] = field(default_factory=list)

    async def listen(self, reader: asyncio.StreamReader) -> None:
        while True:
            body = await read_body(reader)
            telling = decode_telling(body)
            assert isinstance(telling, Told)
            self.sizes.append(LENGTH_BYTES + len(body))
            self.sequences.append(telling.site.sequence)
            self.trackers.update(one.tracker_id for one in telling.site.trackers)
            self.asked.update(one.tracker_id for one in telling.site.trackers if one.actions)
            self.events.extend(str(event.tracker_id) for event in telling.events)

    def forget(self) -> None:
        self.sizes, self.sequences, self.events = [], [], []
        self.trackers.clear()
        self.asked.clear()


async def told_when_all_stop(count: int, path: Path) -> Heard:
    """Have one event happen at every tracker, and return what crossed the link for it."""
    plant, heard = field_of(count), Heard()
    await plant.start()
    server = LinkServer(plant.site, path)
    await server.start()
    reader, writer = await asyncio.open_unix_connection(path)
    listening = asyncio.create_task(heard.listen(reader))
    await plant.forward(seconds=0.6)
    async with asyncio.timeout(PATIENCE_S):
        while len(heard.trackers) < count:
            await settle()
    await plant.forward(seconds=0.2)
    for _ in range(20):
        await settle()
    heard.forget()
    await plant.ask(StopAll())
    async with asyncio.timeout(PATIENCE_S):
        while len(heard.events) < count or len(heard.trackers) < count:
            await settle()
    listening.cancel()
    writer.close()
    await server.close()
    await plant.close()
    return heard


async def test_an_event_at_every_tracker_costs_as_much_a_tracker_however_many_there_are(
    tmp_path: Path,
) -> None:
    heard = {count: await told_when_all_stop(count, tmp_path / f"{count}.sock") for count in (10, 100)}
    for count, told in heard.items():
        assert set(told.trackers.values()) == {1}, "each is made and told once"
        assert sum(told.trackers.values()) == count
        assert sorted(told.events) == sorted(told.trackers)
        assert not told.asked, "what is allowed is worked out for nobody"
        assert len(told.sizes) <= -(-count // MOST_AT_ONCE) + 1
    few, many = sum(heard[10].sizes) / 10, sum(heard[100].sizes) / 100
    assert many <= few


async def test_a_tick_that_changes_one_tracker_makes_one_snapshot() -> None:
    plant = field_of(100)
    await plant.start()
    listener = plant.site.listen()
    while listener.take():
        pass
    plant.site.publisher.mark(("T042",))
    await plant.forward(seconds=0.1)
    update = listener.take()
    assert update is not None
    assert "T042" in {one.tracker_id for one in update.changed}
    assert len(update.changed) == 1
    await plant.close()


async def test_what_is_allowed_is_told_of_those_that_somebody_watches_and_of_no_other() -> None:
    plant = field_of(3)
    await plant.start()
    page, other = object(), object()
    await plant.site.watch(frozenset({"T001"}), page)
    await plant.site.watch(frozenset({"T001", "T002"}), other)
    await settle()
    await plant.forward(seconds=0.6)

    def asked() -> dict[str, int]:
        site = plant.latest()
        return {one.tracker_id: len(one.actions) for one in site.trackers}

    assert asked() == {"T000": 0, "T001": len(Action), "T002": len(Action)}
    await plant.site.watch(frozenset(), other)
    await plant.forward(seconds=0.6)
    assert asked() == {"T000": 0, "T001": len(Action), "T002": 0}
    assert len((await plant.site.tracker("T000")).actions) == len(Action)
    await plant.close()


async def test_sequences_grow_by_one_and_no_event_is_lost_or_overtaken() -> None:
    plant = field_of(2)
    await plant.start()
    listener = plant.site.listen()
    first = listener.take()
    assert first is not None
    sequence, happened = first.snapshot.sequence, []
    for number in range(20):
        plant.site.note(plant.site.model.event(EventKind.REMOTE_WRITTEN, str(number), "scada"))
        if number % 3 == 0:
            await plant.ask(StopAll())
        if number % 4 == 0:
            await plant.forward(seconds=0.1)
        await settle()
        while (update := listener.take()) is not None:
            assert update.after == sequence
            sequence = update.snapshot.sequence
            happened.extend(event.message for event in update.events if event.actor == "scada")
    assert happened == [str(number) for number in range(20)]
    await plant.close()


async def test_storms_are_told_ten_times_a_second_and_slower_where_every_says_so() -> None:
    plant = field_of(20)
    await plant.start()
    await plant.forward(seconds=1.0)
    listener = plant.site.listen()
    while listener.take():
        pass

    async def told_in_two_seconds() -> int:
        before = plant.latest().sequence
        for _ in range(200):
            event = plant.site.model.event(EventKind.MOVE_STARTED, "Moves.", "controller", "T000")
            plant.site.publisher.mark(("T000",), (event,))
            await plant.forward(seconds=0.01)
        return plant.latest().sequence - before

    assert await told_in_two_seconds() <= 21
    plant.site.publisher.every *= 5
    assert await told_in_two_seconds() <= 5
    await plant.close()


async def test_a_look_at_alarms_costs_the_trackers_that_changed() -> None:
    plant = field_of(10)
    await plant.start()
    await plant.forward(seconds=1.0)
    before = plant.latest().alarms
    plant.site.publisher.publish(("T001",))
    assert plant.latest().alarms is before
    await plant.close()
