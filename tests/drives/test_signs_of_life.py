"""A PLC whose signs of life end during a motion: a whole site notices within a second of its time."""

import asyncio

import pytest

from app.drives.profile import load_profile
from app.link.messages import Order
from app.machine.drive_factory import DriveFactory
from app.modbus.server import ModbusServer
from app.simulation.simulated import SimulatedDrive
from app.site.site import Site
from app.tracker.commands.commands import Home
from app.tracker.memory.memory import SiteState, TrackerMemory, TrackerState
from app.tracker.settings.config import DriveConfig, DriveKind, TrackerConfig
from app.tracker.state.snapshot import Snapshot
from tests.drives.test_plc import ECHO, WATCHDOG_MS, Wire
from tests.fault_result import VIRTUAL, FaultResult
from tests.patience import eventually
from tests.patient_loop import LoopClock

READINGS_A_SECOND = 10
HEARTBEAT = 2


@pytest.mark.parametrize(
    ("sign", "frozen", "told"),
    [
        (HEARTBEAT, True, "its heartbeat does not change"),
        (ECHO, True, "does not echo the keep-alive value"),
        (WATCHDOG_MS, False, "was switched off during motion"),
    ],
)
@pytest.mark.fault(91)
async def test_a_sign_of_life_that_ends_stops_the_motion_within_a_second(
    sign: int, frozen: bool, told: str, fault: FaultResult
) -> None:
    clock = LoopClock()
    machine = SimulatedDrive(TrackerConfig("T1", "Tracker 1"), clock)
    wire = Wire(load_profile("simulated-plc"), machine, clock)
    server = ModbusServer(wire)
    port = await server.start("127.0.0.1", 0)
    config = TrackerConfig("T1", "Tracker 1", drive=DriveConfig(DriveKind.MODBUS_TCP, port=port))
    site = Site(clock, DriveFactory(clock).make, SiteState(), (TrackerState(config, TrackerMemory()),))
    await site.start()

    def seen() -> Snapshot:
        return site.model.snapshot(site.model.tracker("T1"), site.model.now())

    await eventually(lambda: not seen().actions["home"])
    await site.execute(Order(Home(), "technician", "T1"))
    await eventually(lambda: seen().azimuth is not None and seen().azimuth.moving)
    wire.still = {sign: wire.read_registers(3, sign, 1)[0] if frozen else 0}
    loop = asyncio.get_running_loop()
    before, began_s = wire.reads, loop.time()
    await eventually(lambda: any(told in notice.message for notice in seen().notices))
    noticed, noticed_s = wire.reads - before, loop.time() - began_s
    message = next(notice.message for notice in seen().notices if told in notice.message)
    await eventually(lambda: not machine.observe().azimuth.moving)
    wire.still = {}
    await eventually(lambda: not any(told in notice.message for notice in seen().notices))
    await eventually(lambda: not seen().actions["home"])
    await site.close()
    await server.close()
    assert noticed <= READINGS_A_SECOND
    assert noticed_s <= 1.0
    fault.noticed(noticed_s, VIRTUAL)
    fault.shows(message)
    fault.recovers("automatic: when the sign of life is back; the operator commands the next motion")
