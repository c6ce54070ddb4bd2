"""A client that floods: live sockets that send all they can at once and read nothing until closed."""

import base64
import json
import os
import socket
import struct
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

WITHIN_S = 20.0


def frame(message: dict[str, Any]) -> bytes:
    """Return one text frame, masked as a client's must be."""
    body = json.dumps(message).encode()
    mask = os.urandom(4)
    length = bytes([0x80 | len(body)]) if len(body) < 126 else struct.pack(">BH", 0x80 | 126, len(body))
    masked = bytes(one ^ mask[place % 4] for place, one in enumerate(body))
    return b"\x81" + length + mask + masked


def stops(count: int) -> bytes:
    """Return so many stops of T1."""
    return frame({"type": "stop", "tracker_id": "T1"}) * count


def ends(count: int) -> bytes:
    """Return the ends of so many presses."""
    return b"".join(frame({"type": "end_jog", "tracker_id": "T1", "press_id": f"p{n}"}) for n in range(count))


@dataclass
class Flooding:
    """One live socket."""

    raw: socket.socket
    heard: bytes = b""

    @classmethod
    def open(cls, port: int, token: str = "") -> "Flooding":
        """Return a live socket, opened with a token where one is given."""
        raw = socket.create_connection(("127.0.0.1", port), WITHIN_S)
        bearer = f"Authorization: Bearer {token}\r\n" if token else ""
        key = base64.b64encode(os.urandom(16)).decode()
        raw.sendall(
            f"GET /live?tracker=T1 HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\n{bearer}"
            f"Connection: Upgrade\r\nSec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n".encode()
        )
        one = cls(raw)
        while b"\r\n\r\n" not in one.heard:
            one.heard += raw.recv(65536)
        head, _, one.heard = one.heard.partition(b"\r\n\r\n")
        assert head.startswith(b"HTTP/1.1 101"), head
        return one

    def send(self, frames: bytes) -> None:
        """Send this at once; what the other end does not take any more is left."""
        try:
            self.raw.sendall(frames)
        except OSError:
            return

    def closed(self) -> tuple[int, str]:
        """Read until the other end closes, and return its code and its reason."""
        while True:
            for opcode, payload in self._frames():
                if opcode == 0x8:
                    self.raw.close()
                    return int.from_bytes(payload[:2], "big"), payload[2:].decode()
            more = self.raw.recv(65536)
            assert more, "The connection ended without a word."
            self.heard += more

    def _frames(self) -> Iterable[tuple[int, bytes]]:
        while len(self.heard) >= 2:
            size, head = self.heard[1] & 0x7F, 2
            if size == 126:
                size, head = int.from_bytes(self.heard[2:4], "big"), 4
            elif size == 127:
                size, head = int.from_bytes(self.heard[2:10], "big"), 10
            if len(self.heard) < head + size:
                return
            opcode, payload = self.heard[0] & 0x0F, self.heard[head : head + size]
            self.heard = self.heard[head + size :]
            yield opcode, payload
