"""A broker of MQTT 5 and 3.1.1 that answers as a test says, in this process."""

import asyncio
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager, suppress
from dataclasses import dataclass, field

CONNECT, CONNACK, PUBLISH, PUBACK, PUBREC, PUBREL, PUBCOMP = 1, 2, 3, 4, 5, 6, 7
SUBSCRIBE, SUBACK, PING, PONG, DISCONNECT = 8, 9, 12, 13, 14
SERVER_REFERENCE = 0x1C
MQTT_5 = 5


@dataclass
class Session:
    """One client's connection."""

    client_id: str
    version: int
    writer: asyncio.StreamWriter

    def send(self, kind: int, body: bytes, flags: int = 0) -> None:
        self.writer.write(bytes([kind << 4 | flags]) + _length(len(body)) + body)

    def farewell(self, code: int, server: str = "") -> None:
        """Send DISCONNECT with a reason, which only MQTT 5 knows, and close."""
        if self.version == MQTT_5:
            self.send(DISCONNECT, bytes([code]) + _properties(server))
        self.writer.close()


@dataclass
class FakeBroker:
    """What it answers to each packet; `connected` counts the connections, `accepted` is what it took."""

    connack: int = 0
    server: str = ""
    puback: Callable[[str, bytes], int] = lambda topic, payload: 0
    suback: int = 1
    knows_mqtt_5: bool = True
    is_silent: bool = False
    unanswered: list[Session] = field(default_factory=list)
    port: int = 0
    connected: int = 0
    subscribed: int = 0
    accepted: list[tuple[str, bytes]] = field(default_factory=list)
    refused: list[tuple[str, bytes]] = field(default_factory=list)
    acknowledged: list[tuple[int, int]] = field(default_factory=list)
    sessions: dict[str, Session] = field(default_factory=dict)

    @property
    def session(self) -> Session:
        return next(iter(self.sessions.values()))

    def publish(self, topic: bytes, payload: bytes, *, qos: int = 0, flags: int = 0, mid: int = 1) -> None:
        """Send a message to the client, with the flags DUP (8) and RETAIN (1) if they are given."""
        identifier = _short(mid) if qos else b""
        body = _text(topic) + identifier + b"\x00" + payload
        self.session.send(PUBLISH, body, flags | qos << 1)

    def told(self, topic: str) -> list[bytes]:
        return [payload for name, payload in self.accepted if name == topic]

    async def serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        session: Session | None = None
        with suppress(OSError, EOFError):
            while True:
                first, body = await _packet(reader)
                if first >> 4 == CONNECT:
                    session = self._connect(body, writer)
                elif session is None or first >> 4 == DISCONNECT:
                    break
                else:
                    self._answer(session, first, body)
        if session is not None and self.sessions.get(session.client_id) is session:
            del self.sessions[session.client_id]
        writer.close()

    def _connect(self, body: bytes, writer: asyncio.StreamWriter) -> Session:
        version, rest = body[6], body[10:]
        if version == MQTT_5:
            rest = rest[1 + rest[0] :]
        name = rest[2 : 2 + int.from_bytes(rest[:2])].decode()
        session = Session(name, version, writer)
        if self.is_silent:
            self.unanswered.append(session)
            return session
        if version == MQTT_5 and not self.knows_mqtt_5:
            session.send(CONNACK, b"\x00\x01")
            writer.close()
            return session
        session.send(
            CONNACK, bytes([0, self.connack]) + (_properties(self.server) if version == MQTT_5 else b"")
        )
        if self.connack:
            writer.close()
            return session
        self.connected += 1
        older = self.sessions.pop(name, None)
        if older is not None:
            older.farewell(0x8E)
        self.sessions[name] = session
        return session

    def _answer(self, session: Session, first: int, body: bytes) -> None:
        match first >> 4:
            case 3:
                self._take(session, first >> 1 & 3, body)
            case 4 | 5 | 7:
                self.acknowledged.append((first >> 4, int.from_bytes(body[:2])))
            case 8:
                self.subscribed += 1
                session.send(SUBACK, body[:2] + b"\x00" + bytes([self.suback]))
            case 12:
                session.send(PONG, b"")

    def _take(self, session: Session, qos: int, body: bytes) -> None:
        end = 2 + int.from_bytes(body[:2])
        topic, rest = body[2:end].decode(), body[end:]
        mid, rest = (rest[:2], rest[2:]) if qos else (b"", rest)
        payload = rest[1 + rest[0] :] if session.version == MQTT_5 else rest
        code = self.puback(topic, payload) if qos else 0
        (self.refused if code >= 0x80 else self.accepted).append((topic, payload))
        if qos:
            session.send(PUBACK, mid + (bytes([code]) if code else b""))


@asynccontextmanager
async def serving(broker: FakeBroker) -> AsyncIterator[FakeBroker]:
    server = await asyncio.start_server(broker.serve, "127.0.0.1", 0)
    broker.port = server.sockets[0].getsockname()[1]
    try:
        yield broker
    finally:
        server.close()
        for session in list(broker.sessions.values()):
            session.writer.close()
        await server.wait_closed()


async def _packet(reader: asyncio.StreamReader) -> tuple[int, bytes]:
    first, length, shift = (await reader.readexactly(1))[0], 0, 0
    while True:
        digit = (await reader.readexactly(1))[0]
        length |= (digit & 0x7F) << shift
        shift += 7
        if digit < 0x80:
            return first, await reader.readexactly(length)


def _length(number: int) -> bytes:
    digits = bytearray()
    while True:
        number, digit = divmod(number, 128)
        digits.append(digit | (0x80 if number else 0))
        if not number:
            return bytes(digits)


def _short(number: int) -> bytes:
    return number.to_bytes(2)


def _text(text: bytes) -> bytes:
    return _short(len(text)) + text


def _properties(server: str) -> bytes:
    told = bytes([SERVER_REFERENCE]) + _text(server.encode()) if server else b""
    return bytes([len(told)]) + told
