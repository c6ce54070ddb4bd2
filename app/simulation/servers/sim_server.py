"""Simulated drives as a process of their own, on Modbus TCP, a serial line or both."""

import asyncio
import signal
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import timedelta
from pathlib import Path
from typing import Protocol

from app.base.clock import Clock, SystemClock
from app.drives.profile import Profile, load_profile
from app.modbus.line import Line
from app.modbus.listening_line import ListeningLine
from app.modbus.pty_line import serial_end
from app.modbus.rtu_server import RtuServer
from app.modbus.server import Device, ModbusServer
from app.simulation.devices.shelf import devices, shelf
from app.simulation.faults import Fault, FaultKind
from app.simulation.position_memory import PositionFile
from app.simulation.simulated import SimulatedDrive
from app.simulation.simulated_machine import SimulatedMachine
from app.simulation.sunlight import Sunlight
from app.sun.position import Location, sun_position
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import SerialConfig, TrackerConfig

CYCLE = timedelta(milliseconds=100)


class Server(Protocol):
    """What serves the simulated drives."""

    async def close(self) -> None:
        """Stop serving."""


@dataclass(frozen=True, slots=True)
class Doors:
    """Where simulated drives are served: Modbus TCP, a serial line or pseudo-terminal, RTU over TCP.

    `serial.port` is a serial device that exists, or the name that a pseudo-terminal shall have, which then
    keeps the pace of the baud rate if `paced`.
    """

    tcp: str = ""
    serial: SerialConfig | None = None
    rtu_over_tcp: str = ""
    paced: bool = False


async def serve(
    host: str, port: int, profile: Profile, drive: SimulatedMachine, clock: Clock, *, unit: int = 1
) -> tuple[ModbusServer, int]:
    """Serve a simulated drive through a profile's registers; return the running server and its port."""
    found = devices(profile, drive, clock, unit)
    server = ModbusServer(found[unit], unit, others=found)
    return server, await server.start(host, port)


async def serve_doors(doors: Doors, served: Mapping[int, Device]) -> tuple[list[Server], list[str]]:
    """Serve devices on every door, or raise `OSError`; return the servers and where they are, for people."""
    servers: list[Server] = []
    places: list[str] = []
    if doors.tcp:
        host, port = parse_address(doors.tcp)
        first, *others = served
        server = ModbusServer(served[first], first, others={unit: served[unit] for unit in others})
        places.append(f"Modbus TCP {host}:{await server.start(host, port)}")
        servers.append(server)
    if doors.serial is not None:
        servers.append(await _rtu(serial_end(doors.serial, paced=doors.paced), served))
        places.append(f"Modbus RTU {doors.serial.port}")
    if doors.rtu_over_tcp:
        gateway = ListeningLine(*parse_address(doors.rtu_over_tcp))
        servers.append(await _rtu(gateway, served))
        places.append(f"Modbus RTU over TCP {gateway.host}:{gateway.port}")
    return servers, places


def run_drive_sim(
    doors: Doors,
    profile: str,
    *,
    units: Sequence[int] = (1,),
    memory: Path | None = None,
    watchdog_ms: int = 500,
    inject: Sequence[str] = (),
    location: Location | None = None,
    gear_ratio: float = 1.0,
) -> None:
    """Serve simulated drives, one for each unit id, until SIGTERM or SIGINT; TCP port 0 takes a free one.

    With a `location` they have photo-sensors under the sun of that place and of this computer's clock.
    Where each axis has a drive of its own, the elevation answers at the next unit id; `gear_ratio` is the
    motors' revolutions for one of the axis. `inject` plays faults on the first from the start, each as
    `kind`, `kind:axis` or `kind:axis:amount`. Raises `ProfileError` for a bad profile, `ValueError` for a
    bad address or fault, `OSError` for a taken port.
    """
    faults = [parse_fault(text) for text in inject]
    known = load_profile(profile)
    has_watchdog = known.watchdog is not None and watchdog_ms > 0
    watchdog = timedelta(milliseconds=watchdog_ms) if has_watchdog else None
    clock = SystemClock()
    config = TrackerConfig("simulated", "Simulated tracker")
    drives = {
        unit: SimulatedDrive(
            config,
            clock,
            memory=_memory_of(memory, unit, units),
            watchdog=watchdog,
            light=_light(config, clock, location),
        )
        for unit in units
    }
    for fault in faults:
        drives[units[0]].inject(fault)
    asyncio.run(_run(doors, known, drives, clock, gear_ratio))


def _light(config: TrackerConfig, clock: Clock, location: Location | None) -> Sunlight | None:
    if location is None:
        return None
    return Sunlight(config, lambda: sun_position(config.algorithm, location, clock.now()))


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


async def _rtu(line: Line, devices: Mapping[int, Device]) -> RtuServer:
    server = RtuServer(devices, line)
    await server.start()
    return server


def _memory_of(memory: Path | None, unit: int, units: Sequence[int]) -> PositionFile | None:
    """Return the file of one drive: the first has the given one, the others their unit id in the name."""
    if memory is None:
        return None
    first = unit == units[0]
    return PositionFile(memory if first else memory.with_name(f"{memory.stem}-{unit}{memory.suffix}"))


async def _run(
    doors: Doors, profile: Profile, drives: Mapping[int, SimulatedDrive], clock: Clock, gear_ratio: float
) -> None:
    ended = ending()
    served = shelf(profile, drives, clock, gear_ratio)
    servers, places = await serve_doors(doors, served)
    units = ", ".join(str(unit) for unit in served)
    for place in places:
        sys.stdout.write(
            f"Simulated drive on {place}, unit {units}, profile {profile.name}. Ctrl-C ends it.\n"
        )
    sys.stdout.flush()
    tasks = [asyncio.create_task(_watch(tuple(drives.values()), clock))]
    tasks += [asyncio.create_task(server.stay(clock)) for server in servers if isinstance(server, RtuServer)]
    await ended.wait()
    for task in tasks:
        task.cancel()
    await asyncio.gather(*tasks, return_exceptions=True)
    for server in servers:
        await server.close()
    for drive in drives.values():
        await drive.close()


def ending() -> asyncio.Event:
    """Return an event that SIGTERM or SIGINT sets."""
    ended = asyncio.Event()
    loop = asyncio.get_running_loop()
    for number in (signal.SIGTERM, signal.SIGINT):
        loop.add_signal_handler(number, ended.set)
    return ended


async def _watch(drives: Sequence[SimulatedMachine], clock: Clock) -> None:
    """Let drives notice their watchdogs and keep their position memories although nobody asks anything."""
    while True:
        await clock.sleep_until(clock.now() + CYCLE)
        for drive in drives:
            _ = drive.is_resting
