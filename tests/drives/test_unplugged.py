"""Adapters that are pulled out and plugged in again, and the names of serial devices."""

import asyncio
import os
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress
from pathlib import Path
from typing import Any

import pytest

from app.base.clock import SystemClock
from app.drives.connections.buses import Buses
from app.modbus.bus import BusUnit
from app.modbus.errors import DriveError, DriveSilent
from app.modbus.line import SerialLine
from app.modbus.pty_line import PtyLine, serial_end
from app.modbus.rtu_server import RtuServer
from app.modbus.wire_faults import Framing
from app.simulation.servers.fault_proxy import FaultProxy
from app.tracker.settings.config import DriveConfig, DriveKind, SerialConfig
from tests.drives.proxied import TIMING, Registers
from tests.patience import PATIENCE_S, pause
from tests.patient_loop import LoopClock
from tests.peers.processes import cable


def on_line(port: str | Path) -> DriveConfig:
    return DriveConfig(DriveKind.MODBUS_RTU, serial=SerialConfig(str(port), 115_200))


async def found(device: BusUnit, registers: Registers) -> None:
    """Read until the device answers, which it has to do by itself."""
    async with asyncio.timeout(PATIENCE_S):
        while True:
            with suppress(DriveSilent):
                assert await device.read(10, 4, what="words") == registers.words(10, 4)
                return
            await pause()


async def missed(device: BusUnit) -> None:
    with pytest.raises(DriveError):
        await device.read(10, 4, what="words")


@asynccontextmanager
async def without_surprises() -> AsyncIterator[None]:
    """Nothing may go wrong in a callback, where only the loop hears of it."""
    surprises: list[dict[str, Any]] = []
    asyncio.get_running_loop().set_exception_handler(lambda _, context: surprises.append(context))
    yield
    assert not surprises


async def test_an_adapter_that_is_unplugged_is_found_again(tmp_path: Path) -> None:
    name, registers = tmp_path / "adapter", Registers(7)
    device = Buses(LoopClock()).unit(on_line(name), 7, TIMING)
    async with without_surprises():
        for _ in range(2):
            server = RtuServer({7: registers}, PtyLine(name))
            await server.start()
            ticket = device.ticket
            await found(device, registers)
            assert device.ticket != ticket, "nothing from before is written"
            await server.close()
            with pytest.raises(DriveSilent, match="plugged in"):
                await device.read(10, 4, what="words")
        await device.close()


async def test_an_unplugged_adapter_is_noticed_at_once_and_let_go(tmp_path: Path) -> None:
    far, lost = PtyLine(tmp_path / "adapter"), asyncio.Event()
    near = SerialLine(SerialConfig(str(tmp_path / "adapter")))
    before = len(os.listdir("/dev/fd"))
    async with without_surprises():
        await far.open(print, print)
        assert await near.open(print, lost.set)
        far.close()
        async with asyncio.timeout(PATIENCE_S):
            await lost.wait()
    assert not near.is_open
    assert len(os.listdir("/dev/fd")) == before, "the port is closed, so that it can be opened again"


@pytest.mark.real_time
@pytest.mark.parametrize("proxied", [False, True], ids=["device", "behind a proxy"])
async def test_both_ends_of_a_cable_come_back_after_it_was_cut(tmp_path: Path, *, proxied: bool) -> None:
    registers, clock = Registers(7), SystemClock()
    master, slave = tmp_path / "one-end", tmp_path / "other-end"
    device = Buses(clock).unit(on_line(master), 7, TIMING)
    behind = PtyLine(tmp_path / "behind") if proxied else SerialLine(SerialConfig(str(slave)))
    server = RtuServer({7: registers}, behind)
    far = SerialLine(SerialConfig(str(tmp_path / "behind")))
    proxy = FaultProxy(SerialLine(SerialConfig(str(slave))), far, Framing.RTU, clock)
    async with without_surprises():
        async with cable(tmp_path):
            await server.start()
            if proxied:
                await proxy.start()
            staying = asyncio.create_task(server.stay(clock))
            await found(device, registers)
        await missed(device)
        async with cable(tmp_path):
            await found(device, registers)
            staying.cancel()
            await asyncio.gather(staying, return_exceptions=True)
            await device.close()
            await proxy.close()
            await server.close()


async def test_a_lasting_name_stays_what_it_is(tmp_path: Path) -> None:
    name, ends = tmp_path / "by-id", os.openpty()
    name.symlink_to(os.ttyname(ends[1]))
    line = serial_end(SerialConfig(str(name)))
    assert isinstance(line, SerialLine)
    assert await line.open(print, print)
    assert name.readlink() == Path(os.ttyname(ends[1]))
    assert not await PtyLine(name).open(print, print), "a device's name is not taken away"
    line.close()
    for end in ends:
        os.close(end)


async def test_a_name_that_a_killed_process_left_behind_is_taken_over(tmp_path: Path) -> None:
    name = tmp_path / "line"
    name.symlink_to("/proc/4194305/fd/3")
    line = serial_end(SerialConfig(str(name)))
    assert await line.open(print, print)
    assert name.is_char_device()
    assert name.readlink().parent == Path(f"/proc/{os.getpid()}/fd"), "it vanishes with its process"
    line.close()
    assert not name.is_symlink()
