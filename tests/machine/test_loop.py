"""Names that are answered slowly: drives behind a dead name server hold up neither the disk nor numbers."""

import asyncio
import os
import socket
import threading
from pathlib import Path
from typing import Any

import pytest

from app.base.settings import Settings
from app.machine import main
from app.machine.loop import ControllerLoop, run_loop
from app.modbus.line import TcpLine
from app.modbus.server import ModbusServer
from app.modbus.tcp import TcpWire
from tests.drives.test_modbus_clients import Registers
from tests.patience import PATIENCE_S

DRIVES = 2 * (min(32, (os.cpu_count() or 1) + 4))
"""More than the threads that a loop has for the work of others."""


async def _connect_all() -> None:
    wires = [TcpWire(f"drive-{number}.invalid", 502) for number in range(DRIVES)]
    lines = [TcpLine(f"gateway-{number}.invalid", 4001) for number in range(4)]
    opening = [line.open(lambda _: None, lambda: None) for line in lines]
    assert not any(await asyncio.gather(*(wire.connect() for wire in wires), *opening))


async def _meanwhile() -> None:
    """Work of the disk, and a drive that is found by its number, beside all those names."""
    assert await asyncio.to_thread(lambda: 7) == 7
    server = ModbusServer(Registers())
    wire = TcpWire("127.0.0.1", await server.start("127.0.0.1", 0), PATIENCE_S)
    assert await wire.connect()
    wire.close()
    await server.close()


def test_names_that_nobody_answers_hold_up_neither_the_disk_nor_other_drives(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    answered, asked = threading.Event(), threading.Semaphore(0)

    def nobody(*_: Any, **__: Any) -> Any:
        asked.release()
        answered.wait(PATIENCE_S)
        raise socket.gaierror(socket.EAI_AGAIN, "no name server answers")

    monkeypatch.setattr(socket, "getaddrinfo", nobody)

    async def story() -> None:
        await _connect_all()
        assert asked.acquire(timeout=PATIENCE_S)
        await _meanwhile()
        answered.set()

    try:
        run_loop(story())
    finally:
        answered.set()


def test_a_name_is_still_found() -> None:
    async def story() -> None:
        server = ModbusServer(Registers())
        wire = TcpWire("localhost", await server.start("127.0.0.1", 0), PATIENCE_S)
        assert await wire.connect()
        wire.close()
        await server.close()

    run_loop(story())


def test_the_controller_runs_on_this_loop(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    ran: list[asyncio.AbstractEventLoop] = []

    async def serve(*_: object) -> None:
        ran.append(asyncio.get_running_loop())

    monkeypatch.setattr(main, "_serve", serve)
    monkeypatch.setattr(main, "set_up_logs", lambda *_, **__: None)
    main.run(Settings(data_dir=tmp_path))
    assert [type(loop) for loop in ran] == [ControllerLoop]
