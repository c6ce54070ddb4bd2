"""Many devices on one bus: a silent line fails all at once, is asked by one at a time, and loses no stop."""

import asyncio
from collections.abc import AsyncIterator

import pytest

from app.base.clock import VirtualClock
from app.modbus.bus import MOST_WAITING, Bus, BusUnit
from app.modbus.errors import DriveSilent
from app.modbus.wire import Ask, Timing, Unanswered
from tests.site.plant import SUMMER_NOON

DEVICES = 8


class HeldWire:
    """A line on which every request waits until the test answers it or lets it be unanswered."""

    connected, advice = True, ""

    def __init__(self) -> None:
        self.asked: list[Ask] = []
        self._reply: asyncio.Future[list[int]] | None = None

    def epoch(self, unit: int) -> int:
        return 0

    async def connect(self) -> bool:
        return True

    async def exchange(self, ask: Ask, timing: Timing, *, urgent: bool) -> list[int]:
        self.asked.append(ask)
        self._reply = asyncio.get_running_loop().create_future()
        return await self._reply

    async def reply(self, *, silent: bool = False) -> None:
        assert self._reply is not None
        if silent:
            self._reply.set_exception(Unanswered())
        else:
            self._reply.set_result([0] * self.asked[-1].count)
        await settle()

    def hurry(self) -> None:
        """Nothing hurries here."""

    def close(self) -> None:
        """Nothing is open."""


Line = tuple[HeldWire, list[BusUnit]]


async def settle() -> None:
    for _ in range(10):
        await asyncio.sleep(0)


def reading(unit: BusUnit) -> "asyncio.Task[list[int]]":
    return asyncio.create_task(unit.read(0, 40, what="status"))


@pytest.fixture
async def line() -> AsyncIterator[Line]:
    """Return a line all of whose devices have answered once."""
    wire = HeldWire()
    bus = Bus("line", wire, VirtualClock(SUMMER_NOON))
    units = [bus.unit(number, Timing()) for number in range(1, DEVICES + 1)]
    for unit in units:
        asked = reading(unit)
        await settle()
        await wire.reply()
        await asked
    wire.asked.clear()
    yield wire, units
    for unit in units:
        await unit.close()


async def test_when_two_devices_were_silent_in_a_row_all_that_wait_are_told_at_once(line: Line) -> None:
    wire, units = line
    waiting = [reading(unit) for unit in units]
    await settle()
    await wire.reply(silent=True)
    assert [task.done() for task in waiting] == [True] + [False] * 7
    await wire.reply(silent=True)
    assert all(task.done() for task in waiting)
    with pytest.raises(DriveSilent, match="does not answer; the request is repeated shortly"):
        await waiting[-1]
    assert [ask.unit for ask in wire.asked] == [1, 2]
    await asyncio.gather(*waiting, return_exceptions=True)


async def test_a_silent_line_is_asked_by_one_at_a_time_and_by_all_once_anybody_answers(line: Line) -> None:
    wire, units = line
    waiting = [reading(unit) for unit in units]
    await settle()
    for _ in range(2):
        await wire.reply(silent=True)
    await asyncio.gather(*waiting, return_exceptions=True)
    probing, other = reading(units[0]), reading(units[5])
    await settle()
    assert other.done()
    assert isinstance(other.exception(), DriveSilent)
    await wire.reply()
    assert await probing == [0] * 40
    again = [reading(unit) for unit in units]
    await settle()
    for _ in units:
        await wire.reply()
    assert await asyncio.gather(*again) == [[0] * 40] * DEVICES


async def test_a_stop_that_nobody_waits_for_is_sent_although_another_device_is_stopped(line: Line) -> None:
    wire, units = line
    blocking = reading(units[0])
    await settle()
    abandoned = asyncio.create_task(units[1].stop(33, [1], what="stop"))
    await settle()
    abandoned.cancel()
    stopping = asyncio.create_task(units[2].stop(33, [1], what="stop"))
    await settle()
    for _ in range(3):
        await wire.reply()
    await asyncio.gather(blocking, stopping)
    assert [ask.unit for ask in wire.asked] == [1, 2, 3]


async def test_requests_that_nobody_waits_for_take_up_no_room(line: Line) -> None:
    wire, units = line
    blocking = reading(units[0])
    await settle()
    for _ in range(3 * MOST_WAITING):
        given_up = reading(units[1])
        await asyncio.sleep(0)
        given_up.cancel()
        await asyncio.gather(given_up, return_exceptions=True)
    asked = reading(units[1])
    await settle()
    for _ in range(2):
        await wire.reply()
    assert await asked == [0] * 40
    await blocking
