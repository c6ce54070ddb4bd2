"""The simulated drive as a process of its own, on Modbus TCP."""

import asyncio
import signal
import sys
from collections.abc import Sequence
from datetime import timedelta
from pathlib import Path

from app.clock import Clock, SystemClock
from app.drives.faults import Fault, FaultKind
from app.drives.modbus_server import ModbusServer
from app.drives.profile import Profile, load_profile
from app.drives.sim_plc import SimulatedPlc
from app.drives.simulated import SimulatedDrive
from app.drives.simulated_machine import SimulatedMachine
from app.tracker.axes import Axis
from app.tracker.config import TrackerConfig

CYCLE = timedelta(milliseconds=100)


async def serve(
    host: str, port: int, profile: Profile, drive: SimulatedMachine, clock: Clock, *, unit: int = 1
) -> tuple[ModbusServer, int]:
    """Serve a simulated drive through a profile's registers; return the running server and its port."""
    server = ModbusServer(SimulatedPlc(profile, drive, clock), unit)
    return server, await server.start(host, port)


def run_drive_sim(
    tcp: str,
    profile: str,
    *,
    unit: int = 1,
    memory: Path | None = None,
    watchdog_ms: int = 500,
    inject: Sequence[str] = (),
) -> None:
    """Serve a simulated drive on `HOST:PORT` until SIGTERM or SIGINT; port 0 takes a free one.

    `inject` plays faults from the start, each as `kind`, `kind:axis` or `kind:axis:amount`. Raises
    `ProfileError` for a bad profile, `ValueError` for a bad address or fault, `OSError` for a taken port.
    """
    host, port = parse_address(tcp)
    faults = [parse_fault(text) for text in inject]
    watchdog = timedelta(milliseconds=watchdog_ms) if watchdog_ms > 0 else None
    clock = SystemClock()
    config = TrackerConfig("simulated", "Simulated tracker")
    drive = SimulatedDrive(config, clock, memory=memory, watchdog=watchdog)
    for fault in faults:
        drive.inject(fault)
    asyncio.run(_run(host, port, load_profile(profile), drive, clock, unit))


def parse_address(text: str) -> tuple[str, int]:
    """Return host and port of `HOST:PORT`, or raise `ValueError`."""
    host, _, port = text.rpartition(":")
    if not host or not port.isdecimal() or int(port) > 0xFFFF:
        raise ValueError(f"{text!r} is no address. Write it as HOST:PORT, for example 127.0.0.1:5020.")
    return host.strip("[]"), int(port)


def parse_fault(text: str) -> Fault:
    """Return the fault that `kind`, `kind:axis` or `kind:axis:amount` names, or raise `ValueError`."""
    kind, _, rest = text.partition(":")
    axis, _, amount = rest.partition(":")
    try:
        return Fault(FaultKind(kind), Axis(axis) if axis not in ("", "both") else None, float(amount or 0))
    except ValueError as error:
        raise ValueError(
            f"{text!r} is no fault. Write kind, kind:axis or kind:axis:amount; kinds are "
            f"{', '.join(FaultKind)}; an axis is azimuth, elevation or both."
        ) from error


async def _run(
    host: str, port: int, profile: Profile, drive: SimulatedDrive, clock: Clock, unit: int
) -> None:
    ended = asyncio.Event()
    loop = asyncio.get_running_loop()
    for number in (signal.SIGTERM, signal.SIGINT):
        loop.add_signal_handler(number, ended.set)
    server, port = await serve(host, port, profile, drive, clock, unit=unit)
    sys.stdout.write(
        f"Simulated drive on Modbus TCP {host}:{port}, unit {unit}, profile {profile.name}. Ctrl-C ends it.\n"
    )
    sys.stdout.flush()
    watching = asyncio.create_task(_watch(drive, clock))
    await ended.wait()
    watching.cancel()
    await asyncio.gather(watching, return_exceptions=True)
    await server.close()
    await drive.close()


async def _watch(drive: SimulatedMachine, clock: Clock) -> None:
    """Let the drive notice its watchdog and keep its position memory although nobody asks it anything."""
    while True:
        await clock.sleep_until(clock.now() + CYCLE)
        _ = drive.is_resting
