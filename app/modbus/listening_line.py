"""The far end of RTU over TCP: what a gateway is to its master."""

import asyncio
import socket
from struct import pack
from typing import cast

from app.base.message import Message, say
from app.modbus.line import Lost, Received


class ListeningLine:
    """Raw RTU frames on a TCP port; a new client takes the place of the one before."""

    def __init__(self, host: str, port: int) -> None:
        self.host = host
        self.port = port
        self._server: asyncio.Server | None = None
        self._client: _Client | None = None

    @property
    def is_open(self) -> bool:
        """Return whether somebody is connected."""
        return self._client is not None

    @property
    def character_s(self) -> float:
        """Return 0: there is no line with a speed."""
        return 0.0

    @property
    def advice(self) -> Message:
        """Return what to check when the port cannot be listened on."""
        return say("Check that no other program uses port {port}.", port=self.port)

    async def open(self, received: Received, lost: Lost) -> bool:
        """Listen, or raise `OSError`; port 0 takes a free one. `lost` is never called."""

        def made() -> asyncio.Protocol:
            return _Client(self, received)

        self._server = await asyncio.get_running_loop().create_server(made, self.host, self.port)
        self.port = int(self._server.sockets[0].getsockname()[1])
        return True

    def write(self, data: bytes) -> None:
        """Send bytes to the client, if there is one."""
        if self._client is not None:
            self._client.transport.write(data)

    def close(self) -> None:
        """Stop listening and cut the connection."""
        if self._server is not None:
            self._server.close()
        self.cut()

    def cut(self, *, reset: bool = False) -> None:
        """Close the connection, or reset it; a new one can be made."""
        client, self._client = self._client, None
        if client is None:
            return
        if reset:
            connection = client.transport.get_extra_info("socket")
            connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, pack("ii", 1, 0))
        client.transport.abort()

    def join(self, client: "_Client") -> None:
        """Let a client take the place of the one before."""
        self.cut()
        self._client = client

    def leave(self, client: "_Client") -> None:
        """Note that a client is gone."""
        if self._client is client:
            self._client = None


class _Client(asyncio.Protocol):
    transport: asyncio.Transport

    def __init__(self, line: ListeningLine, received: Received) -> None:
        self._line = line
        self._received = received

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        self.transport = cast("asyncio.Transport", transport)
        self._line.join(self)

    def data_received(self, data: bytes) -> None:
        self._received(data)

    def connection_lost(self, exc: Exception | None) -> None:
        self._line.leave(self)
