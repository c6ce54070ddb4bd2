"""The commands with which an engineer writes a profile and looks at a drive: nothing here moves anything."""

import asyncio
import json
from dataclasses import asdict, dataclass
from datetime import timedelta
from pathlib import Path
from typing import Annotated

import typer

from app.base.clock import SystemClock
from app.base.file_text import utf8_of
from app.cli.drives import BaudRate, ParityBit, StopBits
from app.cli.drives import drive as drive
from app.drives.connections.adapters import drive_on
from app.drives.connections.bus_tools import Played, record, replay, scan
from app.drives.connections.buses import Buses
from app.drives.connections.probe import probe
from app.drives.connections.profile_needs import check_needs
from app.drives.drive import check_fit
from app.drives.profile import Profile, known_profiles, load_profile
from app.drives.write_frame import write_frame
from app.modbus.errors import DriveError
from app.modbus.trace import Exchange, parse_trace
from app.simulation.servers.sim_server import parse_address
from app.simulation.servers.trace_server import run_trace_server
from app.tracker.memory.drive_check import CheckOutcome, RegisterReading
from app.tracker.settings.config import AxisDrive, DriveConfig, DriveKind, Parity, SerialConfig, TrackerConfig

ProfileName = Annotated[str, typer.Argument(help="Profile, by name or by the path of a .toml file.")]
OptionalProfile = Annotated[str, typer.Option("--profile", help="Profile, by name or by the path of a file.")]
Tcp = Annotated[str, typer.Option(help="HOST:PORT of a device on Modbus TCP.")]
Rtu = Annotated[str, typer.Option(help="Serial port of a Modbus RTU line.")]
RtuOverTcp = Annotated[str, typer.Option(help="HOST:PORT of a gateway that takes RTU frames.")]
UnitId = Annotated[int, typer.Option(min=0, max=255, help="Unit id; of the azimuth where each axis has one.")]
ElevationUnit = Annotated[
    int | None, typer.Option(min=0, max=255, help="Unit id of the elevation's drive. [default: the next one]")
]


SWITCHES = ("lower_limit", "upper_limit", "origin")


@dataclass(frozen=True, slots=True)
class Way:
    """How a drive is reached, as the options of a command say."""

    tcp: str
    rtu: str
    rtu_over_tcp: str
    serial: SerialConfig

    def config(self, profile: str = "simulated-plc", unit: int = 1) -> DriveConfig:
        """Return it as a tracker's settings, or raise `ValueError` unless exactly one way is given."""
        if sum(map(bool, (self.tcp, self.rtu, self.rtu_over_tcp))) != 1:
            raise ValueError("Give one of --tcp HOST:PORT, --rtu PORT and --rtu-over-tcp HOST:PORT.")
        if self.rtu:
            return DriveConfig(DriveKind.MODBUS_RTU, profile, unit=unit, serial=self.serial)
        kind = DriveKind.MODBUS_TCP if self.tcp else DriveKind.MODBUS_RTU_OVER_TCP
        host, port = parse_address(self.tcp or self.rtu_over_tcp)
        return DriveConfig(kind, profile, host, port, unit)


@drive.command()
def profiles() -> None:
    """List the profiles that ship, and which of their registers are not verified."""
    for name in known_profiles():
        found = load_profile(name)
        typer.echo(f"{name:<16}{found.title}\n{'':<16}{_verified(found)}")


@drive.command()
def check(
    file: ProfileName,
    gear: Annotated[
        float | None,
        typer.Option(min=0.0001, max=999_999, help="Gear ratio of both axes: check that its numbers fit."),
    ] = None,
) -> None:
    """Check a profile: a wrong one is refused with file, line, key and rule."""
    found = load_profile(file)
    check_needs(found)
    if gear is not None:
        _check_gear(found, gear)
    typer.echo(
        f"{file} is a right profile for adapter {found.adapter}: {len(found.registers)} registers, "
        f"{_watchdog(found)}, {_switches(found)}. {_verified(found)}"
    )


@drive.command(name="probe")
def probe_command(
    profile: OptionalProfile,
    tcp: Tcp = "",
    rtu: Rtu = "",
    rtu_over_tcp: RtuOverTcp = "",
    unit: UnitId = 1,
    elevation_unit: ElevationUnit = None,
    baud_rate: BaudRate = 19200,
    parity: ParityBit = Parity.EVEN,
    stop_bits: StopBits = 1,
    *,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
) -> None:
    """Read every register of a live device and show it decoded; changes nothing."""
    found = load_profile(profile)
    way = Way(tcp, rtu, rtu_over_tcp, SerialConfig(rtu, baud_rate, parity, stop_bits))
    config = _with_axes(way.config(profile, unit), found, elevation_unit)
    readings = asyncio.run(probe(Buses(SystemClock()), config, found))
    if as_json:
        typer.echo(json.dumps(asdict(readings)))
    else:
        for one in readings.registers:
            typer.echo(_told(one))
        typer.echo(readings.message)
    if readings.outcome is not CheckOutcome.ANSWERED:
        raise typer.Exit(1)


@drive.command(name="scan")
def scan_command(
    tcp: Tcp = "",
    rtu: Rtu = "",
    rtu_over_tcp: RtuOverTcp = "",
    first: Annotated[int, typer.Option(min=0, max=255, help="First unit id to ask.")] = 1,
    last: Annotated[int, typer.Option(min=0, max=255, help="Last unit id to ask.")] = 32,
    address: Annotated[int, typer.Option(min=0, max=0xFFFF, help="Holding register to ask for.")] = 0,
    baud_rate: BaudRate = 19200,
    parity: ParityBit = Parity.EVEN,
    stop_bits: StopBits = 1,
) -> None:
    """Find out which units answer on a bus; one that only refuses the register answers, too."""
    way = Way(tcp, rtu, rtu_over_tcp, SerialConfig(rtu, baud_rate, parity, stop_bits))
    if first > last:
        raise ValueError("The first unit id must not lie above the last.")
    found = asyncio.run(_scan(way.config(), range(first, last + 1), address))
    if not found:
        typer.echo(f"No unit from {first} to {last} answers. Check wiring, baud rate and parity.")
        raise typer.Exit(1)


@drive.command(name="record")
def record_command(
    file: Annotated[Path, typer.Argument(help="File to write, one exchange a line.")],
    profile: OptionalProfile,
    seconds: Annotated[float, typer.Option(min=0.1, max=86400.0, help="How long to poll.")] = 10.0,
    tcp: Tcp = "",
    rtu: Rtu = "",
    rtu_over_tcp: RtuOverTcp = "",
    unit: UnitId = 1,
    elevation_unit: ElevationUnit = None,
    baud_rate: BaudRate = 19200,
    parity: ParityBit = Parity.EVEN,
    stop_bits: StopBits = 1,
) -> None:
    """Record what a device answers: every register once, then polls; changes nothing."""
    found = load_profile(profile)
    way = Way(tcp, rtu, rtu_over_tcp, SerialConfig(rtu, baud_rate, parity, stop_bits))
    config = _tracker(_with_axes(way.config(profile, unit), found, elevation_unit))
    with file.open("w", encoding="utf-8") as trace:

        def keep(exchange: Exchange) -> None:
            trace.write(exchange.line() + "\n")

        good = asyncio.run(record(config, found, SystemClock(), keep, timedelta(seconds=seconds)))
    typer.echo(f"{good} good readings are in {file}.")


@drive.command(name="replay")
def replay_command(
    file: Annotated[
        Path, typer.Argument(help="Trace that `drive record` wrote.", exists=True, dir_okay=False)
    ],
    profile: OptionalProfile = "",
    unit: UnitId = 1,
    elevation_unit: ElevationUnit = None,
    gear: Annotated[
        float,
        typer.Option(min=1e-6, help="Revolutions of a motor for one of its axis, where drives count steps."),
    ] = 1.0,
    tcp: Annotated[
        str, typer.Option(help="Instead, serve the recorded answers on this HOST:PORT over Modbus TCP.")
    ] = "",
) -> None:
    """Show what a profile makes of a recorded trace, or serve its answers as the device did."""
    exchanges = parse_trace(utf8_of(file.read_bytes()).splitlines(), file.name)
    if tcp:
        run_trace_server(tcp, exchanges)
        return
    if not profile:
        raise ValueError("Give --profile NAME to decode the trace, or --tcp HOST:PORT to serve it.")
    found = load_profile(profile)
    config = _with_axes(DriveConfig(DriveKind.MODBUS_TCP, profile, unit=unit), found, elevation_unit, gear)
    played = asyncio.run(replay(_tracker(config), found, exchanges))
    for one in played:
        typer.echo(_played(one))
    if not any(one.feedback for one in played):
        raise DriveError(f"Profile {found.name} makes no reading of {file.name}.")


@drive.command()
def frame(
    profile: ProfileName,
    register: Annotated[str, typer.Argument(help="Register to write, by its name in the profile.")],
    value: Annotated[float, typer.Argument(help="Value in the register's unit.")],
    unit: UnitId = 1,
) -> None:
    """Print the Modbus RTU frame that writes a register, to hold against the manual; sends nothing."""
    typer.echo(write_frame(load_profile(profile), {register: value}, unit).hex(" ").upper())


def _check_gear(profile: Profile, gear_ratio: float) -> None:
    """Raise `DriveError` if a tracker with usual limits and speeds has a number that fits no register."""
    drive = _with_axes(DriveConfig(DriveKind.MODBUS_TCP), profile, None, gear_ratio)
    buses, clock = Buses(SystemClock()), SystemClock()
    check_fit(drive_on(_tracker(drive), profile, lambda one: buses.unit(drive, one, profile.timing), clock))


async def _scan(config: DriveConfig, units: range, address: int) -> int:
    found = 0
    async for one in scan(config, units, SystemClock(), address=address):
        typer.echo(f"unit {one.unit}: {one.said}")
        found += 1
    return found


def _with_axes(
    config: DriveConfig, profile: Profile, elevation_unit: int | None, gear_ratio: float = 1.0
) -> DriveConfig:
    """Return the settings with the elevation's unit and the gear, where each axis has a drive of its own."""
    if not profile.adapter.has_unit_per_axis:
        return config
    other = config.unit + 1 if elevation_unit is None else elevation_unit
    return DriveConfig(
        config.kind,
        config.profile,
        config.host,
        config.port,
        config.unit,
        config.serial,
        azimuth=AxisDrive(gear_ratio=gear_ratio),
        elevation=AxisDrive(unit=other, gear_ratio=gear_ratio),
    )


def _tracker(config: DriveConfig) -> TrackerConfig:
    return TrackerConfig("T1", "Drive on the bench", drive=config)


def _verified(profile: Profile) -> str:
    if not profile.unverified:
        return "Every register is verified."
    if len(profile.unverified) == len(profile.registers):
        return "No register was tried on a device yet."
    return f"Not verified on a device: {', '.join(profile.unverified)}."


def _watchdog(profile: Profile) -> str:
    return f"watchdog {profile.watchdog.timeout_ms} ms" if profile.watchdog is not None else "no watchdog"


def _switches(profile: Profile) -> str:
    """Return the switches that the profile shows, by the names that the adapters look for."""
    bits = {**profile.bits.get("inputs", {}), **profile.bits.get("switches", {})}
    seen = [name for name in bits if name.endswith(SWITCHES)]
    return f"switches {', '.join(seen)}" if seen else "no limit switches"


def _told(one: RegisterReading) -> str:
    mark = "verified  " if one.verified else "unverified"
    shown = one.trouble or f"{one.shown} {one.unit}".strip()
    return f"unit {one.unit_id:<3} {one.address:>5} 0x{one.address:04X} {mark} {one.name:<24} {shown}"


def _played(one: Played) -> str:
    if one.feedback is None:
        return f"{one.at_s:9.3f} s  {one.trouble}"
    azimuth, elevation = one.feedback.azimuth, one.feedback.elevation
    moving = "moving" if azimuth.moving or elevation.moving else "at rest"
    return (
        f"{one.at_s:9.3f} s  azimuth {azimuth.position_deg:.3f} deg  "
        f"elevation {elevation.position_deg:.3f} deg  fault {one.feedback.fault_code}  {moving}"
    )
