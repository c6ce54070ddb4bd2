"""The scheduler: every tick at its instant, deadlines kept whatever is in flight, no drive delays another."""

import asyncio
from collections.abc import AsyncIterator
from dataclasses import dataclass, field
from datetime import datetime, timedelta

import pytest

from app.base.clock import VirtualClock
from app.site.loop.scheduler import GRACE, MOST_ASKED_AT_ONCE, MOST_DUE_AT_ONCE, Scheduler, Slot
from app.tracker.commands.commands import JOG_LEASE, EndJog, Jog
from app.tracker.settings.axes import Axis, JogSpeed
from app.tracker.state.controller_state import HALTED
from app.tracker.state.snapshot import ActivityName, EventKind
from app.tracker.values.motion import HALT, DriveCommand, Feedback, Velocity
from tests.site.plant import SUMMER_NOON, Begun, Plant, make_plant, settle
from tests.site.wrapped_drive import WrappedDrive, wrapped

PERIOD = timedelta(milliseconds=100)
MS = timedelta(milliseconds=1)
BURST = 125


@dataclass
class Ticker:
    """Something that ticks: it notes when, and takes as long as it is told to."""

    clock: VirtualClock
    answers_at_once: bool = True
    takes: timedelta = timedelta(0)
    fails: bool = False
    until: datetime | None = None
    ticks: list[float] = field(default_factory=list)
    scheduled: list[float | None] = field(default_factory=list)
    seen_out: list[float] = field(default_factory=list)
    in_flight: int = 0
    most_in_flight: int = 0

    async def tick(self, scheduled: datetime | None) -> None:
        self.ticks.append(self.at())
        self.scheduled.append(None if scheduled is None else self.at(scheduled))
        self.in_flight += 1
        self.most_in_flight = max(self.in_flight, self.most_in_flight)
        if self.takes:
            await self.clock.sleep_until(self.clock.now() + self.takes)
        self.in_flight -= 1
        if self.until is not None and self.clock.now() >= self.until:
            self.until = None
        if self.fails:
            raise RuntimeError("a programming error")

    def deadline(self) -> datetime | None:
        return self.until

    async def outlasted(self) -> None:
        self.seen_out.append(self.at())

    def at(self, instant: datetime | None = None) -> float:
        """Return an instant in milliseconds since the beginning."""
        return ((instant or self.clock.now()) - SUMMER_NOON) / MS


class EarlyAlarms:
    """A clock whose alarms go off before their time, as those of real systems do by a fraction."""

    def __init__(self, clock: VirtualClock) -> None:
        self._clock = clock

    def now(self) -> datetime:
        return self._clock.now()

    def system_time(self, at: datetime | None = None) -> datetime:
        return self._clock.system_time(at)

    async def sleep_until(self, at: datetime) -> None:
        await self._clock.sleep_until(at - MS)


@dataclass
class Field:
    clock: VirtualClock
    scheduler: Scheduler
    slots: list[Slot] = field(default_factory=list)

    def add(self, one: Ticker) -> Slot:
        self.slots.append(self.scheduler.add(one))
        return self.slots[-1]

    async def forward(self, ms: int) -> None:
        """Let time pass in steps of a millisecond."""
        for _ in range(ms):
            self.clock.advance(MS)
            await settle()


@pytest.fixture
async def field_() -> AsyncIterator[Field]:
    clock = VirtualClock(SUMMER_NOON)
    built = Field(clock, Scheduler(EarlyAlarms(clock), PERIOD))
    built.scheduler.start()
    yield built
    for slot in built.slots:
        await built.scheduler.remove(slot)
    await built.scheduler.close()


async def test_ticks_come_at_their_instants_and_phases_are_spread_evenly(field_: Field) -> None:
    tickers = [Ticker(field_.clock) for _ in range(100)]
    for one in tickers:
        field_.add(one)
    await settle()
    await field_.forward(299)

    first, second, third = tickers[:3]
    assert (first.ticks, first.scheduled) == ([0.0, 100.0, 200.0], [None, 100.0, 200.0])
    assert (second.ticks, second.scheduled) == ([0.0, 60.0, 160.0, 260.0], [None, 60.0, 160.0, 260.0])
    assert (third.ticks, third.scheduled) == ([0.0, 20.0, 120.0, 220.0], [None, 20.0, 120.0, 220.0])
    at_once = [sum(one.ticks[-1] == 200.0 + 5.0 * slot for one in tickers) for slot in range(20)]
    assert sum(at_once) == 100
    assert 4 <= min(at_once) <= max(at_once) <= 6


async def test_a_slow_drive_delays_no_other_and_never_ticks_twice_at_once(field_: Field) -> None:
    slow = Ticker(field_.clock, answers_at_once=False, takes=250 * MS)
    other = Ticker(field_.clock)
    slot = field_.add(slow)
    field_.add(other)
    await settle()
    for _ in range(5):
        field_.scheduler.ask(slot)
        await field_.forward(10)
    await field_.forward(440)

    assert slow.most_in_flight == 1
    assert slow.ticks == [0.0, 250.0]
    assert slow.scheduled == [None, None]
    assert other.ticks == [0.0, 60.0, 160.0, 260.0, 360.0, 460.0]


@pytest.mark.parametrize("at_once", [True, False])
async def test_a_deadline_is_kept_to_the_instant_also_when_it_is_brought_nearer_between_two_ticks(
    field_: Field, at_once: bool
) -> None:
    one = Ticker(field_.clock, answers_at_once=at_once)
    slot = field_.add(one)
    await settle()
    one.until = SUMMER_NOON + 240 * MS
    field_.scheduler.look(slot)
    await field_.forward(20)
    one.until = SUMMER_NOON + 33 * MS
    field_.scheduler.look(slot)
    await field_.forward(100)

    assert (one.ticks, one.scheduled) == ([0.0, 33.0, 100.0], [None, 33.0, 100.0])


async def test_a_deadline_that_is_put_off_does_not_tick(field_: Field) -> None:
    one = Ticker(field_.clock)
    slot = field_.add(one)
    await settle()
    for held_ms in range(0, 60, 10):
        one.until = SUMMER_NOON + (held_ms + 30) * MS
        field_.scheduler.look(slot)
        await field_.forward(10)
    await field_.forward(30)

    assert one.ticks == [0.0, 80.0]


async def test_a_deadline_during_a_tick_in_flight_ticks_again_as_soon_as_that_has_ended(
    field_: Field,
) -> None:
    one = Ticker(field_.clock, answers_at_once=False, takes=6 * MS)
    slot = field_.add(one)
    await settle()
    one.until = SUMMER_NOON + 5 * MS
    field_.scheduler.look(slot)
    one.until, until = None, one.until
    await field_.forward(4)
    one.until = until
    await field_.forward(60)

    assert one.ticks == [0.0, 6.0]
    assert one.seen_out == []


async def test_the_tick_at_a_deadline_is_seen_out_too(field_: Field) -> None:
    one = Ticker(field_.clock, answers_at_once=False)
    slot = field_.add(one)
    await settle()
    one.takes, one.until = 500 * MS, SUMMER_NOON + 40 * MS
    field_.scheduler.look(slot)
    await field_.forward(90)

    assert one.ticks == [0.0, 40.0]
    assert one.seen_out == [pytest.approx(40.0 + GRACE / MS, abs=1.0)]


async def test_a_tick_that_goes_on_beyond_the_deadline_is_seen_out_beside_it(field_: Field) -> None:
    one = Ticker(field_.clock, answers_at_once=False, takes=500 * MS)
    slot = field_.add(one)
    await settle()
    one.until = SUMMER_NOON + 240 * MS
    field_.scheduler.look(slot)
    await field_.forward(400)

    assert one.seen_out == [pytest.approx(240.0 + GRACE / MS, abs=1.0)]


async def test_what_is_asked_for_and_deadlines_come_before_what_is_due(field_: Field) -> None:
    crowd = [Ticker(field_.clock) for _ in range(3 * MOST_DUE_AT_ONCE)]
    order: list[str] = []
    for number, one in enumerate(crowd):
        one.ticks = Noted(order, str(number))
        field_.add(one)
    asked, ending = Ticker(field_.clock), Ticker(field_.clock)
    asked.ticks, ending.ticks = Noted(order, "asked"), Noted(order, "ending")
    slots = [field_.add(one) for one in (asked, ending)]
    await field_.forward(95)
    ending.until = SUMMER_NOON + 150 * MS
    field_.scheduler.look(slots[1])
    order.clear()
    field_.clock.advance(PERIOD)
    field_.scheduler.ask(slots[0])
    await settle()

    assert order[:2] == ["asked", "ending"]
    assert len(order) == len(crowd) + 4


class Noted(list[float]):
    """Notes in one list for all who ticked."""

    def __init__(self, order: list[str], name: str) -> None:
        self._order, self._name = order, name

    def append(self, at: float) -> None:
        self._order.append(self._name)


async def test_a_field_that_is_woken_at_once_lets_what_is_due_begin_in_every_turn(field_: Field) -> None:
    crowd = [Ticker(field_.clock) for _ in range(10 * MOST_ASKED_AT_ONCE)]
    order: list[str] = []
    for one in crowd:
        one.ticks = Noted(order, "asked")
    slots = [field_.add(one) for one in crowd]
    due = Ticker(field_.clock)
    phase = field_.add(due).phase
    await field_.forward(99 + phase // MS)
    due.ticks = Noted(order, "due")
    order.clear()
    for slot in slots:
        field_.scheduler.ask(slot)
    field_.clock.advance(MS)
    await settle()

    assert order.index("due") <= MOST_ASKED_AT_ONCE + MOST_DUE_AT_ONCE
    assert order[:MOST_ASKED_AT_ONCE] == ["asked"] * MOST_ASKED_AT_ONCE


async def test_many_ticks_at_once_let_everything_else_have_its_turn(field_: Field) -> None:
    crowd = [Ticker(field_.clock) for _ in range(10 * MOST_DUE_AT_ONCE)]
    for one in crowd:
        field_.add(one)
    await field_.forward(100)
    before = sum(len(one.ticks) for one in crowd)
    field_.clock.advance(PERIOD)
    turns: list[int] = []
    pressed: list[bool] = []
    for _ in range(16):
        await asyncio.sleep(0)
        turns.append(sum(len(one.ticks) for one in crowd) - before)
        pressed.append(field_.scheduler.pressed)

    assert turns[-1] == len(crowd)
    assert all(now for now, turn in zip(pressed, turns, strict=True) if 0 < turn < len(crowd))
    assert any(pressed)
    assert not pressed[-1], "whoever gives way goes on then"
    steps = [after - earlier for earlier, after in zip([0, *turns], turns, strict=False)]
    assert max(steps) == MOST_DUE_AT_ONCE


@pytest.mark.parametrize("at_once", [True, False])
async def test_a_tick_that_ends_in_an_error_is_the_end_of_it_all(field_: Field, at_once: bool) -> None:
    field_.add(Ticker(field_.clock, answers_at_once=at_once, fails=True))
    assert field_.scheduler.alive
    await settle()

    assert not field_.scheduler.alive


async def test_what_was_removed_ticks_no_more(field_: Field) -> None:
    gone = [Ticker(field_.clock, answers_at_once=at_once, takes=takes) for at_once, takes in LIVES]
    slots = [field_.add(one) for one in gone]
    await settle()
    await field_.forward(65)
    for slot in slots:
        field_.scheduler.ask(slot)
        await field_.scheduler.remove(slot)
    before = [len(one.ticks) for one in gone]
    await field_.forward(300)

    assert [len(one.ticks) for one in gone] == before
    assert field_.scheduler.alive


LIVES = ((True, timedelta(0)), (False, timedelta(milliseconds=500)))


def turning(drive: WrappedDrive) -> bool:
    """Return whether the drive's newest command is a motion."""
    return bool(drive.written) and drive.written[-1].azimuth != HALT


@dataclass
class ReadingDrive(WrappedDrive):
    """A drive whose readings and writes take their time on the plant's clock."""

    clock: VirtualClock | None = None
    reads_in: timedelta = timedelta(0)
    writes_in: timedelta = timedelta(0)
    written_at: list[tuple[datetime, DriveCommand]] = field(default_factory=list)
    stopped_at: list[datetime] = field(default_factory=list)

    async def read(self) -> Feedback:
        await self._wait(self.reads_in)
        return await super().read()

    async def write(self, command: DriveCommand) -> None:
        await self._wait(self.writes_in)
        await super().write(command)
        assert self.clock is not None
        self.written_at.append((self.clock.now(), command))

    async def stop(self) -> None:
        assert self.clock is not None
        self.stopped_at.append(self.clock.now())
        await super().stop()

    async def _wait(self, takes: timedelta) -> None:
        assert self.clock is not None
        await self.clock.sleep_until(self.clock.now() + takes)


@pytest.fixture
async def held() -> AsyncIterator[tuple[Plant, ReadingDrive]]:
    """Return a tracker whose key has just been pressed, and its drive."""
    plant = make_plant(wrap=ReadingDrive)
    drive = plant.drives["T1"]
    assert isinstance(drive, ReadingDrive)
    drive.clock = plant.clock
    await plant.start()
    await plant.ask(press(0))
    await settle()
    assert turning(drive)
    yield plant, drive
    drive.reads_in = drive.writes_in = timedelta(0)
    await finely(plant, 300)
    await plant.close()


def press(sequence: int, lease: timedelta = JOG_LEASE) -> Jog:
    return Jog("p", Axis.AZIMUTH, 1, JogSpeed.SLOW, sequence, lease)


async def finely(plant: Plant, ms: int) -> None:
    end = plant.clock.now() + ms * MS
    while plant.clock.now() < end:
        plant.clock.move_to(min(end, plant.clock.next_wake or end))
        await settle()


def halted_ms(plant: Plant, drive: ReadingDrive, since: datetime) -> float:
    """Return after how long the azimuth was first told to stand still."""
    return next((at - since) / MS for at, told in drive.written_at if at >= since and told.azimuth == HALT)


@pytest.mark.parametrize(("reads_ms", "after_ms"), [(0, 95), (3, 99), (13, 0), (13, 37)])
async def test_a_jog_is_told_to_stop_at_the_end_of_its_lease_whatever_is_in_flight(
    held: tuple[Plant, ReadingDrive], reads_ms: int, after_ms: int
) -> None:
    plant, drive = held
    drive.reads_in = drive.writes_in = reads_ms * MS
    await finely(plant, after_ms)
    drive.written_at.clear()
    await plant.ask(press(1))
    last = plant.clock.now()
    await finely(plant, 400)

    longest_ms = JOG_LEASE / MS + 4 * reads_ms
    assert JOG_LEASE / MS <= halted_ms(plant, drive, last) <= longest_ms
    assert [one.data["outcome"] for one in plant.happened(EventKind.JOG_ENDED)] == ["expired"]


async def test_a_lease_that_a_late_heartbeat_shortens_to_less_than_a_tick_ends_at_its_instant(
    held: tuple[Plant, ReadingDrive],
) -> None:
    plant, drive = held
    await finely(plant, 10)
    await plant.ask(press(1, lease=30 * MS))
    last = plant.clock.now()
    await finely(plant, 200)

    assert halted_ms(plant, drive, last) == 30.0


async def test_a_renewal_while_the_tick_is_in_flight_keeps_the_axis_turning(
    held: tuple[Plant, ReadingDrive],
) -> None:
    plant, drive = held
    drive.reads_in = 20 * MS
    for sequence in range(1, 12):
        await finely(plant, 50)
        await plant.ask(press(sequence))
    begun = plant.clock.now() - 450 * MS

    assert not plant.happened(EventKind.JOG_ENDED)
    told = [one.azimuth for at, one in drive.written_at if at >= begun]
    assert told
    assert all(isinstance(one, Velocity) for one in told)
    assert not drive.stopped_at


async def test_the_ends_of_presses_that_are_over_neither_tick_nor_tell(plant: Plant) -> None:
    """A page that held a hundred presses told the end of each: the whole site was published for every one."""
    await plant.forward(seconds=1)
    told, ticks = plant.site.latest(), plant.site.model.tracker("T1").counter.ticks
    for number in range(BURST):
        answer = await plant.ask(EndJog(f"over-{number}"))
        assert answer is told
    assert plant.site.latest() is told
    assert plant.site.model.tracker("T1").counter.ticks == ticks


async def test_the_end_of_the_press_that_is_held_ticks_and_tells_at_once(plant: Plant) -> None:
    await plant.ask(Jog("p1", Axis.AZIMUTH, 1))
    await plant.forward(seconds=0.05)
    await plant.ask(EndJog("p1"))
    await plant.forward(seconds=0.001)
    assert plant.tracker().activity is not ActivityName.JOGGING
    assert len(plant.happened(EventKind.JOG_ENDED)) == 1


@pytest.mark.parametrize("hangs_from_ms", [150, 205], ids=["read before the end", "read at the end"])
async def test_a_drive_that_hangs_is_told_to_stop_at_the_lease_s_end(
    hangs_from_ms: int, begun: Begun
) -> None:
    """The read of a tick may take as long as the drive does not answer; the stop goes beside it."""
    plant = await begun(wrap=WrappedDrive)
    await plant.forward(seconds=1)
    begun = plant.clock.now()
    await plant.ask(Jog("p1", Axis.AZIMUTH, 1))
    await plant.forward(seconds=hangs_from_ms / 1000.0)
    drive = wrapped(plant, "T1")
    drive.hangs = True
    plant.clock.move_to(begun + JOG_LEASE - MS)
    await settle()
    assert drive.stops == 0
    plant.clock.move_to(begun + JOG_LEASE + 10 * MS)
    await settle()
    assert drive.stops == 1
    drive.hangs = False


async def test_a_jog_that_goes_on_is_not_stopped_for_a_drive_that_is_slow(begun: Begun) -> None:
    plant = await begun(wrap=WrappedDrive)
    await plant.forward(seconds=1)
    await plant.ask(Jog("p1", Axis.AZIMUTH, 1))
    await plant.forward(seconds=0.15)
    drive = wrapped(plant, "T1")
    drive.hangs = True
    for sequence in range(1, 10):
        await plant.ask(Jog("p1", Axis.AZIMUTH, 1, sequence=sequence))
        await plant.forward(seconds=0.05)
    assert drive.stops == 0
    drive.hangs = False


async def test_a_lease_ends_at_its_instant_between_two_ticks(begun: Begun) -> None:
    """Whatever the phase of the press, the command to rest is written at the end of its lease."""
    plant = await begun(wrap=WrappedDrive)
    drive = wrapped(plant, "T1")
    for number in range(0, 200, 13):
        await plant.forward(seconds=0.3 + 0.0013 * number)
        begun = plant.clock.now()
        await plant.ask(Jog(f"p{number}", Axis.AZIMUTH, 1 - number % 2 * 2))
        plant.clock.move_to(begun + JOG_LEASE - MS)
        await settle()
        assert plant.tracker().activity is ActivityName.JOGGING
        plant.clock.move_to(begun + JOG_LEASE)
        await settle()
        assert plant.tracker().activity is not ActivityName.JOGGING
        assert drive.written[-1] == HALTED
