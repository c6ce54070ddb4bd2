"""A disk that fails under a running process: strace makes its calls fail, and lets go of it again."""

import asyncio
import os
import shutil
import signal
import subprocess
from collections.abc import AsyncIterator, Iterator
from contextlib import asynccontextmanager, contextmanager, suppress
from enum import StrEnum
from pathlib import Path

import pytest


class DiskFault(StrEnum):
    """What the calls of the writing thread suffer, as strace has it."""

    FULL = "pwrite64:error=ENOSPC"
    READ_ONLY = "pwrite64:error=EROFS"
    NO_SYNC = "fdatasync:error=EIO"
    STALLED = "fdatasync:delay_enter=2000000"


SMALL_DISK = "size=96m,mode=0700"
BLOCK = bytes(1 << 20)


@contextmanager
def small_disk(folder: Path) -> Iterator[Path]:
    """Yield a folder that is a disk of 96 MB where one can be mounted, else the folder as it is."""
    mounted = os.geteuid() == 0 and _run("mount", "-t", "tmpfs", "-o", SMALL_DISK, "tmpfs", str(folder))
    try:
        yield folder
    finally:
        if mounted:
            _run("umount", "--lazy", str(folder))


@contextmanager
def filled(disk: Path) -> Iterator[None]:
    """Have a disk full to the last byte while the block runs."""
    filler = disk / "filler"
    try:
        with filler.open("wb", buffering=0) as file, suppress(OSError):
            while file.write(BLOCK):
                pass
        yield
    finally:
        filler.unlink()


def _run(*words: str) -> bool:
    return subprocess.run(words, capture_output=True, check=False).returncode == 0


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
