"""A Modbus TCP device that answers as the test says: right, wrong, late, in pieces or not at all."""

import asyncio
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from struct import pack, unpack_from

Answer = Callable[[bytes], list[bytes | None]]
"""Gets the whole request; returns the pieces of the reply, None among them cuts the line."""


class ScriptedServer:
    """Plays one answer a request, then the last one for ever."""

    def __init__(self, *script: Answer) -> None:
        self.script = list(script)
        self.requests: list[bytes] = []
        self.connections = 0
        self.port = 0
        self._tasks: set[asyncio.Task[None]] = set()
        self._server: asyncio.Server | None = None

    async def start(self, port: int = 0) -> None:
        self._server = await asyncio.start_server(self._begin, "127.0.0.1", port)
        self.port = self._server.sockets[0].getsockname()[1]

    async def close(self) -> None:
        assert self._server is not None
        self._server.close()
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)
        await self._server.wait_closed()

    def _begin(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self.connections += 1
        task = asyncio.create_task(self._serve(reader, writer))
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        try:
            while True:
                header = await reader.readexactly(6)
                request = header + await reader.readexactly(unpack_from(">H", header, 4)[0])
                self.requests.append(request)
                answer = self.script.pop(0) if len(self.script) > 1 else self.script[0]
                for piece in answer(request):
                    if piece is None:
                        return
                    writer.write(piece)
                    await writer.drain()
                    await asyncio.sleep(0.005)
        except (asyncio.IncompleteReadError, ConnectionError):
            pass
        finally:
            writer.close()


@asynccontextmanager
async def scripted(*script: Answer) -> AsyncIterator[ScriptedServer]:
    server = ScriptedServer(*script)
    await server.start()
    try:
        yield server
    finally:
        await server.close()


def words_of(request: bytes) -> list[int]:
    """The registers that a good device holds: each one its own address times three."""
    address, count = unpack_from(">HH", request, 8)
    return [(address + place) * 3 & 0xFFFF for place in range(count)]


def right(request: bytes) -> bytes:
    """The right reply to a read (function 3) or a write (6, 16)."""
    if request[7] == 3:
        words = words_of(request)
        body = pack(f">BB{len(words)}H", 3, 2 * len(words), *words)
    else:
        body = request[7:12]
    return request[:4] + pack(">HB", len(body) + 1, request[6]) + body


def good(request: bytes) -> list[bytes | None]:
    return [right(request)]


def changed(place: int, value: int) -> Answer:
    """The right reply with one byte replaced."""

    def answer(request: bytes) -> list[bytes | None]:
        reply = bytearray(right(request))
        reply[place] = value
        return [bytes(reply)]

    return answer


def exception(code: int) -> Answer:
    return lambda request: [request[:4] + pack(">HBBB", 3, request[6], request[7] | 0x80, code)]


def silent(request: bytes) -> list[bytes | None]:
    return []


def cut(request: bytes) -> list[bytes | None]:
    return [None]
