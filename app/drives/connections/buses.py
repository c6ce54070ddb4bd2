"""The buses in use: drives on the same line or at the same gateway share one, with one owner."""

from collections.abc import Callable
from dataclasses import replace
from typing import assert_never

from app.base.clock import Clock
from app.base.message import N_, say
from app.modbus.bus import Bus, BusUnit
from app.modbus.errors import DriveError
from app.modbus.line import SerialLine, TcpLine
from app.modbus.line_turn import serial_part_s
from app.modbus.rtu import RtuWire
from app.modbus.tcp import TcpWire
from app.modbus.wire import Timing, Wire
from app.tracker.settings.config import DriveConfig, DriveKind


class Buses:
    """Hands out devices and brings those together that hang on the same wire.

    `make_wire` makes the wire of a new bus, for example one that also records what goes over it.
    """

    def __init__(self, clock: Clock, make_wire: Callable[[DriveConfig], Wire] | None = None) -> None:
        self._clock = clock
        self._make_wire = make_wire or wire_of
        self._buses: dict[str, tuple[DriveConfig, Bus]] = {}

    def unit(self, drive: DriveConfig, unit: int, timing: Timing) -> BusUnit:
        """Return a device; its bus is found or made with the first request."""
        reckoned_s = serial_part_s(drive.serial, timing) if drive.kind is DriveKind.MODBUS_RTU else 0.0
        return BusUnit(drive.line, unit, timing, lambda: self._bus(drive), reckoned_s=reckoned_s)

    def _bus(self, drive: DriveConfig) -> Bus:
        """Return the bus of a drive, or raise `DriveError` if its line is in use with other settings."""
        wiring = _wiring(drive)
        used, bus = self._buses.get(drive.line, (None, None))
        if bus is None or bus.unit_count == 0:
            bus = Bus(drive.line, self._make_wire(drive), self._clock)
            self._buses[drive.line] = wiring, bus
        elif used != wiring:
            raise DriveError(
                say(
                    "Line {line} is in use with other settings. All drives on one line need the same "
                    "connection type, baud rate, parity, and stop bits.",
                    line=drive.line,
                )
            )
        return bus


def _wiring(drive: DriveConfig) -> DriveConfig:
    """Return what all drives on one line have in common."""
    plain = DriveConfig(drive.kind, host=drive.host, port=drive.port)
    return replace(plain, serial=drive.serial) if drive.kind is DriveKind.MODBUS_RTU else plain


def wire_of(drive: DriveConfig) -> Wire:
    """Return the wire to a drive's line, not yet connected, or raise `DriveError` if it has none."""
    match drive.kind:
        case DriveKind.MODBUS_TCP:
            return TcpWire(drive.host, drive.port)
        case DriveKind.MODBUS_RTU_OVER_TCP:
            return RtuWire(TcpLine(drive.host, drive.port))
        case DriveKind.MODBUS_RTU:
            return RtuWire(SerialLine(drive.serial))
        case DriveKind.SIMULATED:
            raise DriveError(N_("A simulated drive is not connected to a bus."))
        case _ as never:
            assert_never(never)
