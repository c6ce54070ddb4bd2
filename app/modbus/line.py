"""Streams of bytes to a bus, over a serial device or through a gateway. Nothing here blocks the loop."""

import asyncio
import os
import termios
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from typing import Protocol

import serial
from serial.tools import list_ports as serial_list_ports

from app.base.message import N_, Message, say
from app.tracker.settings.config import Parity, SerialConfig

CONNECT_WITHIN_S = 0.3
CHUNK = 4096
PSEUDO_TERMINALS = "/dev/pts/"
PARITIES = {
    Parity.NONE: serial.PARITY_NONE,
    Parity.EVEN: serial.PARITY_EVEN,
    Parity.ODD: serial.PARITY_ODD,
}

Received = Callable[[bytes], None]
Lost = Callable[[], None]


class Line(Protocol):
    """Bytes out, bytes in."""

    @property
    def is_open(self) -> bool:
        """Return whether bytes can be sent."""

    @property
    def character_s(self) -> float:
        """Return how long one character takes, 0 where somebody else keeps the time of the bus."""

    @property
    def advice(self) -> str:
        """Return what to check when the line cannot be opened."""

    async def open(self, received: Received, lost: Lost) -> bool:
        """Open the line, and return whether that worked; `lost` is called when it breaks by itself."""

    def write(self, data: bytes) -> None:
        """Send bytes, or raise `OSError`."""

    def close(self) -> None:
        """Close the line and forget what was not sent."""


class SerialLine:
    """A serial device, opened for this program alone; a pseudo-terminal does as well."""

    def __init__(self, config: SerialConfig) -> None:
        self._config = config
        self._port: serial.Serial | None = None
        self._received: Received = _nobody
        self._lost: Lost = _nothing
        self._why = ""

    @property
    def is_open(self) -> bool:
        """Return whether the device is open."""
        return self._port is not None

    @property
    def character_s(self) -> float:
        """Return how long one character takes."""
        return self._config.bits / self._config.baud_rate

    @property
    def advice(self) -> Message:
        """Return what to check when the device cannot be opened."""
        return say(
            "Check that the adapter {port} is plugged in and not in use{why}.",
            port=self._config.port,
            why=self._why,
        )

    async def open(self, received: Received, lost: Lost) -> bool:
        """Open the device beside the loop, as drivers may take their time."""
        opening = asyncio.ensure_future(asyncio.to_thread(self._open))
        try:
            port = await asyncio.shield(opening)
        except asyncio.CancelledError:
            opening.add_done_callback(_close_unwanted)
            raise
        except (OSError, ValueError, termios.error) as error:
            number = error.args[0] if error.args else None
            self._why = f" ({os.strerror(number)})" if isinstance(number, int) else ""
            return False
        self._port, self._received, self._lost = port, received, lost
        asyncio.get_running_loop().add_reader(port.fileno(), self._read)
        return True

    def write(self, data: bytes) -> None:
        """Send a frame; the system's buffer always has room for one, else `OSError`."""
        if self._port is None:
            raise OSError(N_("the serial line is closed"))
        if os.write(self._port.fileno(), data) != len(data):
            raise OSError(N_("the serial line accepts no more data"))

    def close(self) -> None:
        """Close the device and forget what was not sent, so that closing does not wait."""
        port, self._port = self._port, None
        if port is None:
            return
        asyncio.get_running_loop().remove_reader(port.fileno())
        with suppress(OSError, termios.error):
            port.reset_output_buffer()
        with suppress(OSError):
            port.close()

    def _open(self) -> serial.Serial:
        """Open the device; a pseudo-terminal knows no parity and refuses to be asked for one again."""
        is_pseudo = os.path.realpath(self._config.port).startswith(PSEUDO_TERMINALS)
        return serial.Serial(
            self._config.port,
            baudrate=self._config.baud_rate,
            parity=PARITIES[Parity.NONE if is_pseudo else self._config.parity],
            stopbits=self._config.stop_bits,
            timeout=0,
            write_timeout=0,
            exclusive=True,
        )

    def _read(self) -> None:
        if self._port is None:
            return
        try:
            data = os.read(self._port.fileno(), CHUNK)
        except BlockingIOError:
            return
        except OSError:
            data = b""
        if data:
            self._received(data)
            return
        self.close()
        self._lost()


class TcpLine:
    """A gateway that passes raw RTU frames on; it keeps the silences of its serial side."""

    def __init__(self, host: str, port: int) -> None:
        self._host = host
        self._port = port
        self._transport: asyncio.WriteTransport | None = None

    @property
    def is_open(self) -> bool:
        """Return whether there is a live connection."""
        return self._transport is not None

    @property
    def character_s(self) -> float:
        """Return 0: the gateway keeps the time of the bus."""
        return 0.0

    @property
    def advice(self) -> Message:
        """Return what to check when there is no connection."""
        return N_(
            "Check the gateway's power, cable, and address, and that it passes raw RTU frames on "
            "(not Modbus TCP)."
        )

    async def open(self, received: Received, lost: Lost) -> bool:
        """Connect, and return whether that worked."""
        loop = asyncio.get_running_loop()
        make = partial(_Stream, received, partial(self._on_lost, lost))
        try:
            async with asyncio.timeout(CONNECT_WITHIN_S):
                transport, _ = await loop.create_connection(make, self._host, self._port)
        except (OSError, TimeoutError):
            return False
        self._transport = transport
        return True

    def write(self, data: bytes) -> None:
        """Send bytes, or raise `OSError`."""
        if self._transport is None:
            raise OSError(N_("the connection is closed"))
        self._transport.write(data)

    def close(self) -> None:
        """Cut the connection."""
        transport, self._transport = self._transport, None
        if transport is not None:
            transport.abort()

    def _on_lost(self, lost: Lost, transport: asyncio.BaseTransport | None) -> None:
        if self._transport is not None and self._transport is transport:
            self._transport = None
            lost()


class _Stream(asyncio.Protocol):
    def __init__(self, received: Received, lost: Callable[[asyncio.BaseTransport | None], None]) -> None:
        self._received = received
        self._lost = lost
        self._transport: asyncio.BaseTransport | None = None

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        self._transport = transport

    def data_received(self, data: bytes) -> None:
        self._received(data)

    def connection_lost(self, exc: Exception | None) -> None:
        self._lost(self._transport)


def list_ports() -> tuple[tuple[str, str], ...]:
    """Return this computer's serial ports, each as its most lasting name and what hangs on it."""
    found = serial_list_ports.comports(include_links=True)
    lasting = {os.path.realpath(port.device): port.device for port in found if "/by-id/" in port.device}
    return tuple(
        sorted(
            (lasting.get(port.device, port.device), port.description or N_("serial port"))
            for port in found
            if not os.path.islink(port.device)
        )
    )


def _nobody(_: bytes) -> None:
    """Take bytes that nobody waits for."""


def _nothing() -> None:
    """Do nothing."""


def _close_unwanted(opening: "asyncio.Future[serial.Serial]") -> None:
    if not opening.cancelled() and opening.exception() is None:
        opening.result().close()
