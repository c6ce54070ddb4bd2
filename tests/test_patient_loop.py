"""The loop of the drives' tests: only waiting for nothing takes time on it."""

import asyncio
import os
import pty
import threading
from collections.abc import Coroutine

from tests.patient_loop import PatientLoop


async def passed_s() -> float:
    return asyncio.get_running_loop().time()


def run(work: Coroutine[object, object, float]) -> float:
    with asyncio.Runner(loop_factory=PatientLoop) as runner:
        return runner.run(work)


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


def test_a_thread_is_waited_for_however_long_it_takes() -> None:
    async def work() -> float:
        may = threading.Event()
        asyncio.get_running_loop().call_later(1.0, may.set)
        threading.Timer(0.05, may.set).start()
        async with asyncio.timeout(0.5):
            await asyncio.to_thread(may.wait)
        return await passed_s()

    assert run(work()) == 0.0
