"""The loop of the drives' tests: only waiting for nothing takes time on it."""

import asyncio
import os
import pty
import threading
from collections.abc import Coroutine

from tests.patient_loop import START, LoopClock, PatientLoop


async def passed_s() -> float:
    return asyncio.get_running_loop().time()


def run(work: Coroutine[object, object, float]) -> float:
    with asyncio.Runner(loop_factory=PatientLoop) as runner:
        return runner.run(work)


def test_an_hour_of_waiting_is_soon_over_and_work_takes_none() -> None:
    async def work() -> float:
        for _ in range(1000):
            await asyncio.sleep(0)
        assert await passed_s() == 0.0
        await asyncio.sleep(3600.0)
        return (LoopClock().now() - START).total_seconds()

    assert run(work()) == 3600.0


def test_what_is_on_its_way_arrives_before_a_time_out() -> None:
    async def work() -> float:
        here, there = pty.openpty()
        heard = asyncio.Event()
        asyncio.get_running_loop().add_reader(there, heard.set)
        async with asyncio.timeout(1e-9):
            os.write(here, b"x\n")
            await heard.wait()
        asyncio.get_running_loop().remove_reader(there)
        os.close(here)
        os.close(there)
        return await passed_s()

    assert run(work()) == 0.0


def test_what_goes_over_a_connection_takes_no_time_and_what_nobody_reads_holds_none_up() -> None:
    async def work() -> float:
        heard, begun = asyncio.Event(), await passed_s()

        async def serve(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
            async with asyncio.timeout(1e-9):
                await reader.readexactly(100_000)
            heard.set()
            writer.write(bytes(50_000_000))

        server = await asyncio.start_server(serve, "127.0.0.1", 0)
        reader, writer = await asyncio.open_connection(*server.sockets[0].getsockname(), limit=1)
        writer.write(bytes(100_000))
        await heard.wait()
        assert await passed_s() == begun
        await asyncio.sleep(60.0)
        assert not reader.at_eof()
        writer.transport.abort()
        server.close()
        return await passed_s()

    assert run(work()) == 60.0


def test_a_thread_is_waited_for_however_long_it_takes() -> None:
    async def work() -> float:
        may = threading.Event()
        asyncio.get_running_loop().call_later(1.0, may.set)
        threading.Timer(0.05, may.set).start()
        async with asyncio.timeout(0.5):
            await asyncio.to_thread(may.wait)
        return await passed_s()

    assert run(work()) == 0.0
