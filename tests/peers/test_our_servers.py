"""Independent clients ask our servers, over TCP and RTU: mbpoll, and the npm package modbus-serial."""

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from app.base.clock import VirtualClock
from app.base.settings import Settings
from app.drives.profile import load_profile
from app.gateway.sunspec import SunSpecRtu, SunSpecTcp
from app.gateway.sunspec_device import SunSpecDevice
from app.link.metrics import GatewayStatus
from app.modbus.server import ModbusServer
from app.simulation.sim_plc import SimulatedPlc
from app.simulation.simulated import SimulatedDrive
from app.tracker.settings.config import TrackerConfig
from app.tracker.state.snapshot import ActivityName, EventKind
from app.tracker.values.motion import Velocity
from tests.gateway.rigs import HurriedClock
from tests.patience import eventually
from tests.peers.processes import cable, mbpoll, modbus_serial
from tests.site.plant import SUMMER_NOON, Plant, make_plant

EL_CTL, CTL = 40114, 40118
TARGETS_AND_MANUAL = (0, 30_000, 2, 8_928, 1)
"""30 and 140 degrees in thousandths, high word first, and control 1."""
OTHER_TARGETS = (0, 31_000, 2, 8_928, 1)


@dataclass
class Served:
    """Our servers over TCP and on a serial line, and how each client reaches them."""

    port: int
    line: str

    def mbpoll(self, kind: str) -> list[str]:
        if kind == "tcp":
            return ["-m", "tcp", "-p", str(self.port), "-a", "1", "127.0.0.1"]
        return ["-m", "rtu", "-b", "19200", "-P", "none", "-a", "1", self.line]

    def node(self, kind: str) -> dict[str, Any]:
        return {"tcp": self.port} if kind == "tcp" else {"rtu": self.line}


@asynccontextmanager
async def sunspec(folder: Path) -> AsyncIterator[tuple[Plant, Served]]:
    """A commissioned site behind SunSpec, over TCP and on a serial line."""
    plant = make_plant()
    await plant.start()
    async with cable(folder) as (ours, theirs):
        wanted = Settings(
            sunspec_port=0,
            sunspec_serial_port=ours,
            sunspec_parity="none",
            sunspec_write_hosts=("127.0.0.1", "serial"),
        )
        clock = HurriedClock()
        device = SunSpecDevice(plant.site, clock, write_hosts=wanted.sunspec_write_hosts)
        tcp, rtu = SunSpecTcp(device, clock, wanted), SunSpecRtu(device, clock, wanted)
        tasks = [asyncio.create_task(work) for work in (tcp.run(), rtu.run(), device.follow())]
        await eventually(lambda: tcp.port and rtu.metrics().status is GatewayStatus.LISTENING)
        try:
            await plant.commission()
            yield plant, Served(tcp.port, theirs)
        finally:
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)
            await plant.close()


@pytest.mark.parametrize("kind", ["tcp", "rtu"])
async def test_mbpoll_and_modbus_serial_read_and_write_sunspec(kind: str, tmp_path: Path) -> None:
    async with sunspec(tmp_path) as (plant, served):
        code, said = await mbpoll("-t", "4:hex", "-r", "40000", "-c", "2", *served.mbpoll(kind))
        assert code == 0, said
        assert "0x5375" in said
        assert "0x6E53" in said
        written = [str(word) for word in TARGETS_AND_MANUAL]
        code, said = await mbpoll("-t", "4", "-r", str(EL_CTL), *served.mbpoll(kind), *written)
        assert code == 0, said
        assert plant.tracker().activity is ActivityName.MOVING
        actor = "sunspec 127.0.0.1" if kind == "tcp" else "sunspec serial"
        assert plant.happened(EventKind.MOVE_STARTED)[-1].actor == actor
        code, said = await mbpoll("-t", "4", "-r", "100", *served.mbpoll(kind))
        assert code != 0
        assert "Illegal data address" in said
        answers = await modbus_serial(
            served.node(kind),
            ["readHoldingRegisters", 40070, 2],
            ["writeRegisters", EL_CTL, list(OTHER_TARGETS)],
            ["readHoldingRegisters", EL_CTL, 5],
            ["writeRegister", CTL, 9],
            ["readHoldingRegisters", 0, 2],
        )
        assert answers[0] == {"data": [601, 48]}
        assert "data" in answers[1]
        assert answers[2] == {"data": list(OTHER_TARGETS)}
        assert answers[3:] == [{"exception": 3}, {"exception": 2}]


async def test_mbpoll_and_modbus_serial_drive_the_simulated_plc() -> None:
    clock = VirtualClock(SUMMER_NOON)
    drive = SimulatedDrive(TrackerConfig("T1", "Tracker 1"), clock)
    server = ModbusServer(SimulatedPlc(load_profile("simulated-plc"), drive, clock), 1)
    served = Served(await server.start("127.0.0.1", 0), "")
    code, said = await mbpoll("-t", "4", "-r", "21", *served.mbpoll("tcp"), "1", "0", "1500")
    assert code == 0, said
    assert drive.command.azimuth == Velocity(1.5)
    answers = await modbus_serial(
        served.node("tcp"),
        ["writeRegisters", 22, [0, 700]],
        ["readHoldingRegisters", 20, 4],
        ["readCoils", 0, 1],
        ["writeCoil", 0, True],
    )
    assert answers[1] == {"data": [0, 1, 0, 700]}
    assert answers[2]["data"][0] is False
    assert drive.command.azimuth != Velocity(0.7), "the stop coil stopped it"
    await server.close()
