"""The commands around drives: simulated ones to practise on, and the serial ports of this computer."""

from pathlib import Path
from typing import Annotated

import typer

from app.modbus.line import list_ports
from app.modbus.wire_faults import Framing
from app.simulation.servers.fault_proxy import make_proxy, run_fault_proxy
from app.simulation.servers.sim_server import Doors, run_drive_sim
from app.sun.position import Location
from app.tracker.settings.config import Parity, SerialConfig

TCP = "127.0.0.1:5020"

drive = typer.Typer(name="drive", help="Drives and the lines they hang on.", no_args_is_help=True)

BaudRate = Annotated[int, typer.Option(min=300, help="Speed of the serial line.")]
ParityBit = Annotated[Parity, typer.Option(help="Check bit of the serial line.")]
StopBits = Annotated[int, typer.Option(min=1, max=2, help="Stop bits of the serial line.")]


def drive_sim(
    tcp: Annotated[str, typer.Option(help=f"HOST:PORT to serve Modbus TCP on. [default: {TCP}]")] = "",
    rtu: Annotated[
        str, typer.Option(help="Serve Modbus RTU: a serial device, or the name of a new pseudo-terminal.")
    ] = "",
    rtu_over_tcp: Annotated[str, typer.Option(help="HOST:PORT to serve RTU frames on, as a gateway.")] = "",
    profile: Annotated[str, typer.Option(help="Register map, by name or file.")] = "simulated-plc",
    unit: Annotated[
        list[int] | None, typer.Option(help="Modbus unit id; several make several drives. [default: 1]")
    ] = None,
    baud_rate: BaudRate = 19200,
    parity: ParityBit = Parity.EVEN,
    stop_bits: StopBits = 1,
    memory: Annotated[
        Path | None, typer.Option(help="File in which the drive remembers its position.")
    ] = None,
    watchdog_ms: Annotated[int, typer.Option(min=50, help="Time-out of the drive's own watchdog.")] = 500,
    gear: Annotated[
        float,
        typer.Option(min=0.001, help="Motor revolutions for one of the axis, for drives that count steps."),
    ] = 1.0,
    lat: Annotated[float | None, typer.Option(help="With --lon: latitude, for photo-sensors.")] = None,
    lon: Annotated[float | None, typer.Option(help="With --lat: longitude, east positive.")] = None,
    *,
    paced: Annotated[bool, typer.Option(help="Keep the pace of the baud rate on a pseudo-terminal.")] = False,
) -> None:
    """Serve a simulated tracker over Modbus TCP or RTU, to practise on and to test with."""
    serial = SerialConfig(rtu, baud_rate, parity, stop_bits) if rtu else None
    doors = Doors(tcp or ("" if rtu or rtu_over_tcp else TCP), serial, rtu_over_tcp, paced)
    units = unit or [1]
    if not all(1 <= one <= 247 for one in units) and (rtu or rtu_over_tcp):
        raise ValueError("A unit id on a serial line lies between 1 and 247.")
    location = None if lat is None or lon is None else Location(lat, lon)
    run_drive_sim(
        doors,
        profile,
        units=units,
        memory=memory,
        watchdog_ms=watchdog_ms,
        location=location,
        gear_ratio=gear,
    )


def fault_proxy(
    near: Annotated[str, typer.Argument(help="Where the master connects: HOST:PORT or a new serial name.")],
    far: Annotated[str, typer.Argument(help="Where the device is: HOST:PORT or a serial port.")],
    frames: Annotated[Framing, typer.Option(help="Modbus TCP or RTU frames.")] = Framing.TCP,
    script: Annotated[str, typer.Option(help="Such as 'after 5 frames: drop 3; delay=400 2'.")] = "",
    baud_rate: BaudRate = 19200,
    parity: ParityBit = Parity.EVEN,
    stop_bits: StopBits = 1,
    *,
    paced: Annotated[bool, typer.Option(help="Keep the pace of the baud rate towards the master.")] = False,
) -> None:
    """Stand between master and device and make things go wrong: to test, and to train operators."""
    serial = SerialConfig("", baud_rate, parity, stop_bits)
    proxy = make_proxy(near, far, frames, script, serial, paced=paced)
    run_fault_proxy(proxy, f"from {near} to {far}")


@drive.command()
def ports() -> None:
    """List this computer's serial ports by names that stay when adapters are plugged in anew."""
    found = list_ports()
    for name, what in found:
        typer.echo(f"{name}  {what}")
    if not found:
        typer.echo("No serial port was found. Plug the adapter in, then try again.")
