"""What goes to a device: where, which words, under which ticket, how urgent, and what it is called."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from datetime import datetime, timedelta, timezone
from typing import Any

import pytest

from app.base.clock import VirtualClock
from app.drives.dialects.plc import PlcDrive
from app.drives.profile import load_profile
from app.drives.unit import Unit
from app.modbus.bus import Priority
from app.modbus.errors import DriveError, DriveRefused
from app.modbus.line_turn import LineTurn
from app.tracker.values.motion import HALT, DriveCommand, Position, Velocity
from tests.drives.rigs import CONFIG, START

CIA402, PR, DIRECT, PLC = map(load_profile, ("kinco-cia402", "leadshine-rs", "oriental-az", "simulated-plc"))
TICKET = 7


@dataclass
class NotingLink:
    """A device that holds what it was told, and notes how everything was asked."""

    held: dict[int, int] = field(default_factory=dict)
    reads: list[tuple[Any, ...]] = field(default_factory=list)
    writes: list[tuple[Any, ...]] = field(default_factory=list)
    stops: list[tuple[Any, ...]] = field(default_factory=list)
    refuses: set[int] = field(default_factory=set)
    fails: set[int] = field(default_factory=set)
    is_deaf: bool = False
    ticket: int = TICKET
    line_turn: LineTurn = field(default=LineTurn(1, 0.0, 0.0))

    async def read(
        self, address: int, count: int, *, what: str, priority: Priority = Priority.POLL
    ) -> list[int]:
        self.reads.append((address, count, what, priority))
        if address in self.refuses:
            raise DriveRefused("There is no such register.")
        return [self.held.get(place, 0) for place in range(address, address + count)]

    async def write(
        self,
        address: int,
        words: Sequence[int],
        *,
        what: str,
        ticket: int | None,
        priority: Priority = Priority.COMMAND,
    ) -> None:
        self.writes.append((address, list(words), what, ticket, priority))
        if address in self.fails:
            raise DriveError("No reply.")
        if not self.is_deaf:
            self.held |= dict(enumerate(words, address))

    async def stop(self, address: int, words: Sequence[int], *, what: str) -> None:
        self.stops.append((address, list(words), what))
        self.held |= dict(enumerate(words, address))

    async def close(self) -> None:
        return

    def __str__(self) -> str:
        return "the bench"


def unit_of(profile: Any = CIA402) -> tuple[Unit, NotingLink]:
    link = NotingLink()
    return Unit(profile, link, "the bench"), link


async def test_a_reading_says_what_of_which_profile_is_read() -> None:
    unit, link = unit_of()
    link.held = {14080: 2, 14081: 1}
    assert await unit.poll("statusword", "position") == {"statusword": 0.0, "position": 65538.0}
    assert link.reads == [
        (12800, 2, "statusword of profile kinco-cia402", Priority.POLL),
        (14080, 2, "position of profile kinco-cia402", Priority.POLL),
    ]


async def test_what_is_refused_hides_nothing_that_is_read_after_it() -> None:
    unit, link = unit_of()
    link.refuses = {15104, 27904}
    assert set(await unit.poll("velocity", "position", "inputs")) == {"position"}
    assert not unit.has("velocity")
    assert not unit.has("inputs")
    assert unit.has("position")


async def test_a_command_is_told_where_it_goes_under_the_ticket_of_the_last_look() -> None:
    unit, link = unit_of()
    unit.priority = Priority.JOG
    await unit.look("position")
    await unit.put({"target_position": 65538.0, "mode": 1.0})
    assert link.writes == [
        (13568, [1], "mode (13568) of profile kinco-cia402", TICKET, Priority.JOG),
        (16384, [2, 1], "target_position (16384) of profile kinco-cia402", TICKET, Priority.JOG),
    ]


async def test_before_a_look_there_is_no_ticket_and_a_command_is_no_jog() -> None:
    unit, link = unit_of()
    assert not unit.was_read
    await unit.put({"mode": 1.0})
    assert link.writes == [(13568, [1], "mode (13568) of profile kinco-cia402", None, Priority.COMMAND)]


async def test_only_what_changed_is_written_again_and_what_was_written_first_is_remembered() -> None:
    unit, link = unit_of()
    await unit.put({"mode": 1.0})
    await unit.put({"controlword": 6.0})
    await unit.put({"mode": 1.0, "controlword": 7.0})
    assert [(address, words) for address, words, *_ in link.writes] == [
        (13568, [1]), (12544, [6]), (12544, [7]),
    ]  # fmt: skip
    await unit.put({"mode": 1.0}, renewed=True)
    assert link.writes[-1][:2] == (13568, [1])


async def test_what_failed_to_be_written_is_written_again() -> None:
    unit, link = unit_of()
    await unit.put({"mode": 1.0})
    link.fails = {13568}
    with pytest.raises(DriveError):
        await unit.put({"mode": 3.0})
    link.fails = set()
    await unit.put({"mode": 1.0})
    assert [words for _, words, *_ in link.writes] == [[1], [3], [1]]


async def test_what_is_to_be_confirmed_is_read_once_and_named_if_it_was_not_taken() -> None:
    unit, link = unit_of()
    await unit.confirm()
    assert link.reads == []
    link.is_deaf = True
    await unit.put({"mode": 1.0}, confirmed=True)
    unit.expect({"controlword": 0.0, "no such register": 1.0})
    with pytest.raises(DriveError) as error:
        await unit.confirm()
    assert "at the bench" in str(error.value)
    assert "(mode (13568))" in str(error.value)
    await unit.confirm()
    assert len(link.reads) == 2


async def test_a_sequence_is_written_step_by_step_though_nothing_changed() -> None:
    unit, link = unit_of(DIRECT)
    for _ in range(2):
        await unit.play("set_home")
    address = DIRECT.registers["preset"].address
    assert [(at, words[-1]) for at, words, *_ in link.writes] == [(address, 1), (address, 0)] * 2
    unit, link = unit_of(PR)
    for _ in range(2):
        await unit.play("enable")
    assert len(link.writes) == 2


async def test_a_stop_says_what_stops() -> None:
    unit, link = unit_of()
    await unit.stop({"controlword": 2.0, "target_velocity": 65538 * 0.06103515625})
    assert link.stops == [
        (12544, [2], "stop, controlword (12544) of profile kinco-cia402"),
        (28416, [2, 1], "stop, target_velocity (28416) of profile kinco-cia402"),
    ]


def plc() -> tuple[PlcDrive, NotingLink]:
    link = NotingLink({0: 18512, 1: 1, 17: 500})
    return PlcDrive(CONFIG, PLC, VirtualClock(START), link), link  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("command", "priority"),
    [
        (DriveCommand(HALT, HALT), Priority.JOG),
        (DriveCommand(Velocity(0.5), HALT), Priority.JOG),
        (DriveCommand(HALT, Velocity(0.5)), Priority.JOG),
        (DriveCommand(Velocity(0.5), Velocity(0.0)), Priority.JOG),
        (DriveCommand(Position(10.0, 1.0), HALT), Priority.COMMAND),
        (DriveCommand(HALT, Position(10.0, 1.0)), Priority.COMMAND),
        (DriveCommand(Position(10.0, 1.0), Position(10.0, 1.0)), Priority.COMMAND),
    ],
)
async def test_a_hand_and_a_halt_go_before_every_other_command(
    command: DriveCommand, priority: Priority
) -> None:
    drive, link = plc()
    await drive.read()
    await drive.write(command)
    assert link.writes
    for address, _, what, ticket, urgency in link.writes:
        assert what == f"the command registers from {PLC.at(address)}"
        assert (ticket, urgency) == (TICKET, priority)


async def test_readings_go_first_only_while_an_axis_is_turned_by_hand() -> None:
    drive, link = plc()
    for command in (DriveCommand(Velocity(0.5), HALT), DriveCommand(Position(1.0, 1.0), HALT)):
        await drive.read()
        link.held |= {2: link.held.get(2, 0) + 1}
        await drive.write(command)
    await drive.read()
    what = "block status of profile simulated-plc"
    assert link.reads == [(0, 40, what, one) for one in (Priority.POLL, Priority.JOG, Priority.POLL)]


async def test_a_stop_and_the_clock_are_called_what_they_are() -> None:
    drive, link = plc()
    await drive.stop()
    assert link.stops == [(33, [1], "stop, stop (33)")]
    east = timezone(timedelta(hours=3))
    await drive.set_clock(datetime(2026, 6, 21, 2, 5, 7, tzinfo=east))
    assert link.writes == [(50, [2026, 6, 20, 23, 5, 7], "the clock", None, Priority.COMMAND)]


async def test_what_was_not_taken_is_named_by_its_register() -> None:
    drive, link = plc()
    await drive.read()
    await drive.write(DriveCommand(Velocity(0.5), HALT))
    link.held[2] = 1
    link.held[24] = 9
    with pytest.raises(DriveError, match="azimuth_speed") as error:
        await drive.read()
    assert "Another master commands the drive at the bench" in str(error.value)
    assert PLC.at(24) in str(error.value)


async def test_the_keep_alive_value_stands_for_all_that_went_before_it() -> None:
    drive, link = plc()
    await drive.read()
    await drive.write(DriveCommand(Position(1.0, 1.0), HALT, horn=True))
    assert [address for address, *_ in link.writes] == [20, 38]
    link.writes.clear()
    link.held[2] = 1
    await drive.read()
    await drive.write(DriveCommand(Position(2.0, 1.0), HALT))
    assert [address for address, *_ in link.writes] == [38, 20]
