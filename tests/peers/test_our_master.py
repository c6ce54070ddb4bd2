"""Our master asks servers that others made, over TCP and RTU: libmodbus in C, and modbus_tk in Python."""

import asyncio
import sys
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path

import pytest

from app.base.clock import SystemClock
from app.drives.connections.buses import Buses
from app.modbus.bus import BusUnit
from app.modbus.errors import DriveRefused
from app.modbus.wire import Timing
from app.tracker.settings.config import DriveConfig, DriveKind, Parity, SerialConfig
from tests.peers.processes import HERE, cable, output, program, running
from tests.ports import free_port

UNIT, REGISTERS = 17, 200


@pytest.fixture(scope="module")
def libmodbus_server(tmp_path_factory: pytest.TempPathFactory) -> str:
    built = tmp_path_factory.mktemp("libmodbus") / "server"
    compiling = output(
        program("gcc"), "-O1", "-Wall", "-I/usr/include/modbus", str(HERE / "libmodbus_server.c"),
        "-lmodbus", "-o", str(built),
    )  # fmt: skip
    code, said = asyncio.run(compiling)
    assert code == 0, f"{said}\nThe tests need libmodbus. Install it with: make system-packages"
    return str(built)


@asynccontextmanager
async def asked(server: list[str], kind: str, folder: Path) -> AsyncIterator[BusUnit]:
    """Our master in front of a server of somebody else's."""
    if kind == "tcp":
        port = free_port()
        async with running(*server, "tcp", str(port), ready="ready"):
            unit = Buses(SystemClock()).unit(DriveConfig(DriveKind.MODBUS_TCP, port=port), UNIT, Timing())
            yield unit
            await unit.close()
        return
    async with cable(folder) as (ours, theirs), running(*server, "rtu", theirs, ready="ready"):
        line = SerialConfig(ours, 19200, Parity.NONE)
        unit = Buses(SystemClock()).unit(DriveConfig(DriveKind.MODBUS_RTU, serial=line), UNIT, Timing())
        yield unit
        await unit.close()


@pytest.mark.parametrize("kind", ["tcp", "rtu"])
@pytest.mark.parametrize("made_with", ["libmodbus", "modbus_tk"])
async def test_our_master_reads_and_writes(
    made_with: str, kind: str, tmp_path: Path, libmodbus_server: str
) -> None:
    server = {
        "libmodbus": [libmodbus_server],
        "modbus_tk": [sys.executable, str(HERE / "modbus_tk_server.py")],
    }[made_with]
    async with asked(server, kind, tmp_path) as unit:
        assert await unit.read(0, 125, what="the first registers") == [3 * n + 1 for n in range(125)]
        await unit.write(40, (7,), what="one register", ticket=None)
        await unit.write(50, (1, 0xFFFF, 0x8000), what="three registers", ticket=None)
        assert await unit.read(40, 13, what="what was written") == [
            7, *(3 * n + 1 for n in range(41, 50)), 1, 0xFFFF, 0x8000,
        ]  # fmt: skip
        with pytest.raises(DriveRefused, match="has no such register"):
            await unit.read(REGISTERS, 1, what="a register behind the last")
        assert await unit.read(199, 1, what="the last register") == [598]
