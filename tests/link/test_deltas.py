"""Deltas over the link: whatever is gathered, lost or late, the far end has the whole and every event."""

import asyncio
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from pathlib import Path

from hypothesis import example, given
from hypothesis import strategies as st

from app.link.codec import (
    Done,
    Execute,
    Told,
    decode_telling,
    encode_request,
    encode_telling,
    read_body,
    told,
)
from app.link.messages import Order
from app.link.outlet import MOST_TRACKERS_AT_ONCE, Listener, Outlet
from app.link.server import LinkServer
from app.link.whole import Whole, with_tracker
from app.tracker.commands.commands import Track
from app.tracker.settings.config import Orientation
from app.tracker.state.snapshot import ActivityName, ClockState, Event, EventKind, SiteSnapshot, Snapshot
from app.tracker.values.alarm_words import AlarmCounts, AlarmNow, AlarmState
from app.tracker.values.mode import Mode
from app.tracker.values.reason import Reason
from tests.link.test_link import ScriptedMachine, linked
from tests.patience import eventually

NOON = datetime(2026, 6, 21, 12, tzinfo=UTC)
CLOCK = ClockState("system", 0.0, True, True, NOON)
NAMES = tuple(f"T{number}" for number in range(8))


def tracker(name: str, tick: int) -> Snapshot:
    return Snapshot(
        name, name, NOON, tick, ActivityName.HOLDING, "holds", Mode.DUAL, Orientation(180.0, 45.0), False,
        None, False, None, None, None, None, None, None, None, False, True, None, None, None,
    )  # fmt: skip


def alarm(number: int) -> AlarmNow:
    return AlarmNow(f"a{number}", "drive_lost", None, "Site", 2, "Lost", "It is lost.", "Look.",
                    AlarmState.UNACKNOWLEDGED, NOON)  # fmt: skip


class Field:
    """A site that changes at random, and the outlet that tells of it."""

    def __init__(self, size: int = 0) -> None:
        self.outlet = Outlet()
        self.trackers = {name: tracker(name, 0) for name in (f"T{one}" for one in range(size))}
        self.site = SiteSnapshot("boot", 0, NOON, "Site", None, "UTC", CLOCK, None, ())
        self.events = 0

    def tell(self, changed: tuple[str, ...], *, events: int = 0, alarms: int | None = None) -> None:
        """Change these trackers (one that is not there comes, one whose turn is odd goes) and tell it."""
        arrivals = False
        for name in changed:
            known = self.trackers.get(name)
            if known is not None and known.tick % 4 == 3:
                del self.trackers[name]
            else:
                self.trackers[name] = tracker(name, known.tick + 1 if known else 1)
            arrivals = arrivals or known is None or name not in self.trackers
        site = replace(self.site, sequence=self.site.sequence + 1, trackers=tuple(self.trackers.values()))
        if alarms is not None:
            counts = AlarmCounts(standing=(0, alarms, 0, 0))
            site = replace(site, alarms=tuple(alarm(one) for one in range(alarms)), alarm_counts=counts)
        self.site = site
        happened = [
            Event(NOON, EventKind.MOVE_STARTED, "T1", "Moved.", data={"number": self.events + one})
            for one in range(events)
        ]
        self.events += events
        there = tuple(self.trackers[name] for name in dict.fromkeys(changed) if name in self.trackers)
        self.outlet.publish(site, happened, there, arrivals=arrivals)


class FarEnd:
    """What is heard over a wire that may lose something; it asks again after a gap."""

    def __init__(self, field: Field) -> None:
        self.listener: Listener = field.outlet.listen()
        self.whole = Whole()
        self.numbers: list[int] = []

    def hear(self, *, loses: bool = False) -> bool:
        update = self.listener.take()
        if update is None:
            return False
        telling = decode_telling(encode_telling(told(update))[4:])
        assert isinstance(telling, Told)
        if loses:
            return True
        if not self.whole.follows(telling):
            self.listener.again()
        taken = self.whole.take(telling)
        if taken is not None:
            self.numbers.extend(event.data["number"] for event in taken.events)
        return True


changes = st.tuples(
    st.lists(st.sampled_from(NAMES), max_size=5).map(tuple), st.integers(0, 3), st.none() | st.integers(0, 3)
)
acts = st.one_of(changes, st.sampled_from(("hear", "lose", "again")))


@given(st.lists(acts, max_size=40), st.integers(0, 8))
@example([], 3 * MOST_TRACKERS_AT_ONCE + 1)
def test_the_far_end_has_the_whole_and_every_event_that_was_not_lost(life: list[object], size: int) -> None:
    field = Field(size)
    field.tell(())
    far = FarEnd(field)
    is_whole = True
    for act in life:
        match act:
            case "hear":
                far.hear()
            case "lose":
                is_whole = not far.hear(loses=True) and is_whole
            case "again":
                far.listener.again()
            case (names, events, alarms):
                field.tell(names, events=events, alarms=alarms)  # type: ignore[arg-type]
    field.tell(())
    while far.hear():
        pass
    assert far.whole.snapshot == field.site
    assert far.numbers == sorted(far.numbers)
    if is_whole:
        assert far.numbers == list(range(field.events))


@dataclass
class FieldMachine(ScriptedMachine):
    """A field behind the link; an order changes its tracker and tells nobody before it is answered."""

    field: Field | None = None

    async def execute(self, order: Order) -> SiteSnapshot:
        field, name = self.field, order.tracker_id
        assert field is not None
        assert name is not None
        field.tell((name,))
        forbidden = {"track": (Reason("busy", "It tracks.", ""),)}
        return with_tracker(field.site, replace(field.trackers[name], actions=forbidden))


async def test_what_an_order_did_is_there_when_it_is_answered_and_its_answer_has_the_actions(
    tmp_path: Path,
) -> None:
    field = Field(200)
    field.tell(())
    async with linked(FieldMachine(outlet=field.outlet, field=field), tmp_path) as link:
        for number in range(40):
            answer = await link.client.execute(Order(Track(), "technician", f"T{number}"))
            latest = link.client.latest()
            assert latest == field.site
            (mine,) = [one for one in answer.trackers if one.tracker_id == f"T{number}"]
            assert mine.actions["track"]
            assert not any(one.actions for one in latest.trackers)


async def test_what_an_order_changed_is_sent_before_its_answer(tmp_path: Path) -> None:
    field = Field(1)
    field.tell(())
    machine = FieldMachine(outlet=field.outlet, field=field)
    server = LinkServer(machine, tmp_path / "machine.sock")
    await server.start()
    reader, writer = await asyncio.open_unix_connection(tmp_path / "machine.sock")
    assert isinstance(decode_telling(await read_body(reader)), Told)
    good_until_s = asyncio.get_running_loop().time() + 10.0
    writer.write(encode_request(Execute(1, Track(), "technician", "T0", None, None, good_until_s)))
    effect = decode_telling(await read_body(reader))
    answer = decode_telling(await read_body(reader))
    assert isinstance(effect, Told)
    assert effect.site.trackers == tuple(field.trackers.values())
    assert isinstance(answer, Done)
    assert answer.tracker is not None
    writer.close()
    await server.close()


async def test_who_is_watched_is_told_to_the_machine_again_after_the_link_was_down(tmp_path: Path) -> None:
    machine = ScriptedMachine()
    machine.outlet.publish(Field(1).site)
    async with linked(machine, tmp_path) as link:
        await link.client.watch(frozenset({"T1"}))
        await link.client.ping()
        await link.server.close()
        await eventually(lambda: link.client.latest() is None)
        link.server = LinkServer(machine, link.path)
        await link.server.start()
        await link.until_up()
        await link.client.ping()
    assert machine.watched == [frozenset({"T1"}), frozenset(), frozenset({"T1"}), frozenset()]
