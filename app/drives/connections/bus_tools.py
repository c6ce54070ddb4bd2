"""What can be done with a drive from the command line: scan a bus, record a trace, play it again."""

from collections.abc import AsyncIterator, Callable, Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta

from app.base.clock import Clock, VirtualClock
from app.base.message import N_, join, say, told_by
from app.drives.connections.adapters import drive_on
from app.drives.connections.buses import Buses, wire_of
from app.drives.connections.probe import read_registers
from app.drives.drive import Drive
from app.drives.profile import Profile
from app.modbus.bus import Bus, BusUnit
from app.modbus.errors import DriveError, DriveSilent
from app.modbus.trace import Exchange, RecordingWire, Replay, ReplayWire
from app.modbus.wire import Timing, Wire
from app.tracker.settings.config import DriveConfig, TrackerConfig
from app.tracker.values.motion import Feedback

BEGUN_AT = datetime(2000, 1, 1, tzinfo=UTC)
SCAN_TIMING = Timing(timeout_s=0.15)


@dataclass(frozen=True, slots=True)
class Found:
    """A unit that answers, and what it said to a read of one register."""

    unit: int
    said: str


async def scan(
    drive: DriveConfig, units: Iterable[int], clock: Clock, *, address: int = 0
) -> AsyncIterator[Found]:
    """Yield the units of a bus that answer; an exception is an answer, too. Nothing is written.

    Raises `DriveSilent` if there is no connection to the bus.
    """
    wire = wire_of(drive)
    if not await wire.connect():
        missing = say("There is no connection to {line}.", line=drive.line)
        raise DriveSilent(join(" ", (missing, wire.advice)))
    bus = Bus(drive.line, wire, clock)
    asked: list[BusUnit] = []
    try:
        for number in units:
            unit = bus.unit(number, SCAN_TIMING)
            asked.append(unit)
            said = await _said(unit, address)
            if said is not None:
                yield Found(number, said)
    finally:
        for unit in asked:
            await unit.close()
        wire.close()


async def _said(unit: BusUnit, address: int) -> str | None:
    try:
        words = await unit.read(address, 1, what=say("register {address}", address=address))
    except DriveSilent:
        return None
    except DriveError as error:
        return told_by(error)
    return say("register {address} holds {words}", address=address, words=words[0])


async def record(
    config: TrackerConfig,
    profile: Profile,
    clock: Clock,
    keep: Callable[[Exchange], None],
    length: timedelta,
) -> int:
    """Read every register once and then poll as the controller does, for a time; nothing is written.

    Returns how many readings were good. `keep` gets every exchange as it happens.
    """

    def recording(drive: DriveConfig) -> Wire:
        return RecordingWire(wire_of(drive), clock, keep)

    buses = Buses(clock, recording)
    lent: list[BusUnit] = []

    def unit_of(number: int) -> BusUnit:
        lent.append(buses.unit(config.drive, number, profile.timing))
        return lent[-1]

    drive = drive_on(config, profile, unit_of, clock)
    good, until = 0, clock.now() + length
    try:
        for unit in lent:
            async for _ in read_registers(unit, profile):
                pass
        while clock.now() < until:
            with suppress(DriveError):
                await drive.read()
                good += 1
            await clock.sleep_until(clock.now() + timedelta(milliseconds=profile.poll_ms))
    finally:
        for unit in lent:
            await unit.close()
    return good


@dataclass(frozen=True, slots=True)
class Played:
    """One reading of a replay: when, and what the profile made of it or why it made nothing."""

    at_s: float
    feedback: Feedback | None
    trouble: str = ""


async def replay(config: TrackerConfig, profile: Profile, exchanges: Sequence[Exchange]) -> list[Played]:
    """Return the readings that a profile makes of a trace, on the trace's own time."""
    clock = VirtualClock(BEGUN_AT)

    def moved_to(at_s: float) -> None:
        clock.move_to(max(clock.now(), BEGUN_AT + timedelta(seconds=at_s)))

    answers = Replay(exchanges)
    bus = Bus(N_("the trace"), ReplayWire(answers, moved_to), clock)
    lent: list[BusUnit] = []

    def unit_of(number: int) -> BusUnit:
        lent.append(bus.unit(number, profile.timing))
        return lent[-1]

    drive = drive_on(config, profile, unit_of, clock)
    played: list[Played] = []
    try:
        while (one := await _play_once(drive, answers, clock)) is not None:
            played.append(one)
    finally:
        for unit in lent:
            await unit.close()
    return played


async def _play_once(drive: Drive, answers: Replay, clock: Clock) -> Played | None:
    """Return the next reading, None when the trace has nothing new for it."""
    left, feedback, trouble = answers.remaining, None, ""
    try:
        feedback = await drive.read()
    except DriveError as error:
        trouble = told_by(error)
    if answers.remaining == left:
        return None
    return Played((clock.now() - BEGUN_AT).total_seconds(), feedback, trouble)
