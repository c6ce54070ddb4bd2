"""Other people's programs beside ours: started, waited for, ended; a missing one says how to get it."""

import asyncio
import json
import shutil
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

from tests.patience import PATIENCE_S, eventually

HERE = Path(__file__).parent
NODE_MODULES = HERE.parents[1] / "build" / "modbus-serial" / "node_modules"


def program(name: str) -> str:
    """Return where a program lies, or fail with what to do."""
    found = shutil.which(name)
    assert found, f"The tests need {name}. Install it with: make system-packages"
    return found


async def output(*words: str) -> tuple[int, str]:
    """Run a program and return its exit code and what it said."""
    process = await asyncio.create_subprocess_exec(
        *words, stdout=asyncio.subprocess.PIPE, stderr=asyncio.subprocess.STDOUT
    )
    async with asyncio.timeout(PATIENCE_S):
        said, _ = await process.communicate()
    return process.returncode or 0, said.decode()


@asynccontextmanager
async def running(*words: str, ready: str = "") -> AsyncIterator[None]:
    """Run a program until the block ends; it is ready when it says so."""
    process = await asyncio.create_subprocess_exec(
        *words, stdout=asyncio.subprocess.PIPE, stderr=asyncio.subprocess.DEVNULL
    )
    assert process.stdout is not None
    try:
        if ready:
            async with asyncio.timeout(PATIENCE_S):
                assert (await process.stdout.readline()).decode().strip() == ready
        yield
    finally:
        if process.returncode is None:
            process.kill()
        await process.wait()


@asynccontextmanager
async def cable(folder: Path) -> AsyncIterator[tuple[str, str]]:
    """Two serial devices that are connected to each other."""
    ends = folder / "one-end", folder / "other-end"
    words = [f"pty,raw,echo=0,link={end}" for end in ends]
    async with running(program("socat"), *words):
        await eventually(lambda: all(end.exists() for end in ends))
        yield str(ends[0]), str(ends[1])


async def mbpoll(*words: str) -> tuple[int, str]:
    """Ask once with mbpoll, addresses as they are on the wire."""
    return await output(program("mbpoll"), "-1", "-0", "-q", "-o", "3", *words)


async def modbus_serial(where: dict[str, Any], *calls: list[Any], unit: int = 1) -> list[Any]:
    """Ask with the npm package modbus-serial and return its answers."""
    assert NODE_MODULES.exists(), (
        "The tests need the npm package modbus-serial. Install Node.js with npm, then: make system-packages"
    )
    asked = json.dumps({**where, "unit": unit, "calls": calls})
    client = str(HERE / "modbus-serial" / "client.js")
    code, said = await output(program("env"), f"NODE_PATH={NODE_MODULES}", "node", client, asked)
    assert code == 0, said
    answers: list[Any] = json.loads(said)
    return answers
