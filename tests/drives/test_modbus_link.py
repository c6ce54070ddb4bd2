"""The Modbus master against a device that misbehaves in every way that was seen or can be thought of."""

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from datetime import timedelta

import pytest

from app.base.clock import VirtualClock
from app.modbus.bus import MOST_WAITING, Bus, BusUnit, Priority
from app.modbus.errors import DriveError, DriveRefused, DriveSilent
from app.modbus.tcp import TcpWire
from app.modbus.wire import Timing
from tests.drives.rigs import START, pending_tasks
from tests.drives.scripted_server import (
    Answer,
    ScriptedServer,
    changed,
    cut,
    exception,
    good,
    right,
    scripted,
    silent,
)
from tests.fault_result import VIRTUAL, FaultResult

TIMEOUT_S = 0.6
RIGHT = [30, 33, 36, 39]


def linked_to(port: int, clock: VirtualClock) -> BusUnit:
    return Bus("bench", TcpWire("127.0.0.1", port), clock).unit(1, Timing(TIMEOUT_S))


@asynccontextmanager
async def linked(*script: Answer) -> AsyncIterator[tuple[BusUnit, ScriptedServer, VirtualClock]]:
    clock = VirtualClock(START)
    async with scripted(*script) as server:
        link = linked_to(server.port, clock)
        try:
            yield link, server, clock
        finally:
            await link.close()
    assert not pending_tasks(), "a closed link leaves no task behind"


async def read(link: BusUnit) -> list[int]:
    return await link.read(10, 4, what="four registers")


BAD_REPLIES: dict[str, Answer] = {
    "transaction of another request": changed(1, 99),
    "another protocol": changed(3, 1),
    "another unit": changed(6, 7),
    "another function code": changed(7, 4),
    "length field too large": changed(5, 200),
    "byte count too small": changed(8, 6),
    "fewer registers, consistently": lambda request: [
        right(request)[:4] + b"\x00\x09" + right(request)[6:8] + b"\x06" + right(request)[9:15]
    ],
    "bytes behind the reply": lambda request: [right(request) + b"\x00"],
    "an exception of another function": lambda request: [request[:4] + b"\x00\x03\x01\x86\x02"],
    "text": lambda request: [b"HTTP/1.1 400 Bad Request\r\n\r\n"],
    "the line is cut": cut,
    "the line is cut in the middle": lambda request: [right(request)[:12], None],
}


@pytest.mark.parametrize("name", BAD_REPLIES)
@pytest.mark.fault(6)
async def test_a_bad_reply_is_never_believed_and_the_next_read_is_right(
    name: str, fault: FaultResult
) -> None:
    async with linked(BAD_REPLIES[name], BAD_REPLIES[name], good) as (link, server, _):
        began = asyncio.get_running_loop().time()
        with pytest.raises(DriveError) as caught:
            await read(link)
        fault.noticed(asyncio.get_running_loop().time() - began, VIRTUAL)
        fault.shows(str(caught.value))
        assert await read(link) == RIGHT
        assert server.connections >= 2, "a bad reply costs the connection"
        fault.recovers("automatic: with the next good reply, over a new connection")


async def test_a_reply_in_many_pieces_is_put_together() -> None:
    def dribble(request: bytes) -> list[bytes | None]:
        return [bytes((byte,)) for byte in right(request)]

    async with linked(dribble) as (link, server, _):
        assert await read(link) == RIGHT
        assert server.connections == 1


async def test_a_connection_lost_at_rest_is_renewed_by_the_next_read() -> None:
    async with linked(lambda request: [right(request)]) as (link, server, _):
        await read(link)
        port = server.port
        await server.close()
        await asyncio.sleep(0.02)
        await server.start(port)
        assert await read(link) == RIGHT


@pytest.mark.parametrize("name", ["another unit", "the line is cut"])
async def test_a_read_survives_one_bad_reply(name: str) -> None:
    async with linked(BAD_REPLIES[name], good) as (link, server, _):
        assert await read(link) == RIGHT
        assert len(server.requests) == 2


@pytest.mark.fault(2)
async def test_silence_is_noticed_within_the_time_out_and_costs_the_connection(fault: FaultResult) -> None:
    async with linked(silent, good) as (link, server, _):
        began = asyncio.get_running_loop().time()
        with pytest.raises(DriveSilent, match="did not answer within") as caught:
            await read(link)
        took_s = asyncio.get_running_loop().time() - began
        assert took_s == pytest.approx(TIMEOUT_S, abs=0.01)
        fault.noticed(took_s, VIRTUAL)
        fault.shows(str(caught.value))
        assert len(server.requests) == 1, "a silent device is not asked twice in one call"
        assert await read(link) == RIGHT
        assert server.connections == 2
        fault.recovers("automatic: with the next good reply, over a new connection")


@pytest.mark.fault(5)
async def test_a_late_reply_is_not_taken_for_the_next_one(fault: FaultResult) -> None:
    late: list[bytes] = []

    def keep(request: bytes) -> list[bytes | None]:
        late.append(right(request))
        return []

    def both(request: bytes) -> list[bytes | None]:
        return [late[0], right(request)]

    async with linked(keep, both, both, good) as (link, _, _):
        began = asyncio.get_running_loop().time()
        with pytest.raises(DriveSilent) as caught:
            await link.read(10, 4, what="one")
        fault.noticed(asyncio.get_running_loop().time() - began, VIRTUAL)
        fault.shows(str(caught.value))
        found = []
        for _ in range(2):
            try:
                found.append(await link.read(20, 4, what="another"))
            except DriveError:
                continue
        assert all(words == [60, 63, 66, 69] for words in found)
        assert found, "the link works again"
        fault.recovers("automatic: the late reply is thrown away with its connection")


WRONG_ECHOES: dict[str, tuple[list[int], Answer]] = {
    "one register, another address": ([5], changed(9, 99)),
    "one register, another value": ([5], changed(11, 99)),
    "several, another address": ([5, 6], changed(9, 99)),
    "several, another count": ([5, 6], changed(11, 1)),
    "several answered as one": ([5, 6], changed(7, 6)),
    "no reply": ([5, 6], silent),
    "the line is cut": ([5], cut),
}
REPLIED = tuple(WRONG_ECHOES)[:5]


@pytest.mark.parametrize("name", WRONG_ECHOES)
async def test_a_write_whose_echo_is_wrong_fails_and_is_not_sent_again(name: str) -> None:
    words, answer = WRONG_ECHOES[name]
    async with linked(answer, good) as (link, server, _):
        with pytest.raises(DriveError, match="is not repeated" if name in REPLIED else None):
            await link.write(10, words, what="a set-point", ticket=None)
        assert len(server.requests) == 1


@pytest.mark.parametrize("code", [1, 3])
async def test_what_a_device_does_not_know_is_refused_for_good(code: int) -> None:
    async with linked(exception(code)) as (link, server, _):
        with pytest.raises(DriveRefused, match=rf"exception {code}.*four registers.*profile"):
            await read(link)
        assert (server.connections, len(server.requests)) == (1, 1)


async def test_a_gateway_without_its_device_is_silence() -> None:
    async with linked(exception(10), exception(11)) as (link, _, _):
        for _ in range(2):
            with pytest.raises(DriveSilent, match="gateway"):
                await read(link)


@pytest.mark.parametrize("code", [4, 6])
@pytest.mark.fault(10)
async def test_a_busy_device_is_asked_again_later(code: int, fault: FaultResult) -> None:
    async with linked(exception(code), good) as (link, server, _):
        began = asyncio.get_running_loop().time()
        with pytest.raises(DriveError, match="The request is repeated in the next cycle") as caught:
            await read(link)
        fault.noticed(asyncio.get_running_loop().time() - began, VIRTUAL)
        fault.shows(str(caught.value))
        assert not isinstance(caught.value, DriveRefused | DriveSilent)
        assert await read(link) == RIGHT
        assert server.connections == 1, "an exception reply is a good reply"
        fault.recovers("automatic: it is asked again")


async def test_a_first_connection_that_fails_is_tried_again_with_growing_delay() -> None:
    server = ScriptedServer(good)
    await server.start()
    port = server.port
    await server.close()
    clock = VirtualClock(START)
    link = linked_to(port, clock)
    for _ in range(6):
        with pytest.raises(DriveSilent, match="no connection"):
            await read(link)
        clock.advance(timedelta(seconds=1))
    with pytest.raises(DriveSilent):
        await read(link)
    await server.start(port)
    with pytest.raises(DriveSilent):
        await read(link)
    clock.advance(timedelta(seconds=1))
    assert await read(link) == RIGHT, "one second is the longest delay"
    await link.close()
    await server.close()


async def test_a_stop_overtakes_fifty_polls() -> None:
    async with linked(good) as (link, server, _):
        await read(link)
        polls = [asyncio.create_task(read(link)) for _ in range(50)]
        await asyncio.sleep(0)
        await link.stop(33, [1], what="stop")
        functions = [request[7] for request in server.requests]
        assert functions.index(6) <= 2, "at most the one in flight went before"
        await asyncio.gather(*polls)


async def test_a_stop_is_sent_even_if_its_caller_gives_up() -> None:
    async with linked(silent, good) as (link, server, _):
        poll = asyncio.create_task(read(link))
        await asyncio.sleep(0.02)
        for _ in range(3):
            stop = asyncio.create_task(link.stop(33, [1], what="stop"))
            await asyncio.sleep(0)
            stop.cancel()
            with pytest.raises(asyncio.CancelledError):
                await stop
        with pytest.raises(DriveSilent):
            await poll
        assert await read(link) == RIGHT
        assert [request[9] for request in server.requests if request[7] == 6] == [33], "one stands for all"


async def test_the_urgent_go_first() -> None:
    async with linked(good) as (link, server, _):
        await read(link)
        waiting: list[asyncio.Task[object]] = [asyncio.create_task(read(link))]
        for place, priority in enumerate((Priority.POLL, Priority.COMMAND, Priority.JOG)):
            write = link.write(100 + place, [1], what="a word", ticket=None, priority=priority)
            waiting.append(asyncio.create_task(write))
        await asyncio.gather(*waiting)
        order = [request[9] for request in server.requests if request[7] == 6]
        assert order == [102, 101, 100]


async def test_a_stop_drops_the_writes_that_wait() -> None:
    async with linked(good) as (link, server, _):
        await read(link)
        ticket = link.ticket
        poll = asyncio.create_task(read(link))
        await asyncio.sleep(0)
        move = asyncio.create_task(link.write(100, [1], what="a move", ticket=ticket))
        await asyncio.sleep(0)
        await link.stop(33, [1], what="stop")
        with pytest.raises(DriveError, match="stop had priority"):
            await move
        await poll
        assert [request[9] for request in server.requests if request[7] == 6] == [33]


async def test_a_write_from_before_a_stop_or_a_new_connection_is_not_sent() -> None:
    async with linked(good, good, cut, good) as (link, server, _):
        await read(link)
        ticket = link.ticket
        await link.stop(33, [1], what="stop")
        with pytest.raises(DriveError, match="read first"):
            await link.write(100, [1], what="a move", ticket=ticket)
        ticket = link.ticket
        await read(link)
        assert server.connections == 2
        with pytest.raises(DriveError, match="read first"):
            await link.write(100, [1], what="a move", ticket=ticket)
        assert [request[9] for request in server.requests if request[7] == 6] == [33]


async def test_the_queue_has_a_bound() -> None:
    async with linked(good) as (link, _, _):
        await read(link)
        polls = [asyncio.create_task(read(link)) for _ in range(MOST_WAITING + 20)]
        outcomes = await asyncio.gather(*polls, return_exceptions=True)
        assert sum(isinstance(outcome, DriveSilent) for outcome in outcomes) >= 15


async def test_closing_tells_who_waits() -> None:
    async with linked(silent) as (link, _, _):
        waiting = [asyncio.create_task(read(link)) for _ in range(3)]
        await asyncio.sleep(0.02)
        await link.close()
        outcomes = await asyncio.gather(*waiting, return_exceptions=True)
        assert all(isinstance(outcome, DriveSilent) for outcome in outcomes)
        with pytest.raises(DriveSilent, match="closed"):
            await read(link)


async def test_an_error_that_nobody_foresaw_ends_one_request_and_not_the_link() -> None:
    async with linked(good) as (link, server, _):
        with pytest.raises(DriveError, match="unexpected"):
            await asyncio.wait_for(link.write(100, [70_000], what="what fits no register", ticket=None), 1.0)
        await asyncio.wait_for(link.stop(33, [1], what="stop"), 1.0)
        assert [request[9] for request in server.requests if request[7] == 6] == [33]
