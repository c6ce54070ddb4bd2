"""`heliopanel fault-proxy` as a process of its own, between a device and a master in real time."""

import asyncio
import sys

import pytest

from app.base.clock import SystemClock
from app.drives.connections.buses import Buses
from app.modbus.errors import DriveSilent
from app.modbus.server import ModbusServer
from app.modbus.wire import Timing
from app.tracker.settings.config import DriveConfig, DriveKind
from tests.drives.proxied import Registers
from tests.ports import free_port

COMMAND = "import typer; from app.cli.drives import fault_proxy; typer.run(fault_proxy)"


async def test_the_proxy_is_played_from_the_command_line() -> None:
    server = ModbusServer(Registers(1))
    port = await server.start("127.0.0.1", 0)
    near = free_port()
    process = await asyncio.create_subprocess_exec(
        sys.executable, "-c", COMMAND, f"127.0.0.1:{near}", f"127.0.0.1:{port}",
        stdin=asyncio.subprocess.PIPE, stdout=asyncio.subprocess.PIPE,
    )  # fmt: skip
    assert process.stdin is not None
    assert process.stdout is not None
    config, clock = DriveConfig(DriveKind.MODBUS_TCP, port=near), SystemClock()
    async with asyncio.timeout(40.0):
        assert b"Type a fault" in await process.stdout.readline()
        for line, told, within_s in (
            (b"drop", b"drop", 0.3),
            (b"x", b"no fault", 0.3),
            (b"clear", b"clear", 30.0),
        ):
            device = Buses(clock).unit(config, 1, Timing(within_s))
            process.stdin.write(line + b"\n")
            assert told in await process.stdout.readline()
            if told == b"clear":
                assert await device.read(10, 2, what="words") == [1030, 1033]
            else:
                with pytest.raises(DriveSilent):
                    await device.read(10, 2, what="words")
            await device.close()
        process.terminate()
        assert await process.wait() == 0
    await server.close()
