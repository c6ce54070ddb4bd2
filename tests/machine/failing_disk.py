"""A disk that fails under a running process: strace makes its calls fail, and lets go of it again."""

import asyncio
import shutil
import signal
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from enum import StrEnum
from pathlib import Path

import pytest


class DiskFault(StrEnum):
    """What the calls of the writing thread suffer, as strace has it."""

    FULL = "pwrite64:error=ENOSPC"
    READ_ONLY = "pwrite64:error=EROFS"
    NO_SYNC = "fdatasync:error=EIO"
    STALLED = "fdatasync:delay_enter=2000000"


@asynccontextmanager
async def failing(process_id: int, fault: DiskFault, log: Path) -> AsyncIterator[None]:
    """Have the calls of a process fail while the block runs."""
    assert shutil.which("strace"), "Install strace to make calls fail: apt-get install strace."
    call = fault.partition(":")[0]
    tracer = await asyncio.create_subprocess_exec(
        "strace", "-f", "-p", str(process_id), "-o", str(log), "-e", f"trace={call}", "-e", f"inject={fault}",
        stderr=asyncio.subprocess.PIPE,
    )  # fmt: skip
    assert tracer.stderr is not None
    async with asyncio.timeout(10):
        told = (await tracer.stderr.readline()).decode()
    if "attached" not in told:
        await tracer.wait()
        pytest.fail(f"This computer lets no process be traced: {told.strip()}")
    try:
        yield
    finally:
        tracer.send_signal(signal.SIGINT)
        await tracer.communicate()
